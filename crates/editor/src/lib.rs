//! The program without a window: document, history, selection, camera, brush, gizmo, tools, commands and jobs, and
//! the edit format that the command line reads.
//!
//! Everything happens through [`Editor::handle`]: the window, a test and a script send it [`Event`]s. What is to be
//! shown comes back as a [`SceneView`]; long work goes to the [`Executor`] that the app hands over.

mod beginning;
mod command;
mod document;
mod edit_error;
mod edit_file;
mod edit_node;
mod editor;
mod event;
mod exchange;
mod field_form;
mod input;
mod jobs;
mod method_form;
mod project;
mod project_field;
mod scene_view;
mod selection;
mod selector;
mod setup;
mod snapshot;
mod status;
mod tool;
mod view;
mod workspace;

pub use beginning::Beginning;
pub use command::{Command, KeyMap, Listed, Shortcut};
pub use document::{
    Access, Content, Document, HANDLE_COLOURS, HISTORY_BYTES, Handle, HandleId, HandleTransform, History, MirrorPlane,
    ObjectAction, Paint, PivotPlace, Reach, Twin, object_name,
};
pub use edit_error::EditError;
pub use edit_file::{EDIT_VERSION, EditFile, HandleEntry, SOFT_RANGE, STIFFNESS_RANGE};
pub use editor::Editor;
pub use event::Event;
pub use exchange::ExportError;
pub use field_form::FieldEntry;
pub use input::{Button, Key, Modifiers, Pointer};
pub use jobs::{
    Counts, Descent, Executor, InlineExecutor, Job, JobDone, JobKind, JobOutcome, JobQueue, Region, Revision, Rim,
    Running, Solved,
};
pub use method_form::{
    MethodOption, OptionKind, method_keywords, method_options, method_title, option_value, when_to_use, with_option,
};
pub use project::{MeshReference, Project, geometry_hash};
pub use scene_view::{Cursor, Readout, SceneView};
pub use selection::Selection;
pub use selector::{Axis, Selector};
pub use setup::{HandleSetup, Rest, Setup};
pub use snapshot::Snapshot;
pub use status::thousands;
pub use tool::{
    BRUSH_RADIUS_PX, BrushMetric, Constraint, Depth, StiffnessAction, StiffnessBrush, StrokeShape, ToolMode,
};
pub use view::{
    Camera, Clay, GizmoAxes, GizmoMode, GizmoOrientation, GizmoPart, GizmoShape, Look, NamedView, Orbit, Pick,
    Projection, Ray, Shading, UpAxis, gizmo_shapes, hit_gizmo,
};
pub use workspace::{RegionAction, SnapshotKey, stiffness_colour};
