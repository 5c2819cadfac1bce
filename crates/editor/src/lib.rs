//! The program without a window: document, history, selection, camera, brush, gizmo, tools, commands and jobs, and
//! the edit format that the command line reads.
//!
//! Everything happens through [`Editor::handle`]: the window, a test and a script send it [`Event`]s. The window shows
//! a [`SceneView`]; long work goes to the [`Executor`] that the application provides.
//!
//! A sphere is opened, a handle painted in the middle of the view and moved along x by typing, like a person's work:
//!
//! ```
//! use std::sync::Arc;
//!
//! use glam::DVec2;
//! use pliant_editor::{
//!     Button, Command, Editor, Event, InlineExecutor, Key, Modifiers, Pointer, ToolMode,
//! };
//! use pliant_mesh::shapes;
//!
//! let jobs = InlineExecutor::new();
//! let mut editor = Editor::new(Box::new(jobs.clone()));
//! let mut tell = |event| {
//!     editor.handle(event);
//!     while let Some(done) = jobs.run_next() {
//!         editor.handle(Event::JobDone(done));
//!     }
//! };
//! tell(Event::Viewport { size_px: DVec2::new(800.0, 600.0) });
//! let model = Arc::new(shapes::model(shapes::icosphere(4)));
//! tell(Event::Opened { model, name: "sphere".to_owned(), beginning: None });
//!
//! tell(Event::Command(Command::SetTool(ToolMode::PaintHandle)));
//! let middle = Pointer { position_px: DVec2::new(400.0, 300.0), modifiers: Modifiers::NONE };
//! tell(Event::PointerMoved(middle));
//! tell(Event::PointerPressed(middle, Button::Primary));
//! tell(Event::PointerReleased(middle, Button::Primary));
//! for key in "gx0.2".chars().map(Key::Character).chain([Key::Enter]) {
//!     tell(Event::Key(key, Modifiers::NONE));
//! }
//!
//! let view = editor.view();
//! assert!(view.counts.free > view.counts.handle && view.counts.handle > 0);
//! let farthest = view.displacements.iter().map(|way| way.x).fold(0.0, f64::max);
//! assert!((farthest - 0.2).abs() < 1e-9);
//! assert_eq!(editor.document().handles()[0].affine().translation.x, 0.2);
//! ```

mod bending;
mod chain;
mod command;
mod crease;
mod cut;
mod document;
mod ease;
mod editor;
mod evenly;
mod event;
mod filter_kind;
mod flow_start;
mod format;
mod former;
mod ground_axis;
mod input;
mod jobs;
mod key_space;
mod lines;
mod outline;
mod pickable;
mod region;
mod revision;
mod scene_view;
mod selection;
mod snapped;
mod snapshot;
mod status;
mod stitching;
mod timeline;
mod tool;
mod view;
mod warning;
mod workspace;

pub use bending::{Bent, Carried, Kept, Start, Targets, Until, settle};
pub use command::{Command, KeyMap, Listed, Shortcut, WITHOUT_EXAMPLES};
pub use cut::{CutCurve, CutPlane, CutSight, CutStroke, KeptSide};
pub use document::{
    Access, Animation, BodyPath, Carries, Content, Crease, Document, Dye, FREE_BEND_DEG, FlowOptions, Fluid,
    HANDLE_COLOURS, HISTORY_BYTES, Handle, HandleCurve, HandleFilter, HandleFootprints, HandleId, HandleLine,
    HandleMix, HandleSketch, HandleTransform, History, KeptShape, KeyFrame, KeyId, KeyRow, ObjectAction, Paint,
    PivotPlace, Pose, Reach, SHARPEN_RANGE, SaveMark, SavedAs, SmallParts, Tips, Twin, object_name, sum_of_shapes,
};
pub use ease::Ease;
pub use editor::Editor;
pub use event::Event;
pub use filter_kind::FilterKind;
pub use flow_start::FlowStart;
pub use format::{
    Accuracy, AttachmentEntry, Axis, Beginning, DyeEntry, EDIT_VERSION, EditError, EditFile, ExampleEntry,
    ExampleSource, ExportError, FieldEntry, FilterEntry, FlowFile, FlowMotion, FootprintEntry, FoundPlaces,
    HandleEntry, HandleSetup, JoinsFile, KeyEntry, MatchedByPlace, MeshReference, MixEntry, PathEntry, PathPart,
    Placed, Placement, Places, PoseEntry, Project, Rest, SOFT_RANGE, STIFFNESS_RANGE, Selector, SequenceEdit, Setup,
    StoredKept, VelocityEntry, digest, geometry_hash, refuse_keys,
};
pub use former::Former;
pub use ground_axis::GroundAxis;
pub use input::{Button, Key, Modifiers, Pointer};
pub use jobs::{
    Alternative, BothSides, Compared, Comparison, ControlPlaces, Descent, Executor, Figures, FlowRecording, Flowed,
    InlineExecutor, Inspectable, Inspected, IntersectionPlace, Intersections, Job, JobDone, JobKind, JobOutcome,
    JobQueue, JobResult, PresentBinding, Running, Skin, Skinned, SolveResult, Solved, Symmetry, Unfinished,
};
pub use key_space::KeySpace;
pub use lines::Lines;
pub use region::{Counts, FoundLimb, Region, Rim};
pub use revision::Revision;
pub use scene_view::{ControlPoints, SceneView};
pub use selection::Selection;
pub use snapshot::Snapshot;
pub use status::thousands;
pub use stitching::{MergeChange, MergeSettings, MeshChange, NewMesh, REACH_RANGE, StitchRequest};
pub use timeline::{
    BodyMotion, FollowedFrame, FollowedHandle, Following, Footprints, HandlePlace, SequenceTimeline, Timeline,
    middle_of,
};
pub use tool::{
    BrushMetric, Constraint, Correction, CorrectionBrush, Depth, FlowAction, FlowBrush, PointedRim, RimUse,
    StiffnessAction, StiffnessBrush, StrokeShape, ToolMode,
};
pub use view::{
    Before, Camera, Clay, ControlShape, Cursor, GizmoAxes, GizmoMode, GizmoOrientation, GizmoPart, GizmoShape, Look,
    NamedView, Orbit, Pick, Projection, Ray, Readout, Shading, Skins, UpAxis, hit_gizmo, up_axis_of,
};
pub use workspace::{RegionAction, SnapshotKey, StiffnessChange, stiffness_colour};
