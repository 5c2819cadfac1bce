//! The surface as a flow sees it, and the ways between its two kinds of velocities.
//!
//! A velocity is constant on each triangle, because gradients of pressure are. Ways begin at vertices and need a
//! velocity that varies continuously: the mean of the triangles around each vertex, interpolated.

use std::ops::Range;

use glam::{DVec2, DVec3};
use pliant_mesh::{SurfaceVertex, face_normal, vectors};
use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use crate::chart::Chart;
use crate::corners::Corners;
use crate::crossings::Crossings;
use crate::domain::Domain;
use crate::fans::Fans;
use crate::hinges::Hinges;
use crate::lanes::{LANES, change, vector};
use crate::plane::turned;
use crate::sheets::Sheets;
use crate::sums::{CHUNK, sum, sums};

/// A surface, laid out.
#[derive(Debug)]
pub(crate) struct Fluid<'a> {
    pub sheets: Sheets<'a>,
    pub domain: Domain,
    /// A third of the area around each vertex.
    pub masses: Vec<f64>,
    /// The mean length of an edge.
    pub mean_edge: f64,
}

impl<'a> Fluid<'a> {
    pub fn of(sheets: Sheets<'a>) -> Self {
        let (surface, topology) = (&*sheets.surface, &*sheets.topology);
        let charts: Vec<Chart> = (0..surface.triangles.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|t| Chart::of(surface.corners(t)))
            .collect();
        let hinges = Hinges::of(surface, topology);
        let fans = Fans::of(surface, topology, &hinges, &charts);
        let third = |&corner: &u32| charts[corner as usize / 3].area() / 3.0;
        let masses = (0..surface.positions.len())
            .map(|vertex| fans.corners(vertex).iter().map(third).sum())
            .collect();
        let [lengths] = sum(charts.len(), |t| [(0..3).map(|k| charts[t].edge(k).length()).sum()]);
        let mean_edge = lengths / (3 * charts.len()).max(1) as f64;
        Self {
            domain: Domain {
                crossings: Crossings::of(&hinges, &charts),
                charts,
                fans,
            },
            masses,
            mean_edge,
            sheets,
        }
    }

    /// Brings the triangles around some vertices near to the processor. Ways read them out of order and would wait for
    /// each; in the order in which they are stored they come several times as fast.
    pub fn read_ahead(&self, vertices: Range<usize>) {
        let triangles = &self.sheets.surface.triangles;
        // Triangles are stored in the order of their lowest vertices.
        let first_of = |vertex: usize| {
            let is_before = |corners: &[SurfaceVertex; 3]| corners.iter().any(|corner| corner.index() < vertex);
            triangles.partition_point(is_before)
        };
        let around = first_of(vertices.start)..first_of(vertices.end);
        self.domain.fans.read_ahead(around.clone());
        self.domain.crossings.read_ahead(around);
    }

    /// The number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.masses.len()
    }

    /// The number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.domain.charts.len()
    }

    /// The number of components.
    pub fn component_count(&self) -> usize {
        self.sheets.topology.components().len()
    }

    /// The component of a vertex.
    #[inline(always)]
    pub fn component(&self, vertex: usize) -> usize {
        self.sheets.topology.component(SurfaceVertex(vertex as u32)) as usize
    }

    /// The component of a triangle.
    #[inline(always)]
    pub fn component_of_triangle(&self, triangle: usize) -> usize {
        self.component(self.corners(triangle)[0])
    }

    /// The vertices of a triangle.
    #[inline(always)]
    pub fn corners(&self, triangle: usize) -> [usize; 3] {
        self.sheets.surface.triangles[triangle].map(|vertex| vertex.index())
    }

    /// The axes of a triangle's plane in space: along its first edge, and to the left of it.
    pub fn axes(&self, triangle: usize) -> [DVec3; 2] {
        let corners = self.sheets.surface.corners(triangle);
        let x = (corners[1] - corners[0]).normalize_or(DVec3::X);
        let y = face_normal(corners).cross(x);
        // A triangle without area has no plane of its own: any one through its line serves.
        [x, y.try_normalize().unwrap_or_else(|| x.any_orthonormal_vector())]
    }

    /// The middle of a triangle.
    pub fn middle(&self, triangle: usize) -> DVec3 {
        let [a, b, c] = self.sheets.surface.corners(triangle);
        a + (b - a + c - a) / 3.0
    }

    /// The norm of a velocity on each component: the root of the integral of the squared speed.
    pub fn speeds(&self, velocity: &[DVec2]) -> Vec<f64> {
        let of = |t: usize| [self.domain.charts[t].area() * velocity[t].length_squared()];
        let component = |t: usize| self.component_of_triangle(t);
        let squares = sums(self.triangle_count(), self.component_count(), component, of);
        squares.into_iter().map(|[square]| square.sqrt()).collect()
    }

    /// Fills `first` and `second` with the means around each vertex of two fields, in its tangent plane. `fields` has
    /// each triangle's vectors times its area.
    pub fn to_vertices(&self, fields: &[[f64; 4]], [first, second]: [&mut [DVec2]; 2]) {
        let fans = &self.domain.fans;
        let mean = |(vertex, (first, second)): (usize, (&mut DVec2, &mut DVec2))| {
            let mut sums = [DVec2::ZERO; 2];
            for &corner in fans.corners(vertex) {
                let rotation = fans.rotation(corner);
                let [x, y, other_x, other_y] = fields[corner as usize / 3];
                sums[0] += turned(rotation, DVec2::new(x, y));
                sums[1] += turned(rotation, DVec2::new(other_x, other_y));
            }
            let mass = 3.0 * self.masses[vertex];
            let inverse = if mass > 0.0 { mass.recip() } else { 0.0 };
            [*first, *second] = sums.map(|sum| sum * inverse);
        };
        let pairs = first.par_iter_mut().zip(second).with_min_len(CHUNK).enumerate();
        pairs.for_each(mean);
    }

    /// Adds a change of the vertices' velocities to the triangles'.
    ///
    /// The change goes by way of its circulations along edges (the trapezoidal rule), of which each triangle takes the
    /// Whitney form in its middle: ⅓ Σ c_ij (∇φ_j − ∇φ_i). If they are the differences of a function at the vertices,
    /// this is the function's gradient, which pressure takes off again. A mean of the corners' vectors would leave a
    /// part of every gradient behind, in one direction in triangles that point up and the other in those that point
    /// down.
    pub fn add_to_triangles(&self, changes: &[DVec2], velocity: &mut [DVec2]) {
        let arch = vectors();
        let chunks = velocity.par_chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(chunk, velocity)| {
            arch.dispatch(AddChanges {
                fluid: self,
                start: chunk * CHUNK,
                changes,
                velocity,
            });
        });
    }
}

/// Adds the changes of vertices to the triangles from `start` on.
///
/// A closure would be compiled without the vector instructions that its caller is compiled for.
struct AddChanges<'a> {
    fluid: &'a Fluid<'a>,
    start: usize,
    changes: &'a [DVec2],
    velocity: &'a mut [DVec2],
}

impl WithSimd for AddChanges<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut corners = Corners::new();
        let mut layouts = [[1.0; LANES]; 3];
        for from in (0..self.velocity.len()).step_by(LANES) {
            let velocity = self.velocity[from..].iter_mut().take(LANES);
            for i in 0..velocity.len() {
                let triangle = self.start + from + i;
                let vertices = self.fluid.corners(triangle);
                corners.read(i, &self.fluid.domain.fans, (triangle, vertices), self.changes);
                let layout = self.fluid.domain.charts[triangle].layout();
                (layouts[0][i], layouts[1][i], layouts[2][i]) = (layout[0], layout[1], layout[2]);
            }
            let at = [0, 1, 2].map(|k| corners.at_edges(k));
            let mut sums = [[0.0; LANES]; 2];
            change(&mut sums, |i, _| {
                let chart = Chart::with_layout([layouts[0][i], layouts[1][i], layouts[2][i]]);
                let gradients = chart.gradients();
                let mut sum = DVec2::ZERO;
                for k in 0..3 {
                    let (from, to) = ((k + 1) % 3, (k + 2) % 3);
                    let twice = vector(&at[from][0], i) + vector(&at[to][1], i);
                    sum += (gradients[to] - gradients[from]) * (0.5 * chart.edge(k).dot(twice));
                }
                sum / 3.0
            });
            for (i, velocity) in velocity.enumerate() {
                *velocity += vector(&sums, i);
            }
        }
    }
}
