//! Drawn vertices of a file whose faces have texture coordinates: a vertex whose corners have several is drawn once for
//! each. The first one found keeps the vertex's number; the others come after all vertices, in the order of the faces.

use std::collections::HashMap;

use glam::DVec3;
use pliant_mesh::{Drawn, FileVertex};

/// The drawn vertex of each corner, and the texture coordinates of each drawn vertex.
#[derive(Debug, Default)]
pub(super) struct Wedges {
    pub(super) uvs: Vec<[f32; 2]>,
    /// The file vertex behind each drawn one that comes after all of the file's.
    pub(super) further: Vec<u32>,
}

impl Wedges {
    /// Numbers the drawn vertices, and puts these numbers in place of the corners'. `vertex_uvs` applies to vertices
    /// whose corners have none.
    pub(super) fn number(corners: &mut [u32], corner_uvs: &[[f32; 2]], count: usize, vertex_uvs: &[[f32; 2]]) -> Self {
        let mut out = Self {
            uvs: (0..count)
                .map(|v| vertex_uvs.get(v).copied().unwrap_or_default())
                .collect(),
            further: Vec::new(),
        };
        let mut is_met = vec![false; count];
        let mut known: HashMap<(u32, [u32; 2]), u32> = HashMap::new();
        let each = corners.iter_mut().zip(corner_uvs);
        for (corner, &uv) in each.filter(|(_, uv)| !uv[0].is_nan()) {
            let vertex = *corner as usize;
            if !std::mem::replace(&mut is_met[vertex], true) {
                out.uvs[vertex] = uv;
            } else if out.uvs[vertex].map(f32::to_bits) != uv.map(f32::to_bits) {
                *corner = *known.entry((*corner, uv.map(f32::to_bits))).or_insert_with(|| {
                    out.uvs.push(uv);
                    out.further.push(vertex as u32);
                    (count + out.further.len() - 1) as u32
                });
            }
        }
        out
    }

    /// Adds the further drawn vertices.
    pub(super) fn place(&self, positions: Vec<DVec3>) -> Drawn {
        let count = positions.len();
        let mut drawn = Drawn::once(positions, Vec::new());
        for &vertex in &self.further {
            drawn.positions.push(drawn.positions[vertex as usize]);
            drawn.file_vertex.push(FileVertex(vertex));
        }
        drawn.file_vertex_count = count;
        drawn
    }
}
