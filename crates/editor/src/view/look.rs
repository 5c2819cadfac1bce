//! How the view shows things: chosen by a person, not part of the document.

/// How the surface is shown.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub struct Look {
    /// What it seems to be made of, or what its colours say.
    pub shading: Shading,
    /// Which clay.
    pub clay: Clay,
    /// Whether each triangle is flat, instead of normals being interpolated.
    pub flat: bool,
    /// Whether the triangles' edges are shown.
    pub wireframe: bool,
    /// Whether edges that a closed surface lacks are marked.
    pub borders: bool,
    /// Whether the regions' colours are shown.
    pub regions: bool,
    /// Whether handles are outlined, and the line is drawn where the free region meets what is held.
    pub outlines: bool,
    /// Whether the ground's grid is shown.
    pub grid: bool,
    /// Whether the surface throws a shadow on the ground.
    pub shadow: bool,
    /// Whether the file's own shape is shown in place of the present one.
    pub original: bool,
    /// Whether the smooth base is shown in place of the surface, where the method has one.
    pub base: bool,
    /// How the file's own shape is shown along with the present one.
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
            before: Before::Off,
        }
    }
}

/// How the file's own shape is shown along with the present one.
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

/// What the surface seems to be made of, or what its colours say.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Shading {
    /// Plain clay.
    #[default]
    Clay,
    /// The file's materials.
    Material,
    /// How stiff it was painted.
    Stiffness,
    /// How much of the selected handle's turn and stretch it takes on, where the method has such weights.
    Weights,
    /// How much longer or shorter edges are than at rest.
    Stretch,
    /// How much larger or smaller areas are than at rest.
    Area,
    /// Mean curvature.
    Curvature,
    /// Stripes that it mirrors.
    Zebra,
    /// Which way it faces.
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
    /// Every clay with its name, which menus begin with a capital.
    pub const NAMES: [(&'static str, Self); 6] = [
        ("clay", Self::Clay),
        ("plaster", Self::Plaster),
        ("wax", Self::Wax),
        ("bronze", Self::Bronze),
        ("porcelain", Self::Porcelain),
        ("graphite", Self::Graphite),
    ];
}
