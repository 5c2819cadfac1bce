//! The window's content: borrowed from the editor after each event, with revisions that mark changes.
//!
//! The app keeps the revisions of its last uploads and compares; nothing is uploaded or drawn when none changed.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_mesh::Model;

use crate::cut::CutStroke;
use crate::document::{Handle, HandleId, KeyId};
use crate::jobs::{Descent, JobKind, Skin, Symmetry};
use crate::region::Counts;
use crate::stitching::MergeSettings;
use crate::timeline::BodyMotion;
use crate::tool::{
    BrushMetric, CorrectionBrush, Depth, FlowBrush, PointedRim, RimUse, StiffnessBrush, StrokeShape, ToolMode,
};
use crate::view::{Camera, ControlShape, Cursor, GizmoOrientation, GizmoShape, Look, Orbit, Readout};

/// The whole content of the 3D view and the panels around it.
#[derive(Debug)]
pub struct SceneView<'a> {
    /// The open file's vertex sets; `None` before the first file.
    pub model: Option<&'a Arc<Model>>,
    /// The camera, which gives the matrices. It is in the space of the shown frame, as everything that is shown.
    pub camera: &'a Camera,
    /// The view's size in points.
    pub viewport_px: DVec2,
    /// Grows when [`SceneView::displacements`] changed.
    pub shape_revision: u64,
    /// Displacements per surface vertex, from the file's shape, for [`Model::drawn_positions`]. They are shared and
    /// never changed in place.
    pub displacements: &'a Arc<Vec<DVec3>>,
    /// The drawn displacements from the file's shape: those of the shape, or those of the smooth base if that is shown.
    pub drawn: &'a Arc<Vec<DVec3>>,
    /// Zero displacements: the file's own shape.
    pub original: &'a Arc<Vec<DVec3>>,
    /// Per surface vertex the selected handle's weight, from 0 to 1, if the shading is by weights and the method has
    /// some.
    pub weights: Option<&'a Arc<Vec<f64>>>,
    /// Grows when the colours of regions and handles changed: fetch them by
    /// [`Editor::region_colours`](crate::Editor::region_colours).
    pub regions_revision: u64,
    /// Grows when the lines between regions changed, or the selected handle: fetch them by
    /// [`Editor::rims`](crate::Editor::rims).
    pub rims_revision: u64,
    /// Grows when a part of the overlay (ring, gizmo) changed.
    pub overlay_revision: u64,
    /// Grows when the camera changed.
    pub camera_revision: u64,
    /// True while a drag moves the surface: the regions' colours fade, so that its form is seen.
    pub is_dragging: bool,
    /// The ring of the brush on the surface under the pointer, a closed line in world space; empty if none is shown.
    pub brush_ring: &'a [DVec3],
    /// The selected handle's gizmo, in world space; empty if none is shown.
    pub gizmo: &'a [GizmoShape],
    /// The method's cage or lattice, in world space; empty if it has none.
    pub controls: &'a [ControlShape],
    /// The joint of the limb under the pointer, or the arc of a turn, in world space; empty if none is shown.
    pub shapes: &'a [ControlShape],
    /// The facts about the cage or lattice.
    pub control_points: Option<ControlPoints>,
    /// The progress of an iterative method's descent to the present shape; `None` if nothing is bent, or for a method
    /// with one step.
    pub descent: Option<Descent>,
    /// The look of the surface.
    pub look: Look,
    /// The effect of dragging the view.
    pub orbit: Orbit,
    /// The present length, angle or factor of the active transform.
    pub readout: Option<Readout>,
    /// The left button's tool on the surface.
    pub tool: ToolMode,
    /// The look of the pointer.
    pub cursor: Cursor,
    /// The active lasso or box, a closed line in points of the view; empty if there is none.
    pub outline_px: Vec<DVec2>,
    /// The shape in which the left button selects vertices.
    pub stroke_shape: StrokeShape,
    /// True if the points of curves follow a dragged one at their distances.
    pub chain: bool,
    /// True if a drag of the pose brush bends a limb at all its joints.
    pub whole_limb: bool,
    /// The depth of a lasso or a box.
    pub depth: Depth,
    /// The plane across which both sides are painted at once, found or still being searched for.
    pub symmetry: Symmetry,
    /// The measure of the brush's radius.
    pub brush_metric: BrushMetric,
    /// The stiffness brush.
    pub stiffness_brush: StiffnessBrush,
    /// The brush that corrects the shape.
    pub correction_brush: CorrectionBrush,
    /// The brush that pours and pushes.
    pub flow_brush: FlowBrush,
    /// The ghosts of other moments, from the first to the last.
    pub skins: &'a [Skin],
    /// The selected keys.
    pub selected_keys: &'a BTreeSet<KeyId>,
    /// True while the animation plays.
    pub is_animating: bool,
    /// True while events that have waited for a job are handled, some of them in each frame.
    pub is_catching_up: bool,
    /// The frame of a sequence that must be read next ([`Event::Frame`](crate::Event::Frame)); `None` if none is
    /// awaited.
    pub wanted_frame: Option<usize>,
    /// The other sequence that leads handles, and the frame of it that must be read next
    /// ([`Event::MixFrame`](crate::Event::MixFrame)); `None` if none is awaited.
    pub wanted_mix: Option<(&'a str, usize)>,
    /// True if all frames of a sequence must be read and followed ([`Event::Followed`](crate::Event::Followed)).
    pub wants_following: bool,
    /// The frame of the body's path under the pointer.
    pub pointed_frame: Option<usize>,
    /// The camera in the world, to which the body's path may have carried the shown frame.
    pub world_camera: &'a Camera,
    /// The motion of the shown frame along the path, into the world.
    pub body_motion: BodyMotion,
    /// True while the flow plays.
    pub is_playing: bool,
    /// The pressure of a pen, 0 to 1; `None` until the system reports it.
    pub pressure: Option<f64>,
    /// The axes of the gizmo.
    pub orientation: GizmoOrientation,
    /// True if the next click moves the pivot.
    pub wants_pivot: bool,
    /// The use of the rim that the next click takes; `None` if it takes none.
    pub wants_rim: Option<RimUse>,
    /// The rim under the pointer that the next click takes.
    pub rim: Option<&'a PointedRim>,
    /// The number of its pair at each place that was picked for a merge.
    pub pair_numbers: Vec<Readout>,
    /// The line or curve along which the next drag cuts; `None` if it does not cut.
    pub wants_cut: Option<CutStroke>,
    /// How parts are merged.
    pub merge: &'a MergeSettings,
    /// The change of the mesh that is under way, by the name of its step.
    pub stitching: Option<&'static str>,
    /// The brush's radius in points.
    pub brush_radius_px: f64,
    /// The handles, in the order of their making.
    pub handles: &'a [Handle],
    /// The selected handle.
    pub selected: Option<HandleId>,
    /// The other selected handles.
    pub companions: &'a [HandleId],
    /// The program's activity and the next possible actions, in one line.
    pub status: String,
    /// The last failure, in one sentence, until the next command that works.
    pub problem: Option<&'a str>,
    /// Jobs that run, with their progress (0 to 1).
    pub jobs: Vec<(JobKind, f32)>,
    /// Numbers of vertices by role.
    pub counts: Counts,
    /// The step that Undo takes back.
    pub undo: Option<&'a str>,
    /// The step that Redo makes again.
    pub redo: Option<&'a str>,
    /// True if the document changed since it was opened or saved.
    pub unsaved: bool,
    /// True if shape and regions are final: no job runs that could change them, and no drag is active.
    pub settled: bool,
}

/// The cage or lattice that is shown.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ControlPoints {
    /// Its label for a person, in lower case.
    pub title: &'static str,
    /// The number of its points.
    pub count: usize,
    /// The number of selected points.
    pub selected: usize,
    /// True if it is the document's; if not, the method has made it.
    pub is_own: bool,
}
