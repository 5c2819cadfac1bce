//! What the window must show: borrowed from the editor after each event, with revisions that tell what changed.
//!
//! The app keeps the revisions of what it uploaded last and compares; nothing is uploaded or drawn when none changed.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_mesh::Model;

use crate::document::{Handle, HandleId};
use crate::jobs::{Counts, Descent, JobKind, Symmetry};
use crate::tool::{BrushMetric, CorrectionBrush, Depth, StiffnessBrush, StrokeShape, ToolMode};
use crate::view::{Camera, ControlShape, GizmoOrientation, GizmoShape, Look, Orbit};

/// Everything the 3D view and the panels around it show.
#[derive(Debug)]
pub struct SceneView<'a> {
    /// The open file's vertex sets; `None` before the first file.
    pub model: Option<&'a Arc<Model>>,
    /// The eye: gives the matrices.
    pub camera: &'a Camera,
    /// The view's size in points.
    pub viewport_px: DVec2,
    /// Grows when [`SceneView::displacements`] changed.
    pub shape_revision: u64,
    /// Per surface vertex, from the file's shape: hand it to [`Model::drawn_positions`]. Shared, never changed in
    /// place.
    pub displacements: &'a Arc<Vec<DVec3>>,
    /// What is drawn, from the file's shape: the displacements, or the smooth base, bent alike, where that is shown.
    pub drawn: &'a Arc<Vec<DVec3>>,
    /// No displacement of any vertex: the file's own shape.
    pub original: &'a Arc<Vec<DVec3>>,
    /// Per surface vertex the selected handle's weight, from 0 to 1, where the shading is by weights and the method has
    /// some.
    pub weights: Option<&'a Arc<Vec<f64>>>,
    /// Grows when the colours of regions and handles changed: fetch them by
    /// [`Editor::region_colours`](crate::Editor::region_colours).
    pub regions_revision: u64,
    /// Grows when the lines between regions changed, or the selected handle: fetch them by
    /// [`Editor::rims`](crate::Editor::rims).
    pub rims_revision: u64,
    /// Grows when anything of the overlay (ring, gizmo) changed.
    pub overlay_revision: u64,
    /// Grows when the camera changed.
    pub camera_revision: u64,
    /// The ring of the brush on the surface under the pointer, a closed line in world space; empty where none is shown.
    pub brush_ring: &'a [DVec3],
    /// The selected handle's gizmo, in world space; empty where none is shown.
    pub gizmo: &'a [GizmoShape],
    /// The method's cage or lattice, in world space; empty where it has none.
    pub controls: &'a [ControlShape],
    /// The joint of the limb under the pointer, or the arc of a turn, in world space; empty where none is shown.
    pub shapes: &'a [ControlShape],
    /// What there is to say of the cage or lattice.
    pub control_points: Option<ControlPoints>,
    /// How far an iterative method's descent to the present shape is; `None` where nothing is bent, or in one step.
    pub descent: Option<Descent>,
    /// How the surface is shown.
    pub look: Look,
    /// What dragging the view does.
    pub orbit: Orbit,
    /// The present length, angle or factor of the active transform.
    pub readout: Option<Readout>,
    /// What the left button does on the surface.
    pub tool: ToolMode,
    /// What the pointer should look like.
    pub cursor: Cursor,
    /// The lasso or box that is being drawn, a closed line in points of the view; empty where none is.
    pub outline_px: Vec<DVec2>,
    /// How the left button takes vertices.
    pub stroke_shape: StrokeShape,
    /// How deep a lasso or a box goes.
    pub depth: Depth,
    /// Across which plane both sides are painted at once, found or still looked for.
    pub symmetry: Symmetry,
    /// How the brush measures its radius.
    pub brush_metric: BrushMetric,
    /// The stiffness brush.
    pub stiffness_brush: StiffnessBrush,
    /// The brush that corrects the shape.
    pub correction_brush: CorrectionBrush,
    /// How hard a pen presses, 0 to 1; `None` until the system reports it.
    pub pressure: Option<f64>,
    /// Along which axes the gizmo stands.
    pub orientation: GizmoOrientation,
    /// Whether the next click puts the pivot.
    pub wants_pivot: bool,
    /// The brush's radius in points.
    pub brush_radius_px: f64,
    /// The handles, in the order in which they were made.
    pub handles: &'a [Handle],
    /// The selected handle.
    pub selected: Option<HandleId>,
    /// Handles that are selected along with it.
    pub companions: &'a [HandleId],
    /// What the program is doing and what can be done next, in one line.
    pub status: String,
    /// The last thing that went wrong, in one sentence, until the next command that works.
    pub problem: Option<&'a str>,
    /// Jobs that run, with their progress (0 to 1).
    pub jobs: Vec<(JobKind, f32)>,
    /// Numbers of vertices by role.
    pub counts: Counts,
    /// What Undo would take back.
    pub undo: Option<&'a str>,
    /// What Redo would do again.
    pub redo: Option<&'a str>,
    /// Whether the document changed since it was opened or saved.
    pub unsaved: bool,
    /// Whether shape and regions are final: no job runs that could change them, and nothing is being dragged.
    pub settled: bool,
}

/// The cage or lattice that is shown.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ControlPoints {
    /// What a person calls it, in lower case.
    pub title: &'static str,
    /// How many points it has.
    pub count: usize,
    /// How many of them are selected.
    pub selected: usize,
    /// Whether it is the document's; else the method has made it.
    pub is_own: bool,
}

/// A number to be shown beside the thing that is being dragged.
#[derive(Clone, PartialEq, Debug)]
pub struct Readout {
    /// Where, in world space.
    pub at: DVec3,
    /// The number with its unit or sign.
    pub text: String,
}

/// What the pointer should look like over the view.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Cursor {
    /// An arrow.
    #[default]
    Arrow,
    /// A crosshair: the brush is over the surface.
    Brush,
    /// A hand: something can be grabbed.
    Grab,
    /// A closed hand: something is being dragged.
    Grabbing,
    /// Four arrows: a transform follows the pointer.
    Move,
}
