//! Deformation transfer between surfaces [SP04]: each triangle takes on the map of a triangle of another surface, and a
//! Poisson system joins the triangles.
//!
//! The maps are deformation gradients ([`face_gradient`]). The shape whose gradients are nearest to them, ∫ |∇p' − T
//! ∇p|² → min [SP04, equation 5], solves the Poisson equation of [`Gradients`]. It does not determine the shift of a
//! connected part as a whole, which the displacements of the other surface's triangles determine.

use std::collections::VecDeque;

use glam::{DMat3, DVec3};
use pliant_mesh::{Cancel, Surface, Topology, bounding_box, face_gradient, is_without_area};

use crate::operators::gradients::{Face, Gradients};
use crate::systems::poisson_equation::{PoissonEquation, diagonal_of};
use crate::systems::poisson_system::{settled, write_field};
use crate::{BindError, Budget, Ordering, SolveError};

/// A surface at rest and in a pose, as in its file.
#[derive(Clone, Copy, Debug)]
pub struct PosedShape<'a> {
    /// Its vertices' positions at rest.
    pub rest: &'a [DVec3],
    /// The same vertices' positions in the pose.
    pub posed: &'a [DVec3],
    /// Its triangles.
    pub triangles: &'a [[usize; 3]],
}

impl PosedShape<'_> {
    /// The map of a triangle's edges and unit normal.
    fn map(&self, triangle: usize) -> DMat3 {
        let corners = self.triangles[triangle];
        face_gradient(corners.map(|v| self.rest[v]), corners.map(|v| self.posed[v]))
    }

    /// Returns true if a triangle has a map: its area is zero neither at rest nor in the pose.
    fn has_map(&self, triangle: usize) -> bool {
        let corners = self.triangles[triangle];
        [self.rest, self.posed]
            .iter()
            .all(|places| !is_without_area(corners.map(|v| places[v])))
    }

    /// The diagonal of the box around its triangles at rest.
    fn diagonal(&self) -> f64 {
        let corners: Vec<DVec3> = self
            .triangles
            .iter()
            .flatten()
            .map(|&corner| self.rest[corner])
            .collect();
        bounding_box(&corners).map_or(0.0, |bounds| bounds.diagonal())
    }

    /// The displacement of a triangle's middle.
    fn shift(&self, triangle: usize) -> DVec3 {
        let corners = self.triangles[triangle];
        corners.iter().map(|&v| self.posed[v] - self.rest[v]).sum::<DVec3>() / 3.0
    }
}

/// A surface that takes on the poses of others.
#[derive(Debug)]
pub struct DeformationTransfer<'a> {
    surface: &'a Surface,
    topology: &'a Topology,
    equation: PoissonEquation,
    /// The gradients on the target; `None` if no part has more than one vertex.
    gradients: Option<Gradients>,
}

impl<'a> DeformationTransfer<'a> {
    /// Factors the surface's Laplacian with one vertex of each connected part held. `ordering` is for power 1.
    ///
    /// # Errors
    /// The errors of a method's binding: degenerate triangles, a strip without end, memory, [`BindError::Cancelled`].
    pub fn bind(
        surface: &'a Surface,
        topology: &'a Topology,
        ordering: &Ordering,
        budget: Budget,
        cancel: &Cancel,
    ) -> Result<Self, BindError> {
        let equation = PoissonEquation::bind(surface, topology, ordering, budget, cancel)?;
        let gradients = equation.system().map(|system| {
            let stiffness = vec![1.0; surface.positions.len()];
            let laplacian = &system.operator.laplacian;
            Gradients::of(surface, topology, &stiffness, laplacian, system.columns())
        });
        Ok(Self {
            surface,
            topology,
            equation,
            gradients,
        })
    }

    /// The displacements by which the surface takes on a pose. `partners` has for each of its triangles the one of
    /// `source` whose map it takes; a triangle without a partner, or with one without area, takes the map of the
    /// nearest triangle that has one (edge by edge), and a part without any partner rests. Each part moves by its
    /// partners' mean displacement, in the proportion of the surfaces' sizes.
    ///
    /// # Errors
    /// If the solution stays too inaccurate, or is not finite.
    pub fn pose(&self, source: &PosedShape<'_>, partners: &[Option<usize>]) -> Result<Vec<DVec3>, SolveError> {
        let mut displacements = vec![DVec3::ZERO; self.surface.positions.len()];
        let (Some(system), Some(gradients)) = (self.equation.system(), &self.gradients) else {
            return Ok(displacements);
        };
        let with_maps = partners
            .iter()
            .map(|partner| partner.filter(|&triangle| source.has_map(triangle)));
        let taken = self.nearest(with_maps.collect());
        let changes: Vec<DMat3> = taken
            .iter()
            .map(|partner| partner.map_or(DMat3::ZERO, |partner| source.map(partner) - DMat3::IDENTITY))
            .collect();
        let (mut edges, mut load) = (Vec::new(), Vec::new());
        let of_face = |face: &Face| {
            let change = changes[face.number as usize];
            move |edge: DVec3| change * edge
        };
        gradients.change(of_face, &mut edges);
        gradients.divergence(&edges, self.equation.load_factor(), &mut load);
        let mut field = vec![[0.0; 3]; system.operator.field_len()];
        settled(system.solve_frame(&load, &mut field))?;
        write_field(&field, system.operator.laplacian.vertices(), &mut displacements);
        self.place(source, &taken, &mut displacements);
        match displacements.iter().position(|d| !d.is_finite()) {
            Some(vertex) => Err(SolveError::NotFinite { vertex: vertex as u32 }),
            None => Ok(displacements),
        }
    }

    /// Each triangle's partner, or that of the nearest triangle of its part.
    fn nearest(&self, mut taken: Vec<Option<usize>>) -> Vec<Option<usize>> {
        let triangles = &self.surface.triangles;
        let mut queue: VecDeque<usize> = (0..taken.len()).filter(|&triangle| taken[triangle].is_some()).collect();
        if queue.len() == taken.len() {
            return taken;
        }
        while let Some(triangle) = queue.pop_front() {
            for corner in triangles[triangle] {
                for beside in self.topology.faces(corner, triangles) {
                    let beside = beside as usize;
                    let shared = triangles[beside].iter().filter(|v| triangles[triangle].contains(v));
                    if taken[beside].is_none() && shared.count() > 1 {
                        taken[beside] = taken[triangle];
                        queue.push_back(beside);
                    }
                }
            }
        }
        taken
    }

    /// Moves each part so that the mean displacement of its triangles, by area, is that of their partners.
    fn place(&self, source: &PosedShape<'_>, taken: &[Option<usize>], displacements: &mut [DVec3]) {
        let proportion = diagonal_of(self.surface) / source.diagonal();
        if !proportion.is_finite() {
            return;
        }
        let mut missing = vec![(DVec3::ZERO, 0.0); self.topology.components().len()];
        for (triangle, partner) in taken.iter().enumerate() {
            let Some(partner) = *partner else { continue };
            let corners = self.surface.triangles[triangle];
            let [a, b, c] = self.surface.corners(triangle);
            let area = 0.5 * (b - a).cross(c - a).length();
            let own = corners.iter().map(|v| displacements[v.index()]).sum::<DVec3>() / 3.0;
            let (sum, weight) = &mut missing[self.topology.component(corners[0]) as usize];
            *sum += (source.shift(partner) * proportion - own) * area;
            *weight += area;
        }
        for (component, (sum, weight)) in missing.into_iter().enumerate() {
            if weight > 0.0 {
                for vertex in self.topology.vertices_of(component as u32) {
                    displacements[vertex.index()] += sum / weight;
                }
            }
        }
    }
}
