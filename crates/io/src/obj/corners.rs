//! From faces of `v/vt/vn` corners to drawn vertices.
//!
//! Drawn vertex *i* is `v` line *i* while there are such, so a file without seams needs almost no tables. A `v` line
//! whose corners name several texture coordinates or normals is drawn as one vertex for each combination: the first one
//! found keeps the `v` line's own number, the others come after all of them, in the order of the faces.

use std::collections::HashMap;

use pliant_mesh::{Cancel, Cancelled, Drawn, DrawnVertex, FileVertex};

use super::statements::{NONE, Statements, UNUSED};
use crate::polygon::diagonals::Diagonals;
use crate::polygon::{CORNERS_BETWEEN_LOOKS, triangulate};

/// The number of combinations of one `v` line that are searched linearly before a table is used.
const LONGEST_CHAIN: u32 = 16;

/// The drawn set of an OBJ file and the lines behind each drawn vertex.
#[derive(Debug, Default)]
pub(super) struct Corners {
    pub(super) drawn: Drawn,
    /// The `vt` of each drawn vertex or [`NONE`]; empty if no corner names one.
    pub(super) uv: Vec<u32>,
    /// The `vn` of each drawn vertex or [`NONE`]; empty if no corner names one.
    pub(super) normal: Vec<u32>,
    /// The drawn vertex of each corner of `Statements::corners`.
    pub(super) drawn_of_corner: Vec<u32>,
    /// The start of each run's triangles.
    pub(super) run_triangles: Vec<u32>,
}

/// Numbers the drawn vertices and cuts the faces into triangles.
pub(super) fn draw(statements: &Statements, cancel: &Cancel) -> Result<Corners, Cancelled> {
    let count = statements.positions.len();
    let mut out = Corners::default();
    let has_uv = statements.corners.iter().any(|corner| corner.uv != NONE);
    let has_normal = statements.corners.iter().any(|corner| corner.normal != NONE);
    out.drawn.positions = statements.positions.clone();
    out.drawn.file_vertex = (0..count as u32).map(FileVertex).collect();
    out.drawn.file_vertex_count = count;
    if has_uv || has_normal {
        number_combinations(statements, &mut out, cancel)?;
    } else {
        out.drawn_of_corner = statements.corners.iter().map(|corner| corner.position).collect();
    }
    for (table, wanted) in [(&mut out.uv, has_uv), (&mut out.normal, has_normal)] {
        if !wanted {
            *table = Vec::new();
        }
    }
    cut_faces(statements, &mut out, cancel)?;
    Ok(out)
}

/// Gives every combination of `v`, `vt` and `vn` that a corner names its drawn vertex.
fn number_combinations(statements: &Statements, out: &mut Corners, cancel: &Cancel) -> Result<(), Cancelled> {
    let count = statements.positions.len();
    out.uv = vec![UNUSED; count];
    out.normal = vec![UNUSED; count];
    // The next drawn vertex of the same `v` line.
    let mut next = vec![NONE; count];
    let mut beyond_chains: HashMap<(u32, u32, u32), u32> = HashMap::new();
    out.drawn_of_corner.reserve_exact(statements.corners.len());
    for (number, corner) in statements.corners.iter().enumerate() {
        if number.is_multiple_of(CORNERS_BETWEEN_LOOKS) {
            cancel.check()?;
        }
        let (position, uv, normal) = (corner.position, corner.uv, corner.normal);
        let mut drawn = position;
        if out.uv[drawn as usize] == UNUSED {
            out.uv[drawn as usize] = uv;
            out.normal[drawn as usize] = normal;
        }
        let mut steps = 0;
        while (out.uv[drawn as usize], out.normal[drawn as usize]) != (uv, normal) {
            let is_last = next[drawn as usize] == NONE;
            if !is_last && steps < LONGEST_CHAIN {
                drawn = next[drawn as usize];
                steps += 1;
                continue;
            }
            let fresh = out.drawn.positions.len() as u32;
            let known = if steps < LONGEST_CHAIN {
                fresh
            } else {
                *beyond_chains.entry((position, uv, normal)).or_insert(fresh)
            };
            if known == fresh {
                if steps < LONGEST_CHAIN {
                    next[drawn as usize] = fresh;
                }
                out.drawn.positions.push(statements.positions[position as usize]);
                out.drawn.file_vertex.push(FileVertex(position));
                out.uv.push(uv);
                out.normal.push(normal);
                next.push(NONE);
            }
            drawn = known;
        }
        out.drawn_of_corner.push(drawn);
    }
    for table in [&mut out.uv, &mut out.normal] {
        for index in table.iter_mut().filter(|index| **index == UNUSED) {
            *index = NONE;
        }
    }
    Ok(())
}

/// Cuts every face into triangles over drawn vertices.
fn cut_faces(statements: &Statements, out: &mut Corners, cancel: &Cancel) -> Result<(), Cancelled> {
    let faces = statements.face_ends.len();
    let diagonals = Diagonals::of(&statements.positions);
    out.drawn.triangles.reserve_exact(statements.corners.len() - 2 * faces);
    let (mut start, mut looked_at) = (0, 0);
    let mut runs = statements.runs.iter().peekable();
    for (face, &end) in statements.face_ends.iter().enumerate() {
        if end >= looked_at {
            cancel.check()?;
            looked_at = end + CORNERS_BETWEEN_LOOKS;
        }
        while runs.next_if(|run| run.first_face == face).is_some() {
            out.run_triangles.push(out.drawn.triangles.len() as u32);
        }
        let corners = &out.drawn_of_corner[start..end];
        let positions = &out.drawn.positions;
        let triangles = &mut out.drawn.triangles;
        triangulate(
            corners.len(),
            |k| positions[corners[k] as usize],
            &diagonals,
            |triangle| triangles.push(triangle.map(|k| DrawnVertex(corners[k]))),
        );
        start = end;
    }
    Ok(())
}
