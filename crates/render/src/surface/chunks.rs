//! A mesh split into chunks of neighbouring triangles, for frustum culling, and so that a mesh larger than the device's
//! buffers can be distributed over several pages.
//!
//! Triangles are sorted by the Morton code of their centroid at rest and split every [`CHUNK`] triangles; a chunk has
//! one material. Small meshes keep their order, because there is nothing to gain. Each chunk lists its vertices, so
//! updating all bounds after a deformation reads about as many positions as there are vertices.

use std::ops::Range;

use glam::{Mat4, Vec3, Vec4};

use crate::{AlphaMode, Material, MaterialGroup};

/// Triangles per chunk: five million triangles take at most 305 draw calls, and about a twentieth of those drawn are
/// not visible.
const CHUNK: usize = 16_384;
/// Meshes of up to this many triangles are neither sorted nor split.
const UNSORTED: usize = 4 * CHUNK;

/// The split of a mesh's triangles into chunks. Valid only for the triangles and materials it was built from.
#[derive(Debug)]
pub struct Chunks {
    /// The mesh's triangle at each position of the draw order; `None` if that is the mesh's order.
    order: Option<Vec<u32>>,
    all: Vec<Chunk>,
    /// The vertices of chunk `c`, ascending and without duplicates: `vertices[offsets[c]..offsets[c + 1]]`.
    vertices: Vec<u32>,
    offsets: Vec<usize>,
}

/// Triangles that are drawn or culled together.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Chunk {
    /// Range in the draw order.
    pub(crate) triangles: Range<u32>,
    pub(crate) material: usize,
    pub(crate) alpha: AlphaMode,
}

/// The bounding box of a chunk, relative to the caller's centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChunkBounds {
    pub(crate) min: Vec3,
    pub(crate) max: Vec3,
}

impl Chunks {
    /// Splits a mesh whose triangles get their materials from `groups`; other triangles have the default material.
    /// Vertex indices out of range count as the origin here; uploading the mesh rejects them.
    pub fn new(
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        groups: &[MaterialGroup],
        materials: &[Material],
    ) -> Self {
        let runs = material_runs(triangles.len() as u32, groups, materials);
        let is_sorted = triangles.len() > UNSORTED;
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        let mut all = Vec::new();
        if is_sorted {
            let keys = morton_keys(positions, triangles);
            for run in &runs {
                // Blended triangles keep their order.
                if run.alpha != AlphaMode::Blend {
                    let (start, end) = (run.triangles.start as usize, run.triangles.end as usize);
                    order[start..end].sort_by_key(|&triangle| keys[triangle as usize]);
                }
                let starts = (run.triangles.start..run.triangles.end).step_by(CHUNK);
                all.extend(starts.map(|start| Chunk {
                    triangles: start..(start + CHUNK as u32).min(run.triangles.end),
                    ..run.clone()
                }));
            }
        } else {
            all = runs;
        }
        let mut chunks = Self {
            order: is_sorted.then_some(order),
            all,
            vertices: Vec::new(),
            offsets: vec![0],
        };
        chunks.list_vertices(triangles, positions.len());
        chunks
    }

    /// The number of chunks.
    pub fn count(&self) -> usize {
        self.all.len()
    }

    /// The bounding box of a chunk (below [`Chunks::count`]) for these vertex positions.
    pub fn bounds(&self, chunk: usize, positions: &[[f32; 3]]) -> ChunkBounds {
        let mut bounds = ChunkBounds {
            min: Vec3::INFINITY,
            max: Vec3::NEG_INFINITY,
        };
        for &vertex in &self.vertices[self.offsets[chunk]..self.offsets[chunk + 1]] {
            let Some(&position) = positions.get(vertex as usize) else {
                continue;
            };
            // `min` and `max` skip NaN.
            bounds.min = bounds.min.min(position.into());
            bounds.max = bounds.max.max(position.into());
        }
        bounds
    }

    pub(crate) fn all_bounds(&self, positions: &[[f32; 3]]) -> Vec<ChunkBounds> {
        (0..self.all.len()).map(|chunk| self.bounds(chunk, positions)).collect()
    }

    pub(crate) fn all(&self) -> &[Chunk] {
        &self.all
    }

    pub(crate) fn vertices(&self, chunk: usize) -> &[u32] {
        &self.vertices[self.offsets[chunk]..self.offsets[chunk + 1]]
    }

    /// The mesh's triangle at a position of the draw order.
    pub(crate) fn triangle_at(&self, position: u32) -> u32 {
        match &self.order {
            Some(order) => order.get(position as usize).copied().unwrap_or(position),
            None => position,
        }
    }

    /// Returns true if the chunks were built from this many triangles.
    pub(crate) fn fits(&self, triangle_count: usize) -> bool {
        self.all.last().map_or(0, |chunk| chunk.triangles.end) as usize == triangle_count
    }

    fn list_vertices(&mut self, triangles: &[[u32; 3]], vertex_count: usize) {
        let mut seen_in = vec![u32::MAX; vertex_count];
        for (number, chunk) in self.all.iter().enumerate() {
            let start = self.vertices.len();
            for position in chunk.triangles.clone() {
                for vertex in triangles[self.triangle_at(position) as usize] {
                    if let Some(seen) = seen_in.get_mut(vertex as usize)
                        && *seen != number as u32
                    {
                        *seen = number as u32;
                        self.vertices.push(vertex);
                    }
                }
            }
            // Ascending, so that positions are read in memory order.
            self.vertices[start..].sort_unstable();
            self.offsets.push(self.vertices.len());
        }
    }
}

impl ChunkBounds {
    /// Returns true if the box may intersect the view frustum of `clip_from_world` (reversed depth). Conservative:
    /// never wrongly false.
    pub(crate) fn intersects_frustum(&self, clip_from_world: &Mat4) -> bool {
        if !self.min.is_finite() || !self.max.is_finite() {
            // No vertex, or one at infinity.
            return self.min.x <= self.max.x;
        }
        let [x, y, z, w] = [0, 1, 2, 3].map(|row| clip_from_world.row(row));
        // The box is outside if its corner farthest along a plane's normal is.
        let is_inside = |plane: Vec4| {
            let towards = plane.truncate();
            let corner = Vec3::select(towards.cmpge(Vec3::ZERO), self.max, self.min);
            let reach = towards.abs().dot(corner.abs()) + plane.w.abs();
            towards.dot(corner) + plane.w >= -1e-5 * reach
        };
        [w + x, w - x, w + y, w - y, w - z].into_iter().all(is_inside)
    }
}

/// Runs of triangles with one material, in order; gaps have the default material.
fn material_runs(count: u32, groups: &[MaterialGroup], materials: &[Material]) -> Vec<Chunk> {
    let default_material = materials.len();
    let mut groups: Vec<_> = groups.iter().filter(|group| !group.triangles.is_empty()).collect();
    groups.sort_by_key(|group| group.triangles.start);
    let mut runs: Vec<Chunk> = Vec::new();
    let mut push = |triangles: Range<u32>, material: usize| {
        if triangles.is_empty() {
            return;
        }
        match runs.last_mut() {
            Some(last) if last.material == material && last.triangles.end == triangles.start => {
                last.triangles.end = triangles.end;
            }
            _ => {
                let alpha = materials.get(material).map_or(AlphaMode::Opaque, |m| m.alpha);
                runs.push(Chunk {
                    triangles,
                    material,
                    alpha,
                });
            }
        }
    };
    let mut next = 0;
    for group in groups {
        let (start, end) = (group.triangles.start.clamp(next, count), group.triangles.end.min(count));
        push(next..start, default_material);
        push(start..end, group.material);
        next = next.max(end);
    }
    push(next..count, default_material);
    runs
}

/// 30-bit Morton codes of the triangles' centroids in the mesh's bounding box.
fn morton_keys(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<u32> {
    let finite = positions.iter().map(|&p| Vec3::from(p)).filter(|p| p.is_finite());
    let (min, max) = finite.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), p| {
        (min.min(p), max.max(p))
    });
    let extent = (max - min).max_element();
    let scale = if extent > 0.0 { 1023.0 / extent } else { 0.0 };
    let at = |vertex: u32| positions.get(vertex as usize).map_or(Vec3::ZERO, |&p| Vec3::from(p));
    triangles
        .iter()
        .map(|&[a, b, c]| {
            let middle = ((at(a) + at(b) + at(c)) / 3.0 - min) * scale;
            // NaN becomes 0.
            let [x, y, z] = middle.to_array().map(|t| spread(t.clamp(0.0, 1023.0) as u32));
            x | y << 1 | z << 2
        })
        .collect()
}

/// Spreads ten bits, with two zeros between neighbours.
fn spread(bits: u32) -> u32 {
    let bits = (bits | bits << 16) & 0x0300_00ff;
    let bits = (bits | bits << 8) & 0x0300_f00f;
    let bits = (bits | bits << 4) & 0x030c_30c3;
    (bits | bits << 2) & 0x0924_9249
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::View;

    #[test]
    fn gaps_between_groups_get_the_default_material_and_neighbours_merge() {
        let group = |triangles, material| MaterialGroup { triangles, material };
        let groups = [group(6..8, 0), group(2..4, 1), group(4..4, 0), group(4..6, 1)];
        let glass = Material {
            alpha: AlphaMode::Blend,
            ..Material::default()
        };
        let run = |triangles, material, alpha| Chunk {
            triangles,
            material,
            alpha,
        };
        let expected = [
            run(0..2, 2, AlphaMode::Opaque),
            run(2..6, 1, AlphaMode::Blend),
            run(6..8, 0, AlphaMode::Opaque),
            run(8..10, 2, AlphaMode::Opaque),
        ];
        assert_eq!(material_runs(10, &groups, &[Material::default(), glass]), expected);
    }

    /// A strip of separate triangles along x, in shuffled order.
    fn strip(count: u32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
        let place = |triangle: u32| (triangle * 7919 % count) as f32;
        let positions = (0..count).flat_map(|t| [0.0, 0.5, 1.0].map(|x| [place(t) + x, x, 0.0]));
        (
            positions.collect(),
            (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
        )
    }

    #[test]
    fn a_large_mesh_is_cut_into_small_neighbourhoods_and_loses_no_triangle() {
        let (positions, triangles) = strip(100_003);
        let chunks = Chunks::new(&positions, &triangles, &[], &[]);
        assert!(chunks.fits(100_003) && chunks.count() == 100_003_usize.div_ceil(CHUNK));
        let mut drawn: Vec<u32> = (0..100_003).map(|position| chunks.triangle_at(position)).collect();
        drawn.sort_unstable();
        assert!(drawn.iter().enumerate().all(|(at, &triangle)| at as u32 == triangle));
        let longest = (0..chunks.count()).map(|chunk| {
            let bounds = chunks.bounds(chunk, &positions);
            bounds.max.x - bounds.min.x
        });
        assert!(longest.fold(0.0, f32::max) < 1.05 * CHUNK as f32);
    }

    #[test]
    fn a_box_is_culled_only_outside_the_frustum() {
        let view_from_world = View::look_at(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y);
        let views = [
            View::perspective(0.7, 1.5, 0.01, view_from_world),
            View::orthographic(1.4, 1.5, 0.1, 10.0, view_from_world),
        ];
        for view in views {
            let seen = |middle: Vec3, half: f32| {
                let bounds = ChunkBounds {
                    min: middle - half,
                    max: middle + half,
                };
                bounds.intersects_frustum(&view.clip_from_world)
            };
            assert!(seen(Vec3::ZERO, 0.1) && seen(Vec3::ZERO, 100.0));
            assert!(seen(Vec3::new(2.05, 0.0, 0.0), 0.1), "a corner reaches in");
            assert!(!seen(Vec3::new(3.0, 0.0, 0.0), 0.1) && !seen(Vec3::new(0.0, -2.0, 0.0), 0.1));
            assert!(!seen(Vec3::new(0.0, 0.0, 5.0), 0.5), "behind the eye");
            assert!(seen(Vec3::new(0.0, 0.0, f32::NAN), 1.0) || !seen(Vec3::NAN, 1.0));
        }
    }
}
