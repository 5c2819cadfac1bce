//! Which vertices a part of an edit speaks of: the selectors of the edit format.

use glam::DVec3;
use serde_json::{Value, json};

use crate::edit_error::EditError;
use crate::edit_node::Node;

/// A set of a model's vertices, described so that it can be evaluated on any model ([`crate::Selection`]).
#[derive(Clone, PartialEq, Debug)]
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
        /// Along which axis.
        axis: Axis,
        /// A fraction of the bounding box, 0 at its lower end.
        from: f64,
        /// A fraction of the bounding box, not less than `from`.
        to: f64,
    },
    /// The vertices in a box in world units, its faces included.
    Box {
        /// The lower corner.
        min: DVec3,
        /// The upper corner, nowhere below `min`.
        max: DVec3,
    },
    /// The vertices in a ball in world units, its surface included.
    Sphere {
        /// Its centre in world space.
        center: DVec3,
        /// Its radius, not negative.
        radius: f64,
    },
    /// A connected component: 0 is the one with the most vertices, equal ones stand by their first file vertex.
    Component(u32),
    /// What any of them selects; of none of them, nothing.
    Union(Vec<Selector>),
    /// What all of them select; of none of them, everything.
    Intersection(Vec<Selector>),
    /// What it does not select.
    Not(Box<Selector>),
}

/// An axis of the world.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Axis {
    /// The world's x axis.
    X,
    /// The world's y axis.
    Y,
    /// The world's z axis.
    Z,
    /// The axis along which the bounding box is longest; x before y before z where they agree to 1e-6.
    Longest,
}

const AXES: [(&str, Axis); 4] = [
    ("x", Axis::X),
    ("y", Axis::Y),
    ("z", Axis::Z),
    ("longest", Axis::Longest),
];
const NAMES: [&str; 2] = ["all", "none"];
const KINDS: [&str; 9] = [
    "vertices",
    "ranges",
    "slab",
    "box",
    "sphere",
    "component",
    "union",
    "intersection",
    "not",
];

impl Selector {
    pub(crate) fn read(node: &Node<'_>) -> Result<Self, EditError> {
        if let Some(name) = node.value().as_str() {
            return match name {
                "all" => Ok(Self::All),
                "none" => Ok(Self::None),
                _ => Err(node.unknown_name(name, &[&NAMES[..], &KINDS[..]].concat())),
            };
        }
        let expected = "a selector: \"all\", \"none\" or an object such as {\"vertices\": [0, 1]}";
        let members = node.object(expected, &KINDS)?;
        let mut names = members.names();
        let (Some(kind), None) = (names.next(), names.next()) else {
            let found = format!("an object with {} members", members.names().count());
            let expected = "a selector with exactly one member".to_owned();
            return Err(EditError::WrongKind {
                place: node.place().to_owned(),
                expected,
                found,
            });
        };
        let Some(inner) = members.get(kind) else {
            return Err(node.wrong_kind(expected));
        };
        match kind {
            "vertices" => Ok(Self::Vertices(inner.list("a list of vertex numbers", vertex_number)?)),
            "ranges" => Ok(Self::Ranges(inner.list("a list of [first, last] pairs", vertex_range)?)),
            "slab" => read_slab(&inner),
            "box" => read_box(&inner),
            "sphere" => read_sphere(&inner),
            "component" => match u32::try_from(inner.whole()?) {
                Ok(component) => Ok(Self::Component(component)),
                Err(_) => Err(inner.out_of_range("a component's number")),
            },
            "union" => Ok(Self::Union(read_selectors(&inner)?)),
            "intersection" => Ok(Self::Intersection(read_selectors(&inner)?)),
            _ => Ok(Self::Not(Box::new(Self::read(&inner)?))),
        }
    }

    /// The selector as the edit format has it.
    pub(crate) fn to_value(&self) -> Value {
        let values = |selectors: &[Self]| Value::Array(selectors.iter().map(Self::to_value).collect());
        match self {
            Self::All => json!("all"),
            Self::None => json!("none"),
            Self::Vertices(vertices) => json!({ "vertices": vertices }),
            Self::Ranges(ranges) => json!({ "ranges": ranges }),
            Self::Slab { axis, from, to } => {
                let name = AXES
                    .iter()
                    .find(|(_, known)| known == axis)
                    .map_or("longest", |(name, _)| name);
                json!({ "slab": { "axis": name, "from": from, "to": to } })
            }
            Self::Box { min, max } => json!({ "box": { "min": min.to_array(), "max": max.to_array() } }),
            Self::Sphere { center, radius } => {
                json!({ "sphere": { "center": center.to_array(), "radius": radius } })
            }
            Self::Component(component) => json!({ "component": component }),
            Self::Union(selectors) => json!({ "union": values(selectors) }),
            Self::Intersection(selectors) => json!({ "intersection": values(selectors) }),
            Self::Not(selector) => json!({ "not": selector.to_value() }),
        }
    }
}

/// A vertex number; whether the file has it shows when the selector is evaluated.
fn vertex_number(node: &Node<'_>) -> Result<u32, EditError> {
    u32::try_from(node.whole()?).map_err(|_| node.out_of_range(format!("a vertex number up to {}", u32::MAX)))
}

fn vertex_range(node: &Node<'_>) -> Result<[u32; 2], EditError> {
    let pair = node.list("a pair [first, last]", vertex_number)?;
    match pair[..] {
        [first, last] if first <= last => Ok([first, last]),
        [_, _] => Err(node.out_of_range("a pair [first, last] whose first is not greater than its last")),
        _ => Err(node.wrong_kind("a pair [first, last]")),
    }
}

fn read_selectors(node: &Node<'_>) -> Result<Vec<Selector>, EditError> {
    node.elements("a list of selectors")?
        .map(|inner| Selector::read(&inner))
        .collect()
}

fn read_slab(node: &Node<'_>) -> Result<Selector, EditError> {
    let members = node.object("an object with `axis`, `from` and `to`", &["axis", "from", "to"])?;
    let axis = members.require("axis")?;
    let name = axis.string("the name of an axis")?;
    let Some(&(_, axis)) = AXES.iter().find(|(known, _)| *known == name) else {
        return Err(axis.unknown_name(name, &AXES.map(|(known, _)| known)));
    };
    let (from, to) = (members.require("from")?.number()?, members.require("to")?.number()?);
    if from > to {
        return Err(members
            .require("from")?
            .out_of_range(format!("a fraction that is not greater than `to` ({to})")));
    }
    Ok(Selector::Slab { axis, from, to })
}

fn read_box(node: &Node<'_>) -> Result<Selector, EditError> {
    let members = node.object("an object with `min` and `max`", &["min", "max"])?;
    let min = DVec3::from_array(members.require("min")?.numbers()?);
    let max = DVec3::from_array(members.require("max")?.numbers()?);
    if !min.cmple(max).all() {
        return Err(members
            .require("min")?
            .out_of_range("a corner that is nowhere above `max`"));
    }
    Ok(Selector::Box { min, max })
}

fn read_sphere(node: &Node<'_>) -> Result<Selector, EditError> {
    let members = node.object("an object with `center` and `radius`", &["center", "radius"])?;
    let center = DVec3::from_array(members.require("center")?.numbers()?);
    let radius = members.require("radius")?.number()?;
    if radius < 0.0 {
        return Err(members.require("radius")?.out_of_range("a radius of at least 0"));
    }
    Ok(Selector::Sphere { center, radius })
}
