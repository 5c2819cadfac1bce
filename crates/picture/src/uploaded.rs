//! A surface on the device, with the data that its look shows.

use pliant_editor::{Look, Shading};
use pliant_engine::EngineError;
use pliant_mesh::{Cancel, Model};
use pliant_render::{Renderer, Surface};

use crate::drawing::{self, Drawing, Pose, Scale};
use crate::shape::Shape;

/// The data on the device.
pub struct Uploaded {
    /// The surface.
    pub surface: Surface,
    /// The meaning of the surface's colours, if they show a field.
    pub scale: Option<Scale>,
    /// The parts of the file's materials that can't be shown, a sentence each.
    pub notes: Vec<String>,
}

/// Uploads the surface with the shape's lines, and with the data that `look` shows on it: regions, a field, or the
/// materials.
///
/// # Errors
/// Out of memory, or the device does not respond; [`EngineError::Interrupted`].
pub fn upload(
    renderer: &Renderer,
    drawing: &Drawing,
    pose: &Pose,
    model: &Model,
    shape: &Shape,
    look: &Look,
    cancel: &Cancel,
) -> Result<Uploaded, EngineError> {
    let mut surface = drawing.upload(renderer, pose).map_err(refuse)?;
    let field = drawing::field(look.shading);
    let scale = field.map(|field| Scale::of(field, model));
    let colours = match field.zip(scale.as_ref()) {
        Some((field, scale)) => drawing::colours(field, scale, model, &shape.displacements, shape.stiffness.as_deref()),
        None => shape.region_colours.clone(),
    };
    let colours = drawing::drawn_colours(model, &colours);
    surface.update_regions(renderer.gpu(), &colours).map_err(refuse)?;
    let wires = drawing::wires(model, &colours);
    surface.update_wires(renderer.gpu(), &wires).map_err(refuse)?;
    surface.update_lines(renderer.gpu(), &shape.outlines).map_err(refuse)?;
    let mut notes = Vec::new();
    if look.shading == Shading::Material {
        let decoded = drawing.materials.decode(cancel);
        let decoded = decoded.map_err(|_| EngineError::Interrupted)?;
        let materials = decoded.upload(renderer).map_err(refuse)?;
        surface.set_materials(materials).map_err(refuse)?;
        notes = decoded.notes;
    }
    Ok(Uploaded { surface, scale, notes })
}

/// The refusal of the device.
pub fn refuse(error: impl std::fmt::Display) -> EngineError {
    EngineError::System(error.to_string())
}
