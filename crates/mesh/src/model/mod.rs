//! A file's geometry, welded: the drawn set, the surface, and the tables from one to the other.

mod objects;
mod rest;

use std::collections::BTreeSet;
use std::sync::OnceLock;

use glam::DVec3;
use rayon::prelude::*;

use crate::inspection::topological::{Parts, of_triangles};
use crate::weld::weld;
use crate::{
    Bounds, Cancel, Cancelled, Component, Drawn, DrawnSet, FileVertex, Findings, LocatedFinding, Object, Progress,
    Surface, SurfaceVertex, Topology, WeldOptions, bounding_box,
};

/// A part with less than this share of the largest part's vertices is a loose bit.
pub const LOOSE_BIT: f64 = 0.01;

/// The drawn set, the welded surface and the tables between them.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// The geometry that the file shows: see [`Self::rest`].
    pub drawn: DrawnSet,
    /// The surface that the solver works on.
    pub surface: Surface,
    /// The connectivity of the surface.
    pub topology: Topology,
    /// The faults of the mesh.
    pub findings: Findings,
    /// The connected parts that [`Findings::inside_out_components`] counts, ascending.
    pub inside_out: Vec<u32>,
    /// The objects that the file itself has; empty if it has none.
    pub objects: Vec<Object>,
    /// The options with which its vertices were joined.
    pub weld: WeldOptions,
    /// [`Self::bounds`], measured once, because a view asks at every frame: nothing moves a model's vertices.
    bounds: OnceLock<Option<Bounds>>,
    /// [`Self::bounds_without_specks`], likewise.
    bounds_without_specks: OnceLock<Option<Bounds>>,
}

impl Model {
    /// Welds `drawn` into a surface. Vertices that no kept triangle uses become bare points after its other vertices
    /// ([`Topology::bare_points`]). Geometry that can't be solved for is set aside and reported in the findings.
    ///
    /// Without a distance in the options, vertices on borders are joined within 1e-4 of the triangles' size near the
    /// place and others within 1e-7 of it; borders of vertices that were rounded apart ([`Drawn::roundings`]) within
    /// the distances of their rounding, but no further than a quarter of that size.
    pub fn weld(drawn: Drawn, options: &WeldOptions, progress: &Progress, cancel: &Cancel) -> Result<Self, Cancelled> {
        let mut welded = weld(drawn, options, progress, cancel)?;
        cancel.check()?;
        let drawn = welded.drawn.told_by(&welded.surface);
        let topology = Topology::with_components(&welded.surface, welded.components, cancel)?;
        cancel.check()?;
        progress.set(0.9);
        let parts = Parts {
            surface: &welded.surface,
            drawn: &drawn,
            components: topology.parts(),
        };
        let inside_out = parts.report(topology.findings(), &mut welded.findings);
        progress.set(1.0);
        let model = Self {
            drawn,
            surface: welded.surface,
            topology,
            findings: welded.findings,
            inside_out,
            objects: Vec::new(),
            weld: *options,
            bounds: OnceLock::new(),
            bounds_without_specks: OnceLock::new(),
        };
        // Whoever welds waits anyway.
        model.bounds_without_specks();
        Ok(model)
    }

    /// The bounding box of the vertices that kept triangles use, or of all bare points if there is no triangle; `None`
    /// for an empty surface.
    pub fn bounds(&self) -> Option<Bounds> {
        *self.bounds.get_or_init(|| bounding_box(self.main_positions()))
    }

    /// For each connected part, true if it has fewer vertices than this share (0 to 1) of the largest part's. Bare
    /// points are not parts.
    ///
    /// ```
    /// use pliant_mesh::{Cancel, LOOSE_BIT, Model, Progress, WeldOptions, shapes};
    ///
    /// let beside = glam::DAffine3::from_translation(glam::DVec3::X * 3.0);
    /// let small = shapes::moved(&shapes::icosphere(0), beside);
    /// let drawn = shapes::together(&[shapes::icosphere(3), small]);
    /// let (progress, cancel) = (Progress::new(), Cancel::new());
    /// let model = Model::weld(drawn, &WeldOptions::default(), &progress, &cancel).unwrap();
    /// // 12 of 642 vertices.
    /// assert_eq!(model.small_parts(0.02), [false, true]);
    /// assert_eq!(model.small_parts(LOOSE_BIT), [false, false]);
    /// ```
    pub fn small_parts(&self, share: f64) -> Vec<bool> {
        let components = self.topology.components();
        let of_triangles = of_triangles(components).len();
        let most = components.first().map_or(0, |largest| largest.vertex_count);
        let least = share * most as f64;
        let is_small =
            |(number, part): (usize, &Component)| number < of_triangles && (part.vertex_count as f64) < least;
        components.iter().enumerate().map(is_small).collect()
    }

    /// For each connected part, true if it is a speck: a loose bit that is further from all other parts than their
    /// size.
    pub fn specks(&self) -> Vec<bool> {
        let components = self.topology.components();
        let of_triangles = of_triangles(components).len();
        let is_bit = self.small_parts(LOOSE_BIT);
        if !is_bit.contains(&true) {
            return is_bit;
        }
        let box_of = |number: usize| {
            let vertices = self.topology.vertices_of(number as u32);
            Bounds::around(vertices.map(|v| self.surface.positions[v.index()]))
        };
        let parts = (0..of_triangles).filter(|&number| !is_bit[number]).filter_map(box_of);
        let Some(main) = parts.reduce(|a, b| a.union(&b)) else {
            return vec![false; components.len()];
        };
        let around = main.grown(main.diagonal());
        let is_far = |number: usize| box_of(number).is_some_and(|own| !own.meets(&around));
        (0..components.len())
            .map(|number| is_bit[number] && is_far(number))
            .collect()
    }

    /// The box that the view shows: as [`Self::bounds`], without specks.
    pub fn bounds_without_specks(&self) -> Option<Bounds> {
        let without_specks = || {
            let vertices = self.vertices_without_specks();
            Bounds::around(vertices.map(|v| self.surface.positions[v.index()]))
        };
        *self
            .bounds_without_specks
            .get_or_init(|| match self.specks().contains(&true) {
                true => without_specks(),
                false => self.bounds(),
            })
    }

    /// The vertices of [`Self::main_positions`] that belong to no speck.
    pub fn vertices_without_specks(&self) -> impl Iterator<Item = SurfaceVertex> + '_ {
        let specks = self.specks();
        let vertices = (0..self.main_positions().len() as u32).map(SurfaceVertex);
        vertices.filter(move |&v| !specks[self.topology.component(v) as usize])
    }

    /// The positions that determine where the model is and how large: see [`Topology::main_positions`].
    pub fn main_positions(&self) -> &[DVec3] {
        self.topology.main_positions(&self.surface.positions)
    }

    /// For each drawn vertex, whether it belongs to one of these connected parts, or shows a file vertex of theirs in
    /// another place. Empty if none is chosen.
    pub fn drawn_vertices_of(&self, parts: &BTreeSet<u32>) -> Vec<bool> {
        if parts.is_empty() {
            return Vec::new();
        }
        let is_of_parts = |vertex: SurfaceVertex| parts.contains(&self.topology.component(vertex));
        let mut chosen = vec![false; self.drawn.file_vertex_count()];
        for (file, surface) in self.drawn.file_vertices().zip(self.drawn.surface_vertices()) {
            chosen[file.index()] |= surface.is_some_and(is_of_parts);
        }
        self.drawn.file_vertices().map(|file| chosen[file.index()]).collect()
    }

    /// The lowest of the file's vertices behind a surface vertex. It searches all drawn vertices, so callers that ask for
    /// many vertices take [`Self::first_file_vertices`].
    pub fn first_file_vertex(&self, vertex: SurfaceVertex) -> FileVertex {
        self.drawn.first_file_vertices(vertex.index()..vertex.index() + 1)[0]
    }

    /// The lowest of the file's vertices behind each surface vertex.
    pub fn first_file_vertices(&self) -> Vec<FileVertex> {
        self.drawn.first_file_vertices(0..self.surface.positions.len())
    }

    /// The faults of the mesh, each with the places of its first examples, in the order of [`Findings::sentences`].
    /// This reads every vertex, so it is made on request.
    pub fn located_findings(&self) -> Vec<LocatedFinding> {
        self.findings.located_findings(&self.drawn, &self.surface)
    }

    /// The table from the file's vertices to the surface's.
    pub fn surface_of_file(&self) -> SurfaceOfFile {
        SurfaceOfFile::of_drawn(&self.drawn)
    }
}

/// The surface vertices behind each file vertex.
#[derive(Clone, Debug, Default)]
pub struct SurfaceOfFile {
    offsets: Vec<u32>,
    list: Vec<SurfaceVertex>,
}

impl SurfaceOfFile {
    fn of_drawn(drawn: &DrawnSet) -> Self {
        let mut pairs: Vec<(FileVertex, SurfaceVertex)> = drawn
            .file_vertices()
            .zip(drawn.surface_vertices())
            .filter_map(|(file_vertex, surface_vertex)| Some((file_vertex, surface_vertex?)))
            .collect();
        pairs.par_sort_unstable();
        pairs.dedup();
        let mut offsets = vec![0; drawn.file_vertex_count() + 1];
        for (file_vertex, _) in &pairs {
            offsets[file_vertex.index() + 1] += 1;
        }
        for v in 0..drawn.file_vertex_count() {
            offsets[v + 1] += offsets[v];
        }
        Self {
            offsets,
            list: pairs.into_iter().map(|(_, surface_vertex)| surface_vertex).collect(),
        }
    }

    /// The surface vertices of `vertex`, ascending: none if it is not finite or not drawn (or the file has no such
    /// vertex), two if two nodes show it in two places.
    pub fn of(&self, vertex: FileVertex) -> &[SurfaceVertex] {
        let row = self.offsets.get(vertex.index()..=vertex.index() + 1);
        match row {
            Some(&[start, end]) => &self.list[start as usize..end as usize],
            _ => &[],
        }
    }
}
