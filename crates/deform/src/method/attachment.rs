//! What a method takes beside handles, and a person may bring and edit: a cage, a lattice.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DVec3, USizeVec3};

use super::AttachmentRefused;

/// A thing that a method takes. It is a member of `method` in the edit format.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct AttachmentDeclaration {
    /// Its name in the edit format; none of the method's options has the same.
    pub name: &'static str,
    /// What a person calls it, in lower case.
    pub title: &'static str,
    /// What it is and what happens without it, as a phrase.
    pub help: &'static str,
    /// What it is made of.
    pub kind: AttachmentKind,
}

/// What an attachment is made of.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum AttachmentKind {
    /// A closed triangle mesh whose vertices are moved.
    ControlMesh,
    /// A lattice over a box along the axes, whose control points are moved.
    ControlLattice,
}

/// An attachment. A binding depends on how it rests, a frame on where its points were moved to.
#[derive(Clone, PartialEq, Debug)]
pub enum Attachment {
    /// Of [`AttachmentKind::ControlMesh`].
    Mesh(ControlMesh),
    /// Of [`AttachmentKind::ControlLattice`].
    Lattice(ControlLattice),
}

/// A control mesh.
#[derive(Clone, PartialEq, Debug)]
pub struct ControlMesh {
    /// Where its vertices rest, in world units.
    pub rest: Arc<Vec<DVec3>>,
    /// Its triangles, all of them counterclockwise or all clockwise seen from outside.
    pub triangles: Arc<Vec<[u32; 3]>>,
    /// Where its vertices were moved to by hand: one point a vertex.
    pub moved: Arc<Vec<DVec3>>,
}

/// A control lattice. Where its points rest follows from the box, the counts and the method's functions; see
/// [`crate::Method::control_rest`].
#[derive(Clone, PartialEq, Debug)]
pub struct ControlLattice {
    /// Control points along each axis.
    pub counts: [u32; 3],
    /// The box's lowest corner, in world units.
    pub low: DVec3,
    /// The box's highest corner.
    pub high: DVec3,
    /// Where its points were moved to by hand: one a control point, x running fastest, then y.
    pub moved: Arc<Vec<DVec3>>,
}

impl Attachment {
    /// What it is made of.
    pub fn kind(&self) -> AttachmentKind {
        match self {
            Self::Mesh(_) => AttachmentKind::ControlMesh,
            Self::Lattice(_) => AttachmentKind::ControlLattice,
        }
    }

    /// Where its points were moved to by hand.
    pub fn moved(&self) -> &Arc<Vec<DVec3>> {
        match self {
            Self::Mesh(mesh) => &mesh.moved,
            Self::Lattice(lattice) => &lattice.moved,
        }
    }

    /// The same with its points moved to these places.
    #[must_use]
    pub fn with_moved(&self, moved: Arc<Vec<DVec3>>) -> Self {
        match self.clone() {
            Self::Mesh(mesh) => Self::Mesh(ControlMesh { moved, ..mesh }),
            Self::Lattice(lattice) => Self::Lattice(ControlLattice { moved, ..lattice }),
        }
    }

    /// Whether the two differ in nothing but where their points were moved to: then nothing has to be bound anew.
    pub fn rests_as(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Mesh(a), Self::Mesh(b)) => {
                let same_rest = Arc::ptr_eq(&a.rest, &b.rest) || a.rest == b.rest;
                same_rest && (Arc::ptr_eq(&a.triangles, &b.triangles) || a.triangles == b.triangles)
            }
            (Self::Lattice(a), Self::Lattice(b)) => (a.counts, a.low, a.high) == (b.counts, b.low, b.high),
            _ => false,
        }
    }

    /// How many points it has.
    pub fn point_count(&self) -> usize {
        match self {
            Self::Mesh(mesh) => mesh.rest.len(),
            Self::Lattice(lattice) => lattice.counts.iter().map(|count| *count as usize).product(),
        }
    }

    /// The lines between its points, each once: a mesh's edges, or a lattice's from each point to the next ones.
    pub fn edges(&self) -> Vec<[u32; 2]> {
        match self {
            Self::Mesh(mesh) => {
                let sides = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
                let edges: BTreeSet<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
                edges.into_iter().collect()
            }
            Self::Lattice(lattice) => lattice_edges(lattice.counts),
        }
    }

    /// Refuses another length of `moved` than there are points, points that are not finite, and triangles of vertices
    /// that do not exist.
    pub(crate) fn check(&self) -> Result<(), AttachmentRefused> {
        let (expected, found) = (self.point_count(), self.moved().len());
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
        finite(self.moved())
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

fn lattice_edges(counts: [u32; 3]) -> Vec<[u32; 2]> {
    let counts = USizeVec3::from_array(counts.map(|count| count as usize));
    let number = |place: USizeVec3| (place.x + counts.x * (place.y + counts.y * place.z)) as u32;
    let mut edges = Vec::new();
    for z in 0..counts.z {
        for y in 0..counts.y {
            for x in 0..counts.x {
                let place = USizeVec3::new(x, y, z);
                let next = USizeVec3::AXES.into_iter().map(|axis| place + axis);
                let next = next.filter(|next| next.cmplt(counts).all());
                edges.extend(next.map(|next| [number(place), number(next)]));
            }
        }
    }
    edges
}
