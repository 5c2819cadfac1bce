//! The plane across which a shape is its own mirror image, to a scan's accuracy.
//!
//! Such a plane goes through the surface's centroid, so only its direction is unknown: many are tried with few samples
//! of the surface, and the best are fitted to it. A fit works like that of closest points [CM92]: each sample's image
//! is paired with the vertex nearest to it, and the plane that brings images nearest to the tangent planes there
//! replaces the last one.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::plane::MirrorPlane;
use crate::{Bvh, Cancel, Cancelled, Progress, Surface, Topology, mixed_voronoi_areas, vertex_normals};

/// Directions over a half sphere, 14° apart, beside the axes of the world.
const DIRECTIONS: usize = 200;
/// The samples of the surface by which a direction is judged, and by which a plane is fitted.
const FEW: usize = 150;
const MANY: usize = 1_000;
/// The number of the best directions that are fitted, none nearer to another than this cosine.
const FITTED: usize = 6;
const SAME: f64 = 0.95;
const ROUNDS: usize = 30;
/// A fit ends when a round turns the plane by less than this in radians, and shifts it by less as a share of the size.
const SETTLED: f64 = 1e-7;
/// The share of the samples that count, since parts that the other side lacks, such as a bag in one hand, do not; and how
/// close to the surface their images are on average if the shape has a plane, as a share of the samples' mean distance
/// from the centroid. If most of the limbs stand differently on both sides, as those of a walking horse do, the trunk
/// alone decides, and must be the more alike.
const COUNTED: [(f64, f64); 2] = [(0.8, 0.04), (0.6, 0.02)];
/// If several planes fit equally well, as for a ball, the one across the world's first axis counts.
const ALIKE: f64 = 1.2;

/// The input of the fit.
struct Shape<'a> {
    positions: &'a [DVec3],
    normals: Vec<DVec3>,
    bvh: &'a Bvh,
    samples: Vec<DVec3>,
    centroid: DVec3,
    /// The samples' mean distance from the centroid.
    size: f64,
}

/// The plane across which the surface is its own mirror image; `None` if no plane comes close to that. `topology` and
/// `bvh` are the surface's own.
///
/// # Errors
/// If it was cancelled.
pub fn symmetry_plane(
    surface: &Surface,
    topology: &Topology,
    bvh: &Bvh,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Option<MirrorPlane>, Cancelled> {
    let areas = mixed_voronoi_areas(surface);
    let total: f64 = areas.iter().sum();
    if !(total.is_finite() && total > 0.0) {
        return Ok(None);
    }
    let positions = &surface.positions;
    let weighted = positions.iter().zip(&areas).map(|(p, area)| *p * *area);
    let centroid = weighted.sum::<DVec3>() / total;
    let few = samples(positions, &areas, total, FEW);
    let many = samples(positions, &areas, total, MANY);
    let size = many.iter().map(|p| p.distance(centroid)).sum::<f64>() / many.len() as f64;
    if size <= 0.0 {
        return Ok(None);
    }
    let mut normals = Vec::new();
    vertex_normals(&surface.triangles, topology, positions, &mut normals);
    let shape = Shape {
        positions,
        normals,
        bvh,
        samples: many,
        centroid,
        size,
    };

    let nearest = |point: DVec3| {
        bvh.nearest_vertex(point)
            .map_or(f64::INFINITY, |(_, distance)| distance)
    };
    let mut judged: Vec<(f64, DVec3)> = directions()
        .into_par_iter()
        .filter_map(|normal| {
            let plane = MirrorPlane::new(normal, normal.dot(centroid))?;
            let apart = few.iter().map(|p| nearest(plane.mirrored(*p)));
            Some((counted_mean(apart, COUNTED[0].0), normal))
        })
        .collect();
    cancel.check()?;
    progress.set(0.4);
    // The axes come first, for any samples.
    let mut chosen: Vec<DVec3> = DVec3::AXES.to_vec();
    judged.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, normal) in judged {
        if chosen.len() < DVec3::AXES.len() + FITTED && chosen.iter().all(|other| other.dot(normal).abs() < SAME) {
            chosen.push(normal);
        }
    }
    for (counted, near) in COUNTED {
        let fitted: Vec<(f64, MirrorPlane)> = chosen
            .par_iter()
            .filter_map(|normal| {
                let plane = MirrorPlane::new(*normal, normal.dot(centroid))?;
                let plane = fit(plane, &shape, counted, cancel)?;
                let apart = |p: &DVec3| {
                    let on_surface = bvh.nearest_on_triangles(plane.mirrored(*p), size, |_| true);
                    on_surface.map_or(size, |(_, distance)| distance)
                };
                Some((counted_mean(shape.samples.iter().map(apart), counted), plane))
            })
            .collect();
        cancel.check()?;
        let best = fitted.iter().map(|(error, _)| *error).fold(f64::INFINITY, f64::min);
        // Rounding does not decide between planes that are exact.
        let limit = (ALIKE * best).max(1e-6 * size);
        let first = fitted.into_iter().find(|(error, _)| *error <= limit);
        if let Some((_, plane)) = first.filter(|(error, _)| *error <= near * size) {
            progress.set(1.0);
            return Ok(Some(plane));
        }
    }
    Ok(None)
}

/// Vertices that represent equal areas.
fn samples(positions: &[DVec3], areas: &[f64], total: f64, count: usize) -> Vec<DVec3> {
    let (mut samples, mut sum) = (Vec::with_capacity(count), 0.0);
    for (position, area) in positions.iter().zip(areas) {
        sum += area;
        if sum * count as f64 >= (samples.len() as f64 + 0.5) * total && samples.len() < count {
            samples.push(*position);
        }
    }
    samples
}

/// The axes, and directions that are evenly distributed over a half sphere (a Fibonacci lattice).
fn directions() -> Vec<DVec3> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let lattice = (0..DIRECTIONS).map(|place| {
        let z = (place as f64 + 0.5) / DIRECTIONS as f64;
        let (sin, cos) = (golden * place as f64).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * cos, radius * sin, z)
    });
    DVec3::AXES.into_iter().chain(lattice).collect()
}

/// The mean of the smallest of these numbers, a share of them.
fn counted_mean(numbers: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut numbers: Vec<f64> = numbers.collect();
    numbers.sort_by(f64::total_cmp);
    let counted = &numbers[..counted(numbers.len(), share)];
    counted.iter().sum::<f64>() / counted.len() as f64
}

fn counted(count: usize, share: f64) -> usize {
    ((share * count as f64) as usize).max(1)
}

/// Fits a plane to a share of the samples from its present place; `None` if nothing can be fitted, or if it was cancelled.
fn fit(mut plane: MirrorPlane, shape: &Shape<'_>, share: f64, cancel: &Cancel) -> Option<MirrorPlane> {
    for _ in 0..ROUNDS {
        cancel.check().ok()?;
        let pair = |p: &DVec3| {
            let (vertex, distance) = shape.bvh.nearest_vertex(plane.mirrored(*p))?;
            Some((distance, *p, vertex.index()))
        };
        let mut pairs: Vec<(f64, DVec3, usize)> = shape.samples.iter().filter_map(pair).collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        pairs.truncate(counted(pairs.len(), share));
        let next = step(plane, shape, &pairs)?;
        let turned = next.normal().distance(plane.normal());
        let shifted = (next.height(shape.centroid) - plane.height(shape.centroid)).abs() / shape.size;
        plane = next;
        if turned.max(shifted) < SETTLED {
            break;
        }
    }
    Some(plane)
}

/// A Gauss–Newton step on Σ (m · (p' − q))², the squared distances of the images p' of points from the tangent planes,
/// with normals m, at the vertices q nearest to them. The unknowns are the plane's distance from the centroid and a
/// small change of its normal across itself.
fn step(plane: MirrorPlane, shape: &Shape<'_>, pairs: &[(f64, DVec3, usize)]) -> Option<MirrorPlane> {
    let normal = plane.normal();
    let (across, along) = normal.any_orthonormal_pair();
    let (mut matrix, mut gradient) = (DMat3::ZERO, DVec3::ZERO);
    for &(_, p, vertex) in pairs {
        let tangent = shape.normals[vertex];
        let missed = tangent.dot(plane.mirrored(p) - shape.positions[vertex]);
        let from_centroid = p - shape.centroid;
        // The image moves by −2 ((δn · p − δd) n + (n · p − d) δn).
        let turned =
            |by: DVec3| -2.0 * (by.dot(from_centroid) * tangent.dot(normal) + plane.height(p) * tangent.dot(by));
        let slope = DVec3::new(turned(across), turned(along), 2.0 * tangent.dot(normal) * shape.size) / shape.size;
        matrix += DMat3::from_cols(slope * slope.x, slope * slope.y, slope * slope.z);
        gradient += slope * missed;
    }
    // Directions that the shape does not determine, such as any turn of a ball's plane, stay the same.
    let trace = matrix.x_axis.x + matrix.y_axis.y + matrix.z_axis.z;
    let damped = matrix + DMat3::from_diagonal(DVec3::splat(1e-6 * trace));
    let change = -(damped.inverse() * gradient) / shape.size;
    if !change.is_finite() {
        return None;
    }
    let next = (normal + across * change.x + along * change.y).try_normalize()?;
    let height = plane.height(shape.centroid) - change.z * shape.size;
    MirrorPlane::new(next, next.dot(shape.centroid) - height)
}
