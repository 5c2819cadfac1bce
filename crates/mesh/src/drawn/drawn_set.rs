//! The geometry that a file shows, without the data that the surface already has: once welded, a drawn vertex has the
//! position of its surface vertex, so that position is not stored twice. The few that differ in a bit are stored
//! separately.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use crate::drawn::drawn_triangles::{Corners, DrawnTriangles};
use crate::{DrawnVertex, FileVertex, Surface, SurfaceVertex};

/// No surface vertex.
pub(crate) const NONE: u32 = u32::MAX;

/// The number of drawn vertices for one task.
pub(crate) const CHUNK: usize = 8192;

/// The drawn vertices and triangles of a file, in about a fifth of [`Drawn`](crate::Drawn)'s bytes. Positions and triangles can only
/// be restored with the surface: see [`Model`](crate::Model).
#[derive(Clone, Debug, Default)]
pub struct DrawnSet {
    /// [`NONE`] for a drawn vertex without a finite position.
    pub(crate) surface_vertices: Vec<u32>,
    pub(crate) strays: Strays,
    file_vertices: FileVertices,
    pub(crate) triangles: DrawnTriangles,
    pub(crate) triangle_of_surface: Vec<u32>,
    pub(crate) lines: Vec<[DrawnVertex; 2]>,
}

/// Drawn vertices whose position differs in a bit from their surface vertex's: joined within the tolerance, −0 for 0,
/// or not finite.
#[derive(Clone, Debug, Default)]
pub(crate) struct Strays {
    /// Ascending.
    vertices: Vec<u32>,
    positions: Vec<DVec3>,
}

/// The file vertices behind the drawn ones.
#[derive(Clone, Debug, Default)]
pub(crate) struct FileVertices {
    count: usize,
    /// Empty if each drawn vertex is the file's vertex of that number.
    listed: Vec<FileVertex>,
}

impl FileVertices {
    pub(crate) fn new(count: usize, of_drawn: Vec<FileVertex>) -> Self {
        let are_own = of_drawn.iter().zip(0..).all(|(file_vertex, own)| file_vertex.0 == own);
        Self {
            count,
            listed: if are_own { Vec::new() } else { of_drawn },
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.count
    }

    #[inline]
    pub(crate) fn of(&self, vertex: usize) -> FileVertex {
        self.listed.get(vertex).copied().unwrap_or(FileVertex(vertex as u32))
    }
}

impl Strays {
    fn of(positions: &[DVec3], surface_vertices: &[u32], surface_positions: &[DVec3]) -> Self {
        let strays = |v: &usize| {
            let surface_position = surface_positions.get(surface_vertices[*v] as usize);
            surface_position.is_none_or(|there| bits(*there) != bits(positions[*v]))
        };
        let mut vertices: Vec<u32> = (0..positions.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .filter(strays)
            .map(|v| v as u32)
            .collect();
        vertices.shrink_to_fit();
        Self {
            positions: vertices.iter().map(|&v| positions[v as usize]).collect(),
            vertices,
        }
    }

    fn get(&self, vertex: DrawnVertex) -> Option<DVec3> {
        let place = self.vertices.binary_search(&vertex.0).ok()?;
        Some(self.positions[place])
    }

    /// Those in a run of `count` drawn vertices, by their place in it.
    pub(crate) fn within(&self, first: usize, count: usize) -> impl Iterator<Item = (usize, DVec3)> + '_ {
        let place = |vertex: usize| self.vertices.partition_point(|&v| (v as usize) < vertex);
        (place(first)..place(first + count)).map(move |k| (self.vertices[k] as usize - first, self.positions[k]))
    }
}

fn bits(position: DVec3) -> [u64; 3] {
    position.to_array().map(f64::to_bits)
}

impl DrawnSet {
    /// The compact form of a drawn set whose vertices belong to those of a surface.
    pub(crate) fn new(
        positions: Vec<DVec3>,
        surface_vertices: Vec<u32>,
        surface_positions: &[DVec3],
        file_vertices: FileVertices,
    ) -> Self {
        Self {
            strays: Strays::of(&positions, &surface_vertices, surface_positions),
            surface_vertices,
            file_vertices,
            ..Self::default()
        }
    }

    /// The same with its triangles and, for each triangle of the surface, the number of the drawn one behind it.
    pub(crate) fn with_triangles(self, corners: Corners, triangle_of_surface: Vec<u32>) -> Self {
        Self {
            triangles: DrawnTriangles::AsTheyCame(corners),
            triangle_of_surface,
            ..self
        }
    }

    /// The same with its lines.
    pub(crate) fn with_lines(self, lines: Vec<[DrawnVertex; 2]>) -> Self {
        Self { lines, ..self }
    }

    /// The same without the triangles that the surface has.
    pub(crate) fn told_by(mut self, surface: &Surface) -> Self {
        let triangles = self.triangles;
        self.triangles = triangles.told_by(surface, &self.surface_vertices, &self.triangle_of_surface);
        self
    }

    /// The number of drawn vertices.
    pub fn vertex_count(&self) -> usize {
        self.surface_vertices.len()
    }

    /// The number of drawn triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The drawn lines: see [`crate::Drawn::lines`].
    pub fn lines(&self) -> &[[DrawnVertex; 2]] {
        &self.lines
    }

    /// The number of the file's vertices, drawn or not.
    pub fn file_vertex_count(&self) -> usize {
        self.file_vertices.count()
    }

    /// The surface vertex behind a drawn vertex; `None` if it has no finite position.
    #[inline]
    pub fn surface_vertex(&self, vertex: DrawnVertex) -> Option<SurfaceVertex> {
        known(self.surface_vertices[vertex.index()])
    }

    /// The surface vertex behind each drawn vertex.
    pub fn surface_vertices(&self) -> impl ExactSizeIterator<Item = Option<SurfaceVertex>> + Clone + '_ {
        self.surface_vertices.iter().map(|&v| known(v))
    }

    /// The file vertex behind a drawn vertex.
    #[inline]
    pub fn file_vertex(&self, vertex: DrawnVertex) -> FileVertex {
        self.file_vertices.of(vertex.index())
    }

    /// The file vertex behind each drawn vertex.
    pub fn file_vertices(&self) -> impl ExactSizeIterator<Item = FileVertex> + Clone + '_ {
        (0..self.vertex_count()).map(|v| self.file_vertices.of(v))
    }

    /// The number of the drawn triangle behind each surface triangle, corner for corner.
    pub fn triangle_of_surface(&self) -> &[u32] {
        &self.triangle_of_surface
    }

    /// The lowest of the file's vertices behind each surface vertex of a range.
    pub(crate) fn first_file_vertices(&self, of: Range<usize>) -> Vec<FileVertex> {
        let mut first = vec![FileVertex(u32::MAX); of.len()];
        if first.is_empty() {
            return first;
        }
        for (v, file_vertex) in self.surface_vertices().zip(self.file_vertices()) {
            let place = v.and_then(|v| v.index().checked_sub(of.start));
            if let Some(first) = place.and_then(|place| first.get_mut(place)) {
                *first = file_vertex.min(*first);
            }
        }
        first
    }

    /// The position of a drawn vertex at rest.
    pub(crate) fn position(&self, vertex: DrawnVertex, surface: &Surface) -> DVec3 {
        // A vertex without a surface vertex is a stray.
        let told = || surface.positions.get(self.surface_vertices[vertex.index()] as usize);
        let stray = self.strays.get(vertex);
        stray.or_else(|| told().copied()).unwrap_or(DVec3::NAN)
    }

    /// The corners of the drawn triangle of this number, found by a linear search.
    pub(crate) fn triangle(&self, triangle: u32, surface: &Surface) -> Option<[DrawnVertex; 3]> {
        self.triangles.get(triangle, surface, &self.triangle_of_surface)
    }
}

#[inline]
pub(crate) fn known(surface_vertex: u32) -> Option<SurfaceVertex> {
    (surface_vertex != NONE).then_some(SurfaceVertex(surface_vertex))
}
