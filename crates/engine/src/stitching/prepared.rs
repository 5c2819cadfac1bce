//! A file's shape for joining: cut and transformed, with its surface.

use std::collections::BTreeSet;

use glam::{DAffine3, DVec3, Vec3};
use pliant_editor::HandleTransform;
use pliant_mesh::{Cancel, Drawn, DrawnVertex, FileVertex, Model, Progress, WeldOptions};
use pliant_stitch::{Age, Attributes, NewShape, Part, StitchError, TriangleSource, VertexSource};

use super::look::Source;
use crate::EngineError;
use crate::loading::Loaded;

/// A shape that was cut and transformed.
pub(super) struct Prepared {
    pub drawn: Drawn,
    pub model: Model,
    /// The unit normal of each drawn vertex.
    pub normals: Vec<DVec3>,
    /// The file's drawn vertex and triangle behind each of these.
    vertices: Vec<DrawnVertex>,
    pub triangles: Vec<u32>,
    /// The number here of each of the file's vertices.
    file_numbers: Vec<Option<u32>>,
    /// Whether the corners of each of these triangles run the other way than in the file.
    is_turned: Vec<bool>,
    /// The number of the file's parts that were inside out, and were turned.
    pub turned_parts: usize,
}

impl Prepared {
    /// The shape of a file without the deleted welded vertices (a flag for each), at its drawn positions in `source` and then transformed.
    /// `displacements` are those of its welded vertices in `source`. Closed parts that are inside out are turned, so that
    /// both shapes agree about the outside.
    ///
    /// # Errors
    /// A selection of everything; [`EngineError::Interrupted`].
    pub fn of(
        loaded: &Loaded,
        source: &Source<'_>,
        delete: &[bool],
        (displacements, transform): (Option<&[DVec3]>, Option<&HandleTransform>),
        refuse: impl Fn(StitchError) -> EngineError,
        (progress, cancel): (&Progress, &Cancel),
    ) -> Result<Self, EngineError> {
        let model = &loaded.model;
        let whole = Part {
            model,
            drawn: source.drawn,
            group: &|_| 0,
            attributes: Attributes::NONE,
            normals: None,
        };
        let shape = match delete.contains(&true) {
            false => NewShape::whole(&whole),
            true => NewShape::cut(&whole, delete).map_err(&refuse)?,
        };
        let vertices: Vec<DrawnVertex> = shape
            .vertices
            .iter()
            .map(|source| match *source {
                VertexSource::Old { vertex, .. } => vertex,
                VertexSource::New { like, .. } => like,
            })
            .collect();
        let mut file_numbers = vec![None; model.drawn.file_vertex_count()];
        for (old, number) in vertices.iter().zip(&shape.file_vertices) {
            file_numbers[model.drawn.file_vertex(*old).index()] = Some(number.0);
        }
        // Welded as the file was: each vertex at its surface's, so that only equal ones are joined.
        let surface = |old: DrawnVertex| {
            let vertex = model.drawn.surface_vertex(old)?;
            let displacement = displacements.map_or(DVec3::ZERO, |all| all[vertex.index()]);
            Some(model.surface.positions[vertex.index()] + displacement)
        };
        let places = vertices.iter().map(|&old| surface(old).unwrap_or(DVec3::NAN));
        let mut drawn = Drawn {
            positions: places.collect(),
            triangles: shape.triangles,
            file_vertex: shape.file_vertices,
            file_vertex_count: shape.file_vertex_count,
            ..Drawn::default()
        };
        let map = transform.map_or(DAffine3::IDENTITY, |transform| transform.affine(middle(model, delete)));
        let is_mirrored = map.matrix3.determinant() < 0.0;
        let before = drawn.positions.clone();
        if map != DAffine3::IDENTITY {
            drawn
                .positions
                .iter_mut()
                .for_each(|position| *position = map.transform_point3(*position));
        }
        let inside_out: BTreeSet<u32> = source.model.inside_out.iter().copied().collect();
        let flags = source.model.drawn_vertices_of(&inside_out);
        let is_inside_out = |old: DrawnVertex| flags.get(old.index()) == Some(&true);
        let is_turned = |corners: &[DrawnVertex; 3]| is_inside_out(vertices[corners[0].index()]) != is_mirrored;
        let is_turned: Vec<bool> = drawn.triangles.iter().map(is_turned).collect();
        let turned = drawn
            .triangles
            .iter_mut()
            .zip(&is_turned)
            .filter(|(_, turned)| **turned);
        turned.for_each(|(corners, _)| corners.swap(1, 2));
        let only_equal = WeldOptions { distance: Some(0.0) };
        let welded = Model::weld(drawn.clone(), &only_equal, progress, cancel).map_err(|_| EngineError::Interrupted)?;
        let flattened = flattened(&welded, &before, &drawn);
        if FEW * flattened > drawn.triangles.len() {
            return Err(refuse(StitchError::Transform { triangles: flattened }));
        }
        let unwelded = vertices.iter().map(|old| source.drawn.positions[old.index()]);
        drawn.positions = match map == DAffine3::IDENTITY {
            true => unwelded.collect(),
            false => unwelded.map(|position| map.transform_point3(position)).collect(),
        };
        let of_normals = map.matrix3.inverse().transpose();
        let stored = source.normals();
        let normal = |old: &DrawnVertex| {
            let normal = Vec3::from(stored[old.index()]).as_dvec3();
            let normal = if is_inside_out(*old) { -normal } else { normal };
            if map == DAffine3::IDENTITY {
                normal
            } else {
                (of_normals * normal).normalize_or_zero()
            }
        };
        Ok(Self {
            normals: vertices.iter().map(normal).collect(),
            drawn,
            model: welded,
            vertices,
            triangles: shape.triangle_sources.iter().map(|source| source.triangle).collect(),
            file_numbers,
            is_turned,
            turned_parts: inside_out.len(),
        })
    }

    /// The file's drawn vertex behind one of these.
    pub fn source(&self, vertex: DrawnVertex) -> DrawnVertex {
        self.vertices[vertex.index()]
    }

    /// The number here of a vertex of the file, if it is left.
    pub fn number(&self, file_vertex: u32) -> Option<u32> {
        self.file_numbers.get(file_vertex as usize).copied().flatten()
    }

    /// The number in the file of a vertex here.
    pub fn file_number(&self, vertex: u32) -> u32 {
        let found = self.file_numbers.iter().position(|number| *number == Some(vertex));
        found.map_or(vertex, |found| FileVertex(found as u32).0)
    }

    /// The source of a triangle of the joined shape in this part's file. Those of a mirrored part have turned corners.
    pub fn triangle_source(&self, source: TriangleSource) -> TriangleSource {
        TriangleSource {
            triangle: self.triangles[source.triangle as usize],
            age: if self.is_turned[source.triangle as usize] {
                Age::New
            } else {
                source.age
            },
            ..source
        }
    }

    /// The source of a vertex of the joined shape in this part's file.
    pub fn vertex_source(&self, source: VertexSource) -> VertexSource {
        match source {
            VertexSource::Old { part, vertex } => VertexSource::Old {
                part,
                vertex: self.source(vertex),
            },
            VertexSource::New { part, like, row } => VertexSource::New {
                part,
                like: self.source(like),
                row,
            },
        }
    }
}

/// Rounding may flatten one needle in this many triangles.
const FEW: usize = 100;

/// A triangle is too far from the origin if its longest edge has fewer roundings of its coordinates than this.
const FEWEST_ROUNDINGS: f64 = 1e4;

/// The number of triangles that a transform left without an area, or took so far that rounding bends them.
fn flattened(welded: &Model, before: &[DVec3], after: &Drawn) -> usize {
    let is_sound = |positions: &[DVec3], corners: &[DrawnVertex; 3]| {
        let [a, b, c] = corners.map(|corner| positions[corner.index()]);
        let area = (b - a).cross(c - a).length();
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let rounding = f64::EPSILON * a.abs().max(b.abs()).max(c.abs()).max_element();
        area > 0.0 && area.is_finite() && longest > FEWEST_ROUNDINGS * rounding
    };
    let is_placed = |corners: &[DrawnVertex; 3]| {
        let mut of_corners = corners.iter().map(|&corner| welded.drawn.surface_vertex(corner));
        of_corners.all(|vertex| vertex.is_some())
    };
    let is_flattened = |corners: &&[DrawnVertex; 3]| {
        is_sound(before, corners) && !(is_sound(&after.positions, corners) && is_placed(corners))
    };
    after.triangles.iter().filter(is_flattened).count()
}

/// The mean of the welded vertices that are left.
fn middle(model: &Model, delete: &[bool]) -> DVec3 {
    let positions = model.main_positions();
    let left = || (0..positions.len() as u32).filter(|&v| !delete[v as usize]);
    let count = left().count().max(1) as f64;
    left().map(|v| positions[v as usize]).sum::<DVec3>() / count
}
