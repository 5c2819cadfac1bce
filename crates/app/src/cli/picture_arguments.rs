//! The arguments of the commands that draw pictures.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, RangedU64ValueParser, TypedValueParser};
use pliant_editor::Clay;
use pliant_picture::{Choice, LookOptions, PictureSize, ProjectionName, Shading, StillOptions, Up, View};

use super::shared_arguments::{ComputeArguments, WeldArguments};

#[derive(Args, Debug)]
pub(crate) struct CompareArguments {
    /// The file to bend: glb, gltf, obj, ply, stl, off, 3mf or usdz
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
    #[arg(long, default_value = "guess", value_parser = chosen(Up::CHOICES))]
    pub up: Up,
    /// The direction of view
    #[arg(long, default_value = "three-quarter", value_parser = chosen(View::CHOICES))]
    pub view: View,
    /// The surface's colours
    #[arg(long, default_value = "clay", value_parser = chosen(Shading::CHOICES))]
    pub shading: Shading,
}

impl LookArguments {
    /// The options of the picture.
    pub fn options(self) -> LookOptions {
        let Self { up, view, shading } = self;
        LookOptions { up, view, shading }
    }
}

/// The arguments of `pliant render`.
#[derive(Args, Clone, PartialEq, Debug)]
pub struct RenderArguments {
    /// The file to draw: glb, gltf, obj, ply, stl, off, 3mf or usdz
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
    #[arg(long, default_value = "perspective", value_parser = chosen(ProjectionName::CHOICES))]
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

impl RenderArguments {
    /// The options of the picture.
    pub fn options(&self) -> StillOptions {
        StillOptions {
            size: self.size,
            look: self.look.options(),
            clay: self.clay,
            projection: self.projection,
            flat: self.flat,
            wireframe: self.wireframe,
            borders: self.borders,
            outlines: self.outlines,
            grid: self.grid,
            shadow: self.shadow,
            transparent: self.transparent,
            turntable: self.turntable,
        }
    }
}

/// Reads a choice by its name.
fn chosen<T: Copy + Send + Sync>(choices: &'static [Choice<T>]) -> impl TypedValueParser<Value = T> {
    let named = |choice: &Choice<T>| {
        let value = PossibleValue::new(choice.name);
        if choice.help.is_empty() {
            value
        } else {
            value.help(choice.help)
        }
    };
    let parser = PossibleValuesParser::new(choices.iter().map(named).collect::<Vec<_>>());
    parser.try_map(|name| pliant_picture::named(choices, &name))
}

/// Reads a clay by its name.
fn clay() -> impl TypedValueParser<Value = Clay> {
    PossibleValuesParser::new(Clay::NAMES.map(|(name, _)| name)).map(|chosen| {
        let called = Clay::NAMES.into_iter().find(|(name, _)| *name == chosen);
        called.map_or(Clay::default(), |(_, clay)| clay)
    })
}
