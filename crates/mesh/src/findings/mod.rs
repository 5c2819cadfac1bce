//! The faults that loading found in a mesh, as numbers with examples and as sentences for a person.

pub(crate) mod finding;
mod sentences;

pub use finding::Finding;

/// The faults that loading found in a mesh. Vertices are named by their file vertex, triangles by their drawn triangle.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Findings {
    /// File vertices whose position is not finite (or beyond 1e60): set aside.
    pub non_finite_vertices: Finding,
    /// Triangles left out because they use such a vertex.
    pub non_finite_triangles: Finding,
    /// File vertices that no triangle uses: bare points if they are drawn.
    pub unreferenced_vertices: Finding,
    /// Triangles left out because two of their corners were welded into one.
    pub collapsed_triangles: Finding,
    /// Triangles kept although their area is nearly zero.
    pub zero_area_triangles: Finding,
    /// Triangles left out because an earlier one has the same three vertices.
    pub duplicate_triangles: Finding,
    /// Edges with more than two triangles; the examples are vertices on them.
    pub non_manifold_edges: Finding,
    /// Vertices whose triangles form more than one fan.
    pub non_manifold_vertices: Finding,
    /// Edges whose two triangles disagree about which side is outside; the examples are vertices on them.
    pub misoriented_edges: Finding,
    /// Closed parts whose triangles face inwards; the examples are their first vertices. A part within the box of
    /// another closed part counts as a cavity, whose triangles must face inwards.
    pub inside_out_components: Finding,
    /// Edges with one triangle only; the examples are vertices on them.
    pub boundary_edges: Finding,
    /// Holes; the examples are vertices on their rims.
    pub boundary_loops: Finding,
    /// Vertices on borders that run close beside others without being joined to them.
    pub nearly_joined_vertices: Finding,
    /// Connected parts, largest first; the examples are their first vertices.
    pub components: Finding,
    /// Parts with less than a hundredth of the largest one's vertices; the examples are their first vertices.
    pub loose_bits: Finding,
}

/// One of the faults that loading looks for.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[expect(missing_docs, reason = "each variant is the field of its name in `Findings`")]
pub enum FindingKind {
    NonFiniteVertices,
    NonFiniteTriangles,
    UnreferencedVertices,
    CollapsedTriangles,
    ZeroAreaTriangles,
    DuplicateTriangles,
    NonManifoldEdges,
    NonManifoldVertices,
    MisorientedEdges,
    InsideOutComponents,
    BoundaryEdges,
    BoundaryLoops,
    NearlyJoinedVertices,
    Components,
    LooseBits,
}

/// The kind of number that a finding's examples are.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Named {
    /// The file's vertices.
    FileVertex,
    /// The drawn triangles.
    DrawnTriangle,
}

impl FindingKind {
    /// Every kind, in the order of the sentences.
    pub const ALL: [Self; 15] = [
        Self::NonFiniteVertices,
        Self::NonFiniteTriangles,
        Self::UnreferencedVertices,
        Self::CollapsedTriangles,
        Self::ZeroAreaTriangles,
        Self::DuplicateTriangles,
        Self::NonManifoldEdges,
        Self::NonManifoldVertices,
        Self::MisorientedEdges,
        Self::InsideOutComponents,
        Self::BoundaryEdges,
        Self::BoundaryLoops,
        Self::NearlyJoinedVertices,
        Self::Components,
        Self::LooseBits,
    ];

    /// Its name in machine-readable output.
    pub const fn key(self) -> &'static str {
        match self {
            Self::NonFiniteVertices => "non_finite_vertices",
            Self::NonFiniteTriangles => "non_finite_triangles",
            Self::UnreferencedVertices => "unreferenced_vertices",
            Self::CollapsedTriangles => "collapsed_triangles",
            Self::ZeroAreaTriangles => "zero_area_triangles",
            Self::DuplicateTriangles => "duplicate_triangles",
            Self::NonManifoldEdges => "non_manifold_edges",
            Self::NonManifoldVertices => "non_manifold_vertices",
            Self::MisorientedEdges => "misoriented_edges",
            Self::InsideOutComponents => "inside_out_components",
            Self::BoundaryEdges => "boundary_edges",
            Self::BoundaryLoops => "boundary_loops",
            Self::NearlyJoinedVertices => "nearly_joined_vertices",
            Self::Components => "components",
            Self::LooseBits => "loose_bits",
        }
    }

    /// The kind of number that its examples are.
    pub const fn named(self) -> Named {
        match self {
            Self::NonFiniteTriangles
            | Self::CollapsedTriangles
            | Self::ZeroAreaTriangles
            | Self::DuplicateTriangles => Named::DrawnTriangle,
            _ => Named::FileVertex,
        }
    }
}

impl Findings {
    /// The finding of a kind.
    pub fn of(&self, kind: FindingKind) -> &Finding {
        match kind {
            FindingKind::NonFiniteVertices => &self.non_finite_vertices,
            FindingKind::NonFiniteTriangles => &self.non_finite_triangles,
            FindingKind::UnreferencedVertices => &self.unreferenced_vertices,
            FindingKind::CollapsedTriangles => &self.collapsed_triangles,
            FindingKind::ZeroAreaTriangles => &self.zero_area_triangles,
            FindingKind::DuplicateTriangles => &self.duplicate_triangles,
            FindingKind::NonManifoldEdges => &self.non_manifold_edges,
            FindingKind::NonManifoldVertices => &self.non_manifold_vertices,
            FindingKind::MisorientedEdges => &self.misoriented_edges,
            FindingKind::InsideOutComponents => &self.inside_out_components,
            FindingKind::BoundaryEdges => &self.boundary_edges,
            FindingKind::BoundaryLoops => &self.boundary_loops,
            FindingKind::NearlyJoinedVertices => &self.nearly_joined_vertices,
            FindingKind::Components => &self.components,
            FindingKind::LooseBits => &self.loose_bits,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_listed_once_by_a_name_of_its_own() {
        let mut keys: Vec<&str> = FindingKind::ALL.iter().map(|kind| kind.key()).collect();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), FindingKind::ALL.len());
        assert!(FindingKind::ALL.is_sorted());
    }
}
