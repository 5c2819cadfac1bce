//! The arguments of the commands that draw pictures.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, RangedU64ValueParser, TypedValueParser};
use clap::{Args, ValueEnum};
use pliant_editor::Clay;

use super::shared_arguments::{ComputeArguments, WeldArguments};

#[derive(Args, Debug)]
pub(crate) struct CompareArguments {
    /// The file to bend: glb, gltf, obj, ply, stl or off
    pub file: PathBuf,
    /// The edit
    #[arg(long, value_name = "EDIT.json")]
    pub edit: PathBuf,
    /// The methods to compare, separated by commas, or `all`; each is NAME[:OPTION=VALUE..]. The name of the edit's
    /// own method alone keeps the edit's options
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', required = true, num_args = 1)]
    pub methods: Vec<String>,
    /// The picture to write: a cell for each method
    #[arg(long, value_name = "SHEET.png")]
    pub output: PathBuf,
    /// Write each method's report to this file
    #[arg(long, value_name = "REPORT.json")]
    pub report: Option<PathBuf>,
    /// Replay the edit as a drag of N frames (1 to 100000) instead of one solve
    #[arg(long, value_name = "N", value_parser = RangedU64ValueParser::<usize>::new().range(1..=100_000))]
    pub frames: Option<usize>,
    /// The picture's size in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1600x1000")]
    pub size: PictureSize,
    /// The view and the colours.
    #[command(flatten)]
    pub look: LookArguments,
    /// The welding of vertices.
    #[command(flatten)]
    pub weld: WeldArguments,
    /// The threads and vectors.
    #[command(flatten)]
    pub compute: ComputeArguments,
}

/// The view and the colours of a picture.
#[derive(Args, Clone, Copy, PartialEq, Eq, Debug)]
pub struct LookArguments {
    /// The axis that points up
    #[arg(long, value_enum, default_value = "y")]
    pub up: Up,
    /// The direction of view
    #[arg(long, value_enum, default_value = "three-quarter")]
    pub view: View,
    /// The surface's colours
    #[arg(long, value_enum, default_value = "clay")]
    pub shading: Shading,
}

/// The arguments of `pliant render`.
#[derive(Args, Clone, PartialEq, Debug)]
pub struct RenderArguments {
    /// The file to draw: glb, gltf, obj, ply, stl or off
    pub file: PathBuf,
    /// The picture to write
    #[arg(long, value_name = "OUT.png")]
    pub output: PathBuf,
    /// Draw the file with this edit applied
    #[arg(long, value_name = "EDIT.json")]
    pub edit: Option<PathBuf>,
    /// The picture's size in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x800")]
    pub size: PictureSize,
    /// The view and the colours.
    #[command(flatten)]
    pub look: LookArguments,
    /// The clay of `--shading clay` and `regions`
    #[arg(long, default_value = "clay", value_parser = clay())]
    pub clay: Clay,
    /// The projection
    #[arg(long, value_enum, default_value = "perspective")]
    pub projection: ProjectionName,
    /// Shade each triangle flat instead of interpolating normals
    #[arg(long)]
    pub flat: bool,
    /// Draw the triangles' edges
    #[arg(long)]
    pub wireframe: bool,
    /// Mark edges where the surface ends and edges that more than two triangles share
    #[arg(long)]
    pub borders: bool,
    /// Outline the edit's handles and the free region; `--shading regions` does so, too
    #[arg(long)]
    pub outlines: bool,
    /// Draw the ground's grid
    #[arg(long)]
    pub grid: bool,
    /// Draw the soft shadow on the ground
    #[arg(long)]
    pub shadow: bool,
    /// Leave the background transparent
    #[arg(long)]
    pub transparent: bool,
    /// Write N pictures around the up axis (2 to 9999), as OUT-0001.png and so on
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=9999))]
    pub turntable: Option<u32>,
    /// The welding of vertices.
    #[command(flatten)]
    pub weld: WeldArguments,
}

/// The axis that points up in a picture.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
#[expect(missing_docs, reason = "each variant is what its name says")]
pub enum Up {
    Y,
    Z,
}

/// The direction of view of a picture.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
#[expect(missing_docs, reason = "each variant is what its name says")]
pub enum View {
    Front,
    Back,
    Left,
    Right,
    Top,
    Bottom,
    ThreeQuarter,
}

/// The surface's colours in a picture.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum Shading {
    /// Clay, which shows the shape alone
    Clay,
    /// The file's materials
    Material,
    /// Clay with the edit's regions in colour
    Regions,
    /// The edit's stiffness, with a legend
    Stiffness,
    /// Lengths of edges over those at rest, with a legend
    Distortion,
    /// Areas over those at rest, with a legend
    Area,
    /// Mean curvature, with a legend
    Curvature,
    /// Mirrored stripes: they break at creases and kink where curvature jumps
    Zebra,
    /// The direction in which the surface faces
    Normals,
}

/// The projection of a picture.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum ProjectionName {
    Perspective,
    Orthographic,
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

/// Reads a clay by its name.
fn clay() -> impl TypedValueParser<Value = Clay> {
    PossibleValuesParser::new(Clay::NAMES.map(|(name, _)| name)).map(|chosen| {
        let called = Clay::NAMES.into_iter().find(|(name, _)| *name == chosen);
        called.map_or(Clay::default(), |(_, clay)| clay)
    })
}

#[cfg(test)]
mod tests {
    use super::PictureSize;

    #[test]
    fn a_size_is_two_numbers_within_their_range() {
        assert_eq!("64x48".parse(), Ok(PictureSize { width: 64, height: 48 }));
        for size in ["64", "0x48", "ax3", "64x48x2", "99999x2"] {
            assert!(size.parse::<PictureSize>().is_err(), "{size}");
        }
    }
}
