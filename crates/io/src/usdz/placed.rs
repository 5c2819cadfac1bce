//! The visible meshes of a layer, at their places.

use std::collections::BTreeSet;

use glam::DAffine3;
use pliant_mesh::Cancel;

use super::drawing::Placed;
use super::fault::Fault;
use super::layer::Layer;
use super::looks::Looks;
use super::transform::local;
use super::values::word;

/// The prims that show a shape without a mesh.
const OTHER_SHAPES: [&str; 9] = [
    "Sphere",
    "Cube",
    "Cylinder",
    "Cone",
    "Capsule",
    "Plane",
    "BasisCurves",
    "Points",
    "PointInstancer",
];

/// The drawn set of a layer.
///
/// # Errors
/// A mesh that can't be read; soon after `cancel` is raised.
pub(super) fn placed<'a>(
    text: &'a [u8],
    layer: &'a Layer,
    looks: Looks<'a>,
    cancel: &Cancel,
) -> Result<Placed<'a>, Fault> {
    let mut placed = Placed::new(looks);
    let mut worlds = Vec::with_capacity(layer.prims.len());
    let mut shown = Vec::with_capacity(layer.prims.len());
    let mut others = BTreeSet::new();
    for (number, prim) in layer.prims.iter().enumerate() {
        cancel.check().map_err(|stopped| Fault::Stopped(stopped.into()))?;
        let is_hidden = word(text, prim, "visibility")?.as_deref() == Some("invisible")
            || matches!(word(text, prim, "purpose")?.as_deref(), Some("guide" | "proxy"));
        let is_shown = prim.is_defined && !is_hidden && prim.parent.is_none_or(|parent| shown[parent]);
        shown.push(is_shown);
        let above = prim.parent.map_or(DAffine3::IDENTITY, |parent| worlds[parent]);
        let world = match is_shown {
            true => {
                let local = local(text, prim)?;
                if local.resets {
                    local.transform
                } else {
                    above * local.transform
                }
            }
            false => above,
        };
        worlds.push(world);
        if is_shown && prim.kind == "Mesh" {
            placed.mesh(text, layer, number, world, cancel)?;
        } else if is_shown && OTHER_SHAPES.contains(&prim.kind.as_str()) {
            others.insert(prim.kind.as_str());
        }
    }
    if !others.is_empty() {
        let list = others.into_iter().collect::<Vec<_>>().join(", ");
        let note = format!("Its shapes that are no meshes ({list}) are kept but not shown.");
        placed.looks.notes.push(note);
    }
    Ok(placed.finished())
}
