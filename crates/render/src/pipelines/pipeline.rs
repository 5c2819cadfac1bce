//! The render pipelines by name.

/// The format of the id buffer.
pub(crate) const ID_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// The format of the picture of the surface's height above the ground.
pub(crate) const OCCLUSION_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg8Unorm;

/// A render pipeline: one of a picture, or that of the id buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Pipeline {
    Matcap,
    Painted,
    Zebra,
    Normals,
    Material(Alpha, MaterialAttributes),
    Wireframe,
    SurfaceLines(Visibility),
    Background,
    Grid,
    Occlusion,
    Shadow,
    OverlayTriangles(Visibility),
    OverlayLines(Visibility),
    Id,
}

/// The use of a material's alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Alpha {
    Opaque,
    Mask,
    Blend,
}

/// The rate of texture coordinates and colours: one for each vertex, or the same for all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum MaterialAttributes {
    PerVertex,
    Shared,
}

/// Lines and overlays are drawn twice: fainter where a surface hides them, and where they are visible.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Visibility {
    Hidden,
    Visible,
}

impl Visibility {
    /// Both, in draw order.
    pub(crate) const BOTH: [Self; 2] = [Self::Hidden, Self::Visible];
}
