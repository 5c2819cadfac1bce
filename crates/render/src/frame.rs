//! What one picture shows: a view, a style, surfaces, and marks above them.

use crate::{Overlay, Surface, View};

/// Everything one picture shows. Cheap to make anew each time.
#[derive(Debug, Clone, Copy)]
pub struct Frame<'a> {
    /// How the world is seen.
    pub view: &'a View,
    /// How surfaces look.
    pub style: &'a Style,
    /// What is drawn; order does not matter (transparent materials aside, which are drawn last, in this order).
    pub surfaces: &'a [&'a Surface],
    /// Marks above the surfaces (gizmos, the brush's ring), later ones over earlier ones.
    pub overlays: &'a [Overlay],
}

/// How surfaces look.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Style {
    /// What the surface is made of.
    pub shading: Shading,
    /// How much of it the surface's region colours replace (see [`Surface::update_regions`]): 0 none, 1 all.
    pub region_share: f32,
    /// Whether edges are drawn over it.
    pub wireframe: Wireframe,
    /// What is behind it.
    pub background: Background,
}

/// What a surface seems to be made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Shading {
    /// A plain warm-grey clay: shape and nothing else.
    #[default]
    Clay,
    /// The file's own: base colours, textures and vertex colours.
    Material,
}

/// Edges over the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Wireframe {
    /// None.
    #[default]
    Off,
    /// Thin dark lines, fainter where they lie closer than a few pixels.
    On,
}

/// What is behind the surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Background {
    /// From the top of the picture to its bottom, sRGB 0 to 255.
    Gradient {
        /// Colour at the upper border.
        top: [u8; 3],
        /// Colour at the lower border.
        bottom: [u8; 3],
    },
    /// Nothing: alpha 0 where no surface is (colours are premultiplied by alpha).
    Transparent,
}

impl Default for Background {
    /// A dim neutral slate, darker below, that lets a warm clay stand out.
    fn default() -> Self {
        Self::Gradient {
            top: [72, 76, 82],
            bottom: [34, 36, 40],
        }
    }
}
