//! Displacements blended from a few affine motions, with what handles are missed by carried off smoothly.
//!
//! d(p) = Σ_k w_k(p) (M_k (p − c_k) + t_k) + Σ_i u_i(p) r_i: the motions k of nodes or cells with weights that sum to 1,
//! and the residuals r_i of constrained vertices, by which the first sum misses where their handle takes them. The
//! weights u_i are those of Shepard's interpolation [She68] among the nearest constrained vertices, faded out over a distance.
//! So handles are met exactly, what is fixed rests, and the surface joins both without a crack. Of constrained vertices
//! that are very close to each other one stands for all.

use glam::{DMat3, DVec3, Mat3, Vec3};
use rayon::prelude::*;

use super::moving::Moving;
use super::neighbours::Neighbours;
use super::samples::apart;
use crate::handles::Motion;
use crate::method::{BindInput, Finite};
use crate::{BindError, Role};

/// An affine motion: a point p is displaced by `linear (p − world_centre) + shift`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Affine {
    pub world_centre: DVec3,
    /// The linear part less the identity.
    pub linear: DMat3,
    pub shift: DVec3,
}

/// The weight of a motion or a residual at a point.
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

/// Every vertex of a frame.
#[derive(Debug)]
pub(crate) struct Blend {
    moving: Moving,
    /// The rest positions of the rows.
    world_places: Vec<DVec3>,
    /// Of the motions at each row.
    shares: Shares,
    /// Of the anchors' residuals at each row.
    carry: Shares,
    anchors: Vec<Anchor>,
    /// Of the motions at each anchor.
    anchor_shares: Shares,
    /// By what each anchor was missed in the last frame.
    residuals: Vec<DVec3>,
}

/// A constrained vertex that free ones are near to.
#[derive(Clone, Copy, Debug)]
struct Anchor {
    world_place: DVec3,
    /// Its handle and the coordinates there; `None` where it is fixed.
    handle: Option<(usize, [f64; 4])>,
}

/// Constrained vertices that carry their residuals are so far apart, as a share of how far these are carried: among
/// points in one place the nearest few would not say how the residuals change.
const APART: f64 = 0.1;

/// So many constrained vertices carry their residuals to a point, less one, whose weight is zero.
const CARRIERS: usize = 7;

/// Points that one task weighs.
const AT_ONCE: usize = 256;

impl Blend {
    /// `weigh` gives the shares of the motions at a point, whose weights sum to 1. Residuals are carried as far as
    /// `width`, in world units.
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
        let handle_at = |(vertex, role): (usize, &Role)| {
            let world_place = positions[vertex];
            let handle = match *role {
                Role::Free => return None,
                Role::Fixed => None,
                Role::Handle(handle) if input.partition.soft[usize::from(handle)].is_some() => return None,
                Role::Handle(handle) => {
                    let handle = usize::from(handle);
                    Some((handle, input.handles[handle].coordinates(world_place)))
                }
            };
            Some(Anchor { world_place, handle })
        };
        let constrained: Vec<Anchor> = input.problem.roles.iter().enumerate().filter_map(handle_at).collect();
        let places: Vec<DVec3> = constrained.iter().map(|anchor| anchor.world_place).collect();
        let kept = apart(&places, APART * width);
        let constrained: Vec<Anchor> = kept.iter().map(|&number| constrained[number]).collect();
        let places: Vec<DVec3> = kept.iter().map(|&number| places[number]).collect();
        let tree = Neighbours::of(&places);
        let mut carry = Shares::of(&world_places, input, |place| carriers(place, &tree, &places, width))?;
        // Only anchors that something hangs on are evaluated.
        let mut number_of = vec![u32::MAX; constrained.len()];
        let mut anchors = Vec::new();
        for share in &mut carry.list {
            let number = &mut number_of[share.source as usize];
            if *number == u32::MAX {
                *number = anchors.len() as u32;
                anchors.push(constrained[share.source as usize]);
            }
            share.source = *number;
        }
        let anchor_places: Vec<DVec3> = anchors.iter().map(|anchor| anchor.world_place).collect();
        Ok(Self {
            shares: Shares::of(&world_places, input, &weigh)?,
            anchor_shares: Shares::of(&anchor_places, input, &weigh)?,
            residuals: vec![DVec3::ZERO; anchors.len()],
            anchors,
            carry,
            world_places,
            moving,
        })
    }

    /// How many vertices are blended.
    pub fn row_count(&self) -> usize {
        self.moving.vertices.len()
    }

    /// Fills all of `displacements`.
    pub fn frame(&mut self, affine: &[Affine], motions: &[Motion], displacements: &mut [DVec3]) -> Finite {
        let (anchors, shares) = (&self.anchors, &self.anchor_shares);
        self.residuals
            .par_iter_mut()
            .enumerate()
            .with_min_len(AT_ONCE)
            .for_each(|(number, residual)| {
                let Anchor { world_place, handle } = anchors[number];
                let target = handle.map_or(DVec3::ZERO, |(handle, coordinates)| {
                    motions[handle].displace(coordinates)
                });
                *residual = target - blended(shares.row(number), affine, world_place);
            });
        self.moving.displace(motions, displacements, |row| {
            let mut sum = blended(self.shares.row(row), affine, self.world_places[row]);
            for share in self.carry.row(row) {
                sum += self.residuals[share.source as usize] * share.weight;
            }
            sum
        })
    }

    /// The Jacobian of the displacements of the last frame, which was made of these motions.
    pub fn jacobians(&self, affine: &[Affine], motions: &[Motion], out: &mut [Mat3]) {
        self.moving.jacobians(motions, out, |row| {
            let mut sum = DMat3::ZERO;
            let mut slide = |along: DVec3, slope: Vec3| {
                let slope = slope.as_dvec3();
                sum += DMat3::from_cols(along * slope.x, along * slope.y, along * slope.z);
            };
            for share in self.carry.row(row) {
                slide(self.residuals[share.source as usize], share.slope);
            }
            let place = self.world_places[row];
            for share in self.shares.row(row) {
                slide(affine[share.source as usize].displacement(place), share.slope);
            }
            for share in self.shares.row(row) {
                sum += affine[share.source as usize].linear * share.weight;
            }
            sum.as_mat3()
        });
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

/// The constrained vertices that carry their residuals to a point: with the distances d_i and the largest of them D,
/// the weights are (1/d_i − 1/D)² over their sum, times s(1 − d_min/width), s(t) = t² (3 − 2 t).
fn carriers(place: DVec3, tree: &Neighbours, places: &[DVec3], width: f64) -> Vec<Share> {
    let nearest = tree.nearest(place, CARRIERS);
    let (Some(&(first, least)), Some(&(last, most))) = (nearest.first(), nearest.last()) else {
        return Vec::new();
    };
    if least >= width {
        return Vec::new();
    }
    let whole = |source: u32| Share {
        source,
        slope: Vec3::ZERO,
        weight: 1.0,
    };
    if least == 0.0 {
        return vec![whole(first)];
    }
    let away = |number: u32| place - places[number as usize];
    let inverse_slope = |number: u32, distance: f64| -away(number) / distance.powi(3);
    let raw = |&(number, distance): &(u32, f64)| {
        // Of equally near ones none would have a weight.
        let difference = distance.recip() - OPEN * most.recip();
        let slope = inverse_slope(number, distance) - OPEN * inverse_slope(last, most);
        (number, difference * difference, slope * (2.0 * difference))
    };
    let raw: Vec<(u32, f64, DVec3)> = nearest.iter().map(raw).collect();
    let mut shares = normalised(&raw);
    let t = 1.0 - least / width;
    let fade = t * t * (3.0 - 2.0 * t);
    let fade_slope = away(first) * (-6.0 * t * (1.0 - t) / (width * least));
    for share in &mut shares {
        share.slope = share.slope * fade as f32 + (fade_slope * share.weight).as_vec3();
        share.weight *= fade;
    }
    shares
}

/// A little less than 1, so that the weights of points that are equally far do not vanish.
const OPEN: f64 = 1.0 - 1e-5;
