//! Cutting along a curve on the surface: triangles under it are divided, so that the border lies on it.
//!
//! The curve's points are put into triangles, and the planes through neighbouring points are followed from triangle to
//! triangle (`walk.rs`, `track.rs`). The track never meets a vertex, so that each triangle that it passes is divided by
//! chains from edge to edge (`polygons.rs`), and the polygons are cut into triangles. Points on an edge belong to the
//! surface's edge, so no crack opens; those next to a vertex are put onto it (`snaps.rs`), where they would leave slivers.
//! The sides are found by joining everything but across the track (`sides.rs`).

mod line;
mod polygons;
mod sides;
mod snaps;
mod track;
mod walk;

use std::collections::{BTreeMap, BTreeSet};

use pliant_mesh::{DrawnVertex, SurfaceVertex};

pub use self::line::{Sight, SurfaceCurve};
use self::polygons::{Chains, Divided, FIRST_STATION};
use self::sides::Sides;
use self::snaps::Snaps;
use self::track::{Station, Track};
use crate::error::StitchError;
use crate::part::Part;
use crate::pieces::{Corner, CutPoint, Pieces};
use crate::plane::Keep;
use crate::shape::{Age, NewShape, TriangleSource};

impl NewShape {
    /// Cuts a part along a curve on its surface. The positive side is to the left of the curve, seen from outside along
    /// it. Vertices that are left keep their order and come before new ones; connected parts that the curve does not
    /// touch stay. `spared` has a flag for each surface vertex of whole connected parts that it leaves alone; a missing
    /// one is false.
    ///
    /// # Errors
    /// A curve with too few points, that ends inside the surface, that can't follow it, that crosses itself, or with
    /// one side to keep that does not divide the surface.
    pub fn cut_along_curve(
        part: &Part<'_>,
        curve: &SurfaceCurve,
        keep: Keep,
        spared: &[bool],
    ) -> Result<Self, StitchError> {
        let track = Track::of(part.model, curve, spared)?;
        let divided = divided(part, &track, curve.is_closed)?;
        let sides = Sides::of(part.model, &track, divided.values().map(|(own, _)| own));
        if keep != Keep::Both && !sides.are_apart() {
            return Err(StitchError::CurveDividesNothing);
        }
        let keeps = |is_left: Option<bool>| match keep {
            Keep::Both => true,
            Keep::Positive => is_left != Some(false),
            Keep::Negative => is_left != Some(true),
        };
        let mut cutting = Cutting {
            part,
            track: &track,
            pieces: Pieces {
                surface_points: track.stations.len(),
                ..Pieces::default()
            },
            point_of: BTreeMap::new(),
        };
        let surface_vertex = |corner: DrawnVertex| part.model.drawn.surface_vertex(corner);
        for (triangle, corners) in (0..).zip(&part.drawn.triangles) {
            let [Some(a), Some(b), Some(c)] = corners.map(surface_vertex) else {
                continue;
            };
            let source = |age| TriangleSource { part: 0, triangle, age };
            match divided.get(&sorted([a, b, c])) {
                Some((own, first)) => {
                    for (number, triangles) in (*first..).zip(&own.triangles) {
                        if keeps(sides.of_polygon(number)) {
                            cutting.add(own, triangles, (*corners, [a, b, c]), source(Age::New));
                        }
                    }
                }
                // A triangle without an area has corners on both sides if the track passes it: it goes.
                None => {
                    let is_kept = keeps(sides.of_vertex(a));
                    if is_kept && [b, c].iter().all(|v| sides.of_vertex(*v) == sides.of_vertex(a)) {
                        let whole = corners.map(Corner::Old);
                        cutting.pieces.triangles.push((whole, source(Age::Old)));
                    }
                }
            }
        }
        Ok(cutting.pieces.shape(part, |_| true))
    }
}

/// The divided triangles, by their sorted corners, each with the number of its first polygon.
fn divided(
    part: &Part<'_>,
    track: &Track,
    is_closed: bool,
) -> Result<BTreeMap<[SurfaceVertex; 3], (Divided, usize)>, StitchError> {
    let (model, stations) = (part.model, &track.stations);
    let chains = chains(track);
    let mut snaps = Snaps::of(model, track, is_closed);
    let divide = |triangle: u32, chains: &Chains, snaps: &Snaps| {
        let corners = model.surface.triangles[triangle as usize];
        let position = |point: u32| match point.checked_sub(FIRST_STATION) {
            Some(station) => stations[station as usize].position(model),
            None => model.surface.positions[corners[point as usize].index()],
        };
        let length = |a: u32, b: u32| position(a).distance_squared(position(b));
        Divided::of(corners, chains, (stations, snaps), length)
    };
    let mut of_triangle: BTreeMap<u32, Divided> = BTreeMap::new();
    let mut waiting: Vec<u32> = chains.keys().copied().collect();
    while !waiting.is_empty() {
        let mut undivided = BTreeSet::new();
        for triangle in waiting {
            match divide(triangle, &chains[&triangle], &snaps) {
                Some(own) => drop(of_triangle.insert(triangle, own)),
                None => undivided.extend(model.surface.triangles[triangle as usize]),
            }
        }
        // A triangle that can't be divided with stations on its corners gets them back.
        let changed = snaps.forget(|vertex| undivided.contains(&vertex));
        if changed.is_empty() && !undivided.is_empty() {
            return Err(StitchError::CurveCrossesItself);
        }
        let is_changed = |triangle: &&u32| {
            let corners = model.surface.triangles[**triangle as usize];
            corners.iter().any(|corner| changed.contains(corner))
        };
        waiting = chains.keys().filter(is_changed).copied().collect();
    }
    let of_triangle = of_triangle.into_values();
    let mut divided: BTreeMap<[SurfaceVertex; 3], (Divided, usize)> =
        of_triangle.map(|own| (sorted(own.corners), (own, 0))).collect();
    let mut count = 0;
    for (own, first) in divided.values_mut() {
        *first = count;
        count += own.polygons.len();
    }
    Ok(divided)
}

/// The parts of a track in each triangle.
fn chains(track: &Track) -> BTreeMap<u32, Chains> {
    let mut chains: BTreeMap<u32, Chains> = BTreeMap::new();
    let count = track.stations.len();
    let is_inside = |station: usize| matches!(track.stations[station], Station::Inside { .. });
    if is_inside(0) {
        let ring = Some((0..count).collect());
        let open = Vec::new();
        return [(track.triangles[0], Chains { open, ring })].into();
    }
    let mut chain = vec![0];
    for (from, triangle) in (0..).zip(&track.triangles) {
        let to = (from + 1) % count;
        chain.push(to);
        if !is_inside(to) {
            let own = std::mem::replace(&mut chain, vec![to]);
            chains.entry(*triangle).or_default().open.push(own);
        }
    }
    chains
}

fn sorted(mut corners: [SurfaceVertex; 3]) -> [SurfaceVertex; 3] {
    corners.sort_unstable();
    corners
}

struct Cutting<'a> {
    part: &'a Part<'a>,
    track: &'a Track,
    pieces: Pieces,
    point_of: BTreeMap<(u32, [DrawnVertex; 3]), u32>,
}

impl Cutting<'_> {
    /// Adds pieces of a drawn triangle, whose corners are given as drawn and as surface vertices.
    fn add(
        &mut self,
        divided: &Divided,
        triangles: &[[u32; 3]],
        (drawn, surface): ([DrawnVertex; 3], [SurfaceVertex; 3]),
        source: TriangleSource,
    ) {
        let place = |vertex: SurfaceVertex| surface.iter().position(|&other| other == vertex).unwrap_or(0);
        let places = divided.corners.map(place);
        let corners = places.map(|place| drawn[place]);
        // Coincident triangles may face opposite ways.
        let is_turned = (places[0] + 1) % 3 != places[1];
        for &triangle in triangles {
            let mut piece = triangle.map(|point| match point.checked_sub(FIRST_STATION) {
                Some(station) => Corner::New(self.point(station, divided.corners, corners)),
                None => Corner::Old(corners[point as usize]),
            });
            if is_turned {
                piece.reverse();
            }
            self.pieces.triangles.push((piece, source));
        }
    }

    /// The cut point of a station, between these corners of a drawn triangle.
    fn point(&mut self, station: u32, of_surface: [SurfaceVertex; 3], corners: [DrawnVertex; 3]) -> u32 {
        let own = self.track.stations[station as usize];
        let (corners, shares) = match own {
            Station::Inside { weights, .. } => (corners, [weights.y / (weights.x + weights.y), weights.z]),
            Station::On(crossing) => {
                let place = |end: SurfaceVertex| of_surface.iter().position(|&corner| corner == end).unwrap_or(0);
                let [from, to] = crossing.ends.map(|end| corners[place(end)]);
                ([from, to, to], [crossing.share, 0.0])
            }
        };
        let points = &mut self.pieces.points;
        *self.point_of.entry((station, corners)).or_insert_with(|| {
            points.push(CutPoint {
                corners,
                shares,
                position: own.position(self.part.model),
                on_surface: station,
            });
            points.len() as u32 - 1
        })
    }
}
