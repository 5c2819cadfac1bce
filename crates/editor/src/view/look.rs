//! The look of the view: a person's choice, not part of the document.

use super::skins::Skins;

/// The look of the surface.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub struct Look {
    /// The apparent material of the surface, or the meaning of its colours.
    pub shading: Shading,
    /// The clay.
    pub clay: Clay,
    /// True if each triangle is flat, instead of having interpolated normals.
    pub flat: bool,
    /// True if the triangles' edges are shown.
    pub wireframe: bool,
    /// True if edges that a closed surface does not have are marked.
    pub borders: bool,
    /// True if the regions are shown.
    pub regions: bool,
    /// True if handles are outlined, and the line between the free region and the fixed part is drawn.
    pub outlines: bool,
    /// True if the ground's grid is shown.
    pub grid: bool,
    /// True if the surface casts a shadow on the ground.
    pub shadow: bool,
    /// True if the file's own shape is shown instead of the present one.
    pub original: bool,
    /// True if the smooth base is shown instead of the surface, if the method has one.
    pub base: bool,
    /// True if the timeline is shown.
    pub timeline: bool,
    /// True if the path of a sequence's body is shown, while the timeline is.
    pub path: bool,
    /// The ghosts of other moments, while the timeline is shown.
    pub skins: Skins,
    /// The way in which the file's own shape is shown with the present one.
    pub before: Before,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            shading: Shading::Clay,
            clay: Clay::Clay,
            flat: false,
            wireframe: false,
            borders: false,
            regions: true,
            outlines: true,
            grid: true,
            shadow: true,
            original: false,
            base: false,
            timeline: false,
            path: false,
            skins: Skins::default(),
            before: Before::Off,
        }
    }
}

/// The way in which the file's own shape is shown with the present one.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Before {
    /// Not at all.
    #[default]
    Off,
    /// As a ghost over the present shape.
    Ghost,
    /// On the left of a line that can be dragged.
    Split,
}

/// The apparent material of the surface, or the meaning of its colours.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Shading {
    /// Plain clay.
    #[default]
    Clay,
    /// The file's materials.
    Material,
    /// The painted stiffness.
    Stiffness,
    /// The share of the selected handle's turn and stretch, if the method has such weights.
    Weights,
    /// The stretch of edges relative to rest.
    Stretch,
    /// The change of areas relative to rest.
    Area,
    /// Mean curvature.
    Curvature,
    /// Mirrored stripes.
    Zebra,
    /// The direction of its normals.
    Normals,
}

/// A clay.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
#[expect(missing_docs, reason = "each variant is what its name says")]
pub enum Clay {
    #[default]
    Clay,
    Plaster,
    Wax,
    Bronze,
    Porcelain,
    Graphite,
}

impl Clay {
    /// Every clay with its name, which menus capitalise.
    pub const NAMES: [(&'static str, Self); 6] = [
        ("clay", Self::Clay),
        ("plaster", Self::Plaster),
        ("wax", Self::Wax),
        ("bronze", Self::Bronze),
        ("porcelain", Self::Porcelain),
        ("graphite", Self::Graphite),
    ];
}
