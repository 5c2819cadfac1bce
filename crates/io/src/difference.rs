//! Differences between two files, as data and in words.

use std::fmt;

use pliant_mesh::Drawn;

use crate::{Appearance, Material, quoted};

/// One thing that differs between two files.
#[derive(Clone, PartialEq, Debug)]
pub struct Difference {
    /// The place: "mesh 0, primitive 1, POSITION".
    pub place: String,
    /// The difference.
    pub what: What,
}

/// The kind of a difference.
#[derive(Clone, PartialEq, Debug)]
pub enum What {
    /// Numbers of a list of elements, such as an attribute.
    Elements {
        /// The elements that differ, in ascending order.
        elements: Vec<u32>,
        /// The number of elements in all.
        of: usize,
        /// The largest difference between two numbers; infinite if one of them is not finite.
        largest: f64,
    },
    /// An accessor's min or max.
    Bounds,
    /// The storage of numbers, in words.
    Stored {
        /// In the first file.
        first: String,
        /// In the second.
        second: String,
    },
    /// A count.
    Count {
        /// In the first file.
        first: usize,
        /// In the second.
        second: usize,
    },
    /// A value, as text.
    Value {
        /// In the first file.
        first: String,
        /// In the second.
        second: String,
    },
    /// The second file lacks it.
    OnlyInFirst,
    /// The first file lacks it.
    OnlyInSecond,
    /// Bytes that are not interpreted, such as an image's.
    Bytes {
        /// The first byte that differs.
        at: usize,
    },
}

/// Longer texts of values are shortened to this many characters.
const LONGEST_VALUE: usize = 60;

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { place, what } = self;
        let place = quoted(place);
        let short = |text: &str| -> String {
            let text = quoted(text);
            if text.chars().count() > LONGEST_VALUE {
                text.chars().take(LONGEST_VALUE).chain("...".chars()).collect()
            } else {
                text
            }
        };
        match what {
            What::Elements { elements, of, largest } => {
                let firsts: Vec<String> = elements.iter().take(3).map(u32::to_string).collect();
                let more = if elements.len() > 3 { ", ..." } else { "" };
                let verb = if elements.len() == 1 { "differs" } else { "differ" };
                write!(
                    f,
                    "{place}: {} of {of} {verb} ({}{more}), by at most {largest:.6e}",
                    elements.len(),
                    firsts.join(", ")
                )
            }
            What::Bounds => write!(f, "{place}: min and max differ"),
            What::Stored { first, second } => {
                write!(f, "{place}: stored as {first} in the first, as {second} in the second")
            }
            What::Count { first, second } => write!(f, "{place}: {first} in the first, {second} in the second"),
            What::Value { first, second } => {
                write!(
                    f,
                    "{place}: {} in the first, {} in the second",
                    short(first),
                    short(second)
                )
            }
            What::OnlyInFirst => write!(f, "{place}: only in the first"),
            What::OnlyInSecond => write!(f, "{place}: only in the second"),
            What::Bytes { at } => write!(f, "{place}: the bytes differ, first at byte {at}"),
        }
    }
}

/// Elements of two lists of equal length that differ in their bits; `None` if there are none.
pub(crate) fn of_elements<const N: usize>(
    a: impl ExactSizeIterator<Item = [f64; N]>,
    b: impl Iterator<Item = [f64; N]>,
) -> Option<What> {
    let of = a.len();
    let (mut elements, mut largest) = (Vec::new(), 0.0_f64);
    for (element, (a, b)) in a.zip(b).enumerate() {
        if a.map(f64::to_bits) != b.map(f64::to_bits) {
            elements.push(element as u32);
            let apart = farthest(&a, &b);
            if apart > largest {
                largest = apart;
            }
        }
    }
    (!elements.is_empty()).then_some(What::Elements { elements, of, largest })
}

/// The largest difference between two numbers at the same place; infinite if it is NaN.
fn farthest<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    let apart = |lane: usize| {
        let apart = (a[lane] - b[lane]).abs();
        match (a[lane].to_bits() == b[lane].to_bits(), apart.is_nan()) {
            (true, _) => 0.0,
            (false, true) => f64::INFINITY,
            (false, false) => apart,
        }
    };
    (0..N).map(apart).max_by(f64::total_cmp).unwrap_or(0.0)
}

/// The difference between two byte strings.
pub(crate) fn of_bytes(a: &[u8], b: &[u8]) -> Option<Difference> {
    let at = a.iter().zip(b).position(|(a, b)| a != b);
    let at = at.or((a.len() != b.len()).then_some(a.len().min(b.len())))?;
    Some(Difference {
        place: "data beside the shape".to_owned(),
        what: What::Bytes { at },
    })
}

/// The differences between the shapes that two files show. If their faces are alike, triangles follow from positions
/// alone.
pub(crate) fn of_shapes(
    (a, a_looks): (&Drawn, &Appearance),
    (b, b_looks): (&Drawn, &Appearance),
    are_faces_alike: bool,
) -> Vec<Difference> {
    let mut out = Vec::new();
    let mut say = |place: &str, what: Option<What>| {
        out.extend(what.map(|what| Difference {
            place: place.to_owned(),
            what,
        }));
    };
    let count = |first: usize, second: usize| (first != second).then_some(What::Count { first, second });
    say("vertices of the file", count(a.file_vertex_count, b.file_vertex_count));
    say("drawn vertices", count(a.positions.len(), b.positions.len()));
    say("drawn triangles", count(a.triangles.len(), b.triangles.len()));
    if a.positions.len() == b.positions.len() {
        let of_drawn = |drawn: &Drawn| drawn.positions.iter().map(|p| p.to_array()).collect::<Vec<_>>();
        say(
            "positions",
            of_elements(of_drawn(a).into_iter(), of_drawn(b).into_iter()),
        );
    }
    if a.triangles.len() == b.triangles.len() && !are_faces_alike {
        let corners = |drawn: &Drawn| {
            let corners = drawn.triangles.iter().map(|t| t.map(|corner| f64::from(corner.0)));
            corners.collect::<Vec<_>>()
        };
        say(
            "triangles' corners",
            of_elements(corners(a).into_iter(), corners(b).into_iter()),
        );
    }
    say(
        "normals",
        of_attribute(&a_looks.normals, &b_looks.normals, |n| n.map(f64::from)),
    );
    say(
        "texture coordinates",
        of_attribute(&a_looks.uvs, &b_looks.uvs, |uv| uv.map(f64::from)),
    );
    say(
        "colours",
        of_attribute(&a_looks.colours, &b_looks.colours, |c| c.map(f64::from)),
    );
    say("groups", count(a_looks.groups.len(), b_looks.groups.len()));
    for (group, (first, second)) in a_looks.groups.iter().zip(&b_looks.groups).enumerate() {
        let told = |group: &crate::Group| format!("{:?} over triangles {:?}", group.node_name, group.triangles);
        say(&format!("group {group}"), of_values(told(first), told(second)));
    }
    say("materials", count(a_looks.materials.len(), b_looks.materials.len()));
    for (number, (first, second)) in a_looks.materials.iter().zip(&b_looks.materials).enumerate() {
        let told = |material: &Material| format!("{material:?}");
        say(&format!("material {number}"), of_values(told(first), told(second)));
    }
    say("images", count(a_looks.images.len(), b_looks.images.len()));
    for (number, (first, second)) in a_looks.images.iter().zip(&b_looks.images).enumerate() {
        let bytes = of_bytes(&first.encoded, &second.encoded);
        say(&format!("image {number}"), bytes.map(|difference| difference.what));
    }
    out
}

fn of_attribute<T: Copy, const N: usize>(
    a: &Option<Vec<T>>,
    b: &Option<Vec<T>>,
    numbers: impl Fn(T) -> [f64; N],
) -> Option<What> {
    match (a, b) {
        (None, None) => None,
        (Some(_), None) => Some(What::OnlyInFirst),
        (None, Some(_)) => Some(What::OnlyInSecond),
        (Some(a), Some(b)) if a.len() != b.len() => Some(What::Count {
            first: a.len(),
            second: b.len(),
        }),
        (Some(a), Some(b)) => of_elements(a.iter().map(|&x| numbers(x)), b.iter().map(|&x| numbers(x))),
    }
}

fn of_values(first: String, second: String) -> Option<What> {
    (first != second).then_some(What::Value { first, second })
}
