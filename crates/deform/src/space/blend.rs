//! Displacements blended from a few affine motions, which give way to handles and to fixed vertices.
//!
//! d(p) = b(p) + Σ_h u_h(p) (H_h p − b(p)), b(p) = Σ_k w_k(p) (M_k (p − c_k) + t_k): the motions k of nodes or cells
//! with weights that sum to 1, and the affine motions H_h of hard handles; for fixed vertices H is zero. The weight u_h
//! is 1 at the vertices of h, with slope 0, and fades with the distance to the nearest of them; if several are near,
//! their weights are those of Shepard's interpolation [She68]. So handles are met exactly, fixed vertices rest, and
//! their surroundings move with them to the second order of the distance, with or without triangles between them.

use glam::{DMat3, DVec3, Mat3, Vec3};
use rayon::prelude::*;

use super::hand_field::outer;
use super::moving::Moving;
use super::neighbours::Neighbours;
use super::shaping::shaping;
use crate::handles::Motion;
use crate::handles::finite::Finite;
use crate::method::BindInput;
use crate::{BindError, Role};

/// An affine motion: a point p is displaced by `linear (p − world_centre) + shift`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Affine {
    pub world_centre: DVec3,
    /// The linear part less the identity.
    pub linear: DMat3,
    pub shift: DVec3,
}

/// The weight of a motion at a point.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Share {
    pub source: u32,
    /// The weight's gradient per world unit, in single precision, because only normals are made of it.
    pub slope: Vec3,
    pub weight: f64,
}

/// A few shares for each of some points, as compressed rows.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shares {
    offsets: Vec<u32>,
    list: Vec<Share>,
}

/// The blend at every vertex of a frame.
#[derive(Debug)]
pub(crate) struct Blend {
    moving: Moving,
    /// The rest positions of the rows.
    world_places: Vec<DVec3>,
    /// The shares of the motions at each row.
    shares: Shares,
    /// The shares of the handles' motions at each row, by their numbers; the next number is that of the fixed vertices.
    holds: Shares,
    /// Each handle's centre and unit of length.
    frames: Vec<(DVec3, f64)>,
}

/// The vertices that a hard handle holds, or those that are fixed.
struct Hold {
    tree: Neighbours,
    world_places: Vec<DVec3>,
    /// Their box.
    world_low: DVec3,
    world_high: DVec3,
}

/// The number of points that one task weighs.
const AT_ONCE: usize = 256;

impl Blend {
    /// `weigh` gives the shares of the motions at a point, whose weights sum to 1. `width` is the reach of handles and
    /// fixed vertices, in world units.
    ///
    /// # Errors
    /// It was cancelled.
    pub fn bind(
        input: &BindInput<'_>,
        width: f64,
        weigh: impl Fn(DVec3) -> Vec<Share> + Sync,
    ) -> Result<Self, BindError> {
        let positions = &input.problem.surface.positions;
        let moving = Moving::of(input);
        let world_places: Vec<DVec3> = moving
            .vertices
            .iter()
            .map(|&vertex| positions[vertex as usize])
            .collect();
        let places = |vertices: Vec<u32>| vertices.iter().map(|&vertex| positions[vertex as usize]).collect();
        let of_handles = input.handles.iter().zip(&input.partition.soft);
        let of_handles = of_handles.map(|(handle, soft)| match soft {
            Some(_) => Hold::of(Vec::new()),
            None => Hold::of(places(shaping(input.problem, handle.vertices.iter().copied()))),
        });
        let roles = input.problem.roles;
        let fixed = (0..roles.len() as u32).filter(|&vertex| roles[vertex as usize] == Role::Fixed);
        let fixed = Hold::of(places(shaping(input.problem, fixed)));
        let all: Vec<Hold> = of_handles.chain([fixed]).collect();
        Ok(Self {
            shares: Shares::of(&world_places, input, &weigh)?,
            holds: Shares::of(&world_places, input, |place| held_by(place, &all, width))?,
            frames: input
                .handles
                .iter()
                .map(|handle| (handle.world_centre, handle.radius))
                .collect(),
            world_places,
            moving,
        })
    }

    /// The number of blended vertices.
    pub fn row_count(&self) -> usize {
        self.moving.vertices.len()
    }

    /// Fills all of `displacements`.
    pub fn frame(&self, affine: &[Affine], motions: &[Motion], displacements: &mut [DVec3]) -> Finite {
        let holds = self.hold_motions(motions);
        self.moving.displace(motions, displacements, |row| {
            let place = self.world_places[row];
            let reached = blended(self.shares.row(row), affine, place);
            let held = self.holds.row(row).iter();
            let held = held.map(|share| (holds[share.source as usize].displacement(place) - reached) * share.weight);
            reached + held.sum::<DVec3>()
        })
    }

    /// The Jacobian of the displacements.
    pub fn jacobians(&self, affine: &[Affine], motions: &[Motion], out: &mut [Mat3]) {
        let holds = self.hold_motions(motions);
        self.moving.jacobians(motions, out, |row| {
            let (place, shares) = (self.world_places[row], self.shares.row(row));
            let reached = blended(shares, affine, place);
            let own = blended_jacobian(shares, affine, place, reached);
            let mut sum = own;
            for share in self.holds.row(row) {
                let hold = &holds[share.source as usize];
                sum += (hold.linear - own) * share.weight;
                sum += outer(hold.displacement(place) - reached, share.slope.as_dvec3());
            }
            sum.as_mat3()
        });
    }

    /// The motions of the handles, and that of the fixed vertices.
    fn hold_motions(&self, motions: &[Motion]) -> Vec<Affine> {
        let of_handles = self.frames.iter().zip(motions);
        let of_handles = of_handles.map(|(&(world_centre, radius), motion)| Affine {
            world_centre,
            linear: motion.linear * radius.recip(),
            shift: motion.shift,
        });
        let rest = Affine {
            world_centre: DVec3::ZERO,
            linear: DMat3::ZERO,
            shift: DVec3::ZERO,
        };
        of_handles.chain([rest]).collect()
    }
}

impl Hold {
    fn of(world_places: Vec<DVec3>) -> Self {
        let (world_low, world_high) = world_places
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &place| {
                (low.min(place), high.max(place))
            });
        Self {
            tree: Neighbours::of(&world_places),
            world_places,
            world_low,
            world_high,
        }
    }

    /// The vector from its nearest vertex to a point that is less than `width` away.
    fn away(&self, place: DVec3, width: f64) -> Option<DVec3> {
        let beside = place.clamp(self.world_low, self.world_high);
        if self.world_places.is_empty() || beside.distance_squared(place) >= width * width {
            return None;
        }
        let &(nearest, distance) = self.tree.nearest_within(place, 1, width).first()?;
        (distance < width).then(|| place - self.world_places[nearest as usize])
    }
}

impl Affine {
    /// The displacement of a point.
    pub fn displacement(&self, world_point: DVec3) -> DVec3 {
        self.linear * (world_point - self.world_centre) + self.shift
    }
}

impl Shares {
    fn of(
        places: &[DVec3],
        input: &BindInput<'_>,
        weigh: impl Fn(DVec3) -> Vec<Share> + Sync,
    ) -> Result<Self, BindError> {
        let chunks = places.par_chunks(AT_ONCE).map(|places| {
            input.cancel.check()?;
            let (mut ends, mut list) = (Vec::with_capacity(places.len()), Vec::new());
            for &place in places {
                list.extend(weigh(place));
                ends.push(list.len() as u32);
            }
            Ok::<_, BindError>((ends, list))
        });
        let chunks: Vec<_> = chunks.collect::<Result<_, _>>()?;
        let mut shares = Self {
            offsets: Vec::with_capacity(places.len() + 1),
            list: Vec::with_capacity(chunks.iter().map(|(_, list)| list.len()).sum()),
        };
        shares.offsets.push(0);
        for (ends, list) in chunks {
            let first = shares.list.len() as u32;
            shares.offsets.extend(ends.iter().map(|end| first + end));
            shares.list.extend(list);
        }
        Ok(shares)
    }

    fn row(&self, number: usize) -> &[Share] {
        &self.list[self.offsets[number] as usize..self.offsets[number + 1] as usize]
    }
}

fn blended(shares: &[Share], affine: &[Affine], world_place: DVec3) -> DVec3 {
    let each = shares.iter();
    each.map(|share| affine[share.source as usize].displacement(world_place) * share.weight)
        .sum()
}

/// The Jacobian of [`blended`], whose displacement there is `reached`. The weights' gradients sum to zero except for
/// their single precision: applied to differences they give zero if all motions agree.
fn blended_jacobian(shares: &[Share], affine: &[Affine], world_place: DVec3, reached: DVec3) -> DMat3 {
    let mut sum = DMat3::ZERO;
    for share in shares {
        let own = &affine[share.source as usize];
        sum += outer(own.displacement(world_place) - reached, share.slope.as_dvec3()) + own.linear * share.weight;
    }
    sum
}

/// Weights and their gradients, from those of weights that do not sum to 1 yet.
pub(crate) fn normalised(raw: &[(u32, f64, DVec3)]) -> Vec<Share> {
    let sum: f64 = raw.iter().map(|(_, weight, _)| weight).sum();
    let slope: DVec3 = raw.iter().map(|(_, _, slope)| *slope).sum();
    let share = |&(source, weight, own): &(u32, f64, DVec3)| Share {
        source,
        slope: ((own - slope * (weight / sum)) / sum).as_vec3(),
        weight: weight / sum,
    };
    raw.iter().map(share).collect()
}

/// The shares with which these hold a point: with the distances d_h the weights are (1/d_h − 1/width)² over their sum,
/// times s(d_min/width), s(u) = (1 − u)⁴ (1 + 4 u) [Wen95]. The handle's motion and b may differ in their slopes by G;
/// then u s(u) adds at most 0.44 G on the way back to b, where the smoothstep adds 0.67 G.
fn held_by(place: DVec3, all: &[Hold], width: f64) -> Vec<Share> {
    let near = (0..)
        .zip(all)
        .filter_map(|(number, hold)| Some((number, hold.away(place, width)?)));
    let near: Vec<(u32, DVec3, f64)> = near.map(|(number, away)| (number, away, away.length())).collect();
    let Some(&(source, away, least)) = near.iter().min_by(|a, b| a.2.total_cmp(&b.2)) else {
        return Vec::new();
    };
    if least == 0.0 {
        return vec![Share {
            source,
            slope: Vec3::ZERO,
            weight: 1.0,
        }];
    }
    let raw = |&(number, away, distance): &(u32, DVec3, f64)| {
        // Everything is multiplied by the least distance, so that no square overflows.
        let difference = least / distance - least / width;
        let slope = away * (-least / distance.powi(3));
        (number, difference * difference, slope * (2.0 * difference))
    };
    let raw: Vec<(u32, f64, DVec3)> = near.iter().map(raw).collect();
    let mut shares = normalised(&raw);
    let u = least / width;
    let t = 1.0 - u;
    let fade = t.powi(4) * (1.0 + 4.0 * u);
    let fade_slope = away * (-20.0 * t.powi(3) / (width * width));
    for share in &mut shares {
        share.slope = share.slope * fade as f32 + (fade_slope * share.weight).as_vec3();
        share.weight *= fade;
    }
    shares
}
