//! The left button: tools, their gestures, brushes, and the overlay on the surface.
//!
//! A tool is a person's choice ([`ToolMode`], [`ToolSettings`]); a gesture is active while a button is held or after a
//! key has begun it ([`Gesture`]). A new gesture needs its own file and a line in `begin.rs` or in the command that
//! begins it.

mod adjust;
mod begin;
mod brush;
mod constraint;
mod context;
mod control_box;
mod correct;
mod correction_brush;
mod crease_stroke;
mod curve_stroke;
mod cut_curve;
mod cut_line;
mod cut_side;
mod drawn_path;
mod enclosed;
mod firmness;
mod flow_brush;
mod flow_stroke;
mod gesture;
mod hidden_points;
mod intersections;
mod joint_shapes;
mod limb;
mod mode;
mod moved_controls;
mod navigate;
mod number_entry;
mod other_side;
mod outline;
mod overlay;
mod paint;
mod path_drag;
mod path_places;
mod picked_pairs;
mod polyline;
mod pose;
mod rim;
mod settings;
mod size;
mod sketch_stroke;
mod smooth;
mod spine;
mod stiffness;
mod stiffness_brush;
mod stroke;
mod surface_snap;
mod symmetry;
mod taken_handle;
mod transform;
mod transform_measure;
mod uncut_reach;
mod widen;

pub(crate) use adjust::Adjust;
pub(crate) use begin::begin;
pub(crate) use brush::Brush;
pub use brush::BrushMetric;
pub use constraint::Constraint;
pub(crate) use context::Context;
pub use correction_brush::{Correction, CorrectionBrush};
pub(crate) use cut_side::hint as cut_hint;
pub use flow_brush::{FlowAction, FlowBrush};
pub(crate) use gesture::{Gesture, Next};
pub use mode::{Depth, StrokeShape, ToolMode};
pub(crate) use overlay::{Lit, Overlay};
pub(crate) use pose::{hover, tint};
pub use rim::{PointedRim, RimUse};
pub(crate) use settings::ToolSettings;
pub(crate) use size::SizeBrush;
pub use stiffness_brush::{StiffnessAction, StiffnessBrush};
pub(crate) use transform::TransformDrag;
pub(crate) use transform_measure::TransformKind;
pub(crate) use widen::Widen;
