//! A number painted on the surface, in an edit: selections with a value each, the later one having priority. A
//! stiffness may be "rigid" instead of a number, which is infinity here: JSON has none.

use std::ops::RangeInclusive;

use pliant_mesh::Model;
use serde::ser::SerializeSeq;
use serde::{Deserialize, Serialize, Serializer};

use super::edit_error::EditError;
use super::selector::Selector;

/// A part of a painted field.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(try_from = "StoredEntry", rename_all = "snake_case")]
pub enum FieldEntry {
    /// The whole field: one value for each of the file's vertices. Welded twins take the value of the one with the
    /// lowest number.
    PerVertex(#[serde(serialize_with = "write_all")] Vec<f64>),
    /// One value on a selection.
    #[serde(untagged)]
    Select {
        /// The selection.
        select: Selector,
        /// The value there; infinity is written "rigid".
        #[serde(serialize_with = "write")]
        value: f64,
    },
}

/// The members in the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredEntry {
    select: Option<Selector>,
    value: Option<Value>,
    per_vertex: Option<Vec<Value>>,
}

/// A number, or the word for infinity.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number or \"rigid\"")]
enum Value {
    Number(f64),
    Word(Word),
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Word {
    Rigid,
}

impl Value {
    fn of(number: f64) -> Self {
        if number == f64::INFINITY {
            Self::Word(Word::Rigid)
        } else {
            Self::Number(number)
        }
    }

    fn number(self) -> f64 {
        match self {
            Self::Number(number) => number,
            Self::Word(Word::Rigid) => f64::INFINITY,
        }
    }
}

fn write<S: Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    Value::of(*number).serialize(serializer)
}

fn write_all<S: Serializer>(numbers: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    let mut list = serializer.serialize_seq(Some(numbers.len()))?;
    for &number in numbers {
        list.serialize_element(&Value::of(number))?;
    }
    list.end()
}

impl TryFrom<StoredEntry> for FieldEntry {
    type Error = &'static str;

    fn try_from(stored: StoredEntry) -> Result<Self, &'static str> {
        match (stored.per_vertex, stored.select, stored.value) {
            (Some(values), None, None) => Ok(Self::PerVertex(values.into_iter().map(Value::number).collect())),
            (Some(_), Some(_), _) => Err("has both `per_vertex` and `select`: keep one of them"),
            (Some(_), None, Some(_)) => Err("has both `per_vertex` and `value`: keep one of them"),
            (None, Some(select), Some(value)) => Ok(Self::Select {
                select,
                value: value.number(),
            }),
            (None, Some(_), None) => Err("lacks its member `value`: add it"),
            (None, None, _) => Err("lacks its member `select`: add it, or give `per_vertex`"),
        }
    }
}

/// The quantity of a field, and the range of its values.
#[derive(Clone, Debug)]
pub(crate) struct FieldKind {
    /// With its article: "a stiffness".
    pub name: &'static str,
    pub range: RangeInclusive<f64>,
    /// True if it may also be "rigid".
    pub may_be_rigid: bool,
}

impl FieldKind {
    /// Refuses a value outside this kind.
    pub(crate) fn check(&self, value: f64) -> Result<(), EditError> {
        if self.range.contains(&value) || (self.may_be_rigid && value == f64::INFINITY) {
            return Ok(());
        }
        let (name, least, most) = (self.name, self.range.start(), self.range.end());
        Err(EditError::OutOfRange {
            place: String::new(),
            found: if value == f64::INFINITY {
                "rigid".to_owned()
            } else {
                value.to_string()
            },
            allowed: match self.may_be_rigid {
                true => format!("{name} from {least} to {most}, or \"rigid\""),
                false => format!("{name} from {least} to {most}"),
            },
        })
    }

    /// Refuses an entry with such a value, or with an invalid selector.
    pub(crate) fn check_all(&self, entries: &[FieldEntry]) -> Result<(), EditError> {
        for (index, entry) in entries.iter().enumerate() {
            let checked = match entry {
                FieldEntry::Select { select, value } => select
                    .check()
                    .map_err(|error| error.under("select"))
                    .and_then(|()| self.check(*value).map_err(|error| error.under("value"))),
                FieldEntry::PerVertex(values) => {
                    let refused = values.iter().enumerate().find_map(|(vertex, value)| {
                        let refused = self.check(*value).err()?;
                        Some(refused.under(&format!("per_vertex[{vertex}]")))
                    });
                    refused.map_or(Ok(()), Err)
                }
            };
            checked.map_err(|error| error.under(&format!("[{index}]")))?;
        }
        Ok(())
    }
}

impl FieldEntry {
    /// A document's entry: the surface vertices' values at the file's vertices, `default` for a file vertex that is not
    /// on the surface.
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
pub(super) fn lowest_file_vertices(model: &Model) -> Vec<u32> {
    let mut lowest = vec![u32::MAX; model.surface.positions.len()];
    for (surface_vertex, file_vertex) in model.drawn.surface_vertices().zip(model.drawn.file_vertices()) {
        if let Some(surface_vertex) = surface_vertex {
            let slot = &mut lowest[surface_vertex.index()];
            *slot = file_vertex.0.min(*slot);
        }
    }
    lowest
}
