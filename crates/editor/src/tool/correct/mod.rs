//! Corrections by hand of a method's shape, for example in armpits and creases: smooth, relax, grab.
//!
//! A stroke changes the visible shape, and the next drags keep the change (see `document/kept_shape`).

mod grab;
mod kelvinlet;
mod smooth;

use super::context::Context;
use super::correction_brush::Correction;
use super::gesture::Gesture;
use crate::input::Pointer;
use crate::view::Pick;

/// Begins a stroke at a point of the surface; Shift smooths with every brush.
pub(super) fn begin(context: &mut Context<'_>, pointer: Pointer, pick: &Pick) -> Box<dyn Gesture> {
    let mut brush = context.settings.correction_brush;
    if pointer.modifiers.shift {
        brush.correction = Correction::Smooth;
    }
    match brush.correction {
        Correction::Smooth | Correction::Relax => Box::new(smooth::SmoothShape::begin(context, pointer, brush)),
        Correction::Grab => Box::new(grab::GrabShape::begin(context, pointer, pick)),
    }
}
