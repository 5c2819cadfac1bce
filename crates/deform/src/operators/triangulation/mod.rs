//! The domain of a Laplacian: triangles with edge lengths, and their adjacency.
//!
//! Either the surface's own triangles, measured in space or along stretched axes, or intrinsic ones on the same
//! vertices, whose edges are straight within the surface and need not be its own edges.

mod flips;
mod intrinsic;
mod principal;
mod surface;
mod tufted;

use pliant_mesh::{Surface, SurfaceVertex, Topology};

use crate::numerical::graph::Graph;
use crate::operators::triangulation::intrinsic::Intrinsic;
use crate::operators::triangulation::principal::stretches;
use crate::operators::triangulation::surface::SurfaceTriangulation;
use crate::{Remedy, TriangulationKind};

/// Triangles with edge lengths over the surface's vertices.
#[derive(Clone, Debug)]
pub(crate) enum Triangulation<'a> {
    /// The surface's own triangles.
    Surface(SurfaceTriangulation<'a>),
    /// Intrinsic triangles on its vertices.
    Intrinsic(Box<Intrinsic>, &'a Topology),
}

impl Graph for Triangulation<'_> {
    fn neighbours(&self, vertex: SurfaceVertex) -> &[SurfaceVertex] {
        match self {
            Self::Surface(triangulation) => triangulation.topology.neighbours(vertex),
            Self::Intrinsic(triangulation, _) => triangulation.neighbours(vertex),
        }
    }
}

impl<'a> Triangulation<'a> {
    /// The surface's own triangles as they are in space.
    pub fn of_surface(surface: &'a Surface, topology: &'a Topology) -> Self {
        Self::Surface(SurfaceTriangulation {
            surface,
            topology,
            stretches: Vec::new(),
        })
    }

    /// Triangles of a kind, measured along stretched axes (see [`stretches`]).
    pub fn stretched(
        surface: &'a Surface,
        topology: &'a Topology,
        kind: TriangulationKind,
        anisotropy: f64,
        may_move: &dyn Fn(SurfaceVertex) -> bool,
    ) -> Self {
        let triangulation = SurfaceTriangulation {
            surface,
            topology,
            stretches: stretches(surface, topology, anisotropy, may_move),
        };
        match kind {
            TriangulationKind::AsIs => Self::Surface(triangulation),
            TriangulationKind::IntrinsicDelaunay => {
                Self::Intrinsic(Box::new(Intrinsic::delaunay(&triangulation)), triangulation.topology)
            }
            TriangulationKind::Tufted => {
                Self::Intrinsic(Box::new(Intrinsic::tufted(&triangulation)), triangulation.topology)
            }
        }
    }

    /// The surface's topology: both kinds have its components.
    pub fn topology(&self) -> &'a Topology {
        match self {
            Self::Surface(triangulation) => triangulation.topology,
            Self::Intrinsic(_, topology) => topology,
        }
    }

    /// The number of vertices.
    pub fn vertex_count(&self) -> usize {
        match self {
            Self::Surface(triangulation) => triangulation.surface.positions.len(),
            Self::Intrinsic(triangulation, _) => triangulation.vertex_count(),
        }
    }

    /// The number of triangles.
    pub fn face_count(&self) -> usize {
        match self {
            Self::Surface(triangulation) => triangulation.surface.triangles.len(),
            Self::Intrinsic(triangulation, _) => triangulation.face_count(),
        }
    }

    /// Visits the triangles around a vertex, each once, ascending.
    pub fn for_each_face(&self, vertex: SurfaceVertex, visit: impl FnMut(u32)) {
        match self {
            Self::Surface(triangulation) => triangulation
                .topology
                .faces(vertex, &triangulation.surface.triangles)
                .for_each(visit),
            Self::Intrinsic(triangulation, _) => triangulation.faces(vertex).iter().copied().for_each(visit),
        }
    }

    /// A triangle's corners; an intrinsic one may have a vertex twice.
    pub fn corners(&self, face: u32) -> [SurfaceVertex; 3] {
        match self {
            Self::Surface(triangulation) => triangulation.surface.triangles[face as usize],
            Self::Intrinsic(triangulation, _) => triangulation.corners(face),
        }
    }

    /// A triangle's edge lengths, entry `i` opposite corner `i`.
    pub fn lengths(&self, face: u32) -> [f64; 3] {
        match self {
            Self::Surface(triangulation) => triangulation.lengths(face),
            Self::Intrinsic(triangulation, _) => triangulation.lengths(face),
        }
    }

    /// The share of each triangle in the surface: ½ if the surface is covered twice.
    pub fn share(&self) -> f64 {
        match self {
            Self::Surface(_) => 1.0,
            Self::Intrinsic(triangulation, _) => triangulation.share(),
        }
    }

    /// The number of mollified triangles.
    pub fn mollified_faces(&self) -> usize {
        match self {
            Self::Surface(_) => 0,
            Self::Intrinsic(triangulation, _) => triangulation.mollified_faces(),
        }
    }

    /// Sentences for a person about edges that could not be flipped.
    pub fn warning(&self) -> Option<String> {
        match self {
            Self::Intrinsic(triangulation, _) if !triangulation.is_delaunay() => Some(format!(
                "the intrinsic triangulation could not be made Delaunay everywhere, so some weights stay negative: if \
                 the surface folds, take {}, which needs no triangles",
                Remedy::OfSpace
            )),
            _ => None,
        }
    }
}
