//! Normals of a deformed shape that keep the file's smooth and hard edges.
//!
//! Drawn vertices that share a surface vertex and a stored normal form one group, whose geometric normal is the
//! area-weighted mean over its triangles. The stored normal is rotated by the smallest rotation from the geometric
//! normal at rest to the current one. So the file's normals are shown bit for bit at rest, and shading does not jump
//! when a drag begins.
//!
//! Nearly all surface vertices have a single group, whose geometric normal is the surface's own.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::OnceLock;

use glam::{DVec3, Mat3, Quat, Vec3, Vec3A};
use pliant_mesh::{DrawnVertex, Model, SurfaceVertex, Vector3, vertex_normals};
use rayon::prelude::*;

use super::relative::Relative;

/// The number of groups for one task.
const CHUNK: usize = 1024;

/// The drawn vertices that share a normal, and the triangles from which it is computed.
#[derive(Debug)]
pub struct NormalGroups {
    /// The group of each drawn vertex: numbers below the count of surface vertices mean all triangles at that vertex,
    /// higher ones a part of them.
    group_of_drawn: Vec<u32>,
    parts: Parts,
    /// Whether each drawn vertex belongs to a part that is turned inside out, so that its normal is reversed; empty if
    /// none does. Groups are the same as in the file.
    turned: Vec<bool>,
    /// Drawn vertices without a normal, so that their triangles are drawn flat.
    flat: Vec<Range<u32>>,
    /// Geometric normals at rest and stored normals of each group; `None` if the file stores no normals.
    rest: Option<RestNormals>,
    /// The normals of the groups that are shown at rest, after their first use.
    shown_at_rest: OnceLock<Vec<Vec3>>,
}

/// The groups of surface vertices that have several.
#[derive(Debug, Default)]
struct Parts {
    /// Triangles of part `p`: `triangles[offsets[p]..offsets[p + 1]]`, in the file's order, so that the order of sums
    /// is fixed.
    offsets: Vec<u32>,
    triangles: Vec<[SurfaceVertex; 3]>,
}

#[derive(Debug)]
struct RestNormals {
    geometric: Vec<Vec3>,
    stored: Vec<Vec3>,
}

impl NormalGroups {
    /// Groups the model's drawn vertices. `triangles` are in drawn vertices, with the file's winding unless `turned`;
    /// `stored` has one world-space unit normal per drawn vertex.
    pub fn of(
        model: &Model,
        relative: &Relative,
        triangles: &[[u32; 3]],
        stored: Option<Vec<[f32; 3]>>,
        turned: Vec<bool>,
    ) -> Self {
        let (group_of_drawn, stored_of_group) = group_vertices(model, stored.as_deref());
        let mut groups = Self {
            parts: Parts::of(model, triangles, &turned, &group_of_drawn, stored_of_group.len()),
            group_of_drawn,
            turned,
            flat: Vec::new(),
            rest: None,
            shown_at_rest: OnceLock::new(),
        };
        if stored.is_some() {
            groups.rest = Some(RestNormals {
                geometric: groups.geometric_at_rest(model, relative),
                stored: stored_of_group,
            });
        }
        groups
    }

    /// The same, with zero normals for these ranges of drawn vertices, whose triangles are then drawn flat.
    pub fn with_flat(self, flat: Vec<Range<u32>>) -> Self {
        Self { flat, ..self }
    }

    /// One unit normal per drawn vertex into `out`, for a shape with these [`Relative::positions`]. `normals` is
    /// overwritten by the geometric ones of the groups.
    pub fn at<V: Vector3>(&self, model: &Model, positions: &[V], normals: &mut Vec<V>, out: &mut Vec<[f32; 3]>) {
        self.geometric(model, positions, normals);
        let shown = |&group: &u32| {
            let group = group as usize;
            let normal = direction(normals[group]);
            let Some(RestNormals { geometric, stored }) = &self.rest else {
                return normal.to_array();
            };
            let (from, stored) = (geometric[group], stored[group]);
            // Without a stored normal, the vertex gets the geometric one.
            let shown = if stored == Vec3::ZERO {
                normal
            } else if normal == from {
                stored
            } else {
                rotated(stored, from, normal)
            };
            shown.to_array()
        };
        self.group_of_drawn
            .par_iter()
            .with_min_len(CHUNK)
            .map(shown)
            .collect_into_vec(out);
        self.turn(out);
    }

    /// Reverses the normals of parts that are turned inside out, and gives flat triangles none.
    fn turn(&self, normals: &mut [[f32; 3]]) {
        for range in &self.flat {
            if let Some(normals) = normals.get_mut(range.start as usize..range.end as usize) {
                normals.fill([0.0; 3]);
            }
        }
        for (normal, _) in normals
            .iter_mut()
            .zip(&self.turned)
            .filter(|(_, is_turned)| **is_turned)
        {
            *normal = normal.map(|number| -number);
        }
    }

    /// As [`NormalGroups::at`], from the normals at rest and the Jacobian J of the displacements at each surface
    /// vertex: a normal n becomes the direction of cof(I + J) n, with cof(F) = det(F) F⁻ᵀ, which has no pole where F is
    /// singular.
    pub fn turned(&self, model: &Model, relative: &Relative, jacobians: &[Mat3], out: &mut Vec<[f32; 3]>) {
        let at_rest = self.shown_at_rest.get_or_init(|| {
            let mut normals = match &self.rest {
                Some(rest) => rest.geometric.clone(),
                None => self.geometric_at_rest(model, relative),
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
        self.group_of_drawn
            .par_iter()
            .enumerate()
            .with_min_len(CHUNK)
            .map(turned)
            .collect_into_vec(out);
        self.turn(out);
    }

    /// The geometric normal of each group; none if its triangles have no area.
    fn geometric<V: Vector3>(&self, model: &Model, positions: &[V], normals: &mut Vec<V>) {
        vertex_normals(&model.surface.triangles, &model.topology, positions, normals);
        self.parts.add_normals(positions, normals);
    }

    fn geometric_at_rest(&self, model: &Model, relative: &Relative) -> Vec<Vec3> {
        match relative.is_fine {
            true => self.geometric_at_rest_in::<DVec3>(model, relative),
            false => self.geometric_at_rest_in::<Vec3A>(model, relative),
        }
    }

    fn geometric_at_rest_in<V: Vector3>(&self, model: &Model, relative: &Relative) -> Vec<Vec3> {
        let (mut positions, mut normals) = (Vec::<V>::new(), Vec::new());
        relative.positions(&model.surface.positions, |_| DVec3::ZERO, &mut positions);
        self.geometric(model, &positions, &mut normals);
        normals.into_iter().map(direction).collect()
    }
}

impl Parts {
    fn of(model: &Model, triangles: &[[u32; 3]], turned: &[bool], group_of_drawn: &[u32], group_count: usize) -> Self {
        let whole = model.surface.positions.len();
        let part_of = |drawn: u32| (group_of_drawn[drawn as usize] as usize).checked_sub(whole);
        let mut offsets = vec![0_u32; group_count - whole + 1];
        for part in triangles.iter().flatten().filter_map(|&drawn| part_of(drawn)) {
            offsets[part + 1] += 1;
        }
        for part in 1..offsets.len() {
            offsets[part] += offsets[part - 1];
        }
        let mut next = offsets.clone();
        let mut listed = vec![[SurfaceVertex(0); 3]; offsets.last().map_or(0, |&end| end as usize)];
        for corners in triangles {
            for part in corners.iter().filter_map(|&drawn| part_of(drawn)) {
                // A triangle with a corner without a position has no area.
                let corner = |drawn| model.drawn.surface_vertex(DrawnVertex(drawn));
                let [a, b, c] = corners.map(corner);
                if let (Some(a), Some(b), Some(c)) = (a, b, c) {
                    let is_turned = turned.get(corners[0] as usize).is_some_and(|is_turned| *is_turned);
                    listed[next[part] as usize] = if is_turned { [a, c, b] } else { [a, b, c] };
                }
                next[part] += 1;
            }
        }
        Self {
            offsets,
            triangles: listed,
        }
    }

    /// Appends the parts' normals to those of the surface vertices.
    fn add_normals<V: Vector3>(&self, positions: &[V], normals: &mut Vec<V>) {
        let count = self.offsets.len() - 1;
        normals.resize(positions.len() + count, V::ZERO);
        let doubled_area = |corners: &[SurfaceVertex; 3]| {
            let [a, b, c] = corners.map(|corner| positions[corner.index()]);
            (b - a).cross(c - a)
        };
        let chunks = normals[positions.len()..].par_chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(chunk, normals)| {
            for (normal, part) in normals.iter_mut().zip(chunk * CHUNK..) {
                let own = &self.triangles[self.offsets[part] as usize..self.offsets[part + 1] as usize];
                *normal = own.iter().map(doubled_area).sum();
            }
            V::normalize_all(normals);
        });
    }
}

/// A normal for display; the z axis if there is none.
fn direction(normal: impl Vector3) -> Vec3 {
    let normal = Vec3::from(normal.single());
    if normal == Vec3::ZERO { Vec3::Z } else { normal }
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
    let whole = model.surface.positions.len();
    let stored_at = |drawn: usize| {
        let normal = stored.and_then(|normals| normals.get(drawn).copied());
        normal.map_or(Vec3::ZERO, Vec3::from)
    };
    // The first drawn vertex of each surface vertex, and whether the others have its stored normal.
    let mut first = vec![u32::MAX; whole];
    let mut is_one = vec![true; whole];
    let surface_vertices = || model.drawn.surface_vertices().enumerate();
    for (drawn, surface) in surface_vertices() {
        let Some(surface) = surface.map(SurfaceVertex::index) else {
            continue;
        };
        if first[surface] == u32::MAX {
            first[surface] = drawn as u32;
        }
        is_one[surface] &= same_bits(stored_at(first[surface] as usize), stored_at(drawn));
    }
    let stored_of_surface = first.iter().zip(&is_one);
    let mut stored_of_group: Vec<Vec3> = stored_of_surface
        .map(|(&drawn, &is_one)| if is_one { stored_at(drawn as usize) } else { Vec3::ZERO })
        .collect();
    let mut part_of_key: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
    let group_of_drawn = surface_vertices().map(|(drawn, surface)| {
        let own = stored_at(drawn);
        let mut new_part = || {
            stored_of_group.push(own);
            stored_of_group.len() as u32 - 1
        };
        match surface {
            Some(surface) if is_one[surface.index()] => surface.0,
            Some(surface) => *part_of_key
                .entry((surface.0, own.to_array().map(f32::to_bits)))
                .or_insert_with(new_part),
            None => new_part(),
        }
    });
    let group_of_drawn = group_of_drawn.collect();
    (group_of_drawn, stored_of_group)
}

fn same_bits(one: Vec3, other: Vec3) -> bool {
    one.to_array().map(f32::to_bits) == other.to_array().map(f32::to_bits)
}
