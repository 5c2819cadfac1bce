//! The examples of a method in an edit: `[{"file": "pose.obj", "weight": 0.5}, {"morph_target": "Smile"}, ..]`.

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{ExampleShape, Examples, LARGEST_WEIGHT};
use pliant_mesh::Model;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::edit_error::EditError;
use super::field::lowest_file_vertices;
use super::reader::read;
use super::transform::Numbers;

/// An example in an edit.
#[derive(Clone, PartialEq, Debug)]
pub struct ExampleEntry {
    /// Its name, for a person.
    pub name: String,
    /// The source of its shape.
    pub source: ExampleSource,
    /// Its weight, from −[`LARGEST_WEIGHT`] to it; `None` if it is found.
    pub weight: Option<f64>,
    /// The displacement of each surface vertex from rest, once the file or the target was read.
    pub displacements: Option<Arc<Vec<DVec3>>>,
}

/// The source of its shape.
#[derive(Clone, PartialEq, Debug)]
pub enum ExampleSource {
    /// A mesh of the same vertices and triangles; the name is relative to the edit's folder.
    File(String),
    /// A morph target of the file itself.
    MorphTarget(String),
    /// The displacement of each of the file's vertices from rest. Welded twins move like the one with the lowest
    /// number.
    PerVertex(Vec<DVec3>),
}

/// The members in the file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredExample {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    name: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    morph_target: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    displacements: Option<Vec<Numbers<3>>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weight: Option<f64>,
}

/// Reads the list.
pub(super) fn read_examples(value: &Value) -> Result<Vec<ExampleEntry>, EditError> {
    let list: Vec<Value> = read(value)?;
    let entry = |(place, value): (usize, &Value)| {
        let own = read_example(place, value);
        own.map_err(|error| error.under(&format!("[{place}]")))
    };
    list.iter().enumerate().map(entry).collect()
}

fn read_example(place: usize, value: &Value) -> Result<ExampleEntry, EditError> {
    let stored: StoredExample = read(value)?;
    check_weight(stored.weight)?;
    let source = match (stored.file, stored.morph_target, stored.displacements) {
        (Some(file), None, None) => ExampleSource::File(file),
        (None, Some(target), None) => ExampleSource::MorphTarget(target),
        (None, None, Some(numbers)) => {
            let points = numbers.into_iter().map(|numbers| DVec3::from_array(numbers.0));
            ExampleSource::PerVertex(points.collect())
        }
        (None, None, None) => {
            let sentence = "has neither a `file` nor a `morph_target` nor `displacements`: give one of them";
            return Err(EditError::custom(sentence));
        }
        _ => {
            let sentence = "has more than one of `file`, `morph_target` and `displacements`: keep one of them";
            return Err(EditError::custom(sentence));
        }
    };
    let name = stored.name.unwrap_or_else(|| match &source {
        ExampleSource::File(file) => {
            let stem = std::path::Path::new(file).file_stem().unwrap_or_default();
            stem.to_string_lossy().into_owned()
        }
        ExampleSource::MorphTarget(target) => target.clone(),
        ExampleSource::PerVertex(_) => format!("example {}", place + 1),
    });
    Ok(ExampleEntry {
        name,
        source,
        weight: stored.weight,
        displacements: None,
    })
}

/// Refuses a weight out of range.
pub(super) fn check_weight(weight: Option<f64>) -> Result<(), EditError> {
    match weight.filter(|weight| !(-LARGEST_WEIGHT..=LARGEST_WEIGHT).contains(weight)) {
        Some(weight) => {
            let allowed = format!("a weight from {} to {LARGEST_WEIGHT}", -LARGEST_WEIGHT);
            Err(EditError::out_of_range(&json!(weight), &allowed).under("weight"))
        }
        None => Ok(()),
    }
}

/// The list in the edit format.
pub(super) fn examples_to_value(entries: &[ExampleEntry]) -> Value {
    let stored = entries.iter().map(|entry| {
        let mut stored = StoredExample {
            name: Some(entry.name.clone()),
            file: None,
            morph_target: None,
            displacements: None,
            weight: entry.weight,
        };
        match &entry.source {
            ExampleSource::File(file) => stored.file = Some(file.clone()),
            ExampleSource::MorphTarget(target) => stored.morph_target = Some(target.clone()),
            ExampleSource::PerVertex(points) => {
                stored.displacements = Some(points.iter().map(|point| Numbers(point.to_array())).collect());
            }
        }
        stored
    });
    json!(stored.collect::<Vec<_>>())
}

/// A document's examples in an edit.
pub(super) fn entries_of(examples: &Examples, model: &Model) -> Vec<ExampleEntry> {
    let entry = |(shape, weight): (&ExampleShape, &Option<f64>)| {
        let mut points = vec![DVec3::ZERO; model.drawn.file_vertex_count()];
        for (surface_vertex, file_vertex) in model.drawn.surface_vertices().zip(model.drawn.file_vertices()) {
            if let Some(vertex) = surface_vertex {
                points[file_vertex.index()] = shape.displacements[vertex.index()];
            }
        }
        ExampleEntry {
            name: shape.name.clone(),
            source: ExampleSource::PerVertex(points),
            weight: *weight,
            displacements: None,
        }
    };
    examples.shapes.iter().zip(&examples.weights).map(entry).collect()
}

/// The examples on a model, whose list is the method's member `name`.
///
/// # Errors
/// A file or a target that was not read, or a count of numbers that differs from that of the file's vertices.
pub(super) fn resolved(name: &str, entries: &[ExampleEntry], model: &Model) -> Result<Examples, EditError> {
    let mut shapes = Vec::new();
    for (place, entry) in entries.iter().enumerate() {
        let displacements = match (&entry.displacements, &entry.source) {
            (Some(displacements), _) => Arc::clone(displacements),
            (None, ExampleSource::PerVertex(points)) => {
                let count = model.drawn.file_vertex_count();
                if points.len() != count {
                    return Err(EditError::FieldLength {
                        place: format!("method.{name}[{place}].displacements"),
                        found: points.len(),
                        count,
                    });
                }
                let lowest = lowest_file_vertices(model).into_iter();
                Arc::new(lowest.map(|file_vertex| points[file_vertex as usize]).collect())
            }
            (None, ExampleSource::File(source) | ExampleSource::MorphTarget(source)) => {
                let unread = EditError::custom(format!("names {source:?}, which can't be read here: give its numbers"));
                return Err(unread.under(&format!("[{place}]")));
            }
        };
        shapes.push(ExampleShape {
            name: entry.name.clone(),
            displacements,
        });
    }
    Ok(Examples {
        shapes: Arc::new(shapes),
        weights: entries.iter().map(|entry| entry.weight).collect(),
    })
}
