//! The pose brush: a limb under the pointer turns about its joint, in one gesture from an untouched scan.
//!
//! While the pointer rests over a limb a job searches for its joint ([`hover`]), which is shown with its falloff
//! ([`shapes`]). A drag makes the limb beyond the falloff a handle that reaches back across it, with its pivot in the
//! joint, and turns that. With *Whole limb*, each part between two joints becomes a handle, a child of the one before it,
//! and the limb bends at all its joints so that the grabbed point follows ([`reach`]). All of it is one step of the history, and a handle like any other afterwards.

mod drag;
mod motion;
mod reach;

pub(super) use self::drag::PoseDrag;
pub(super) use crate::tool::joint_shapes::joint_shapes;
pub(super) use crate::tool::limb::{Limb, limb_under};
pub(crate) use crate::tool::limb::{hover, tint};
