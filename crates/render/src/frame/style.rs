//! How surfaces look.

use crate::Matcap;

/// How surfaces look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    /// How surfaces are shaded.
    pub shading: Shading,
    /// The share of the shading's colour that the region colours replace (see [`crate::Surface::update_regions`]): 0 none, 1
    /// all.
    pub region_share: f32,
    /// Smooth or flat shading.
    pub faces: Faces,
    /// Whether the edges of triangles are drawn.
    pub wireframe: Wireframe,
    /// Whether boundary and non-manifold edges are marked.
    pub borders: Borders,
    /// Whether the lines on the surface are drawn.
    pub outlines: Outlines,
    /// Whether the surfaces' shadows on the ground are drawn.
    pub shadows: Shadows,
    /// The level of detail.
    pub detail: Detail,
    /// Pixels per point, which scales the widths of borders and outlines.
    pub pixels_per_point: f32,
    /// The background behind the surfaces.
    pub background: Background,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            shading: Shading::default(),
            region_share: 0.0,
            faces: Faces::default(),
            wireframe: Wireframe::default(),
            borders: Borders::default(),
            outlines: Outlines::default(),
            shadows: Shadows::default(),
            detail: Detail::default(),
            pixels_per_point: 1.0,
            background: Background::default(),
        }
    }
}

/// How a surface is shaded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Shading {
    /// A clay matcap: only the shape.
    Matcap(Matcap),
    /// The file's own materials.
    Material,
    /// Region colours that encode numbers, shaded so weakly that they match a legend.
    Painted,
    /// Reflection lines: they break at creases and kink where the curvature jumps.
    Zebra,
    /// World-space normals as colours.
    Normals,
}

impl Default for Shading {
    fn default() -> Self {
        Self::Matcap(Matcap::default())
    }
}

/// Smooth or flat shading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Faces {
    /// Vertex normals, interpolated.
    #[default]
    Smooth,
    /// Face normals.
    Flat,
}

/// Whether the edges of triangles are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Wireframe {
    /// None.
    #[default]
    Off,
    /// Thin dark lines, fainter where edges are shorter than a few pixels.
    On,
}

/// Whether boundary and non-manifold edges are marked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Borders {
    /// None.
    #[default]
    Off,
    /// Marked, each kind in its colour ([`crate::border`]).
    On,
}

/// Whether the lines on a surface ([`crate::Surface::update_lines`]) are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Outlines {
    /// None.
    #[default]
    Off,
    /// Drawn where they are visible.
    On,
}

/// Whether the shadows that surfaces have ([`crate::Renderer::update_shadow`]) are drawn on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Shadows {
    /// None.
    #[default]
    Off,
    /// Drawn over the ground and its grid; they are invisible from below.
    On,
}

/// The level of detail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Detail {
    /// All triangles.
    #[default]
    Full,
    /// At most a twentieth of a large surface's triangles, for interaction on slow devices. Materials and wireframes
    /// keep full detail.
    Reduced,
}

/// The background behind the surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Background {
    /// A vertical gradient, sRGB 0 to 255.
    Gradient {
        /// Colour at the top.
        top: [u8; 3],
        /// Colour at the bottom.
        bottom: [u8; 3],
    },
    /// Alpha 0 where there is no surface (colours are premultiplied).
    Transparent,
}

impl Default for Background {
    /// A dim neutral grey, darker at the bottom, against which warm clay stands out.
    fn default() -> Self {
        Self::Gradient {
            top: [72, 76, 82],
            bottom: [34, 36, 40],
        }
    }
}
