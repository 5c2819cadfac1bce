//! The corners of a primitive, and its triangles and lines.

use pliant_mesh::DrawnVertex;
use rayon::prelude::*;

use super::primitive::{Mode, Primitive};
use crate::gltf::document::Document;

/// The number of corners or triangles for one task.
const CHUNK: usize = 1 << 14;

/// The corners of a primitive: indices into its vertices, or all of them in order.
pub(super) enum Corners {
    Listed(Vec<u32>),
    Counted(u32),
}

/// The winding of a triangle.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Winding {
    AsStored,
    Flipped,
}

/// The number of a primitive's corners, without reading them.
pub(super) fn corner_count(document: &Document, primitive: &Primitive, vertex_count: usize) -> Result<usize, String> {
    let Some(accessor) = primitive.indices else {
        return Ok(vertex_count);
    };
    Ok(document.layout(accessor)?.count)
}

/// The largest number of triangles for so many corners.
pub(super) fn triangle_count(mode: Mode, corner_count: usize) -> usize {
    if mode == Mode::Triangles {
        corner_count / 3
    } else {
        corner_count.saturating_sub(2)
    }
}

/// Reads a primitive's corners.
pub(super) fn corners(document: &Document, primitive: &Primitive, vertex_count: usize) -> Result<Corners, String> {
    let Some(accessor) = primitive.indices else {
        return Ok(Corners::Counted(vertex_count as u32));
    };
    let indices = document
        .layout(accessor)?
        .indices(document)
        .map_err(|what| format!("has indices that {what}"))?;
    match indices
        .par_iter()
        .with_min_len(CHUNK)
        .position_first(|&index| index as usize >= vertex_count)
    {
        Some(at) => Err(format!("has index {}, but only {vertex_count} vertices", indices[at])),
        None => Ok(Corners::Listed(indices)),
    }
}

impl Corners {
    /// Their number.
    pub fn len(&self) -> usize {
        match self {
            Self::Listed(indices) => indices.len(),
            Self::Counted(count) => *count as usize,
        }
    }

    /// Appends the lines over drawn vertices that begin at `first`, of which points are some; pairs of equal corners make
    /// none.
    pub fn lines(&self, mode: Mode, first: u32, out: &mut Vec<[DrawnVertex; 2]>) {
        let corner = |k: usize| match self {
            Self::Listed(indices) => indices[k],
            Self::Counted(_) => k as u32,
        };
        let count = self.len();
        let lines = match mode {
            Mode::Lines => count / 2,
            Mode::LineStrip => count.saturating_sub(1),
            Mode::LineLoop if count > 1 => count,
            Mode::Points => count,
            _ => 0,
        };
        let line = |k: usize| match mode {
            Mode::Lines => [corner(2 * k), corner(2 * k + 1)],
            Mode::Points => [corner(k); 2],
            _ => [corner(k), corner((k + 1) % count)],
        };
        let drawn = (0..lines).map(line).filter(|[a, b]| a != b || mode == Mode::Points);
        out.extend(drawn.map(|ends| ends.map(|corner| DrawnVertex(first + corner))));
    }

    /// Appends the triangles over drawn vertices that begin at `first`. Degenerate triangles that connect strips (two
    /// equal corners) are left out.
    pub fn triangles(&self, mode: Mode, winding: Winding, first: u32, out: &mut Vec<[DrawnVertex; 3]>) {
        let corner = |k: usize| match self {
            Self::Listed(indices) => indices[k],
            Self::Counted(_) => k as u32,
        };
        let triangle = |t: usize| match mode {
            Mode::Strip if t % 2 == 1 => [corner(t + 1), corner(t), corner(t + 2)],
            Mode::Strip => [corner(t), corner(t + 1), corner(t + 2)],
            Mode::Fan => [corner(0), corner(t + 1), corner(t + 2)],
            _ => [corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)],
        };
        let wound = |[a, b, c]: [u32; 3]| {
            let corners = if winding == Winding::Flipped {
                [a, c, b]
            } else {
                [a, b, c]
            };
            corners.map(|corner| DrawnVertex(first + corner))
        };
        let all = (0..triangle_count(mode, self.len()))
            .into_par_iter()
            .with_min_len(CHUNK);
        if mode == Mode::Triangles {
            out.par_extend(all.map(|t| wound(triangle(t))));
        } else {
            let is_drawn = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
            out.par_extend(all.map(triangle).filter(is_drawn).map(wound));
        }
    }
}
