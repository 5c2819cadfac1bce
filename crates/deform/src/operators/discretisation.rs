//! The choices of weights and triangles of a Laplacian.

use crate::option::named_choices;

named_choices! {
    /// The weights w_ij and areas M_ii of the Laplacian [BS08, section 5.1].
    pub enum Discretisation {
        /// w_ij = 1, M_ii = Σ_j w_ij: independent of the triangles' shapes. The weights have one factor for the whole
        /// surface, with which they agree with the others if all triangles are equilateral; edges at a boundary count
        /// half, as they do there.
        Uniform = "uniform",
        /// w_ij = ½ (cot α + cot β), M_ii the same for all: independent of the vertices' density.
        Cotangent = "cotangent",
        /// w_ij = ½ (cot α + cot β), M_ii the vertex' own area [BS08, equation 7].
        CotangentArea = "cotangent-area",
    }
}

named_choices! {
    /// The triangles that the Laplacian is made on; their vertices are the surface's.
    pub enum TriangulationKind {
        /// The surface's triangles.
        AsIs = "as-is",
        /// The surface's triangles, with edges flipped within it until no weight is negative, except at edges with more
        /// or less than two triangles \[FSBS06\].
        IntrinsicDelaunay = "intrinsic-delaunay",
        /// The surface's tufted cover, flipped: no weight is negative on any triangles \[SC20\].
        Tufted = "tufted",
    }
}
