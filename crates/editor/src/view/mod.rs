//! The view: its camera, its picking and its look.

mod arc;
mod camera;
mod camera_history;
mod camera_motion;
mod control_shapes;
mod gizmo;
mod look;
mod net_sides;
mod picking;
mod pointer;
mod sight;
mod skins;
mod state;
mod upright;

pub(crate) use arc::arc_shapes;
pub use camera::{Camera, NamedView, Orbit, Projection, Ray, UpAxis};
pub(crate) use camera_history::CameraStep;
pub use control_shapes::ControlShape;
pub(crate) use control_shapes::{ControlLines, GRAB_PX, ShownPoint, control_at, control_shapes};
pub(crate) use gizmo::axis_vector;
pub(crate) use gizmo::distance_to_segment;
pub use gizmo::{GizmoAxes, GizmoMode, GizmoOrientation, GizmoPart, GizmoShape, gizmo_shapes, hit_gizmo};
pub use look::{Before, Clay, Look, Shading};
pub(crate) use net_sides::NetSides;
pub use picking::Pick;
pub(crate) use picking::Picking;
pub use pointer::{Cursor, Readout};
pub use skins::Skins;
pub(crate) use state::View;
pub use upright::up_axis_of;
