//! A flow file's selections on a model.

use glam::DVec3;
use pliant_mesh::Model;

use crate::{EditError, FlowFile, FlowMotion, Selection, Selector};

/// The vertices that a flow file names on a model.
#[derive(Clone, Debug)]
pub struct FlowStart {
    /// The vertices and the colour of each dye.
    pub dye: Vec<(Selection, DVec3)>,
    /// The vertices and the motion of each velocity; each spin has its centre.
    pub velocity: Vec<(Selection, FlowMotion)>,
}

impl FlowFile {
    /// Selects the vertices on a model.
    ///
    /// # Errors
    /// A selector that names vertices or a component that the model does not have, or that selects nothing.
    pub fn resolve(&self, model: &Model) -> Result<FlowStart, EditError> {
        let select = |selector: &Selector, place: String| {
            let selection = selector.evaluate_at(model, &format!("{place}.select"))?;
            match selection.is_empty() {
                false => Ok(selection),
                true => {
                    let nothing =
                        EditError::custom("selects no vertex: leave the entry out, or select some".to_owned());
                    Err(nothing.under("select").under(&place))
                }
            }
        };
        let dye = self.dye.iter().enumerate().map(|(number, entry)| {
            let selection = select(&entry.select, format!("dye[{number}]"))?;
            Ok((selection, entry.color))
        });
        let velocity = self.velocity.iter().enumerate().map(|(number, entry)| {
            let selection = select(&entry.select, format!("velocity[{number}]"))?;
            let motion = entry.motion.with_centre(|| mean(&selection, model));
            Ok((selection, motion))
        });
        Ok(FlowStart {
            dye: dye.collect::<Result<_, EditError>>()?,
            velocity: velocity.collect::<Result<_, EditError>>()?,
        })
    }
}

/// The mean of the selected vertices, of which there is at least one.
fn mean(selection: &Selection, model: &Model) -> DVec3 {
    let positions = || selection.iter().map(|vertex| model.surface.positions[vertex.index()]);
    let origin = positions().next().unwrap_or_default();
    // Relative to one of them, so that no digits are lost far from the origin.
    origin + positions().map(|position| position - origin).sum::<DVec3>() / selection.len().max(1) as f64
}
