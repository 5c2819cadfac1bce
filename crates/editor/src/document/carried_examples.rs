//! The methods' examples on the vertices of another mesh.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Attachment, BilaplacianOrder, BindError, Budget, fair};
use pliant_mesh::{Cancel, Cancelled, Model};

use super::matching::Matching;

/// Gives the examples displacements for the vertices of a new mesh. Vertices that match take their own along. Those that
/// are new in a former part continue them smoothly, and a part that is new rests.
///
/// Examples that can't be continued are removed; returns a sentence about them.
///
/// # Errors
/// [`Cancelled`].
pub(super) fn carry_examples(
    attachments: &mut BTreeMap<&'static str, Attachment>,
    matching: &Matching,
    model: &Model,
    budget: Budget,
    cancel: &Cancel,
) -> Result<Vec<String>, Cancelled> {
    let new = matching.new_in_former_parts(model);
    let mut refused = Vec::new();
    for (name, attachment) in attachments.iter_mut() {
        let Attachment::Shapes(examples) = attachment else {
            continue;
        };
        for shape in Arc::make_mut(&mut examples.shapes) {
            let known = matching.displacements(&shape.displacements);
            match continued(known, &new, model, budget, cancel) {
                Ok(displacements) => shape.displacements = Arc::new(displacements),
                Err(BindError::Cancelled(cancelled)) => return Err(cancelled),
                Err(error) => refused.push((*name, error)),
            }
        }
    }
    attachments.retain(|name, _| refused.iter().all(|(refused, _)| refused != name));
    let sentence = |(_, error): &(_, BindError)| {
        format!("The examples were removed, because they could not be continued into the new triangles ({error}).")
    };
    Ok(refused.first().map(sentence).into_iter().collect())
}

/// The displacements with those of the vertices `new` (ascending) continued from the others: with equal tangents, or
/// with a crease where the triangles are too slender for that.
fn continued(
    known: Vec<DVec3>,
    new: &[u32],
    model: &Model,
    budget: Budget,
    cancel: &Cancel,
) -> Result<Vec<DVec3>, BindError> {
    let mut values: Vec<[f64; 3]> = known.iter().map(DVec3::to_array).collect();
    let (surface, topology) = (&model.surface, &model.topology);
    let mut faired = |order| fair(surface, topology, new, order, &mut values, budget, cancel);
    match faired(BilaplacianOrder::ThinPlate) {
        Err(BindError::Cancelled(cancelled)) => return Err(BindError::Cancelled(cancelled)),
        Err(_) => faired(BilaplacianOrder::Membrane)?,
        Ok(()) => {}
    }
    Ok(values.into_iter().map(DVec3::from_array).collect())
}
