//! The command line's arguments.

use std::path::PathBuf;

use clap::builder::RangedU64ValueParser;
use clap::error::ContextValue;
use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
use pliant_deform::{ConstraintKind, METHODS};
use pliant_io::{MorphDeltas, MorphTarget, quoted};

use super::motion_arguments::{AnimateArguments, SequenceArguments};
use super::picture_arguments::{CompareArguments, RenderArguments};
use super::shared_arguments::{BendingArguments, ComputeArguments, WeldArguments};
use super::stitch_arguments::{BridgeArguments, CutArguments, FillArguments, MergeArguments};
use crate::version::VERSION;

/// Bends scanned meshes.
#[derive(Parser, Debug)]
#[command(
    name = "pliant",
    version = VERSION,
    about = "Bends scanned meshes: opens glb, gltf, obj, ply, stl, off, 3mf and usdz files and saves them back, changing \
             only the shape",
    args_conflicts_with_subcommands = true,
    disable_help_subcommand = true
)]
pub(crate) struct Arguments {
    /// The file to open in the window, or the folder or point cache of a sequence; by default the built-in sample
    pub file: Option<PathBuf>,
    /// Open the window with this edit on FILE
    #[arg(long, value_name = "EDIT.json", requires = "file")]
    pub edit: Option<PathBuf>,
    #[command(subcommand)]
    pub command: Option<Command>,
}

#[derive(Subcommand, Debug)]
pub(crate) enum Command {
    /// List a file's contents and its mesh's faults
    Info(InfoArguments),
    /// Apply an edit to a file
    Apply(ApplyArguments),
    /// Draw a file as a picture
    Render(RenderArguments),
    /// Draw one edit by several methods into one picture, with figures
    Compare(CompareArguments),
    /// List the differences between two files
    Diff(DiffArguments),
    /// Put a pose of one mesh onto another
    Transfer(TransferArguments),
    /// Put a part of one file onto another, without a crack
    Merge(MergeArguments),
    /// Fill holes with new triangles
    Fill(FillArguments),
    /// Join two borders of a file by a tube
    Bridge(BridgeArguments),
    /// Delete vertices with the triangles that use them, or cut along a plane
    Cut(CutArguments),
    /// Bend the file over time, by the keys of an edit, and save an animated glTF, a point cache or a file for each frame
    Animate(AnimateArguments),
    /// Edit a sequence of files of the same vertices and faces, by keys that spread over the frames around them
    Sequence(SequenceArguments),
    /// Let dye flow along the surface and save it as vertex colours
    Flow(FlowArguments),
    /// Serve an assistant by the Model Context Protocol on standard input and output
    Mcp,
    /// Write man pages, shell completions and the manual's pages of commands
    Generate(GenerateArguments),
}

#[derive(Args, Debug)]
pub(crate) struct GenerateArguments {
    /// The output folder, which is made if it is missing
    pub folder: PathBuf,
}

#[derive(Args, Debug)]
pub(crate) struct InfoArguments {
    /// The file: glb, gltf, obj, ply, stl, off, 3mf or usdz
    pub file: PathBuf,
    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,
    /// The welding of vertices.
    #[command(flatten)]
    pub weld: WeldArguments,
}

#[derive(Args, Debug)]
pub(crate) struct DiffArguments {
    /// The first file: glb, gltf, obj, ply, stl, off, 3mf or usdz
    pub first: PathBuf,
    /// The second file
    pub second: PathBuf,
    /// Print JSON instead of text
    #[arg(long)]
    pub json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct ApplyArguments {
    /// The file to bend: glb, gltf, obj, ply, stl, off, 3mf or usdz
    pub file: PathBuf,
    /// The edit: regions, handles with transforms, curves or sketches, and a method; or a .pliant project
    #[arg(long, value_name = "EDIT.json")]
    pub edit: PathBuf,
    /// The file to write; its extension tells its format
    #[arg(long, value_name = "OUT")]
    pub output: PathBuf,
    /// Write a report to this file: times, iterations, distortion and warnings
    #[arg(long, value_name = "REPORT.json")]
    pub report: Option<PathBuf>,
    /// The kind of the output.
    #[command(flatten)]
    pub morph: MorphArguments,
    /// Replay the edit as a drag of N frames (1 to 100000) instead of one solve
    #[arg(long, value_name = "N", value_parser = RangedU64ValueParser::<usize>::new().range(1..=100_000))]
    pub frames: Option<usize>,
    /// The bending.
    #[command(flatten)]
    pub bending: BendingArguments,
}

/// The kind of the output: a shape or a morph target.
#[derive(Args, Debug)]
pub(crate) struct MorphArguments {
    /// Keep the shape and save the new one as a morph target with this name (by default the name of the edit's or the
    /// pose's file); OUT must be glb or gltf
    #[arg(long, value_name = "NAME", num_args = 0..=1, default_missing_value = "")]
    pub as_morph: Option<String>,
    /// The morph target's default weight, from 0 to 1
    #[arg(long, value_name = "W", default_value = "1", requires = "as_morph", value_parser = unit_number)]
    pub morph_weight: f64,
    /// Turn the deltas of the file's own morph targets with the surface, or keep them: `turn` or `stay`. By default
    /// they turn if they would otherwise be wrong by more than 30 degrees
    #[arg(long, value_name = "HOW", conflicts_with = "as_morph")]
    pub morph_deltas: Option<Deltas>,
}

/// The deltas of morph targets under an edit.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Deltas {
    /// They turn with the surface.
    Turn,
    /// They stay as they are stored.
    Stay,
}

impl MorphArguments {
    /// The choice for the deltas of the file's own morph targets.
    pub fn deltas(&self) -> MorphDeltas {
        match self.morph_deltas {
            None => MorphDeltas::WhereFarOff,
            Some(Deltas::Turn) => MorphDeltas::Turn,
            Some(Deltas::Stay) => MorphDeltas::Stay,
        }
    }

    /// The morph target to add, with the name `own_name` if the arguments give none.
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
    /// The mesh that has the pose, at rest: glb, gltf, obj, ply, stl, off, 3mf or usdz
    pub source: PathBuf,
    /// The same vertices and triangles in the pose
    pub pose: PathBuf,
    /// The mesh that takes on the pose
    pub target: PathBuf,
    /// The file to write; its extension tells its format
    #[arg(long, value_name = "OUT")]
    pub output: PathBuf,
    /// The pairs of corresponding triangles, numbered from 0: {"triangles": [[SOURCE, TARGET], ..]}. Without it, both
    /// must have the same triangles
    #[arg(long, value_name = "PAIRS.json")]
    pub correspondences: Option<PathBuf>,
    /// The kind of the output.
    #[command(flatten)]
    pub morph: MorphArguments,
    /// The welding of vertices.
    #[command(flatten)]
    pub weld: WeldArguments,
    /// The threads and vectors.
    #[command(flatten)]
    pub compute: ComputeArguments,
}

#[derive(Args, Debug)]
pub(crate) struct FlowArguments {
    /// The file along whose surface dye flows: glb, gltf, obj, ply, stl, off, 3mf or usdz
    pub file: PathBuf,
    /// The dye, the velocities and the forces
    #[arg(long, value_name = "FLOW.json")]
    pub flow: PathBuf,
    /// The file to write; its extension tells its format. With -#### before the extension, a file for the start and for
    /// each step, with its number
    #[arg(long, value_name = "OUT")]
    pub output: PathBuf,
    /// The file for the flow's figures and times
    #[arg(long, value_name = "REPORT.json")]
    pub report: Option<PathBuf>,
    /// The most memory for the pressure's factor beside the mesh, such as 8GB or 500MB; without it 16GiB, and never more
    /// than the machine has left
    #[arg(long, value_name = "SIZE", value_parser = pliant_engine::memory::bytes)]
    pub memory: Option<u64>,
    /// The welding of vertices.
    #[command(flatten)]
    pub weld: WeldArguments,
    /// The threads and vectors.
    #[command(flatten)]
    pub compute: ComputeArguments,
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
pub(super) fn methods_help() -> String {
    let mut help = "Methods and their options, as members of the edit's `method`:".to_owned();
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
        "\n\nConstraints, as members of the edit:\n  \
         handles[].soft ({soft}): weight of a handle that only pulls, 1e-6 to 1e6; at 1 handle and surface yield \
         equally; without it the handle is exact\n  \
         handles[].free_along (methods with an energy): direction along which the handle slides to where the energy is \
         least; without it the handle is held in all directions\n  \
         handles[].continuity ({joints}): smoothness of the surface at this handle, 0 for a hinge, 1 for equal \
         tangents, 2 for equal curvature, or between; at most the order less 1; default 2\n  \
         continuity ({joints}): the same for all handles and fixed vertices: a number, or a list of \
         {{\"select\": .., \"value\": ..}} in which the later entry wins"
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
