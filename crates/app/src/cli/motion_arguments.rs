//! The arguments of the commands that bend over time.

use std::path::PathBuf;

use clap::Args;
use pliant_engine::MORPH_TOLERANCE;

use super::shared_arguments::BendingArguments;

#[derive(Args, Debug)]
pub(crate) struct AnimateArguments {
    /// The file to bend: glb, gltf, obj, ply, stl, off, 3mf or usdz
    pub file: PathBuf,
    /// The edit, with `keys`: handles' transforms at times
    #[arg(long, value_name = "EDIT.json")]
    pub edit: PathBuf,
    /// The files to write: FILE with an animation of morph targets (glb, gltf), a point cache (pc2, mdd), or
    /// NAME-####.obj and the like, with the frame's number from 0000 on
    #[arg(long, value_name = "OUT")]
    pub output: PathBuf,
    /// The file for the figures: times, and the number and the error of the morph targets
    #[arg(long, value_name = "REPORT.json")]
    pub report: Option<PathBuf>,
    /// The largest error of a glTF's frames, as a share of the diagonal of the shape's box: more of it takes fewer morph
    /// targets
    #[arg(long, value_name = "SHARE", default_value_t = MORPH_TOLERANCE, value_parser = error_share)]
    pub tolerance: f64,
    /// The frames a second
    #[arg(long, value_name = "F", default_value = "24", value_parser = frame_rate)]
    pub fps: f64,
    /// Allow numbered files to replace existing ones
    #[arg(long)]
    pub replace: bool,
    /// The bending.
    #[command(flatten)]
    pub bending: BendingArguments,
}

#[derive(Args, Debug)]
pub(crate) struct SequenceArguments {
    /// The folder of the frames: files of one format with the same vertices and faces, in the order of their names, in
    /// which numbers count by their value; a point cache (pc2, mdd); or a glb or gltf with an animation of morph
    /// targets
    #[arg(value_name = "FOLDER_OR_FILE")]
    pub frames: PathBuf,
    /// The mesh whose vertices a point cache moves
    #[arg(long, value_name = "MESH")]
    pub mesh: Option<PathBuf>,
    /// The edit, with `keys`: handles' transforms at frames, each with the `span` of frames over which it spreads
    #[arg(long, value_name = "EDIT.json")]
    pub edit: PathBuf,
    /// The folder to write, in which frames keep their names; it is made if it is missing. For a point cache the cache to
    /// write, of the same kind. For a glb or gltf an animation as of `pliant animate`
    #[arg(long, value_name = "OUT")]
    pub output: PathBuf,
    /// The file for the numbers of frames and the warnings
    #[arg(long, value_name = "REPORT.json")]
    pub report: Option<PathBuf>,
    /// The frames a second in which a glTF's animation is edited. Without it every key of the animation is a frame: the
    /// rate is the lowest usual one from 24 on at which that is so, and keys at uneven times are frames beside those at 24
    #[arg(long, value_name = "F", value_parser = frame_rate)]
    pub fps: Option<f64>,
    /// Allow numbered files of a glTF's animation to replace existing ones
    #[arg(long)]
    pub replace: bool,
    /// The bending.
    #[command(flatten)]
    pub bending: BendingArguments,
}

fn error_share(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|number| (1e-7..=0.1).contains(number))
        .ok_or_else(|| "a share of the diagonal is a number from 1e-7 to 0.1".to_owned())
}

fn frame_rate(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|number| (0.001..=1000.0).contains(number))
        .ok_or_else(|| "a frame rate is a number from 0.001 to 1000".to_owned())
}
