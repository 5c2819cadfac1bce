//! Inputs of a method beside handles, which a person may bring and edit: a cage, a lattice, examples.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec3;

use super::AttachmentRefused;

/// An input that a method declares. It is a member of `method` in the edit format.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct AttachmentDeclaration {
    /// Its name in the edit format; none of the method's options has the same.
    pub name: &'static str,
    /// Its label for a person, in lower case.
    pub title: &'static str,
    /// A phrase on its purpose and on its replacement if it is missing.
    pub help: &'static str,
    /// Its kind.
    pub kind: AttachmentKind,
}

/// The kind of an attachment.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum AttachmentKind {
    /// A closed triangle mesh whose vertices are moved.
    ControlMesh,
    /// A lattice over a box along the axes, whose control points are moved.
    ControlLattice,
    /// Shapes of the same vertices and triangles, each with a weight.
    Shapes,
}

/// An attachment. A binding depends on its rest shape, a frame on the moved positions of its points or on its weights.
#[derive(Clone, PartialEq, Debug)]
pub enum Attachment {
    /// The attachment of [`AttachmentKind::ControlMesh`].
    Mesh(ControlMesh),
    /// The attachment of [`AttachmentKind::ControlLattice`].
    Lattice(ControlLattice),
    /// The attachment of [`AttachmentKind::Shapes`].
    Shapes(Examples),
}

/// Further shapes of a surface, and their weights.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Examples {
    /// The shapes.
    pub shapes: Arc<Vec<ExampleShape>>,
    /// Each shape's weight, from −[`LARGEST_WEIGHT`] to it: 0 is rest, 1 the shape itself, and more goes beyond.
    /// `None`: the solver finds it.
    pub weights: Vec<Option<f64>>,
}

/// A further shape of the same vertices and triangles.
#[derive(Clone, PartialEq, Debug)]
pub struct ExampleShape {
    /// Its label for a person.
    pub name: String,
    /// The displacement of each surface vertex from rest, in world units.
    pub displacements: Arc<Vec<DVec3>>,
}

/// The largest weight of an example.
pub const LARGEST_WEIGHT: f64 = 10.0;

/// A control mesh.
#[derive(Clone, PartialEq, Debug)]
pub struct ControlMesh {
    /// The rest positions of its vertices, in world units.
    pub rest: Arc<Vec<DVec3>>,
    /// Its triangles, all of them counterclockwise or all clockwise seen from outside.
    pub triangles: Arc<Vec<[u32; 3]>>,
    /// The positions to which its vertices were moved by hand: one per vertex.
    pub moved: Arc<Vec<DVec3>>,
}

/// A control lattice. The rest positions of its points follow from the box, the counts and the method's functions; see
/// [`crate::Method::control_rest`].
#[derive(Clone, PartialEq, Debug)]
pub struct ControlLattice {
    /// Control points along each axis.
    pub counts: [u32; 3],
    /// The box's lowest corner, in world units.
    pub low: DVec3,
    /// The box's highest corner.
    pub high: DVec3,
    /// The positions to which its points were moved by hand: one per control point, x running fastest, then y.
    pub moved: Arc<Vec<DVec3>>,
}

impl Attachment {
    /// Its kind.
    pub fn kind(&self) -> AttachmentKind {
        match self {
            Self::Mesh(_) => AttachmentKind::ControlMesh,
            Self::Lattice(_) => AttachmentKind::ControlLattice,
            Self::Shapes(_) => AttachmentKind::Shapes,
        }
    }

    /// The positions to which its points were moved by hand; `None` for examples, which have none.
    pub fn moved(&self) -> Option<&Arc<Vec<DVec3>>> {
        match self {
            Self::Mesh(mesh) => Some(&mesh.moved),
            Self::Lattice(lattice) => Some(&lattice.moved),
            Self::Shapes(_) => None,
        }
    }

    /// The same with its points moved to these positions.
    #[must_use]
    pub fn with_moved(&self, moved: Arc<Vec<DVec3>>) -> Self {
        match self.clone() {
            Self::Mesh(mesh) => Self::Mesh(ControlMesh { moved, ..mesh }),
            Self::Lattice(lattice) => Self::Lattice(ControlLattice { moved, ..lattice }),
            Self::Shapes(examples) => Self::Shapes(examples),
        }
    }

    /// Returns true if the two differ only in the moved positions of their points, or in names and weights: then no new
    /// binding is needed.
    pub fn rests_as(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Mesh(a), Self::Mesh(b)) => {
                let same_rest = Arc::ptr_eq(&a.rest, &b.rest) || a.rest == b.rest;
                same_rest && (Arc::ptr_eq(&a.triangles, &b.triangles) || a.triangles == b.triangles)
            }
            (Self::Lattice(a), Self::Lattice(b)) => (a.counts, a.low, a.high) == (b.counts, b.low, b.high),
            (Self::Shapes(a), Self::Shapes(b)) => {
                let same = |(a, b): (&ExampleShape, &ExampleShape)| {
                    Arc::ptr_eq(&a.displacements, &b.displacements) || a.displacements == b.displacements
                };
                a.shapes.len() == b.shapes.len() && a.shapes.iter().zip(&*b.shapes).all(same)
            }
            _ => false,
        }
    }

    /// The number of its points.
    pub fn point_count(&self) -> usize {
        match self {
            Self::Mesh(mesh) => mesh.rest.len(),
            Self::Lattice(lattice) => lattice.counts.iter().map(|count| *count as usize).product(),
            Self::Shapes(_) => 0,
        }
    }

    /// The lines between its points, each once: a mesh's edges, or a lattice's lines between neighbouring points.
    pub fn edges(&self) -> Vec<[u32; 2]> {
        match self {
            Self::Mesh(mesh) => {
                let sides = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
                let edges: BTreeSet<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
                edges.into_iter().collect()
            }
            Self::Lattice(lattice) => lattice_edges(lattice.counts),
            Self::Shapes(_) => Vec::new(),
        }
    }

    /// The triangles of its outside: a mesh's own, or those of a lattice's six sides, two for each of their cells,
    /// counterclockwise seen from outside.
    pub fn outside(&self) -> Vec<[u32; 3]> {
        match self {
            Self::Mesh(mesh) => mesh.triangles.to_vec(),
            Self::Lattice(lattice) => lattice_outside(lattice.counts),
            Self::Shapes(_) => Vec::new(),
        }
    }

    /// Refuses a wrong length of `moved`, points that are not finite, triangles of vertices that do not exist, and
    /// weights that are too many, too few or too large.
    pub(crate) fn check(&self) -> Result<(), AttachmentRefused> {
        if let Self::Shapes(examples) = self {
            return examples.check();
        }
        let moved = self.moved().map_or(&[][..], |moved| moved);
        let (expected, found) = (self.point_count(), moved.len());
        if let Self::Mesh(mesh) = self {
            finite(&mesh.rest)?;
            for (triangle, corners) in mesh.triangles.iter().enumerate() {
                if let Some(&vertex) = corners.iter().find(|vertex| **vertex as usize >= expected) {
                    return Err(AttachmentRefused::NoSuchVertex {
                        triangle,
                        vertex,
                        count: expected,
                    });
                }
            }
        }
        if found != expected {
            return Err(AttachmentRefused::MovedCount { found, expected });
        }
        finite(moved)
    }
}

impl Examples {
    /// The shapes with all weights 0.
    pub fn at_rest(shapes: Vec<ExampleShape>) -> Self {
        Self {
            weights: vec![Some(0.0); shapes.len()],
            shapes: Arc::new(shapes),
        }
    }

    /// Refuses weights that [`Examples::weights`] does not allow, and displacements that are not finite.
    pub(crate) fn check(&self) -> Result<(), AttachmentRefused> {
        check_weights(&self.weights, self.shapes.len())?;
        self.shapes.iter().try_for_each(|shape| finite(&shape.displacements))
    }

    /// Refuses a shape without this many vertices.
    pub(crate) fn check_fits(&self, vertex_count: usize) -> Result<(), AttachmentRefused> {
        let fits = |shape: &&ExampleShape| shape.displacements.len() == vertex_count;
        match self.shapes.iter().find(|shape| !fits(shape)) {
            Some(shape) => Err(AttachmentRefused::VertexCount {
                name: shape.name.clone(),
                found: shape.displacements.len(),
                expected: vertex_count,
            }),
            None => Ok(()),
        }
    }
}

/// Refuses a wrong number of weights, and weights that are not finite or too large.
pub(crate) fn check_weights(weights: &[Option<f64>], expected: usize) -> Result<(), AttachmentRefused> {
    if weights.len() != expected {
        return Err(AttachmentRefused::WeightCount {
            found: weights.len(),
            expected,
        });
    }
    let is_allowed = |weight: &Option<f64>| weight.is_none_or(|weight| weight.abs() <= LARGEST_WEIGHT);
    match weights.iter().position(|weight| !is_allowed(weight)) {
        Some(place) => Err(AttachmentRefused::Weight {
            place,
            most: LARGEST_WEIGHT,
        }),
        None => Ok(()),
    }
}

/// Beyond this the squares of distances may overflow.
const LARGEST: f64 = 1e100;

pub(crate) fn finite(points: &[DVec3]) -> Result<(), AttachmentRefused> {
    let is_finite = |point: &DVec3| point.is_finite() && point.abs().max_element() < LARGEST;
    match points.iter().position(|point| !is_finite(point)) {
        Some(point) => Err(AttachmentRefused::NotFinite { point }),
        None => Ok(()),
    }
}

/// The number of a lattice's point at a place along each axis.
fn number(counts: [u32; 3], place: [u32; 3]) -> u32 {
    place[0] + counts[0] * (place[1] + counts[1] * place[2])
}

fn lattice_edges(counts: [u32; 3]) -> Vec<[u32; 2]> {
    let mut edges = Vec::new();
    for z in 0..counts[2] {
        for y in 0..counts[1] {
            for x in 0..counts[0] {
                let place = [x, y, z];
                let next = [0, 1, 2].map(|axis| std::array::from_fn(|k| place[k] + u32::from(k == axis)));
                let next = next.into_iter().filter(|next| (0..3).all(|k| next[k] < counts[k]));
                edges.extend(next.map(|next| [number(counts, place), number(counts, next)]));
            }
        }
    }
    edges
}

fn lattice_outside(counts: [u32; 3]) -> Vec<[u32; 3]> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        let (right, up) = ((axis + 1) % 3, (axis + 2) % 3);
        let last = counts[axis].saturating_sub(1);
        for (i, j) in (1..counts[up]).flat_map(|j| (1..counts[right]).map(move |i| (i, j))) {
            let at = |level: u32, i: u32, j: u32| {
                let mut place = [level; 3];
                (place[right], place[up]) = (i, j);
                number(counts, place)
            };
            let cell = |level: u32| {
                [
                    at(level, i - 1, j - 1),
                    at(level, i, j - 1),
                    at(level, i, j),
                    at(level, i - 1, j),
                ]
            };
            let ([a, b, c, d], [e, f, g, h]) = (cell(last), cell(0));
            triangles.extend([[a, b, c], [a, c, d], [e, g, f], [e, h, g]]);
        }
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::{lattice_edges, lattice_outside};

    #[test]
    fn the_outside_of_a_lattice_is_closed_and_turned_outwards() {
        for counts in [[2, 2, 2], [3, 4, 3], [2, 5, 4]] {
            let place = |point: u32| {
                let [x, y, _] = counts;
                glam::DVec3::new(
                    f64::from(point % x),
                    f64::from(point / x % y),
                    f64::from(point / (x * y)),
                )
            };
            let triangles = lattice_outside(counts);
            let volume: f64 = triangles
                .iter()
                .map(|corners| {
                    let [a, b, c] = corners.map(place);
                    a.dot(b.cross(c)) / 6.0
                })
                .sum();
            let box_volume: u32 = counts.iter().map(|count| count - 1).product();
            assert!((volume - f64::from(box_volume)).abs() < 1e-9, "{counts:?}: {volume}");
            let sides = || triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
            for [a, b] in sides() {
                assert_eq!(
                    sides().filter(|side| *side == [b, a]).count(),
                    1,
                    "{counts:?}: {a} to {b}"
                );
            }
            // Its lines between neighbouring points are edges of the lattice.
            let edges = lattice_edges(counts);
            let straight = sides().filter(|[a, b]| place(*a).distance(place(*b)) < 1.1);
            assert!(
                straight
                    .map(|[a, b]| [a.min(b), a.max(b)])
                    .all(|side| edges.contains(&side))
            );
        }
    }
}
