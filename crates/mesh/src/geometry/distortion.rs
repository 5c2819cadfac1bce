//! The distance of a deformation from the rest shape.

use glam::DVec3;
use rayon::prelude::*;

use super::signed_volume;
use crate::surface::corners;
use crate::{Surface, SurfaceVertex, Topology, bounding_box};

/// The distortion figures of a deformed surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distortion {
    /// Mean over edges of max(r, 1/r), where r is the deformed length over the rest length: 1 for a rigid motion,
    /// otherwise more. Edges without rest length are left out.
    pub edge_stretch_mean: f64,
    /// The largest of these ratios; infinite if an edge shrank to a point.
    pub edge_stretch_max: f64,
    /// Triangles that turned over: their normal opposes the mean normal, weighted by area, of the other triangles at
    /// their vertices, and did not at rest. A part that turned over as a whole counts only at its rim, and a triangle
    /// without an area has no normal.
    pub flipped_faces: usize,
    /// Deformed over rest volume, each hole closed by a cap from its rim's centre. 1 if the rest shape encloses almost
    /// nothing (below 1e-9 of its box's diagonal cubed), as a flat sheet.
    pub volume_ratio: f64,
}

impl Default for Distortion {
    /// The box of the rest shape.
    fn default() -> Self {
        Self {
            edge_stretch_mean: 1.0,
            edge_stretch_max: 1.0,
            flipped_faces: 0,
            volume_ratio: 1.0,
        }
    }
}

impl Distortion {
    /// Compares `surface` with its vertices moved to `deformed` (one position each).
    pub fn of(surface: &Surface, topology: &Topology, deformed: &[DVec3]) -> Self {
        let (edge_stretch_mean, edge_stretch_max) = edge_stretch(surface, topology, deformed);
        Self {
            edge_stretch_mean,
            edge_stretch_max,
            flipped_faces: flipped(surface, topology, deformed)
                .into_iter()
                .filter(|is| *is)
                .count(),
            volume_ratio: volume_ratio(surface, topology, deformed),
        }
    }
}

/// Vertices or triangles per piece of a sum: the pieces do not depend on the number of threads.
const PIECE: usize = 8192;

/// max(r, 1/r) for every edge with a rest length, r = deformed / rest length: the terms of the figures, in the order of
/// [`Topology::edges`] for the edges from vertex `v` to higher ones.
fn edge_stretches<'a>(
    surface: &'a Surface,
    topology: &'a Topology,
    deformed: &'a [DVec3],
    v: usize,
) -> impl Iterator<Item = f64> + 'a {
    let ring = topology
        .neighbours(SurfaceVertex(v as u32))
        .iter()
        .map(|u| u.index())
        .filter(move |&u| u > v);
    ring.filter_map(move |u| {
        let rest = surface.positions[v].distance(surface.positions[u]);
        let ratio = deformed[v].distance(deformed[u]) / rest;
        (rest > 0.0).then(|| ratio.max(1.0 / ratio))
    })
}

fn edge_stretch(surface: &Surface, topology: &Topology, deformed: &[DVec3]) -> (f64, f64) {
    let vertex_count = surface.positions.len();
    let pieces: Vec<(f64, f64, usize)> = (0..vertex_count.div_ceil(PIECE))
        .into_par_iter()
        .map(|piece| {
            let vertices = piece * PIECE..((piece + 1) * PIECE).min(vertex_count);
            vertices
                .flat_map(|v| edge_stretches(surface, topology, deformed, v))
                .fold((0.0, 1.0, 0), |(sum, max, count), s| {
                    (sum + s, f64::max(max, s), count + 1)
                })
        })
        .collect();
    let (sum, max, count) = pieces.iter().fold((0.0, 1.0, 0), |all, piece| {
        (all.0 + piece.0, f64::max(all.1, piece.1), all.2 + piece.2)
    });
    (if count == 0 { 1.0 } else { sum / count as f64 }, max)
}

/// For each triangle, true if it turned over.
pub(super) fn flipped(surface: &Surface, topology: &Topology, deformed: &[DVec3]) -> Vec<bool> {
    let at_rest = opposing_faces(surface, topology, &surface.positions);
    let now = opposing_faces(surface, topology, deformed);
    let has_normal = |triangle: &[SurfaceVertex; 3]| has_normal(corners(*triangle, &surface.positions));
    let each = at_rest.iter().zip(&now).zip(&surface.triangles);
    each.map(|((&rest, &now), triangle)| now && !rest && has_normal(triangle))
        .collect()
}

/// Below this share of its longest side squared, a triangle's area consists of rounding errors only.
const LEAST_AREA: f64 = 1e-6;

/// Returns true if a triangle's area, by the positions of its corners, is more than rounding errors, so that its normal
/// can be trusted.
pub fn has_normal([a, b, c]: [DVec3; 3]) -> bool {
    let longest = a
        .distance_squared(b)
        .max(b.distance_squared(c))
        .max(c.distance_squared(a));
    (b - a).cross(c - a).length() > LEAST_AREA * longest
}

/// For each triangle, true if its normal opposes the mean normal of the triangles around it.
fn opposing_faces(surface: &Surface, topology: &Topology, positions: &[DVec3]) -> Vec<bool> {
    let areas: Vec<DVec3> = surface
        .triangles
        .par_iter()
        .map(|&triangle| {
            let [a, b, c] = corners(triangle, positions);
            (b - a).cross(c - a)
        })
        .collect();
    let around: Vec<DVec3> = (0..positions.len() as u32)
        .into_par_iter()
        .map(|v| {
            topology
                .faces(SurfaceVertex(v), &surface.triangles)
                .map(|t| areas[t as usize])
                .sum()
        })
        .collect();
    surface
        .triangles
        .par_iter()
        .zip(&areas)
        .map(|(triangle, &own)| {
            let others = triangle.iter().map(|v| around[v.index()] - own).sum::<DVec3>();
            own.dot(others) < 0.0
        })
        .collect()
}

fn volume_ratio(surface: &Surface, topology: &Topology, deformed: &[DVec3]) -> f64 {
    let Some(bounds) = bounding_box(&surface.positions) else {
        return 1.0;
    };
    let rims = topology.boundary_loops();
    let rest = capped_volume(surface, &rims, &surface.positions);
    if rest.abs() <= 1e-9 * bounds.diagonal().powi(3) {
        return 1.0;
    }
    capped_volume(surface, &rims, deformed) / rest
}

/// The signed volume with a fan from each rim's mean vertex across its hole, so that it doesn't depend on the origin.
fn capped_volume(surface: &Surface, rims: &[Vec<SurfaceVertex>], positions: &[DVec3]) -> f64 {
    // The apex for `signed_volume`.
    let Some(&[origin, ..]) = surface.triangles.first() else {
        return 0.0;
    };
    let relative = |v: SurfaceVertex| positions[v.index()] - positions[origin.index()];
    let caps: f64 = rims
        .iter()
        .map(|rim| {
            let centre = rim.iter().map(|&v| relative(v)).sum::<DVec3>() / rim.len() as f64;
            (0..rim.len())
                .map(|i| {
                    let (a, b) = (relative(rim[i]), relative(rim[(i + 1) % rim.len()]));
                    centre.dot(a.cross(b)) / 6.0
                })
                .sum::<f64>()
        })
        .sum();
    signed_volume(&surface.triangles, positions) + caps
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;
    use glam::{DAffine3, DMat3, DQuat};

    fn moved(surface: &Surface, motion: DAffine3) -> Vec<DVec3> {
        surface.positions.iter().map(|&p| motion.transform_point3(p)).collect()
    }

    #[test]
    fn a_rigid_motion_distorts_nothing() {
        let rotation = DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 1.3);
        let motion = DAffine3::from_rotation_translation(rotation, DVec3::new(10.0, 5.0, -3.0));
        for (class, drawn) in shapes::classes() {
            let model = shapes::model(drawn);
            let distortion = Distortion::of(&model.surface, &model.topology, &moved(&model.surface, motion));
            assert!(
                (distortion.edge_stretch_mean - 1.0).abs() < 1e-8,
                "{class}: {distortion:?}"
            );
            assert!(
                (distortion.edge_stretch_max - 1.0).abs() < 1e-8,
                "{class}: {distortion:?}"
            );
            assert_eq!(distortion.flipped_faces, 0, "{class}");
            assert!((distortion.volume_ratio - 1.0).abs() < 1e-9, "{class}: {distortion:?}");
        }
    }

    #[test]
    fn scaling_stretches_every_edge_and_the_volume_by_its_cube() {
        for drawn in [shapes::icosphere(2), shapes::tube(12, 5, 3.0), shapes::bar(3, 1, 2)] {
            let model = shapes::model(drawn);
            let half = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::splat(0.5)));
            let distortion = Distortion::of(&model.surface, &model.topology, &moved(&model.surface, half));
            assert!((distortion.edge_stretch_mean - 2.0).abs() < 1e-12);
            assert!((distortion.edge_stretch_max - 2.0).abs() < 1e-12);
            assert!((distortion.volume_ratio - 0.125).abs() < 1e-12);
            assert_eq!(distortion.flipped_faces, 0);
        }
    }

    #[test]
    fn a_vertex_pushed_over_its_ring_flips_faces() {
        let model = shapes::model(shapes::grid(6, 6));
        let mut deformed = model.surface.positions.clone();
        let inner = (0..deformed.len() as u32)
            .map(SurfaceVertex)
            .find(|&v| !model.topology.is_boundary_vertex(v));
        let inner = inner.map(SurfaceVertex::index).unwrap_or_default();
        deformed[inner].x += 0.4;
        let distortion = Distortion::of(&model.surface, &model.topology, &deformed);
        assert!(distortion.flipped_faces > 0);
        assert!(distortion.edge_stretch_max > 1.5);
        assert_eq!(distortion.volume_ratio, 1.0, "a flat sheet has no volume to compare");
    }

    #[test]
    fn a_triangle_without_area_is_never_flipped() {
        let mut drawn = shapes::grid(6, 6);
        // Three vertices of one row.
        drawn.triangles.push([0, 1, 2].map(crate::DrawnVertex));
        let model = shapes::model(drawn);
        for by in [-0.02, 0.02] {
            let mut deformed = model.surface.positions.clone();
            deformed[1].y += by;
            let distortion = Distortion::of(&model.surface, &model.topology, &deformed);
            assert_eq!(distortion.flipped_faces, 0, "moved by {by}");
        }
    }
}
