//! A number painted on the surface, as it stands in an edit: selections with a value each, the later one winning.

use std::ops::RangeInclusive;

use pliant_mesh::Model;
use serde_json::{Value, json};

use crate::edit_error::EditError;
use crate::edit_node::Node;
use crate::selector::Selector;

/// A part of a painted field.
#[derive(Clone, PartialEq, Debug)]
pub enum FieldEntry {
    /// One value on a selection.
    Select {
        /// Where.
        select: Selector,
        /// The value there.
        value: f64,
    },
    /// The whole field: one value for each of the file's vertices. Twins that were welded take the value of the one
    /// with the lowest number.
    PerVertex(Vec<f64>),
}

/// What a field is of, and what its values may be.
#[derive(Clone, Debug)]
pub(crate) struct FieldKind {
    /// With its article: "a stiffness".
    pub name: &'static str,
    pub range: RangeInclusive<f64>,
}

impl FieldKind {
    /// A value of this kind.
    pub(crate) fn value(&self, node: &Node<'_>) -> Result<f64, EditError> {
        let value = node.number()?;
        if self.range.contains(&value) {
            return Ok(value);
        }
        let (name, least, most) = (self.name, self.range.start(), self.range.end());
        Err(node.out_of_range(format!("{name} from {least} to {most}")))
    }

    /// Reads `{"select": .., "value": ..}` or `{"per_vertex": [..]}`.
    pub(crate) fn read(&self, node: &Node<'_>) -> Result<FieldEntry, EditError> {
        let expected = format!(
            "{} on a selection: an object with `select` and `value`, or with `per_vertex`",
            self.name
        );
        let members = node.object(&expected, &["select", "value", "per_vertex"])?;
        if let Some(values) = members.get("per_vertex") {
            if let Some(second) = members.names().find(|&name| name != "per_vertex") {
                let place = node.place().to_owned();
                return Err(EditError::Both {
                    place,
                    first: "per_vertex",
                    second: second.to_owned(),
                });
            }
            return Ok(FieldEntry::PerVertex(
                values.list("a list of numbers", |node| self.value(node))?,
            ));
        }
        Ok(FieldEntry::Select {
            select: Selector::read(&members.require("select")?)?,
            value: self.value(&members.require("value")?)?,
        })
    }
}

impl FieldEntry {
    pub(crate) fn to_value(&self) -> Value {
        match self {
            Self::Select { select, value } => json!({ "select": select.to_value(), "value": value }),
            Self::PerVertex(values) => json!({ "per_vertex": values }),
        }
    }

    /// The entry as it comes from a document: the values of the surface's vertices at the file's, `default` where a
    /// vertex of the file is no vertex of the surface.
    pub(crate) fn of_surface(field: &[f64], default: f64, model: &Model) -> Self {
        let mut values = vec![default; model.drawn.file_vertex_count()];
        for (surface_vertex, file_vertex) in model.drawn.surface_vertices().zip(model.drawn.file_vertices()) {
            if let Some(vertex) = surface_vertex {
                values[file_vertex.index()] = field[vertex.index()];
            }
        }
        Self::PerVertex(values)
    }

    /// Paints the entry, which is number `index` of the edit's member `member`, on a field over the surface's vertices.
    pub(crate) fn paint(&self, field: &mut [f64], model: &Model, member: &str, index: usize) -> Result<(), EditError> {
        match self {
            Self::Select { select, value } => {
                let place = format!("{member}[{index}].select");
                for vertex in select.evaluate_at(model, &place)?.iter() {
                    field[vertex.index()] = *value;
                }
            }
            Self::PerVertex(values) => {
                let (found, count) = (values.len(), model.drawn.file_vertex_count());
                if found != count {
                    let place = format!("{member}[{index}].per_vertex");
                    return Err(EditError::FieldLength { place, found, count });
                }
                for (vertex, file_vertex) in lowest_file_vertices(model).into_iter().enumerate() {
                    field[vertex] = values[file_vertex as usize];
                }
            }
        }
        Ok(())
    }
}

/// The lowest file vertex behind each surface vertex.
fn lowest_file_vertices(model: &Model) -> Vec<u32> {
    let mut lowest = vec![u32::MAX; model.surface.positions.len()];
    for (surface_vertex, file_vertex) in model.drawn.surface_vertices().zip(model.drawn.file_vertices()) {
        if let Some(surface_vertex) = surface_vertex {
            let slot = &mut lowest[surface_vertex.index()];
            *slot = file_vertex.0.min(*slot);
        }
    }
    lowest
}
