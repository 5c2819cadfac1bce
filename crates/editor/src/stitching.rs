//! Changes of the mesh that a person asks for. The editor has no files and no materials, so its caller makes the new
//! mesh, off the thread that handles events, and returns it as [`Event::Stitched`](crate::Event::Stitched).

use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Budget, Method};
use pliant_mesh::{Cancel, Cancelled, Model, SurfaceVertex};

use crate::cut::{CutCurve, CutPlane, KeptSide};
use crate::document::{Document, HandleId, Matching};
use crate::format::Placement;
use crate::former::Former;
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
    /// Cuts along a plane. These vertices are spared, which are all those of some connected parts.
    Cut(CutPlane, KeptSide, Vec<SurfaceVertex>),
    /// Cuts along a curve on the present surface; these vertices are spared in the same way.
    CutAlong(CutCurve, KeptSide, Vec<SurfaceVertex>),
    /// Puts another file of this name beside the shape. The caller knows the file.
    Append(String),
    /// Joins a part to the others.
    Merge(MergeChange),
}

/// The joining of a part, B, to all others, A.
#[derive(Clone, PartialEq, Debug)]
pub struct MergeChange {
    /// The vertices of B: whole connected parts.
    pub part: Vec<SurfaceVertex>,
    /// Vertices on borders of A and of B that belong together; without pairs the nearest borders are joined.
    pub pairs: Vec<[SurfaceVertex; 2]>,
    /// How they are joined.
    pub settings: MergeSettings,
}

/// How two parts are joined.
#[derive(Clone, PartialEq, Debug)]
pub struct MergeSettings {
    /// The distance from the borders within which each part may bend, as a share of its diagonal; in [`REACH_RANGE`].
    pub reach: f64,
    /// The method by which both bend.
    pub method: Method,
    /// Whether B moves first, so that its borders fit A's.
    pub placement: Placement,
}

/// The range of [`MergeSettings::reach`].
pub const REACH_RANGE: RangeInclusive<f64> = 0.01..=1.0;

impl Default for MergeSettings {
    fn default() -> Self {
        Self {
            reach: 0.2,
            method: Method::of_merges(),
            placement: Placement::Kept,
        }
    }
}

impl MeshChange {
    /// The name of its step in the history.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Append(_) => "Append file",
            Self::Merge(_) => "Merge parts",
            Self::FillAll => "Fill holes",
            Self::FillAt(_) => "Fill hole",
            Self::Bridge(_) => "Bridge borders",
            Self::Delete(_) => "Delete region",
            Self::Cut(..) | Self::CutAlong(..) => "Cut",
        }
    }
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
        self.snapshot.displacements()
    }

    /// The connected parts that are turned inside out, by their numbers.
    pub fn inside_out(&self) -> &BTreeSet<u32> {
        self.snapshot.document.inside_out()
    }

    /// The document on the new mesh, which has the shape of the snapshot at rest, except at vertices that the change has
    /// moved: `moved` are the displacements of all vertices to their new places, if they differ from the present ones.
    /// `budget` limits the memory for continuing examples into new triangles.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn onto(
        &self,
        model: Arc<Model>,
        moved: Option<&[DVec3]>,
        budget: Budget,
        cancel: &Cancel,
    ) -> Result<NewMesh, Cancelled> {
        let before = &self.snapshot;
        let places = moved.unwrap_or(before.document.from_file());
        let matching = Matching::of(&before.model, &model, Some(places));
        let (mut document, lost) = before.document.onto_new_mesh(&matching, &model, budget, cancel)?;
        let selected = match &self.change {
            MeshChange::Append(name) => document.hold_new_part(name, &matching, &model),
            _ => None,
        };
        document.centre_pivots(&model);
        Ok(NewMesh {
            former: Former::of(before, &matching, &model),
            document,
            model,
            selected,
            lost,
        })
    }
}

/// A new mesh, with the document on it.
#[derive(Clone, Debug)]
pub struct NewMesh {
    pub(crate) model: Arc<Model>,
    pub(crate) document: Document,
    /// The handle to select, if the change has made one.
    pub(crate) selected: Option<HandleId>,
    former: Former,
    lost: Vec<String>,
}

impl NewMesh {
    /// The mesh from which it was made.
    pub fn former(&self) -> &Former {
        &self.former
    }

    /// Sentences about parts of the document that the new mesh can't keep.
    pub fn lost(&self) -> &[String] {
        &self.lost
    }
}
