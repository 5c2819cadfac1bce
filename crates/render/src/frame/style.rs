//! The look of surfaces.

use crate::Matcap;

/// The look of surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    /// The shading of surfaces.
    pub shading: Shading,
    /// The share of the shading's colour that the region colours replace (see [`crate::Surface::update_regions`]): 0
    /// none, 1 all.
    pub region_share: f32,
    /// Smooth or flat shading.
    pub faces: Faces,
    /// The drawing of triangles' edges.
    pub wireframe: Wireframe,
    /// The marking of boundary and non-manifold edges.
    pub borders: Borders,
    /// The drawing of the lines on the surface.
    pub outlines: Outlines,
    /// The drawing of the surfaces' shadows on the ground.
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

/// The shading of a surface.
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

/// The drawing of triangles' edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Wireframe {
    /// None.
    #[default]
    Off,
    /// Thin dark lines, fainter where edges are shorter than a few pixels.
    On,
}

/// The marking of boundary and non-manifold edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Borders {
    /// None.
    #[default]
    Off,
    /// Marked, each kind in its colour ([`crate::border`]).
    On,
}

/// The drawing of the lines on a surface ([`crate::Surface::update_lines`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Outlines {
    /// None.
    #[default]
    Off,
    /// Drawn where they are visible.
    On,
}

/// The drawing of surfaces' shadows on the ground ([`crate::Renderer::update_shadow`]).
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
