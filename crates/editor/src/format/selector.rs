//! The selectors of the edit format: sets of vertices.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::edit_error::EditError;
use super::json::parse;
use super::reader::read;
use super::transform::vector;

/// A set of a model's vertices, described so that it can be evaluated on any model ([`crate::Selection`]).
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(
    rename_all = "lowercase",
    deny_unknown_fields,
    expecting = "a selector: \"all\", \"none\" or an object with one member such as {\"vertices\": [0, 1]}"
)]
pub enum Selector {
    /// Every vertex.
    All,
    /// No vertex.
    None,
    /// Vertices by the file's numbers.
    Vertices(Vec<u32>),
    /// Vertices by ranges of the file's numbers, both ends included.
    Ranges(Vec<[u32; 2]>),
    /// The vertices between two planes across an axis, both included.
    Slab {
        /// The axis.
        axis: Axis,
        /// The start as a fraction of the bounding box, 0 at its lower end.
        from: f64,
        /// The end as a fraction of the bounding box, not less than `from`.
        to: f64,
    },
    /// The vertices in a box in world units, its faces included.
    Box {
        /// The lower corner.
        #[serde(with = "vector")]
        min: DVec3,
        /// The upper corner, not below `min` on any axis.
        #[serde(with = "vector")]
        max: DVec3,
    },
    /// The vertices in a ball in world units, its surface included.
    Sphere {
        /// Its centre in world space.
        #[serde(with = "vector")]
        center: DVec3,
        /// Its radius, not negative.
        radius: f64,
    },
    /// A connected component: 0 is the one with the most vertices, equal ones are in the order of their first file
    /// vertex.
    Component(u32),
    /// The union of these; nothing if there are none.
    Union(Vec<Selector>),
    /// The intersection of these; everything if there are none.
    Intersection(Vec<Selector>),
    /// The complement of this one.
    Not(Box<Selector>),
}

/// An axis of the world.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", expecting = "the name of an axis")]
pub enum Axis {
    /// The world's x axis.
    X,
    /// The world's y axis.
    Y,
    /// The world's z axis.
    Z,
    /// The axis along which the bounding box is longest; x before y before z if they agree to 1e-6.
    Longest,
}

impl Selector {
    /// Reads a selector's JSON text.
    ///
    /// # Errors
    /// Members that the format does not have, and values that exclude each other, by name and place.
    pub fn parse(text: &str) -> Result<Self, EditError> {
        let read = || {
            let selector: Self = read(&parse(text)?)?;
            selector.check()?;
            Ok(selector)
        };
        read().map_err(|error: EditError| error.at("the selector"))
    }

    /// Refuses values that exclude each other; the evaluation checks whether the model has the vertices.
    pub(crate) fn check(&self) -> Result<(), EditError> {
        match self {
            Self::Ranges(ranges) => match ranges.iter().position(|[first, last]| first > last) {
                None => Ok(()),
                Some(index) => {
                    let allowed = "a pair [first, last] whose first is not greater than its last";
                    Err(out_of_range(&ranges[index], allowed).under(&format!("ranges[{index}]")))
                }
            },
            Self::Slab { from, to, .. } if from > to => {
                let allowed = format!("a fraction of at most `to` ({to})");
                Err(out_of_range(from, &allowed).under("slab.from"))
            }
            Self::Box { min, max } if !min.cmple(*max).all() => {
                Err(out_of_range(&min.to_array(), "a corner with no coordinate above that of `max`").under("box.min"))
            }
            Self::Sphere { radius, .. } if *radius < 0.0 => {
                Err(out_of_range(radius, "a radius of at least 0").under("sphere.radius"))
            }
            Self::Union(selectors) => check_all(selectors).map_err(|error| error.under("union")),
            Self::Intersection(selectors) => check_all(selectors).map_err(|error| error.under("intersection")),
            Self::Not(selector) => selector.check().map_err(|error| error.under("not")),
            _ => Ok(()),
        }
    }
}

fn check_all(selectors: &[Selector]) -> Result<(), EditError> {
    for (index, selector) in selectors.iter().enumerate() {
        selector.check().map_err(|error| error.under(&format!("[{index}]")))?;
    }
    Ok(())
}

fn out_of_range(found: &impl Serialize, allowed: &str) -> EditError {
    EditError::OutOfRange {
        place: String::new(),
        found: json!(found).to_string(),
        allowed: allowed.to_owned(),
    }
}

/// The set flags as ranges with both ends.
pub(crate) fn ranges_of(selected: &[bool]) -> Vec<[u32; 2]> {
    let mut ranges: Vec<[u32; 2]> = Vec::new();
    for (vertex, _) in selected.iter().enumerate().filter(|(_, selected)| **selected) {
        let vertex = vertex as u32;
        match ranges.last_mut() {
            Some([_, last]) if *last + 1 == vertex => *last = vertex,
            _ => ranges.push([vertex, vertex]),
        }
    }
    ranges
}
