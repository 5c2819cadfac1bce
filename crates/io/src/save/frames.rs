//! Local frames of a deformation, which carry normals and tangents along with the vertices that moved.
//!
//! Normals are not recomputed, because a file's own may be custom, smoothed across seams or hard at edges. The
//! deformation gradient F of the faces around it turns each: n' ∝ F⁻ᵀ n and t' ∝ F t. [Twins](super::twins) that a seam
//! split share one F (the area-weighted mean over the faces of all of them), so that no seam shows; the two sides of a
//! hard edge have different normals, so each uses only its own faces.

use glam::{DMat3, DVec3};
use pliant_mesh::{Cancelled, Drawn, DrawnVertex, face_gradient};
use rayon::prelude::*;

use crate::save::bits::bit_equal;
use crate::save::course::Course;
use crate::save::twins;

/// Frames closer to the identity than this leave stored numbers unchanged: f32 resolves 6e-8.
const UNTURNED: f64 = 1e-7;

/// The number of triangles whose gradients are computed in parallel before they are summed in order: as many as stay in
/// the cache between the two. Sums do not depend on it.
const BLOCK: usize = 1 << 14;

const NO_GROUP: u32 = u32::MAX;

/// The deformation gradient at each moved drawn vertex, in world space.
pub(crate) struct Frames {
    /// Group of each drawn vertex, or [`NO_GROUP`].
    group_of: Vec<u32>,
    /// Mean gradient of each group; `None` if it is the identity or no face has an area.
    gradients: Vec<Option<DMat3>>,
}

impl Frames {
    /// The frames between the rest shape and new positions (one per drawn vertex), grouped by the given rest normals.
    pub fn of(drawn: &Drawn, positions: &[DVec3], normals: &[DVec3], course: &Course<'_>) -> Result<Self, Cancelled> {
        let (of_groups, course) = course.split(0.4);
        let (group_of, group_count) = group(drawn, positions, normals, &of_groups)?;
        let mut sums = vec![(DMat3::ZERO, 0.0_f64); group_count];
        let mut gradients = Vec::with_capacity(BLOCK);
        for (number, block) in drawn.triangles.chunks(BLOCK).enumerate() {
            course.reach(number * BLOCK, drawn.triangles.len())?;
            block
                .par_iter()
                .with_min_len(BLOCK / 16)
                .map(|corners| {
                    if corners.iter().all(|corner| group_of[corner.index()] == NO_GROUP) {
                        return (DMat3::ZERO, 0.0);
                    }
                    let rest = corners.map(|corner| drawn.positions[corner.index()]);
                    let deformed = corners.map(|corner| positions[corner.index()]);
                    let area = 0.5 * (rest[1] - rest[0]).cross(rest[2] - rest[0]).length();
                    let gradient = face_gradient(rest, deformed);
                    if area > 0.0 && gradient.is_finite() {
                        (gradient * area, area)
                    } else {
                        (DMat3::ZERO, 0.0)
                    }
                })
                .collect_into_vec(&mut gradients);
            for (corners, &(gradient, area)) in block.iter().zip(&gradients) {
                if area == 0.0 {
                    continue;
                }
                let groups = corners.map(|corner| group_of[corner.index()]);
                for (k, &of_corner) in groups.iter().enumerate() {
                    if of_corner != NO_GROUP && !groups[..k].contains(&of_corner) {
                        let sum = &mut sums[of_corner as usize];
                        sum.0 += gradient;
                        sum.1 += area;
                    }
                }
            }
        }
        let gradients = sums
            .into_iter()
            .map(|(sum, area)| turning(sum * area.recip()))
            .collect();
        Ok(Self { group_of, gradients })
    }

    /// The gradient at a drawn vertex, in world space. It is `None` if the vertex did not move, if its surroundings
    /// neither turned nor stretched, or if no face around it has an area. Its normal and tangent then stay as stored.
    pub fn gradient(&self, vertex: DrawnVertex) -> Option<DMat3> {
        match self.group_of[vertex.index()] {
            NO_GROUP => None,
            group => self.gradients[group as usize],
        }
    }

    /// A drawn vertex's world-space normal after the deformation, with its length kept.
    pub fn carry_normal(&self, vertex: DrawnVertex, normal: DVec3) -> DVec3 {
        self.gradient(vertex)
            .map_or(normal, |gradient| carried_normal(gradient, normal))
    }
}

/// `normal` carried by the inverse transpose of `gradient`, with its length kept. A normal that would become zero is
/// returned unchanged.
pub(crate) fn carried_normal(gradient: DMat3, normal: DVec3) -> DVec3 {
    // The cofactor matrix is det(F) F⁻ᵀ: the same direction without a division, and defined for a singular F.
    let [x, y, z] = [gradient.x_axis, gradient.y_axis, gradient.z_axis];
    let cofactor = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    let sign = if gradient.determinant() < 0.0 { -1.0 } else { 1.0 };
    match (cofactor * normal * sign).try_normalize() {
        Some(direction) => direction * normal.length(),
        None => normal,
    }
}

/// `tangent` carried by `gradient`, with its length kept and at its old angle to the normal (a right angle in any sound
/// file), which `new_normal` replaces. A tangent that would become zero is returned unchanged.
pub(crate) fn carried_tangent(gradient: DMat3, normal: DVec3, new_normal: DVec3, tangent: DVec3) -> DVec3 {
    let (Some(old_up), Some(up)) = (normal.try_normalize(), new_normal.try_normalize()) else {
        return (gradient * tangent)
            .try_normalize()
            .map_or(tangent, |direction| direction * tangent.length());
    };
    let height = tangent.dot(old_up);
    let breadth = (tangent - height * old_up).length();
    let moved = gradient * tangent;
    match (moved - moved.dot(up) * up).try_normalize() {
        Some(direction) => direction * breadth + up * height,
        None => tangent,
    }
}

/// The mean gradient, unless it is the identity or not finite.
fn turning(mean: DMat3) -> Option<DMat3> {
    let off = (mean - DMat3::IDENTITY)
        .to_cols_array()
        .into_iter()
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    (mean.is_finite() && off > UNTURNED).then_some(mean)
}

/// Groups the moved twins and numbers the groups by their first vertex, so that neighbours' sums are near each other in
/// memory; numbered in the order of the hashes, every sum would miss the cache. Only vertices at a rim have twins, so
/// the others are neither hashed nor sorted. Sorting by a hash can run in parallel, filling a hash table can't.
fn group(
    drawn: &Drawn,
    positions: &[DVec3],
    normals: &[DVec3],
    course: &Course<'_>,
) -> Result<(Vec<u32>, usize), Cancelled> {
    course.reach(0, 4)?;
    // Adding zero turns -0 into 0, because exporters mix the two across a seam.
    let bits = |x: f64| (x + 0.0).to_bits();
    let key = |v: usize| {
        let [a, b, c] = drawn.positions[v].to_array().map(bits);
        let [d, e, f] = normals.get(v).copied().unwrap_or(DVec3::ZERO).to_array().map(bits);
        [a, b, c, d, e, f]
    };
    let is_at_rim = twins::rim(drawn);
    let mut group_of: Vec<u32> = (0..positions.len())
        .into_par_iter()
        .map(|v| match bit_equal(drawn.positions[v], positions[v]) {
            true => NO_GROUP,
            false => v as u32,
        })
        .collect();
    course.reach(1, 4)?;
    let mut moved: Vec<(u64, u32)> = (0..positions.len())
        .into_par_iter()
        .filter(|&v| is_at_rim[v] && group_of[v] != NO_GROUP)
        .map(|v| (hash(key(v)), v as u32))
        .collect();
    moved.par_sort_unstable();
    course.reach(2, 4)?;
    // Finds the lowest twin of each vertex, which is the vertex itself if it has none.
    for run in moved.chunk_by(|a, b| a.0 == b.0) {
        for (k, &(_, v)) in run.iter().enumerate() {
            let twin = run[..k]
                .iter()
                .find(|&&(_, other)| key(other as usize) == key(v as usize));
            group_of[v as usize] = twin.map_or(v, |&(_, other)| group_of[other as usize]);
        }
    }
    let moved: Vec<u32> = moved
        .into_iter()
        .map(|(_, v)| v)
        .filter(|&v| group_of[v as usize] == v)
        .collect();
    twins::for_each(drawn, normals, &is_at_rim, &moved, |v, twin| {
        let [own, other] = [v, twin].map(|v| root(&mut group_of, v));
        group_of[own.max(other) as usize] = own.min(other);
    });
    course.reach(3, 4)?;
    // A twin never has a higher index, so its group is already numbered.
    let mut group_count = 0;
    for v in 0..group_of.len() {
        if group_of[v] == v as u32 {
            group_of[v] = group_count;
            group_count += 1;
        } else if group_of[v] != NO_GROUP {
            group_of[v] = group_of[group_of[v] as usize];
        }
    }
    Ok((group_of, group_count as usize))
}

/// The lowest known twin of a vertex; the vertex then points at it directly.
fn root(group_of: &mut [u32], mut v: u32) -> u32 {
    while group_of[v as usize] != v {
        group_of[v as usize] = group_of[group_of[v as usize] as usize];
        v = group_of[v as usize];
    }
    v
}

/// A multiplicative hash of the key's words.
fn hash(key: [u64; 6]) -> u64 {
    key.iter().fold(0x9e37_79b9_7f4a_7c15, |hash: u64, &word| {
        (hash.rotate_left(23) ^ word).wrapping_mul(0xff51_afd7_ed55_8ccd) ^ (hash >> 29)
    })
}
