//! The drawn geometry at rest and displaced, restored from the surface and the drawn set.

use glam::DVec3;
use rayon::prelude::*;

use crate::drawn::drawn_set::{CHUNK, known};
use crate::{Drawn, DrawnSet, DrawnVertex, Model, SurfaceVertex};

impl Model {
    /// The geometry that the file shows, as before welding: the same to the bit.
    pub fn rest(&self) -> Drawn {
        Drawn {
            positions: self.rest_positions(),
            triangles: self.drawn_triangles(),
            lines: self.drawn.lines.clone(),
            file_vertex: self.drawn.file_vertices().collect(),
            file_vertex_count: self.drawn.file_vertex_count(),
            roundings: Vec::new(),
        }
    }

    /// The position of a drawn vertex at rest.
    pub fn rest_position(&self, vertex: DrawnVertex) -> DVec3 {
        self.drawn.position(vertex, &self.surface)
    }

    /// The position of each drawn vertex at rest.
    pub fn rest_positions(&self) -> Vec<DVec3> {
        let mut out = Vec::new();
        let rest = &self.surface.positions;
        self.spread(|v| rest[v.index()], |stray, _| stray, &mut out);
        out
    }

    /// The drawn triangles, in the file's order: see [`Drawn::triangles`].
    pub fn drawn_triangles(&self) -> Vec<[DrawnVertex; 3]> {
        let drawn = &self.drawn;
        drawn.triangles.listed(&self.surface, &drawn.triangle_of_surface)
    }

    /// The corners of a drawn triangle; `None` beyond the last. Found by a linear search: for many triangles use
    /// [`Self::drawn_triangles`].
    pub fn drawn_triangle(&self, triangle: u32) -> Option<[DrawnVertex; 3]> {
        self.drawn.triangle(triangle, &self.surface)
    }

    /// The corners of the drawn triangle behind one of the surface's, corner for corner.
    #[inline]
    pub fn drawn_corners(&self, surface_triangle: usize) -> [DrawnVertex; 3] {
        let number = self.drawn.triangle_of_surface[surface_triangle];
        let corners = self.surface.triangles[surface_triangle];
        self.drawn.triangles.behind(corners, number)
    }

    /// Each drawn vertex's rest position plus the displacement of its surface vertex (`displacements`, one each), into
    /// `out`. If the displacement is zero, or if there is no surface vertex, the result has the rest position's own
    /// bits.
    pub fn drawn_positions(&self, displacements: &[DVec3], out: &mut Vec<DVec3>) {
        let rest = &self.surface.positions[..];
        let displacements = &displacements[..rest.len()];
        self.spread(
            |v| displaced(rest[v.index()], displacements[v.index()]),
            |stray, v| v.map_or(stray, |v| displaced(stray, displacements[v.index()])),
            out,
        );
    }

    /// For each drawn vertex the value of `of_surface` for its surface vertex, into `out`. A drawn vertex whose rest
    /// position differs in a bit from its surface vertex's, or that has no surface vertex, gets the value of `of_stray`
    /// for that position.
    #[inline]
    pub fn spread<T: Copy + Default + Send>(
        &self,
        of_surface: impl Fn(SurfaceVertex) -> T + Sync,
        of_stray: impl Fn(DVec3, Option<SurfaceVertex>) -> T + Sync,
        out: &mut Vec<T>,
    ) {
        let DrawnSet {
            surface_vertices,
            strays,
            ..
        } = &self.drawn;
        out.resize(surface_vertices.len(), T::default());
        let chunks = out.par_chunks_mut(CHUNK).zip(surface_vertices.par_chunks(CHUNK));
        chunks.enumerate().for_each(|(chunk, (out, surface_vertices))| {
            for (moved, &v) in out.iter_mut().zip(surface_vertices) {
                if let Some(v) = known(v) {
                    *moved = of_surface(v);
                }
            }
            for (place, stray) in strays.within(chunk * CHUNK, out.len()) {
                out[place] = of_stray(stray, known(surface_vertices[place]));
            }
        });
    }
}

#[inline]
fn displaced(rest: DVec3, displacement: DVec3) -> DVec3 {
    // Adding zero would turn −0 into 0.
    if displacement == DVec3::ZERO {
        rest
    } else {
        rest + displacement
    }
}
