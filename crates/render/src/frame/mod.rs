//! What one frame shows: a view, a style, surfaces, and overlays.

pub(crate) mod grid;
pub(crate) mod image;
pub(crate) mod overlay;
pub(crate) mod palette;
pub(crate) mod recording;
pub(crate) mod target;
pub(crate) mod uniforms;
pub(crate) mod view;

use crate::{Grid, Matcap, Overlay, Surface, View};

/// Everything one picture shows. Cheap to make anew each time.
#[derive(Debug, Clone, Copy)]
pub struct Frame<'a> {
    /// How the world is seen.
    pub view: &'a View,
    /// How surfaces look.
    pub style: &'a Style,
    /// What is drawn; order does not matter (transparent materials aside, which are drawn last, in this order).
    pub surfaces: &'a [&'a Surface],
    /// The ground, if it is to be seen.
    pub grid: Option<&'a Grid>,
    /// Marks above the surfaces (gizmos, the brush's ring), later ones over earlier ones.
    pub overlays: &'a [Overlay],
}

/// How surfaces look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    /// What the surface is made of.
    pub shading: Shading,
    /// How much of it the surface's region colours replace (see [`Surface::update_regions`]): 0 none, 1 all.
    pub region_share: f32,
    /// Which way faces seem to face.
    pub faces: Faces,
    /// Whether edges are drawn over it.
    pub wireframe: Wireframe,
    /// Whether edges that a closed surface lacks are marked.
    pub borders: Borders,
    /// Whether the surface's own lines are drawn.
    pub outlines: Outlines,
    /// How many of its triangles are drawn.
    pub detail: Detail,
    /// How many of the picture's pixels borders and outlines take for a point.
    pub pixels_per_point: f32,
    /// What is behind it.
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
            detail: Detail::default(),
            pixels_per_point: 1.0,
            background: Background::default(),
        }
    }
}

/// What a surface seems to be made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Shading {
    /// A clay under its studio's lamps: shape and nothing else.
    Matcap(Matcap),
    /// The file's own materials.
    Material,
    /// Region colours that carry numbers: shaded so gently that they match a legend.
    Painted,
    /// Stripes that the surface mirrors: they break where it has creases and kink where its curvature jumps.
    Zebra,
    /// The direction in which the surface faces, as a colour.
    Normals,
}

impl Default for Shading {
    fn default() -> Self {
        Self::Matcap(Matcap::default())
    }
}

/// Which way faces seem to face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Faces {
    /// As the vertices' normals say, interpolated.
    #[default]
    Smooth,
    /// As the triangles lie.
    Flat,
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

/// Marks on edges that a closed surface lacks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Borders {
    /// None.
    #[default]
    Off,
    /// Edges of one triangle in one colour, those of more than two in another ([`crate::border`]).
    On,
}

/// Lines that were given to a surface ([`crate::Surface::update_lines`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Outlines {
    /// None.
    #[default]
    Off,
    /// Drawn where no surface hides them.
    On,
}

/// How many of a surface's triangles are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Detail {
    /// All.
    #[default]
    Full,
    /// A twentieth or fewer of a large surface's: while something moves on a slow device. Materials and wireframes stay
    /// full.
    Reduced,
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
