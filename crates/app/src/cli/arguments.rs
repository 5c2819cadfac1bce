//! The command line's arguments.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, RangedU64ValueParser, TypedValueParser};
use clap::error::ContextValue;
use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
use pliant_deform::{ConstraintKind, METHODS};
use pliant_editor::Clay;
use pliant_engine::stitching::Replace;
use pliant_io::{MorphDeltas, MorphTarget, quoted};
use pliant_mesh::{Vectors, WeldOptions};

use crate::version::VERSION;

/// Bends scanned meshes.
#[derive(Parser, Debug)]
#[command(
    name = "pliant",
    version = VERSION,
    about = "Bends scanned meshes: opens glb, gltf, obj, ply, stl and off, and saves them back with nothing lost but \
             the old shape",
    args_conflicts_with_subcommands = true,
    disable_help_subcommand = true
)]
pub(crate) struct Arguments {
    /// The file to open in the window; without it, the built-in sample
    pub file: Option<PathBuf>,
    /// Begin with this edit, in the window on FILE
    #[arg(long, value_name = "EDIT.json", requires = "file")]
    pub edit: Option<PathBuf>,
    #[command(subcommand)]
    pub command: Option<Command>,
}

#[derive(Subcommand, Debug)]
pub(crate) enum Command {
    /// Say what a file holds and what is wrong with its mesh
    Info(InfoArguments),
    /// Apply an edit to a file
    Apply(ApplyArguments),
    /// Draw a file as a picture
    Render(RenderArguments),
    /// Draw one edit by several methods into one picture, with their figures
    Compare(CompareArguments),
    /// Say in words what differs between two files
    Diff(DiffArguments),
    /// Put a pose of one mesh onto another
    Transfer(TransferArguments),
    /// Put a part of one file onto another, without a crack
    Merge(MergeArguments),
    /// Fill holes
    Fill(FillArguments),
    /// Delete vertices, with the triangles that use them
    Cut(CutArguments),
    /// Let dye flow along the surface and save it as vertex colours
    Flow(FlowArguments),
    /// Write the man pages, the completions for shells and the manual's pages of commands
    Generate(GenerateArguments),
}

#[derive(Args, Debug)]
pub(crate) struct GenerateArguments {
    /// The folder to write them into; it is made if it is missing
    pub folder: PathBuf,
}

#[derive(Args, Debug)]
pub(crate) struct InfoArguments {
    /// The file: glb, gltf, obj, ply, stl or off
    pub file: PathBuf,
    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,
    /// Which vertices are one.
    #[command(flatten)]
    pub weld: WeldArguments,
}

#[derive(Args, Debug)]
pub(crate) struct DiffArguments {
    /// The first file: glb, gltf, obj, ply, stl or off
    pub first: PathBuf,
    /// The second file
    pub second: PathBuf,
    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct ApplyArguments {
    /// The file to bend: glb, gltf, obj, ply, stl or off
    pub file: PathBuf,
    /// The edit
    #[arg(long, value_name = "EDIT.json")]
    pub edit: PathBuf,
    /// The file to write; its extension tells its format
    #[arg(long, value_name = "OUT")]
    pub output: PathBuf,
    /// Where to write what was done, how long it took and how far the shape was distorted
    #[arg(long, value_name = "REPORT.json")]
    pub report: Option<PathBuf>,
    /// As a shape or as a morph target.
    #[command(flatten)]
    pub morph: MorphArguments,
    /// Replay the edit as a drag of N frames (1 to 100000) instead of one solve
    #[arg(long, value_name = "N", value_parser = RangedU64ValueParser::<usize>::new().range(1..=100_000))]
    pub frames: Option<usize>,
    /// Use this method instead of the edit's, with its defaults or with options set: NAME[:OPTION=VALUE..]
    #[arg(long, value_name = "NAME")]
    pub method: Option<String>,
    /// The most memory that binding may take beside the mesh, such as 8GB or 500MB; without it 16GiB, and never more
    /// than the machine has left. What does not fit is solved in a way that takes less, or refused
    #[arg(long, value_name = "SIZE", value_parser = pliant_engine::memory::bytes)]
    pub memory: Option<u64>,
    /// Which vertices are one.
    #[command(flatten)]
    pub weld: WeldArguments,
    /// On how many threads, and with which vectors.
    #[command(flatten)]
    pub compute: ComputeArguments,
}

/// Which vertices of a file are one.
#[derive(Args, Clone, Copy, PartialEq, Debug, Default)]
pub struct WeldArguments {
    /// Join vertices that are closer than this, in the file's units, before anything else; 0 joins equal ones alone.
    /// Without it, the distance follows from the mesh's edges and from how the file rounds its numbers
    #[arg(long, value_name = "DISTANCE", value_parser = length)]
    pub weld: Option<f64>,
}

impl WeldArguments {
    /// The same for loading.
    pub fn options(self) -> WeldOptions {
        WeldOptions { distance: self.weld }
    }
}

/// Whether what comes out is a shape or a morph target.
#[derive(Args, Debug)]
pub(crate) struct MorphArguments {
    /// Leave the shape as it is and save the new one as a morph target of this name (without one, that of the edit's or
    /// the pose's file): OUT is glb or gltf
    #[arg(long, value_name = "NAME", num_args = 0..=1, default_missing_value = "")]
    pub as_morph: Option<String>,
    /// How far the morph target shows by default, from 0 to 1
    #[arg(long, value_name = "W", default_value = "1", requires = "as_morph", value_parser = unit_number)]
    pub morph_weight: f64,
    /// Whether the deltas of the file's own morph targets turn with the surface: `turn` or `stay`. Without it they turn
    /// where they would else be off by more than 30 degrees
    #[arg(long, value_name = "HOW", conflicts_with = "as_morph")]
    pub morph_deltas: Option<Deltas>,
}

/// Whether deltas of morph targets turn with the surface.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Deltas {
    /// They do.
    Turn,
    /// They stay as they are stored.
    Stay,
}

impl MorphArguments {
    /// Whether the deltas of the file's own morph targets turn with the surface.
    pub fn deltas(&self) -> MorphDeltas {
        match self.morph_deltas {
            None => MorphDeltas::WhereFarOff,
            Some(Deltas::Turn) => MorphDeltas::Turn,
            Some(Deltas::Stay) => MorphDeltas::Stay,
        }
    }

    /// The morph target that was asked for, called `own_name` where it was given no name.
    pub fn target<'a>(&'a self, own_name: &'a str) -> Option<MorphTarget<'a>> {
        let name = self.as_morph.as_deref()?;
        Some(MorphTarget {
            name: if name.is_empty() { own_name } else { name },
            weight: self.morph_weight,
        })
    }
}

#[derive(Args, Debug)]
pub(crate) struct TransferArguments {
    /// The mesh that has the pose, at rest: glb, gltf, obj, ply, stl or off
    pub source: PathBuf,
    /// The same vertices and triangles in the pose
    pub pose: PathBuf,
    /// The mesh that is to take it on
    pub target: PathBuf,
    /// The file to write; its extension tells its format
    #[arg(long, value_name = "OUT")]
    pub output: PathBuf,
    /// Which triangles of SOURCE and TARGET belong together, numbered from 0: {"triangles": [[SOURCE, TARGET], ..]}.
    /// Without it, both must have the same triangles
    #[arg(long, value_name = "PAIRS.json")]
    pub correspondences: Option<PathBuf>,
    /// As a shape or as a morph target.
    #[command(flatten)]
    pub morph: MorphArguments,
    /// Which vertices are one.
    #[command(flatten)]
    pub weld: WeldArguments,
    /// On how many threads, and with which vectors.
    #[command(flatten)]
    pub compute: ComputeArguments,
}

#[derive(Args, Debug)]
pub(crate) struct MergeArguments {
    /// The file that stays where it is: glb, gltf, obj, ply, stl or off
    pub first: PathBuf,
    /// The file that is put onto it
    pub second: PathBuf,
    /// What to delete of both, and which places belong together
    #[arg(long, value_name = "JOINS.json")]
    pub joins: PathBuf,
    /// Where to write, and what may be replaced.
    #[command(flatten)]
    pub output: NewShapeArguments,
    /// Which vertices are one.
    #[command(flatten)]
    pub weld: WeldArguments,
    /// On how many threads, and with which vectors.
    #[command(flatten)]
    pub compute: ComputeArguments,
}

#[derive(Args, Debug)]
pub(crate) struct FillArguments {
    /// The file with holes: glb, gltf, obj, ply, stl or off
    pub file: PathBuf,
    /// Fill the N longest holes alone; without it and --at, every hole
    #[arg(long, value_name = "N", conflicts_with = "at", value_parser = RangedU64ValueParser::<usize>::new().range(1..=100_000_000))]
    pub largest: Option<usize>,
    /// Fill the hole whose rim passes this vertex of the file alone
    #[arg(long, value_name = "VERTEX")]
    pub at: Option<u32>,
    /// Where to write, and what may be replaced.
    #[command(flatten)]
    pub output: NewShapeArguments,
    /// Which vertices are one.
    #[command(flatten)]
    pub weld: WeldArguments,
    /// On how many threads, and with which vectors.
    #[command(flatten)]
    pub compute: ComputeArguments,
}

#[derive(Args, Debug)]
pub(crate) struct CutArguments {
    /// The file to cut: glb, gltf, obj, ply, stl or off
    pub file: PathBuf,
    /// The vertices to delete, as a selector of the edit format
    #[arg(long, value_name = "SELECTOR.json")]
    pub delete: PathBuf,
    /// Where to write, and what may be replaced.
    #[command(flatten)]
    pub output: NewShapeArguments,
    /// Which vertices are one.
    #[command(flatten)]
    pub weld: WeldArguments,
    /// On how many threads, and with which vectors.
    #[command(flatten)]
    pub compute: ComputeArguments,
}

#[derive(Args, Debug)]
pub(crate) struct FlowArguments {
    /// The file along whose surface dye flows: glb, gltf, obj, ply, stl or off
    pub file: PathBuf,
    /// The dye, the velocities and the forces
    #[arg(long, value_name = "FLOW.json")]
    pub flow: PathBuf,
    /// The file to write; its extension tells its format. With -#### before the extension, a file for the start and for
    /// each step, with its number
    #[arg(long, value_name = "OUT")]
    pub output: PathBuf,
    /// Where to write how the flow went and how long it took
    #[arg(long, value_name = "REPORT.json")]
    pub report: Option<PathBuf>,
    /// The most memory that the pressure's factor may take beside the mesh, such as 8GB or 500MB; without it 16GiB, and
    /// never more than the machine has left
    #[arg(long, value_name = "SIZE", value_parser = pliant_engine::memory::bytes)]
    pub memory: Option<u64>,
    /// Which vertices are one.
    #[command(flatten)]
    pub weld: WeldArguments,
    /// On how many threads, and with which vectors.
    #[command(flatten)]
    pub compute: ComputeArguments,
}

/// Where a new shape goes.
#[derive(Args, Debug)]
pub(crate) struct NewShapeArguments {
    /// The file to write; its extension tells its format
    #[arg(long, value_name = "OUT")]
    pub output: PathBuf,
    /// Where to write what was done
    #[arg(long, value_name = "REPORT.json")]
    pub report: Option<PathBuf>,
    /// OUT may be the file that is read; the original is kept beside it
    #[arg(long)]
    pub replace: bool,
}

impl NewShapeArguments {
    /// Whether OUT may be the file that is read.
    pub fn replace(&self) -> Replace {
        match self.replace {
            true => Replace::WithOriginalKept,
            false => Replace::Never,
        }
    }
}

#[derive(Args, Debug)]
pub(crate) struct CompareArguments {
    /// The file to bend: glb, gltf, obj, ply, stl or off
    pub file: PathBuf,
    /// The edit
    #[arg(long, value_name = "EDIT.json")]
    pub edit: PathBuf,
    /// The methods to compare, divided by commas, or `all` of them; each is NAME[:OPTION=VALUE..]. The edit's own keeps
    /// the edit's options where it is given by its name alone
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', required = true, num_args = 1)]
    pub methods: Vec<String>,
    /// The picture to write: a cell for each method
    #[arg(long, value_name = "SHEET.png")]
    pub output: PathBuf,
    /// Where to write each method's report
    #[arg(long, value_name = "REPORT.json")]
    pub report: Option<PathBuf>,
    /// Replay the edit as a drag of N frames (1 to 100000) instead of one solve
    #[arg(long, value_name = "N", value_parser = RangedU64ValueParser::<usize>::new().range(1..=100_000))]
    pub frames: Option<usize>,
    /// The picture's size in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1600x1000")]
    pub size: PictureSize,
    /// From where, and in which colours.
    #[command(flatten)]
    pub look: LookArguments,
    /// Which vertices are one.
    #[command(flatten)]
    pub weld: WeldArguments,
    /// On how many threads, and with which vectors.
    #[command(flatten)]
    pub compute: ComputeArguments,
}

/// What is computed with. The result is the same whatever it is.
#[derive(Args, Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct ComputeArguments {
    /// How many threads to use (at most four a core); without it, all cores. The result is the same whatever their
    /// number
    #[arg(long, value_name = "N", value_parser = RangedU64ValueParser::<usize>::new().range(1..=65_536))]
    pub threads: Option<usize>,
    /// Which of the processor's vectors to use: avx512, avx2 or baseline; without it, the widest. The result is the
    /// same whichever they are
    #[arg(long, value_name = "VECTORS", value_parser = vectors)]
    pub vectors: Option<Vectors>,
}

/// Vectors by name.
fn vectors(name: &str) -> Result<Vectors, String> {
    Vectors::from_name(name).ok_or_else(|| {
        let names = Vectors::ALL.map(Vectors::name).join(", ");
        format!("there are {names}")
    })
}

/// From where a picture looks, and in which colours.
#[derive(Args, Clone, Copy, PartialEq, Eq, Debug)]
pub struct LookArguments {
    /// The axis that points up
    #[arg(long, value_enum, default_value = "y")]
    pub up: Up,
    /// From where to look
    #[arg(long, value_enum, default_value = "three-quarter")]
    pub view: View,
    /// How to colour the surface
    #[arg(long, value_enum, default_value = "clay")]
    pub shading: Shading,
}

/// What `pliant render` draws, and how.
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
    /// From where, and in which colours.
    #[command(flatten)]
    pub look: LookArguments,
    /// Which clay `--shading clay` and `regions` take
    #[arg(long, default_value = "clay", value_parser = clay())]
    pub clay: Clay,
    /// How depth looks
    #[arg(long, value_enum, default_value = "perspective")]
    pub projection: ProjectionName,
    /// Show each triangle flat instead of interpolating normals
    #[arg(long)]
    pub flat: bool,
    /// Draw the triangles' edges
    #[arg(long)]
    pub wireframe: bool,
    /// Mark edges where the surface ends, and those that more than two triangles share
    #[arg(long)]
    pub borders: bool,
    /// Outline the edit's handles, and draw the line where the free region meets what is held; `--shading regions` does
    /// so, too
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
    /// Write N pictures all around the up axis (2 to 9999), as OUT-0001.png and so on
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=9999))]
    pub turntable: Option<u32>,
    /// Which vertices are one.
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

/// From where a picture looks.
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

/// How a picture colours the surface.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum Shading {
    /// Clay: shape and nothing else
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

/// How depth looks in a picture.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum ProjectionName {
    Perspective,
    Orthographic,
}

/// A picture's size in pixels, 1 to 16384 each way.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PictureSize {
    /// How wide.
    pub width: u32,
    /// How high.
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

fn length(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|number: &f64| number.is_finite() && *number >= 0.0)
        .ok_or_else(|| "a distance is a number from 0".to_owned())
}

fn unit_number(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|number| (0.0..=1.0).contains(number))
        .ok_or_else(|| "a weight is a number from 0 to 1".to_owned())
}

/// Reads the arguments, the program's name first. The error may be the help that was requested.
pub(crate) fn parse(arguments: Vec<std::ffi::OsString>) -> Result<Arguments, clap::Error> {
    Arguments::from_arg_matches(&definition().try_get_matches_from(arguments)?)
}

/// The definition of the command line, with the methods in the help of `apply`.
pub(crate) fn definition() -> clap::Command {
    Arguments::command().mut_subcommand("apply", |apply| apply.after_help(methods_help()))
}

/// Each method with its options, for the help.
fn methods_help() -> String {
    let mut help = "Methods and their options, as they stand in the edit's `method`:".to_owned();
    for declaration in METHODS {
        help += &format!("\n  {}: {}", declaration.name, declaration.when_to_use);
        let default = (declaration.default)();
        for option in declaration.options {
            if let Some(default) = default.value(option.name) {
                help += &format!("\n      {}: {}", option.name, option.sentence(default));
            }
        }
        for attachment in declaration.attachments {
            help += &format!("\n      {}: {}", attachment.name, attachment.help);
        }
    }
    let heeding = |kind: ConstraintKind| {
        let methods = METHODS.iter().filter(|declaration| declaration.heeds(kind));
        methods
            .map(|declaration| declaration.name)
            .collect::<Vec<_>>()
            .join(", ")
    };
    let (soft, joints) = (
        heeding(ConstraintKind::SoftHandles),
        heeding(ConstraintKind::Continuity),
    );
    help + &format!(
        "\n\nWhat holds the surface, as members of the edit:\n  \
         handles[].soft ({soft}): weight of a handle that only pulls, 1e-6 to 1e6; at 1 handle and surface give way to \
         each other; without it the handle holds exactly\n  \
         handles[].continuity ({joints}): how the surface joins this handle, 0 a hinge, 1 equal tangents, 2 equal \
         curvature, or between; at most the order less 1; default 2\n  \
         continuity ({joints}): the same for all that is held: a number, or a list of {{\"select\": .., \"value\": ..}} \
         in which the later entry wins"
    )
}

/// A refusal of arguments as one line, in which arguments are as short as names in other refusals.
pub(crate) fn one_line(error: &clap::Error) -> String {
    let mut text = error.render().to_string();
    for (_, value) in error.context() {
        if let ContextValue::String(argument) = value {
            // The argument may be contained in another one, which then is already short.
            text = text.replace(argument, &quoted(argument));
        }
    }
    let mut line = String::new();
    for part in text
        .lines()
        .map(str::trim)
        .take_while(|part| !part.starts_with("Usage:"))
    {
        if part.is_empty() || part.starts_with("For more information") {
            continue;
        }
        let part = part.strip_prefix("error: ").unwrap_or(part);
        if let Some(tip) = part.strip_prefix("tip: ") {
            line += "; ";
            line += tip;
        } else {
            if !line.is_empty() {
                line.push(' ');
            }
            line += part;
        }
    }
    line + "; see `pliant --help`"
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    fn parse_words(line: &str) -> Result<Arguments, clap::Error> {
        parse(line.split_whitespace().map(Into::into).collect())
    }

    #[test]
    fn the_arguments_are_sound() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn a_bare_file_is_for_the_window_and_a_command_is_itself() {
        assert_eq!(parse_words("pliant scan.glb").unwrap().file, Some("scan.glb".into()));
        assert!(parse_words("pliant").unwrap().command.is_none());
        assert!(matches!(
            parse_words("pliant info a.ply --json").unwrap().command,
            Some(Command::Info(_))
        ));
    }

    #[test]
    fn a_picture_has_the_size_that_was_asked_for() {
        let line = "pliant render a.ply --output a.png --size 64x48 --up z --view three-quarter --shading regions";
        let Some(Command::Render(render)) = parse_words(line).unwrap().command else {
            panic!("not a render")
        };
        assert_eq!(render.size, PictureSize { width: 64, height: 48 });
        for size in ["64", "0x48", "ax3", "64x48x2", "99999x2"] {
            assert!(size.parse::<PictureSize>().is_err(), "{size}");
        }
    }

    #[test]
    fn every_refusal_is_one_line_that_names_the_culprit() {
        for (line, culprit) in [
            ("pliant apply a.ply --output b.ply", "--edit"),
            ("pliant apply a.ply --edit e.json --output b.ply --frames 0", "--frames"),
            (
                "pliant apply a.ply --edit e.json --output b.ply --threads none",
                "--threads",
            ),
            ("pliant apply a.ply --edit e.json --output b.ply --frame 3", "--frame"),
            ("pliant render a.ply --output a.png --view behind", "behind"),
            ("pliant info a.ply --weld=-0.1", "--weld"),
            ("pliant apply a.ply --edit e.json --output b.ply --weld wide", "--weld"),
            ("pliant a.ply b.ply", "b.ply"),
        ] {
            let said = one_line(&parse_words(line).unwrap_err());
            assert!(!said.contains('\n') && said.contains(culprit), "{line}: {said}");
        }
    }

    #[test]
    fn the_help_of_apply_lists_every_method() {
        let help = parse_words("pliant apply --help").unwrap_err().render().to_string();
        assert!(METHODS.iter().all(|method| help.contains(method.name)), "{help}");
    }
}
