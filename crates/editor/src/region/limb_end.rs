//! The end of the limb that a handle is on: where it meets another limb.
//!
//! A handle on a thigh has two sides, one towards the foot and one towards the body. On the body's side there are several
//! ways on: the trunk and the other leg. The shortest path from foot to foot turns around in the crotch, where it is
//! nearest to the trunk, so the thigh ends at the crotch's distance from its own foot. The line at that distance
//! goes around the hip without touching the other leg. It is where the Reeb graph of the distance branches [HSKK01],
//! at the centre of the tripod of two feet and the trunk.

use std::f64::consts::PI;

use pliant_mesh::{Cancel, Cancelled, DistanceSearch, Surface, SurfaceVertex, Topology};

use super::fronts::{Way, ways};

/// The surface is looked at within so many radii of the handle: beyond a crotch that is within its reach, and around
/// the other leg.
const AROUND_RADII: f64 = 8.0;

/// A way on is apart from others over at least so many radii.
const WAY_RADII: f64 = 0.25;

/// A limb beside this one has at least this share of the area of this one from the handle on.
const SMALLEST_SHARE: f64 = 0.05;

/// The back of a limb is within so many radii of the handle.
const BACK_RADII: f64 = 3.0;

/// Limbs that meet this one within so many radii beyond its end meet it there.
const NEAR_RADII: f64 = 0.5;

/// A path between two limbs turns around in the middle of the stretch that is nearest to the trunk, but for so many radii.
const TURN_RADII: f64 = 0.25;

/// The limb ends before the turn, where the path no longer comes nearer to the trunk by this share of its length.
const APPROACH: f64 = 0.5;

/// If the turn is nearer than so many radii to the handle's middle, the other limb begins by the difference farther away: the
/// handle needs room to bend.
const ROOM_RADII: f64 = 0.5;

/// Beyond the limb's end, a way counts as so many times longer.
const BEYOND: f64 = 4.0;

/// By how many times ways count as longer at vertices beyond the end of the limb on which a handle with these members is;
/// infinitely many on a limb beside it. `None` if it is on no limb, or the limb meets no other one near the handle. The
/// limb has the scale of a round handle of this radius. Within `room` of the handle, ways on the body keep their length: a
/// handle that is as large as its limb ends where the limb does.
///
/// # Errors
/// [`Cancelled`] soon after `cancel` is raised.
pub(super) fn limb_end(
    search: &mut DistanceSearch,
    surface: &Surface,
    topology: &Topology,
    members: &[(SurfaceVertex, f64)],
    [radius, room]: [f64; 2],
    cancel: &Cancel,
) -> Result<Option<Vec<(SurfaceVertex, f64)>>, Cancelled> {
    let position = |v: SurfaceVertex| surface.positions[v.index()];
    let limit = AROUND_RADII * radius;
    let around = search.within(&surface.triangles, topology, position, members, limit);
    let around = around.to_vec();
    cancel.check()?;
    let least_area = SMALLEST_SHARE * PI * radius.powi(2);
    let ways = ways(
        surface,
        topology,
        &around,
        [WAY_RADII, BACK_RADII].map(|radii| radii * radius),
        least_area,
    );
    let mut is_around = vec![false; surface.positions.len()];
    around.iter().for_each(|(v, _)| is_around[v.index()] = true);
    let mut surroundings = Surroundings {
        search,
        surface,
        topology,
        around,
        is_around,
        members,
        radius,
        cancel,
    };
    let mut limb = match ways.sides() {
        Some([tip, body]) => surroundings.limb(Some(&tip), &body)?,
        None => None,
    };
    if limb.is_none() {
        // The handle may hold the limb's tip itself.
        limb = surroundings.limb(None, &ways.all.iter().collect::<Vec<_>>())?;
    }
    limb.map(|limb| surroundings.beyond(&limb, room)).transpose()
}

/// The surface around a handle.
struct Surroundings<'a> {
    search: &'a mut DistanceSearch,
    surface: &'a Surface,
    topology: &'a Topology,
    around: Vec<(SurfaceVertex, f64)>,
    is_around: Vec<bool>,
    members: &'a [(SurfaceVertex, f64)],
    radius: f64,
    cancel: &'a Cancel,
}

/// The limb that a handle is on.
struct Limb<'a> {
    /// The distances of the surroundings from its tip.
    from_tip: Vec<f64>,
    /// That of the handle's middle.
    middle: f64,
    meetings: Vec<Meeting<'a>>,
}

/// Where another limb meets this one.
struct Meeting<'a> {
    way: &'a Way,
    /// The place at which the path between both limbs' tips turns away from the trunk.
    turn: SurfaceVertex,
    /// The distance from the tip at which this limb ends.
    end: f64,
}

impl Surroundings<'_> {
    /// The limb with this tip that goes on into these ways; without a tip, it is the part of the handle that is farthest
    /// from the largest way. `None` if there is no such limb.
    fn limb<'a>(&mut self, tip: Option<&[&Way]>, ways: &[&'a Way]) -> Result<Option<Limb<'a>>, Cancelled> {
        let Some(trunk) = ways.iter().copied().max_by(|a, b| a.area.total_cmp(&b.area)) else {
            return Ok(None);
        };
        let tip_area: f64 = tip.into_iter().flatten().map(|way| way.area).sum();
        let least_area = SMALLEST_SHARE * (PI * self.radius.powi(2) + tip_area);
        let is_limb = |way: &&Way| !std::ptr::eq(*way, trunk) && way.area >= least_area;
        let others: Vec<&Way> = ways.iter().copied().filter(is_limb).collect();
        if others.is_empty() {
            return Ok(None);
        }
        let from_trunk = self.distances(&trunk.end)?;
        let members = self.members.iter().map(|&(v, _)| v);
        let tip_end: Vec<SurfaceVertex> = match tip {
            Some(tip) => tip.iter().flat_map(|way| way.end.iter().copied()).collect(),
            None => {
                let farthest = members.max_by(|a, b| from_trunk[a.index()].total_cmp(&from_trunk[b.index()]));
                farthest.into_iter().collect()
            }
        };
        let from_tip = self.distances(&tip_end)?;
        let mut at: Vec<f64> = self.members.iter().map(|(v, _)| from_tip[v.index()]).collect();
        at.sort_by(f64::total_cmp);
        let middle = at[at.len() / 2];
        let first = match tip {
            Some(_) => middle - NEAR_RADII * self.radius,
            None => at[at.len() * 3 / 4],
        };
        let meetings = others.into_iter().map(|way| {
            let path = self.path(&from_tip, way);
            let turn = turn(&path, &from_trunk, TURN_RADII * self.radius)?;
            let end = end(&path, &from_trunk, &from_tip)?;
            // If another way leaves before the handle, this is no limb with this tip.
            (from_tip[turn.index()] >= first).then_some(Meeting { way, turn, end })
        });
        let meetings: Option<Vec<Meeting<'a>>> = meetings.collect();
        Ok(meetings.map(|meetings| Limb {
            from_tip,
            middle,
            meetings,
        }))
    }

    /// By how many times ways count as longer beyond a limb's end.
    fn beyond(&mut self, limb: &Limb<'_>, room: f64) -> Result<Vec<(SurfaceVertex, f64)>, Cancelled> {
        let Limb {
            from_tip,
            middle,
            meetings,
        } = limb;
        let nearest = meetings.iter().map(|meeting| meeting.end).fold(f64::INFINITY, f64::min);
        let end = nearest.max(*middle);
        let beyond = self.around.iter().filter(|(v, _)| from_tip[v.index()] > end);
        let times = |&(v, distance): &(SurfaceVertex, f64)| (v, if distance < room { 1.0 } else { BEYOND });
        let mut times: Vec<(SurfaceVertex, f64)> = beyond.map(times).collect();
        let near = |meeting: &&Meeting<'_>| meeting.end <= nearest + NEAR_RADII * self.radius;
        for Meeting { way, turn, .. } in meetings.iter().filter(near).collect::<Vec<_>>() {
            let from_way = self.distances(&way.end)?;
            let room = (middle + ROOM_RADII * self.radius - from_tip[turn.index()]).max(0.0);
            for (v, times) in &mut times {
                let beyond = |distances: &[f64]| distances[v.index()] - distances[turn.index()];
                if beyond(&from_way) + room < beyond(from_tip) {
                    *times = f64::INFINITY;
                }
            }
        }
        Ok(times)
    }

    /// The distances of the surroundings from the nearest of some vertices; infinite elsewhere.
    fn distances(&mut self, from: &[SurfaceVertex]) -> Result<Vec<f64>, Cancelled> {
        self.cancel.check()?;
        let position = |v: SurfaceVertex| self.surface.positions[v.index()];
        let within = |v: SurfaceVertex| if self.is_around[v.index()] { 1.0 } else { f64::INFINITY };
        let seeds: Vec<(SurfaceVertex, f64)> = from.iter().map(|&v| (v, 0.0)).collect();
        let mut distances = vec![f64::INFINITY; self.surface.positions.len()];
        let triangles = &self.surface.triangles;
        // The surroundings bound the search.
        for &(v, at) in self
            .search
            .within_stretched(triangles, self.topology, position, within, &seeds, f64::MAX)
        {
            distances[v.index()] = at;
        }
        Ok(distances)
    }

    /// The path from the end of a way to the tip.
    fn path(&self, from_tip: &[f64], way: &Way) -> Vec<SurfaceVertex> {
        let nearest = |a: &SurfaceVertex, b: &SurfaceVertex| from_tip[a.index()].total_cmp(&from_tip[b.index()]);
        let mut path = Vec::new();
        let mut next = way.end.iter().copied().min_by(nearest);
        while let Some(vertex) = next {
            path.push(vertex);
            let beside = self.topology.neighbours(vertex).iter().copied();
            next = beside.min_by(nearest).filter(|v| nearest(v, &vertex).is_lt());
        }
        path
    }
}

/// The place at which a path turns around: the middle of the stretch that is nearest to the trunk, but for `near`.
fn turn(path: &[SurfaceVertex], from_trunk: &[f64], near: f64) -> Option<SurfaceVertex> {
    let height = |place: &usize| from_trunk[path[*place].index()];
    let lowest = (0..path.len()).min_by(|a, b| height(a).total_cmp(&height(b)))?;
    let is_near = |place: &usize| height(place) <= height(&lowest) + near;
    let first = (0..=lowest).rev().take_while(is_near).last()?;
    let last = (lowest..path.len()).take_while(is_near).last()?;
    path.get((first + last) / 2).copied()
}

/// The distance from the tip at which a limb with this path to another one ends.
fn end(path: &[SurfaceVertex], from_trunk: &[f64], from_tip: &[f64]) -> Option<f64> {
    let height = |v: &SurfaceVertex| from_trunk[v.index()] + APPROACH * from_tip[v.index()];
    let lowest = path.iter().min_by(|a, b| height(a).total_cmp(&height(b)))?;
    Some(from_tip[lowest.index()])
}
