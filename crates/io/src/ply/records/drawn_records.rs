//! The parts of the records that are drawn or moved.

use glam::DVec3;

/// The data of a vertex, in the order of [`Columns`].
pub(super) const COLUMN_NAMES: [&[&str]; 12] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx", "normal_x"],
    &["ny", "normal_y"],
    &["nz", "normal_z"],
    &["red", "r", "diffuse_red"],
    &["green", "g", "diffuse_green"],
    &["blue", "b", "diffuse_blue"],
    &["alpha", "a", "diffuse_alpha"],
    &["s", "u", "texture_u", "texture_s"],
    &["t", "v", "texture_v", "texture_t"],
];

/// The property with each datum of a vertex, if any: x, y, z, the normal, red, green, blue, alpha, and the texture
/// coordinates.
pub(in crate::ply) type Columns = [Option<usize>; COLUMN_NAMES.len()];

/// The places of the vertices' records.
#[derive(Clone, Debug)]
pub(in crate::ply) enum Places {
    /// At equal distances.
    Strided { first: usize, stride: usize },
    /// The start of each.
    Each(Vec<usize>),
}

impl Default for Places {
    fn default() -> Self {
        Self::Each(Vec::new())
    }
}

impl Places {
    pub(in crate::ply) fn of(&self, vertex: usize) -> usize {
        match self {
            Self::Strided { first, stride } => first + vertex * stride,
            Self::Each(starts) => starts[vertex],
        }
    }
}

/// The parts of the records that are drawn or moved.
#[derive(Debug, Default)]
pub(in crate::ply) struct Records {
    /// The element with the vertices.
    pub(in crate::ply) vertex_element: Option<usize>,
    pub(in crate::ply) columns: Columns,
    pub(in crate::ply) places: Places,
    pub(in crate::ply) positions: Vec<DVec3>,
    /// Empty if the vertices have none. f32 is enough for drawing normals, and for rotating them on saving.
    pub(in crate::ply) normals: Vec<[f32; 3]>,
    /// From 0 to 1, as stored; empty if the vertices have none.
    pub(in crate::ply) colours: Vec<[f32; 4]>,
    pub(in crate::ply) uvs: Vec<[f32; 2]>,
    /// Corners of all faces, then strips' triangles, one after the other.
    pub(in crate::ply) corners: Vec<u32>,
    /// The end of each face's corners.
    pub(in crate::ply) face_ends: Vec<u32>,
    /// The texture coordinates of each of `corners`; empty if no face has any, NaN for a face without.
    pub(in crate::ply) corner_uvs: Vec<[f32; 2]>,
    /// The texture of each face; empty if no face names one.
    pub(in crate::ply) textures: Vec<u32>,
    /// The number of faces with fewer than three corners.
    pub(in crate::ply) left_out: usize,
}
