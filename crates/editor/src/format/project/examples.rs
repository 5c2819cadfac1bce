//! A document's examples in a project.

use std::sync::Arc;

use pliant_deform::{Attachment, ExampleShape, Examples};
use pliant_mesh::Model;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::EditError;
use crate::document::bits_equal;
use crate::format::examples::check_weight;
use crate::format::reader::read;
use crate::format::stored_field::Field;

/// An example.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredExample {
    name: String,
    /// Without a weight, the solver finds it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weight: Option<f64>,
    /// The displacements from the rest shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    displacements: Option<Field>,
}

/// The examples as a list.
pub(super) fn stored_examples(examples: &Examples, model: &Model) -> Value {
    let stored = examples
        .shapes
        .iter()
        .zip(&examples.weights)
        .map(|(shape, weight)| StoredExample {
            name: shape.name.clone(),
            weight: *weight,
            displacements: Field::of(model, |vertex| {
                let value = shape.displacements[vertex.index()];
                (!bits_equal(value, glam::DVec3::ZERO)).then_some(value.to_array())
            }),
        });
    json!(stored.collect::<Vec<_>>())
}

/// Reads the value of [`stored_examples`].
pub(super) fn read_examples(value: &Value, model: &Model) -> Result<Attachment, EditError> {
    let stored: Vec<StoredExample> = read(value)?;
    let mut examples = Examples::default();
    let mut shapes = Vec::new();
    for (place, own) in stored.into_iter().enumerate() {
        check_weight(own.weight).map_err(|error| error.under(&format!("[{place}]")))?;
        let displacements = match own.displacements {
            Some(field) => field.displacements("attachments: examples", model)?,
            None => Arc::new(vec![glam::DVec3::ZERO; model.surface.positions.len()]),
        };
        shapes.push(ExampleShape {
            name: own.name,
            displacements,
        });
        examples.weights.push(own.weight);
    }
    examples.shapes = Arc::new(shapes);
    Ok(Attachment::Shapes(examples))
}

/// Returns true if an example of the list has a set weight.
pub(super) fn are_weighed(value: &Value) -> bool {
    let weight = |example: &Value| example.get("weight").and_then(Value::as_f64);
    let list = value.as_array();
    list.is_some_and(|list| list.iter().filter_map(weight).any(|weight| weight != 0.0))
}
