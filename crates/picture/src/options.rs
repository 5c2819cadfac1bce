//! The options of a picture.

use pliant_editor::{Clay, UpAxis, up_axis_of};
use pliant_mesh::Model;

use crate::choice::Choice;

/// The axis that points up in a picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[expect(missing_docs, reason = "the choices' help describes each")]
pub enum Up {
    #[default]
    Guess,
    Y,
    Z,
}

impl Up {
    /// Every axis.
    pub const CHOICES: &[Choice<Self>] = &[
        Choice::with_help(
            "guess",
            Self::Guess,
            "The axis on which the shape stands, as the window guesses it",
        ),
        Choice::of("y", Self::Y),
        Choice::of("z", Self::Z),
    ];

    /// The axis in pictures of this model.
    pub(crate) fn axis_of(self, model: &Model) -> UpAxis {
        match self {
            Self::Guess => up_axis_of(model),
            Self::Y => UpAxis::Y,
            Self::Z => UpAxis::Z,
        }
    }
}

/// The direction of view of a picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[expect(missing_docs, reason = "each variant is what its name says")]
pub enum View {
    Front,
    Back,
    Left,
    Right,
    Top,
    Bottom,
    #[default]
    ThreeQuarter,
}

impl View {
    /// Every direction.
    pub const CHOICES: &[Choice<Self>] = &[
        Choice::of("front", Self::Front),
        Choice::of("back", Self::Back),
        Choice::of("left", Self::Left),
        Choice::of("right", Self::Right),
        Choice::of("top", Self::Top),
        Choice::of("bottom", Self::Bottom),
        Choice::of("three-quarter", Self::ThreeQuarter),
    ];
}

/// The surface's colours in a picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[expect(missing_docs, reason = "the choices' help describes each")]
pub enum Shading {
    #[default]
    Clay,
    Material,
    Regions,
    Stiffness,
    Distortion,
    Area,
    Curvature,
    Zebra,
    Normals,
}

impl Shading {
    /// Every shading.
    pub const CHOICES: &[Choice<Self>] = &[
        Choice::with_help("clay", Self::Clay, "Clay, which shows the shape alone"),
        Choice::with_help("material", Self::Material, "The file's materials"),
        Choice::with_help("regions", Self::Regions, "Clay with the edit's regions in colour"),
        Choice::with_help("stiffness", Self::Stiffness, "The edit's stiffness, with a legend"),
        Choice::with_help(
            "distortion",
            Self::Distortion,
            "Lengths of edges over those at rest, with a legend",
        ),
        Choice::with_help("area", Self::Area, "Areas over those at rest, with a legend"),
        Choice::with_help("curvature", Self::Curvature, "Mean curvature, with a legend"),
        Choice::with_help(
            "zebra",
            Self::Zebra,
            "Mirrored stripes: they break at creases and kink where curvature jumps",
        ),
        Choice::with_help("normals", Self::Normals, "The direction in which the surface faces"),
    ];

    /// The editor's shading.
    pub(crate) fn of_editor(self) -> pliant_editor::Shading {
        use pliant_editor::Shading as Editor;
        match self {
            Self::Clay | Self::Regions => Editor::Clay,
            Self::Material => Editor::Material,
            Self::Stiffness => Editor::Stiffness,
            Self::Distortion => Editor::Stretch,
            Self::Area => Editor::Area,
            Self::Curvature => Editor::Curvature,
            Self::Zebra => Editor::Zebra,
            Self::Normals => Editor::Normals,
        }
    }
}

/// The projection of a picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[expect(missing_docs, reason = "each variant is what its name says")]
pub enum ProjectionName {
    #[default]
    Perspective,
    Orthographic,
}

impl ProjectionName {
    /// Every projection.
    pub const CHOICES: &[Choice<Self>] = &[
        Choice::of("perspective", Self::Perspective),
        Choice::of("orthographic", Self::Orthographic),
    ];
}

/// A picture's size in pixels, 1 to 16384 each way.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PictureSize {
    /// The width.
    pub width: u32,
    /// The height.
    pub height: u32,
}

impl std::str::FromStr for PictureSize {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |text: &str| text.parse().ok().filter(|side| (1..=16384).contains(side));
        let sides = text
            .split_once(['x', 'X'])
            .and_then(|(width, height)| Some((side(width)?, side(height)?)));
        match sides {
            Some((width, height)) => Ok(Self { width, height }),
            None => Err("a size is WIDTHxHEIGHT, such as 1280x800, each from 1 to 16384".to_owned()),
        }
    }
}

/// The view and the colours of a picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct LookOptions {
    /// The axis that points up.
    pub up: Up,
    /// The direction of view.
    pub view: View,
    /// The surface's colours.
    pub shading: Shading,
}

/// The options of one picture or of a turntable.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct StillOptions {
    /// The size in pixels.
    pub size: PictureSize,
    /// The view and the colours.
    pub look: LookOptions,
    /// The clay of the shadings clay and regions.
    pub clay: Clay,
    /// The projection.
    pub projection: ProjectionName,
    /// Shades each triangle flat instead of interpolating normals.
    pub flat: bool,
    /// Draws the triangles' edges.
    pub wireframe: bool,
    /// Marks edges where the surface ends and edges that more than two triangles share.
    pub borders: bool,
    /// Outlines the edit's handles and the free region.
    pub outlines: bool,
    /// Draws the ground's grid.
    pub grid: bool,
    /// Draws the soft shadow on the ground.
    pub shadow: bool,
    /// Leaves the background transparent.
    pub transparent: bool,
    /// The number of pictures around the up axis; `None` is one picture.
    pub turntable: Option<u32>,
}

impl Default for StillOptions {
    fn default() -> Self {
        Self {
            size: PictureSize {
                width: 1280,
                height: 800,
            },
            look: LookOptions::default(),
            clay: Clay::default(),
            projection: ProjectionName::default(),
            flat: false,
            wireframe: false,
            borders: false,
            outlines: false,
            grid: false,
            shadow: false,
            transparent: false,
            turntable: None,
        }
    }
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn a_size_is_two_sides_from_1_to_16384() {
        let size: PictureSize = "64x48".parse().unwrap();
        assert_eq!(size, PictureSize { width: 64, height: 48 });
        for size in ["64", "0x48", "ax3", "64x48x2", "99999x2"] {
            assert!(size.parse::<PictureSize>().is_err(), "{size}");
        }
    }
}
