//! Normals of a deformed shape that keep the file's smooth and hard edges.
//!
//! Drawn vertices that share a surface vertex and a stored normal form one group, whose geometric normal is the
//! area-weighted mean over its triangles. The stored normal is rotated by the smallest rotation from the geometric
//! normal at rest to the current one. So the file's normals are shown bit for bit at rest, and shading does not jump
//! when a drag begins.

use std::collections::HashMap;
use std::sync::OnceLock;

use glam::{DVec3, Mat3, Quat, Vec3};
use pliant_mesh::{DrawnVertex, Model};
use rayon::prelude::*;

/// Which drawn vertices share a normal, and the triangles that it is computed from.
#[derive(Debug)]
pub struct NormalGroups {
    /// The group of each drawn vertex.
    group_of_drawn: Vec<u32>,
    /// Triangles of group `g`: `faces[offsets[g]..offsets[g + 1]]`, ascending, so that the order of sums is fixed.
    offsets: Vec<u32>,
    faces: Vec<u32>,
    /// Geometric normals at rest and stored normals of each group; `None` if the file stores no normals.
    rest: Option<RestNormals>,
    /// The normals of the groups that are shown at rest, once they were asked for.
    shown_at_rest: OnceLock<Vec<Vec3>>,
}

#[derive(Debug)]
struct RestNormals {
    geometric: Vec<Vec3>,
    stored: Vec<Vec3>,
}

impl NormalGroups {
    /// Groups the model's drawn vertices. `triangles` are in drawn vertices; `stored` has one world-space unit normal
    /// per drawn vertex.
    pub fn of(model: &Model, triangles: &[[u32; 3]], stored: Option<Vec<[f32; 3]>>) -> Self {
        let (group_of_drawn, stored_of_group) = group_vertices(model, stored.as_deref());
        let group_count = stored_of_group.len();
        let mut offsets = vec![0_u32; group_count + 1];
        let corner_groups = |corners: &[u32; 3]| corners.map(|v| group_of_drawn[v as usize] as usize);
        for corners in triangles {
            for group in corner_groups(corners) {
                offsets[group + 1] += 1;
            }
        }
        for group in 0..group_count {
            offsets[group + 1] += offsets[group];
        }
        let mut next = offsets.clone();
        let mut faces = vec![0_u32; 3 * triangles.len()];
        for (face, corners) in triangles.iter().enumerate() {
            for group in corner_groups(corners) {
                faces[next[group] as usize] = face as u32;
                next[group] += 1;
            }
        }
        let mut groups = Self {
            group_of_drawn,
            offsets,
            faces,
            rest: None,
            shown_at_rest: OnceLock::new(),
        };
        if stored.is_some() {
            let geometric = groups.geometric(&model.rest_positions(), triangles);
            groups.rest = Some(RestNormals {
                geometric,
                stored: stored_of_group,
            });
        }
        groups
    }

    /// One unit normal per drawn vertex, for a shape with these positions of drawn vertices; `triangles` as in
    /// [`NormalGroups::of`].
    pub fn at(&self, positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<[f32; 3]> {
        let mut normals = self.geometric(positions, triangles);
        if let Some(rest) = &self.rest {
            normals
                .par_iter_mut()
                .zip(&rest.geometric)
                .zip(&rest.stored)
                .for_each(|((normal, &from), &stored)| {
                    // Without a stored normal, the vertex gets the geometric one.
                    if stored != Vec3::ZERO {
                        *normal = if *normal == from {
                            stored
                        } else {
                            rotated(stored, from, *normal)
                        };
                    }
                });
        }
        self.group_of_drawn
            .par_iter()
            .map(|&group| normals[group as usize].to_array())
            .collect()
    }

    /// As [`NormalGroups::at`], from those at rest and the Jacobian J of the displacements at each surface vertex: a
    /// normal n becomes the direction of cof(I + J) n, with cof(F) = det(F) F⁻ᵀ, which has no pole where F is singular.
    pub fn turned(&self, model: &Model, triangles: &[[u32; 3]], jacobians: &[Mat3]) -> Vec<[f32; 3]> {
        let at_rest = self.shown_at_rest.get_or_init(|| {
            let mut normals = match &self.rest {
                Some(rest) => rest.geometric.clone(),
                None => self.geometric(&model.rest_positions(), triangles),
            };
            let stored = self.rest.iter().flat_map(|rest| &rest.stored);
            for (normal, stored) in normals.iter_mut().zip(stored) {
                if *stored != Vec3::ZERO {
                    *normal = *stored;
                }
            }
            normals
        });
        let turned = |(drawn, &group): (usize, &u32)| {
            let normal = at_rest[group as usize];
            let surface = model.drawn.surface_vertex(DrawnVertex(drawn as u32));
            let jacobian = surface.map_or(Mat3::ZERO, |vertex| jacobians[vertex.index()]);
            if jacobian == Mat3::ZERO {
                return normal.to_array();
            }
            let Mat3 { x_axis, y_axis, z_axis } = Mat3::IDENTITY + jacobian;
            let cofactor = Mat3::from_cols(y_axis.cross(z_axis), z_axis.cross(x_axis), x_axis.cross(y_axis));
            (cofactor * normal).try_normalize().unwrap_or(normal).to_array()
        };
        self.group_of_drawn.par_iter().enumerate().map(turned).collect()
    }

    /// Area-weighted geometric normal of each group; the z axis if its triangles have no area.
    fn geometric(&self, positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
        // f32 is enough from here on: a doubled area vector only gives a direction for shading.
        let doubled_areas: Vec<Vec3> = triangles
            .par_iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|vertex| positions[vertex as usize]);
                (b - a).cross(c - a).as_vec3()
            })
            .collect();
        let scale = doubled_areas
            .par_iter()
            .map(|area| area.abs().max_element())
            .reduce(|| 0.0, f32::max);
        let scale = if scale.is_normal() { scale.recip() } else { 1.0 };
        (0..self.offsets.len() - 1)
            .into_par_iter()
            .map(|group| {
                let faces = &self.faces[self.offsets[group] as usize..self.offsets[group + 1] as usize];
                let sum: Vec3 = faces.iter().map(|&face| doubled_areas[face as usize] * scale).sum();
                sum.try_normalize().unwrap_or(Vec3::Z)
            })
            .collect()
    }
}

/// Rotates `stored` by the smallest rotation from one geometric normal to another.
fn rotated(stored: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    Quat::from_rotation_arc(from, to)
        .mul_vec3(stored)
        .try_normalize()
        .unwrap_or(to)
}

/// The group of each drawn vertex, and the stored normal of each group (zero if the file has none).
fn group_vertices(model: &Model, stored: Option<&[[f32; 3]]>) -> (Vec<u32>, Vec<Vec3>) {
    let vertex_count = model.drawn.vertex_count();
    let mut group_of_drawn = Vec::with_capacity(vertex_count);
    let mut stored_of_group = Vec::new();
    let mut group_of_key: HashMap<(u32, [u32; 3]), u32> = HashMap::with_capacity(vertex_count);
    for (drawn, surface_vertex) in model.drawn.surface_vertices().enumerate() {
        let normal = stored
            .and_then(|normals| normals.get(drawn).copied())
            .unwrap_or_default();
        let mut new_group = || {
            stored_of_group.push(Vec3::from(normal));
            stored_of_group.len() as u32 - 1
        };
        let group = match surface_vertex {
            Some(surface) => *group_of_key
                .entry((surface.0, normal.map(f32::to_bits)))
                .or_insert_with(new_group),
            None => new_group(),
        };
        group_of_drawn.push(group);
    }
    (group_of_drawn, stored_of_group)
}
