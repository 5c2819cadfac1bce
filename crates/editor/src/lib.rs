//! The program without a window: document, history, selection, camera, brush, gizmo, tools, commands and jobs, and
//! the edit format that the command line reads.
//!
//! Everything happens through [`Editor::handle`]: the window, a test and a script send it [`Event`]s. What is to be
//! shown comes back as a [`SceneView`]; long work goes to the [`Executor`] that the app hands over.

mod beginning;
mod brush;
mod camera;
mod colours;
mod command;
mod consequences;
mod constraint;
mod document;
mod edit_error;
mod edit_file;
mod edit_node;
mod editor;
mod engine;
mod event;
mod exchange;
mod execute;
mod field_form;
mod gizmo;
mod handle_motion;
mod handle_transform;
mod history;
mod inline_executor;
mod job;
mod job_queue;
mod method_form;
mod number_entry;
mod overlay;
mod picking;
mod polar;
mod project;
mod project_field;
mod region;
mod scene_view;
mod selection;
mod selector;
mod setup;
mod snapshot;
mod status;
mod tool;
mod transaction;

pub use beginning::Beginning;
pub use brush::BRUSH_RADIUS_PX;
pub use camera::{Camera, NamedView, Ray, UpAxis};
pub use command::{Command, Listed, Reach, Shortcut};
pub use constraint::Constraint;
pub use document::{Document, Handle, HandleId, MirrorPlane, Paint, PivotPlace, Twin};
pub use edit_error::EditError;
pub use edit_file::{EDIT_VERSION, EditFile, HandleEntry, SOFT_RANGE, STIFFNESS_RANGE};
pub use editor::Editor;
pub use event::{Button, Event, Key, Modifiers, Pointer};
pub use exchange::ExportError;
pub use field_form::FieldEntry;
pub use gizmo::{GizmoMode, GizmoPart, GizmoShape, gizmo_shapes, hit_gizmo};
pub use handle_transform::HandleTransform;
pub use history::{HISTORY_BYTES, History};
pub use inline_executor::InlineExecutor;
pub use job::{Executor, Job, JobDone, JobKind, JobOutcome, Revision, Solved};
pub use job_queue::{JobQueue, Running};
pub use method_form::{MethodOption, OptionKind, method_options, method_title, option_value, when_to_use, with_option};
pub use picking::Pick;
pub use project::{MeshReference, Project, geometry_hash};
pub use region::Region;
pub use scene_view::{Counts, Cursor, SceneView, Shading};
pub use selection::Selection;
pub use selector::{Axis, Selector};
pub use setup::{HandleSetup, Rest, Setup};
pub use snapshot::{Snapshot, SnapshotKey};
pub use tool::ToolMode;
