//! Refusals, each in one sentence that names the culprit and the remedy. Vertices are numbered as in the file.

use pliant_deform::{BindError, SolveError};
use pliant_mesh::Cancelled;

/// A shape can't be cut, filled or joined as requested.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StitchError {
    /// The flag was raised.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A closed surface has nothing to fill.
    #[error("the surface is closed: it has no hole to fill")]
    NoHole,
    /// A closed surface has no border to join, or to name.
    #[error("the surface has no border: cut a part out first")]
    NoBorder,
    /// A given vertex is inside the surface or in no triangle, but should be on a border.
    #[error("vertex {vertex} is on no border: `pliant info` lists the borders; give a vertex of one of them")]
    NotOnBorder {
        /// The vertex.
        vertex: u32,
    },
    /// The file does not have this vertex.
    #[error("there is no vertex {vertex}: the file has {count}, numbered from 0")]
    NoVertex {
        /// The vertex.
        vertex: u32,
        /// The number of the file's vertices.
        count: usize,
    },
    /// A border can't be filled or joined.
    #[error("the border at vertex {vertex} {fault}")]
    FaultyBorder {
        /// A vertex of it.
        vertex: u32,
        /// Its fault.
        fault: BorderFault,
    },
    /// Two given vertices are on one border.
    #[error(
        "vertices {} and {} are on one border, but a tube needs two: give a vertex of another border", .vertices[0], .vertices[1]
    )]
    SameBorder {
        /// The vertices.
        vertices: [u32; 2],
    },
    /// Two borders have a vertex in common, so that no tube fits between them.
    #[error(
        "the borders at vertices {} and {} touch, so no tube fits between them: delete the vertices there first", .vertices[0], .vertices[1]
    )]
    BordersTouch {
        /// A vertex of each.
        vertices: [u32; 2],
    },
    /// The surface has no other borders than the outer ones of open sheets, and none was named.
    #[error(
        "the surface has no hole: the border at vertex {vertex} is the outer border of an open sheet, which is filled \
         only if it is picked in the window, or named by a vertex or by its length"
    )]
    OnlyOuterBorders {
        /// A vertex of the longest.
        vertex: u32,
    },
    /// The cut would leave nothing.
    #[error("the selection holds every triangle: select less, so that something is left")]
    NothingLeft,
    /// The whole surface is on one side of the plane.
    #[error(
        "the plane does not cross the surface, which lies between the levels {from} and {to} along its unit normal: \
         choose a level between these"
    )]
    PlaneMisses {
        /// The lowest level of a vertex along the unit normal, in world units.
        from: f64,
        /// The highest.
        to: f64,
    },
    /// A curve has too few points.
    #[error("the curve has {found} points, but needs at least {least}: give more")]
    CurveTooShort {
        /// The number of points.
        found: usize,
        /// The least number.
        least: usize,
    },
    /// The ends of an open curve are on no border.
    #[error(
        "the curve begins or ends inside the surface, at point {point}: lead both ends to a border, or the last to the \
         first"
    )]
    CurveEndsInside {
        /// The number of the end, from 0.
        point: usize,
    },
    /// No way along the surface follows the curve between two points.
    #[error(
        "the curve can't follow the surface from point {from} to the next one: lead it around borders, along one \
         connected part, or put more points there"
    )]
    CurveLost {
        /// The number of the first point, from 0.
        from: usize,
    },
    /// Neighbouring points of a curve are on different connected parts.
    #[error(
        "the curve goes from one connected part to another after point {from}: cut one part after the other and hide the \
         others, or cut along a straight line, which goes through all parts"
    )]
    CurveChangesPart {
        /// The number of the first point, from 0.
        from: usize,
    },
    /// A curve crosses itself, or runs back along itself.
    #[error("the curve crosses itself or touches itself on the surface: draw it without crossing")]
    CurveCrossesItself,
    /// The surface beside both sides of a curve is in one piece.
    #[error(
        "the curve does not divide the surface, which goes on from its left to its right around it: keep both sides, or \
         draw the curve around the part that goes"
    )]
    CurveDividesNothing,
    /// The cut has no vertex.
    #[error("the selection holds no vertex: select at least one")]
    NothingSelected,
    /// B's transform leaves triangles without an area, because it flattens them or moves them too far.
    #[error(
        "the transform of B flattens {triangles} of its triangles, or moves them too far to compute with: move it less \
         far, and scale every axis by more than 0"
    )]
    Transform {
        /// The number of these triangles.
        triangles: usize,
    },
    /// The method refused to bend a part.
    #[error("{part} can't be bent to the common border: {source}")]
    Bind {
        /// `A` or `B`.
        part: &'static str,
        /// The refusal.
        source: BindError,
    },
    /// The method failed to bend a part.
    #[error("{part} can't be bent to the common border: {source}")]
    Solve {
        /// `A` or `B`.
        part: &'static str,
        /// The failure.
        source: SolveError,
    },
    /// A pair joins borders that other pairs join with different ones.
    #[error(
        "pair {pair} joins vertex {a} of A with vertex {b} of B, whose borders other pairs join with different ones: keep the pairs of one border of A on one border of B"
    )]
    CrossedBorders {
        /// The pair's place in the list.
        pair: usize,
        /// The vertex of A.
        a: u32,
        /// The vertex of B.
        b: u32,
    },
    /// Pairs follow each other on A's border, but not in the opposite direction on B's.
    #[error(
        "the pairs on the border at vertex {vertex} of A are not in the opposite order on B's border: if one part is inside out, turn it; otherwise leave out the pair that crosses the others"
    )]
    PairsOutOfOrder {
        /// A vertex of A's border.
        vertex: u32,
    },
    /// Two pairs have the same vertex.
    #[error("vertex {vertex} of {part} is in two pairs: keep one of them")]
    TwicePaired {
        /// `A` or `B`.
        part: &'static str,
        /// The vertex.
        vertex: u32,
    },
}

impl StitchError {
    /// The place of the obstacle: a vertex, numbered as in the file, if it has one on a shape that was made from one file.
    pub fn place(&self) -> Option<u32> {
        match *self {
            Self::NotOnBorder { vertex } | Self::FaultyBorder { vertex, .. } | Self::OnlyOuterBorders { vertex } => {
                Some(vertex)
            }
            Self::SameBorder { vertices } | Self::BordersTouch { vertices } => Some(vertices[0]),
            _ => None,
        }
    }
}

/// The fault of a border.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum BorderFault {
    /// It ends at an edge that more than two triangles share.
    NonManifold,
    /// Triangles along it disagree about the outside.
    Misoriented,
    /// Two of its edges cross.
    CrossesItself,
    /// It goes around one triangle without neighbours.
    LoneTriangle,
}

impl std::fmt::Display for BorderFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::NonManifold => {
                "ends at an edge that more than two triangles share: delete the triangles there, then fill the hole"
            }
            Self::Misoriented => {
                "runs along triangles that disagree about the outside: turn those that are inside out first"
            }
            Self::LoneTriangle => "goes around a single triangle: delete the triangle",
            Self::CrossesItself => "crosses itself: delete the triangles where it does, then fill the hole",
        })
    }
}
