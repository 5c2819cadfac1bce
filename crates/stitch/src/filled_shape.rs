//! Makes a shape of a part with its holes filled.

use std::collections::BTreeMap;

use glam::DVec3;
use pliant_deform::Budget;
use pliant_mesh::{Cancel, DrawnVertex, FileVertex, SurfaceVertex};
use rayon::prelude::*;

use crate::borders::Loops;
use crate::dress::{DressedCorner, DressedPatch};
use crate::error::StitchError;
use crate::fill::Filled;
use crate::part::Part;
use crate::shape::{Age, NewShape, TriangleSource, VertexSource};

/// A file's normal within this cosine of the surface's is smooth, and turns with the patch; any other belongs to a hard
/// edge and is kept.
const SMOOTH: f64 = 0.866;

impl NewShape {
    /// Takes a whole part, unchanged but for the triangles that belong to no surface because a corner is not finite.
    pub fn whole(part: &Part<'_>) -> Self {
        let vertices = (0..part.drawn.positions.len() as u32).map(DrawnVertex);
        let source = |triangle| TriangleSource {
            part: 0,
            triangle,
            age: Age::Old,
        };
        let all = (0..).zip(&part.drawn.triangles);
        let sound: Vec<u32> = all
            .filter(|(_, corners)| !part.is_broken(corners))
            .map(|(triangle, _)| triangle)
            .collect();
        Self {
            vertices: vertices.map(|vertex| VertexSource::Old { part: 0, vertex }).collect(),
            positions: part.drawn.positions.clone(),
            file_vertices: part.drawn.file_vertex.clone(),
            file_vertex_count: part.drawn.file_vertex_count,
            triangles: sound.iter().map(|&t| part.drawn.triangles[t as usize]).collect(),
            triangle_sources: sound.into_iter().map(source).collect(),
            ..Self::default()
        }
    }

    /// Fills the holes of a part. The part's vertices and triangles come first, in their order.
    ///
    /// # Errors
    /// [`StitchError::Cancelled`].
    pub fn filled(part: &Part<'_>, filled: &Filled, budget: Budget, cancel: &Cancel) -> Result<Self, StitchError> {
        let dressed: Vec<Option<DressedPatch>> = filled
            .holes
            .par_iter()
            .map(|hole| DressedPatch::of(part, hole, budget, cancel))
            .collect();
        cancel.check()?;
        let mut shape = Self::whole(part);
        // The area vectors of the patches' triangles at each point of a rim.
        let mut at_rims: BTreeMap<SurfaceVertex, DVec3> = BTreeMap::new();
        for (hole, dressed) in filled.holes.iter().zip(dressed) {
            let Some(dressed) = dressed else { continue };
            let border = Loops::of(&hole.borders).vertices;
            let rim = border.len();
            let position = |point: u32| match (point as usize).checked_sub(rim) {
                None => part.model.surface.positions[border[point as usize].index()],
                Some(inside) => hole.points[inside],
            };
            let mut normals = vec![DVec3::ZERO; rim + hole.points.len()];
            for corners in &hole.triangles {
                let [a, b, c] = corners.map(position);
                let area = (b - a).cross(c - a);
                corners.iter().for_each(|&corner| normals[corner as usize] += area);
            }
            for (vertex, normal) in border.iter().zip(&normals) {
                *at_rims.entry(*vertex).or_default() += *normal;
            }
            shape.add_patch(part, (rim, &border), &dressed, position, &normals);
        }
        if part.normals.is_some() {
            turn_rims(part, &at_rims, &mut shape);
        } else {
            shape.normals.clear();
        }
        Ok(shape)
    }

    fn add_patch(
        &mut self,
        part: &Part<'_>,
        (rim, border): (usize, &[SurfaceVertex]),
        dressed: &DressedPatch,
        position: impl Fn(u32) -> DVec3,
        normals: &[DVec3],
    ) {
        let first = self.positions.len() as u32;
        let first_file = self.file_vertex_count as u32;
        let width = part.attributes.width();
        let first_row = self.values.len().checked_div(width).unwrap_or(0) as u32;
        for (row, &(point, like)) in (first_row..).zip(&dressed.vertices) {
            let vertex = DrawnVertex(self.positions.len() as u32);
            self.vertices.push(VertexSource::New { part: 0, like, row });
            self.positions.push(position(point));
            self.file_vertices.push(match (point as usize).checked_sub(rim) {
                None => part.model.first_file_vertex(border[point as usize]),
                Some(inside) => FileVertex(first_file + inside as u32),
            });
            self.normals.push((vertex, normals[point as usize].normalize_or_zero()));
        }
        self.file_vertex_count += normals.len() - rim;
        self.values.extend(&dressed.values);
        let corner = |corner: DressedCorner| match corner {
            DressedCorner::Old(vertex) => vertex,
            DressedCorner::New(place) => DrawnVertex(first + place),
        };
        self.triangles
            .extend(dressed.triangles.iter().map(|corners| corners.map(corner)));
        self.triangle_sources
            .extend(dressed.sources.iter().map(|&triangle| TriangleSource {
                part: 0,
                triangle,
                age: Age::New,
            }));
    }
}

/// Gives the smooth vertices on rims the normal of the closed surface.
fn turn_rims(part: &Part<'_>, at_rims: &BTreeMap<SurfaceVertex, DVec3>, shape: &mut NewShape) {
    let (Some(normal_of), model) = (part.normals, part.model) else {
        return;
    };
    let mut turned: BTreeMap<DrawnVertex, DVec3> = BTreeMap::new();
    for (&vertex, of_patches) in at_rims {
        let faces: Vec<u32> = model.topology.faces(vertex, &model.surface.triangles).collect();
        let areas = faces.iter().map(|&face| {
            let [a, b, c] = model.surface.corners(face as usize);
            (b - a).cross(c - a)
        });
        let before: DVec3 = areas.sum();
        let after = (before + *of_patches).normalize_or_zero();
        for &face in &faces {
            let drawn = model.drawn_corners(face as usize);
            let own = model.surface.triangles[face as usize].into_iter().zip(drawn);
            for (_, corner) in own.filter(|(own, _)| *own == vertex) {
                if normal_of(corner).dot(before.normalize_or_zero()) >= SMOOTH && after != DVec3::ZERO {
                    turned.insert(corner, after);
                }
            }
        }
    }
    shape.normals.splice(0..0, turned);
}
