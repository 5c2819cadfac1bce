//! A number painted on the surface, in an edit: selections with a value each, or values of vertices by number, the later
//! one having priority. A stiffness may be "rigid" instead of a number, which is infinity here: JSON has none.

use std::ops::RangeInclusive;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use pliant_mesh::{Model, SurfaceVertex};
use serde::ser::SerializeSeq;
use serde::{Deserialize, Serialize, Serializer};

use super::edit_error::EditError;
use super::selector::{Selector, ranges_of};

/// A part of a painted field.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(try_from = "StoredEntry", rename_all = "snake_case")]
pub enum FieldEntry {
    /// The whole field: one value for each of the file's vertices. Welded twins take the value of the one with the
    /// lowest number.
    PerVertex(#[serde(serialize_with = "write_all")] Vec<f64>),
    /// Values of some of the file's vertices; welded twins take the value of the one with the lowest number.
    #[serde(untagged)]
    Some {
        /// First and last of runs of vertices, ascending.
        ranges: Vec<[u32; 2]>,
        /// Their values.
        #[serde(rename = "f64_base64", serialize_with = "write_base64")]
        values: Vec<f64>,
    },
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
    ranges: Option<Vec<[u32; 2]>>,
    f64_base64: Option<String>,
}

/// A number, or the word for infinity.
#[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number or \"rigid\"")]
enum Value {
    Number(f64),
    Word(Word),
}

#[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
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

fn write_base64<S: Serializer>(numbers: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    STANDARD.encode(bytes).serialize(serializer)
}

/// The entry with these runs of vertices and the numbers of their values.
fn some(ranges: Vec<[u32; 2]>, text: &str) -> Result<FieldEntry, &'static str> {
    let bytes = STANDARD
        .decode(text)
        .map_err(|_| "has `f64_base64` that is not base64: export the edit again")?;
    let number = |bytes: &[u8]| bytes.try_into().map_or(f64::NAN, f64::from_le_bytes);
    let values: Vec<f64> = bytes.chunks_exact(8).map(number).collect();
    let are_runs = ranges.iter().all(|[first, last]| first <= last) && ranges.is_sorted_by(|a, b| a[1] < b[0]);
    let count: u64 = ranges
        .iter()
        .map(|[first, last]| u64::from(last.saturating_sub(*first)) + 1)
        .sum();
    match are_runs && bytes.len() as u64 == 8 * count {
        true => Ok(FieldEntry::Some { ranges, values }),
        false => {
            Err("has `ranges` that do not ascend or do not fit the numbers in `f64_base64`: export the edit again")
        }
    }
}

impl TryFrom<StoredEntry> for FieldEntry {
    type Error = &'static str;

    fn try_from(stored: StoredEntry) -> Result<Self, &'static str> {
        match (stored.ranges, stored.f64_base64) {
            (None, None) => {}
            (Some(ranges), Some(text))
                if (&stored.per_vertex, &stored.select, &stored.value) == (&None, &None, &None) =>
            {
                return some(ranges, &text);
            }
            (Some(_), Some(_)) => return Err("has `ranges` beside another member than `f64_base64`: keep one of them"),
            (Some(_), None) => return Err("lacks its member `f64_base64`: add it"),
            (None, Some(_)) => return Err("lacks its member `ranges`: add it"),
        }
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
                FieldEntry::PerVertex(values) | FieldEntry::Some { values, .. } => {
                    let member = if matches!(entry, FieldEntry::Some { .. }) {
                        "f64_base64"
                    } else {
                        "per_vertex"
                    };
                    let refused = values.iter().enumerate().find_map(|(vertex, value)| {
                        let refused = self.check(*value).err()?;
                        Some(refused.under(&format!("{member}[{vertex}]")))
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

    /// The values at surface vertices, for all of the file's vertices behind them.
    pub(crate) fn of_vertices(model: &Model, value: impl Fn(SurfaceVertex) -> Option<f64>) -> Self {
        let mut values = vec![None; model.drawn.file_vertex_count()];
        for (surface_vertex, file_vertex) in model.drawn.surface_vertices().zip(model.drawn.file_vertices()) {
            if let Some(vertex) = surface_vertex {
                values[file_vertex.index()] = value(vertex);
            }
        }
        let has_value: Vec<bool> = values.iter().map(Option::is_some).collect();
        Self::Some {
            ranges: ranges_of(&has_value),
            values: values.into_iter().flatten().collect(),
        }
    }

    /// The same entry without the vertices that have the value `default` in any case, in fewer bytes.
    pub(crate) fn compact(&self, default: f64) -> Self {
        let Self::PerVertex(values) = self else {
            return self.clone();
        };
        let is_painted: Vec<bool> = values.iter().map(|value| *value != default).collect();
        Self::Some {
            ranges: ranges_of(&is_painted),
            values: values.iter().copied().filter(|value| *value != default).collect(),
        }
    }

    /// The value of each of the file's `count` vertices that has one here; a selection gives none.
    ///
    /// # Errors
    /// Other numbers of vertices; `place` is the entry's.
    pub(crate) fn numbered(&self, count: usize, place: &str) -> Result<Vec<Option<f64>>, EditError> {
        match self {
            Self::PerVertex(values) if values.len() == count => Ok(values.iter().copied().map(Some).collect()),
            Self::PerVertex(values) => Err(EditError::FieldLength {
                place: format!("{place}.per_vertex"),
                found: values.len(),
                count,
            }),
            Self::Some { ranges, values } => {
                let mut numbered = vec![None; count];
                let vertices = ranges.iter().flat_map(|[first, last]| *first..=*last);
                for (vertex, value) in vertices.zip(values) {
                    let slot = numbered.get_mut(vertex as usize);
                    *slot.ok_or_else(|| EditError::NoSuchVertex {
                        place: format!("{place}.ranges"),
                        vertex: vertex.into(),
                        count,
                    })? = Some(*value);
                }
                Ok(numbered)
            }
            Self::Select { .. } => Ok(vec![None; count]),
        }
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
            Self::PerVertex(_) | Self::Some { .. } => {
                let numbered = self.numbered(model.drawn.file_vertex_count(), &format!("{member}[{index}]"))?;
                for (own, file_vertex) in field.iter_mut().zip(lowest_file_vertices(model)) {
                    *own = numbered[file_vertex as usize].unwrap_or(*own);
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
