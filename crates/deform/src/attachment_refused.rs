//! Reasons why a cage, a lattice or examples can't be used.

/// An attachment can't be used. The sentence has no subject: "the cage", "the lattice" or "the examples" is put before
/// it.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AttachmentRefused {
    /// The method does not declare it, or declares another kind.
    #[error("is not an input of this method: leave it out")]
    Kind,
    /// The number of its points is too small or too large.
    #[error("has {found} points: give {least} to {most}")]
    PointCount {
        /// The number of points.
        found: usize,
        /// The fewest.
        least: usize,
        /// The most.
        most: usize,
    },
    /// `moved` has a wrong length.
    #[error("has {found} moved points, but {expected} points: give one for each of its points, or leave `moved` out")]
    MovedCount {
        /// The length.
        found: usize,
        /// The number of points.
        expected: usize,
    },
    /// A point that is not finite.
    #[error("has no finite position at its point {point}: give three finite numbers")]
    NotFinite {
        /// The point.
        point: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error("names vertex {vertex} in its triangle {triangle}, but has {count} vertices: use numbers below that")]
    NoSuchVertex {
        /// The triangle.
        triangle: usize,
        /// The vertex.
        vertex: u32,
        /// The number of vertices.
        count: usize,
    },
    /// A vertex without a triangle.
    #[error("has no triangle at its vertex {vertex}: remove the vertex")]
    UnusedVertex {
        /// The vertex.
        vertex: usize,
    },
    /// A triangle without area.
    #[error("has no area in its triangle {triangle}: remove it or move its vertices apart")]
    NoArea {
        /// The triangle.
        triangle: usize,
    },
    /// An edge with one triangle.
    #[error("is open at the edge from vertex {0} to vertex {1}: close it")]
    Open(u32, u32),
    /// An edge with more than two triangles.
    #[error("has more than two triangles at the edge from vertex {0} to vertex {1}: leave two of them")]
    NonManifold(u32, u32),
    /// Two triangles at an edge that face different sides.
    #[error("has triangles that face different sides at the edge from vertex {0} to vertex {1}: turn one of them over")]
    Turned(u32, u32),
    /// The volume is zero.
    #[error("encloses no volume: give a closed mesh around the region")]
    NoVolume,
    /// Vertices that must be within it are not.
    #[error(
        "leaves {count} of the region's vertices outside, but {coordinates} coordinates are only for those inside: \
         make it larger, or take mean-value coordinates"
    )]
    Outside {
        /// The number of vertices.
        count: usize,
        /// The coordinates' name.
        coordinates: &'static str,
    },
    /// Vertices are at places without a node of the harmonic grid.
    #[error(
        "is closer than one cell of the grid to {count} of the region's vertices: move it away from them or raise \
         `grid`"
    )]
    Close {
        /// The number of vertices.
        count: usize,
    },
    /// A number of control points along an axis that the functions can't have.
    #[error("has {found} control points along {axis}: with this `basis` and `degree` give {least} to {most}")]
    Counts {
        /// The axis.
        axis: char,
        /// The number.
        found: u32,
        /// The fewest.
        least: u32,
        /// The most.
        most: u32,
    },
    /// The box has no extent.
    #[error("has a box without extent along {axis}: give a `max` above its `min`")]
    Flat {
        /// The axis.
        axis: char,
    },
    /// An example's number of vertices differs from the surface's.
    #[error(
        "can't be used: {name:?} has {found} vertices, but the surface has {expected}: give examples of the same mesh"
    )]
    VertexCount {
        /// The example's name.
        name: String,
        /// The example's number of vertices.
        found: usize,
        /// The surface's number of vertices.
        expected: usize,
    },
    /// The number of weights is too small or too large.
    #[error("can't be used with {found} weights: give one for each of the {expected}")]
    WeightCount {
        /// The number of weights.
        found: usize,
        /// The number of examples.
        expected: usize,
    },
    /// A weight that is not finite or too large.
    #[error("can't be used with the weight of number {place}: give −{most} to {most}")]
    Weight {
        /// The example's number.
        place: usize,
        /// The largest weight.
        most: f64,
    },
}
