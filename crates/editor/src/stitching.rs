//! Changes of the mesh that a person asks for. The editor has no files and no materials, so its caller makes the new
//! mesh, off the thread that handles events, and returns it as [`Event::Stitched`](crate::Event::Stitched).

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::{Model, SurfaceVertex};

use crate::document::{Document, Matching};
use crate::snapshot::Snapshot;

/// A change of topology of the present shape. Vertices are those of the present surface.
#[derive(Clone, PartialEq, Debug)]
pub enum MeshChange {
    /// Fills every hole.
    FillAll,
    /// Fills the hole whose rim passes a vertex.
    FillAt(SurfaceVertex),
    /// Joins the borders that pass two vertices by a tube.
    Bridge([SurfaceVertex; 2]),
    /// Deletes vertices, with every triangle that uses one.
    Delete(Vec<SurfaceVertex>),
    /// Cuts along a plane.
    Cut(CutPlane, KeptSide),
}

impl MeshChange {
    /// The name of its step in the history.
    pub fn name(&self) -> &'static str {
        match self {
            Self::FillAll => "Fill holes",
            Self::FillAt(_) => "Fill hole",
            Self::Bridge(_) => "Bridge borders",
            Self::Delete(_) => "Delete region",
            Self::Cut(..) => "Cut",
        }
    }
}

/// A plane: the points p with `normal` · p = `distance`, in world units. The normal may have any length.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct CutPlane {
    /// The normal.
    pub normal: DVec3,
    /// The distance along it.
    pub distance: f64,
}

/// The side of a plane that a cut keeps.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum KeptSide {
    /// The side to which the normal points.
    #[default]
    Positive,
    /// The other one.
    Negative,
    /// Both: the surface only gets edges along the plane.
    Both,
}

/// A change of the mesh, to be made off the thread that handles events.
#[derive(Clone, Debug)]
pub struct StitchRequest {
    /// The change.
    pub change: MeshChange,
    /// The document when it was asked for.
    pub snapshot: Snapshot,
}

impl StitchRequest {
    /// The present shape, as displacements of the surface's vertices from the file's.
    pub fn displacements(&self) -> &[DVec3] {
        self.snapshot.document.from_file()
    }

    /// The connected parts that are turned inside out, by their numbers.
    pub fn inside_out(&self) -> &BTreeSet<u32> {
        self.snapshot.document.inside_out()
    }

    /// The document on the new mesh, which has the shape of the snapshot at rest.
    pub fn onto(&self, model: Arc<Model>) -> NewMesh {
        let before = &self.snapshot;
        let matching = Matching::of(&before.model, &model, Some(before.document.from_file()));
        NewMesh {
            document: before.document.onto_new_mesh(&matching),
            model,
        }
    }
}

/// A new mesh, with the document on it.
#[derive(Clone, Debug)]
pub struct NewMesh {
    pub(crate) model: Arc<Model>,
    pub(crate) document: Document,
}
