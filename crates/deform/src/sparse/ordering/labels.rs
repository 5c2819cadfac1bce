//! A graph whose vertices are labelled by part.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use pliant_mesh::SurfaceVertex;

use crate::numerical::graph::Graph;

/// The label of vertices that are no longer in a part.
pub(crate) const CUT_OUT: u32 = 0;

/// A graph and its vertices' labels: at first 1 everywhere, then halves of part i are 2 i and 2 i + 1.
///
/// A part writes only the labels of its own vertices, and of other labels it reads only that they are not its own, so
/// the result does not depend on the order in which parts are cut.
pub(crate) struct Labelled<'a, G> {
    graph: &'a G,
    labels: Vec<AtomicU32>,
}

impl<'a, G: Graph> Labelled<'a, G> {
    /// All of a graph of `count` vertices as one part.
    pub fn whole(graph: &'a G, count: usize) -> Self {
        Self {
            graph,
            labels: (0..count).map(|_| AtomicU32::new(1)).collect(),
        }
    }

    /// The part of a vertex.
    pub fn label(&self, vertex: u32) -> u32 {
        self.labels[vertex as usize].load(Relaxed)
    }

    /// Moves a vertex into another part.
    pub fn set_label(&self, vertex: u32, label: u32) {
        self.labels[vertex as usize].store(label, Relaxed);
    }

    /// A vertex' neighbours, in any part.
    pub fn ring(&self, vertex: u32) -> &[SurfaceVertex] {
        self.graph.neighbours(SurfaceVertex(vertex))
    }

    /// Returns true if a walk of at most `edges` edges leads to a vertex with this label.
    pub fn reaches(&self, vertex: u32, edges: u32, label: u32) -> bool {
        let ring = self.ring(vertex);
        ring.iter().any(|n| self.label(n.0) == label)
            || edges > 1 && ring.iter().any(|n| self.reaches(n.0, edges - 1, label))
    }
}
