//! The program without a window: document, history, selection, camera, brush, gizmo, tools, commands and jobs, and
//! the edit format that the command line reads.
//!
//! Everything happens through [`Editor::handle`]: the window, a test and a script send it [`Event`]s. What is to be
//! shown comes back as a [`SceneView`]; long work goes to the [`Executor`] that the app hands over.

mod access;
mod brush;
mod camera;
mod camera_history;
mod colours;
mod command;
mod command_table;
mod consequences;
mod constraint;
mod dispatch;
mod document;
mod editor;
mod engine;
mod event;
mod execute;
mod following;
mod format;
mod framing;
mod gizmo;
mod handle_actions;
mod handle_colour;
mod handle_motion;
mod handle_transform;
mod handle_values;
mod history;
mod inline_executor;
mod job;
mod job_queue;
mod key_map;
mod look;
mod mirror;
mod number_entry;
mod object_actions;
mod obstacle;
mod overlay;
mod picking;
mod polar;
mod recolouring;
mod region;
mod region_action;
mod rim;
mod scene_view;
mod selection;
mod shortcut;
mod sight;
mod snapshot;
mod status;
mod tool;
mod transaction;
mod turn;

pub use access::{Access, ObjectAction, object_name};
pub use brush::{BRUSH_RADIUS_PX, BrushMetric};
pub use camera::{Camera, NamedView, Orbit, Projection, Ray, UpAxis};
pub use colours::stiffness_colour;
pub use command::{Command, Reach};
pub use command_table::{CommandGroup, Listed};
pub use constraint::Constraint;
pub use document::{Document, Handle, HandleId, MirrorPlane, Paint, PivotPlace, Twin};
pub use editor::Editor;
pub use event::{Button, Event, Key, Modifiers, Pointer};
pub use format::{
    Axis, Beginning, EDIT_VERSION, EditError, EditFile, ExportError, FieldEntry, HandleEntry, HandleSetup,
    MeshReference, Project, Rest, SOFT_RANGE, STIFFNESS_RANGE, Selector, Setup, geometry_hash,
};
pub use gizmo::{GizmoAxes, GizmoMode, GizmoOrientation, GizmoPart, GizmoShape, gizmo_shapes, hit_gizmo};
pub use handle_colour::HANDLE_COLOURS;
pub use handle_transform::HandleTransform;
pub use history::{HISTORY_BYTES, History};
pub use inline_executor::InlineExecutor;
pub use job::{Descent, Executor, Job, JobDone, JobKind, JobOutcome, Revision, Solved};
pub use job_queue::{JobQueue, Running};
pub use key_map::KeyMap;
pub use look::{Clay, Look, Shading};
pub use picking::Pick;
pub use region::Region;
pub use region_action::RegionAction;
pub use rim::Rim;
pub use scene_view::{Counts, Cursor, Readout, SceneView};
pub use selection::Selection;
pub use shortcut::Shortcut;
pub use snapshot::{Snapshot, SnapshotKey};
pub use status::thousands;
pub use tool::{Depth, StiffnessAction, StiffnessBrush, StrokeShape, ToolMode};
