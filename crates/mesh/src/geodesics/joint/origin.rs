//! The places from which the rings of a limb are measured.

use super::rings::Source;
use super::shape::Shape;
use crate::geodesics::DistanceSearch;
use crate::{Cancel, Cancelled, SurfaceVertex};

/// A far tip of a limb is as far as possible from the other end of the surface, less so many times the detour through the
/// seeds. The second tip counts where there is no joint from the first.
const DETOURS: [f64; 2] = [1.0, 2.0];

/// The place from which the rings of a limb are measured.
#[derive(Clone, Copy)]
pub(super) struct Origin {
    /// The limb's tip.
    pub(super) tip: SurfaceVertex,
    /// The distance that the search first covers.
    pub(super) near: f64,
    /// The rings that count.
    pub(super) source: Source,
    /// The least share of the area that a limb has.
    pub(super) least: f64,
}

impl Origin {
    /// A far tip, from which nothing is known about the rings.
    pub(super) fn far(tip: SurfaceVertex) -> Self {
        Self {
            tip,
            near: f64::INFINITY,
            source: Source::Point,
            least: 0.0,
        }
    }
}

/// Tips that are found from afar.
pub(super) struct FarTips {
    /// Points far from the other end of the surface to which the way from there goes through the seeds, or nearly so: one
    /// for each weight of [`DETOURS`].
    pub(super) limb: [SurfaceVertex; 2],
    /// The two ends of the surface: the point farthest from the seeds, and the point farthest from there.
    pub(super) ends: [SurfaceVertex; 2],
}

impl FarTips {
    /// Two searches of the whole surface.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn of(
        search: &mut DistanceSearch,
        shape: &Shape<'_>,
        seeds: &[(SurfaceVertex, f64); 3],
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        let position = |v: SurfaceVertex| shape.positions[v.index()];
        let mut distances = |from: &[(SurfaceVertex, f64)]| {
            let mut distance = vec![f64::NEG_INFINITY; shape.positions.len()];
            let reached = search.within(shape.triangles, shape.topology, position, from, f64::INFINITY);
            reached.iter().for_each(|&(v, at)| distance[v.index()] = at);
            (distance, reached.last().map_or(from[0].0, |&(v, _)| v))
        };
        let (from_seeds, other_end) = distances(seeds);
        cancel.check()?;
        let (from_end, far_end) = distances(&[(other_end, 0.0)]);
        cancel.check()?;
        let of_seeds = from_end[seeds[0].0.index()];
        let component = shape.topology.vertices_of(shape.topology.component(other_end));
        let tip = |weight: f64| {
            let merit = |v: SurfaceVertex| {
                let detour = from_seeds[v.index()] + of_seeds - from_end[v.index()];
                from_end[v.index()] - weight * detour
            };
            let farthest = component.clone().max_by(|&a, &b| merit(a).total_cmp(&merit(b)));
            farthest.unwrap_or(seeds[0].0)
        };
        Ok(Self {
            limb: DETOURS.map(tip),
            ends: [far_end, other_end],
        })
    }
}
