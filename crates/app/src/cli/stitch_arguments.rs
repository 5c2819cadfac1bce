//! The arguments of the commands that change a file's topology.

use std::path::PathBuf;

use clap::Args;
use clap::builder::RangedU64ValueParser;
use pliant_engine::stitching::Replace;

use super::cut_plane::{KeepArgument, PlaneArgument};
use super::shared_arguments::{ComputeArguments, WeldArguments};

#[derive(Args, Debug)]
pub(crate) struct MergeArguments {
    /// The file that stays where it is: glb, gltf, obj, ply, stl, off, 3mf or usdz
    pub first: PathBuf,
    /// The file that is joined to it
    pub second: PathBuf,
    /// The parts to delete and the places to join
    #[arg(long, value_name = "JOINS.json")]
    pub joins: PathBuf,
    /// The output file and report, and the computation.
    #[command(flatten)]
    pub output: NewShapeArguments,
}

#[derive(Args, Debug)]
pub(crate) struct FillArguments {
    /// The file with holes: glb, gltf, obj, ply, stl, off, 3mf or usdz
    pub file: PathBuf,
    /// Fill only the N longest borders; without it and --at, fill every hole except the outer border of an open sheet
    #[arg(long, value_name = "N", conflicts_with = "at", value_parser = RangedU64ValueParser::<usize>::new().range(1..=100_000_000))]
    pub largest: Option<usize>,
    /// Fill only the border that passes this vertex of the file
    #[arg(long, value_name = "VERTEX")]
    pub at: Option<u32>,
    /// The output file and report, and the computation.
    #[command(flatten)]
    pub output: NewShapeArguments,
}

#[derive(Args, Debug)]
pub(crate) struct BridgeArguments {
    /// The file with the borders: glb, gltf, obj, ply, stl, off, 3mf or usdz
    pub file: PathBuf,
    /// A vertex of each of the two borders to join, by their numbers in the file
    #[arg(long, num_args = 2, value_names = ["VERTEX", "VERTEX"], required = true)]
    pub borders: Vec<u32>,
    /// The output file and report, and the computation.
    #[command(flatten)]
    pub output: NewShapeArguments,
}

#[derive(Args, Debug)]
pub(crate) struct CutArguments {
    /// The file to cut: glb, gltf, obj, ply, stl, off, 3mf or usdz
    pub file: PathBuf,
    /// The vertices to delete, as a selector of the edit format
    #[arg(
        long,
        value_name = "SELECTOR.json",
        required_unless_present_any = ["plane", "curve"],
        conflicts_with_all = ["plane", "curve"]
    )]
    pub delete: Option<PathBuf>,
    /// Cut along the plane of the points p with (NX, NY, NZ) · p = D, in world units, and split the triangles that it
    /// crosses
    #[arg(long, value_name = "NX,NY,NZ,D", allow_hyphen_values = true)]
    pub plane: Option<PlaneArgument>,
    /// Cut along a curve on the surface, and split the triangles under it
    #[arg(long, value_name = "CURVE.json", conflicts_with = "plane")]
    pub curve: Option<PathBuf>,
    /// The side to keep: the one to which (NX, NY, NZ) points, or to the left of the curve seen along it from outside;
    /// the other; or both, whose triangles are only split
    #[arg(long, value_enum, default_value_t = KeepArgument::Positive, conflicts_with = "delete")]
    pub keep: KeepArgument,
    /// The output file and report, and the computation.
    #[command(flatten)]
    pub output: NewShapeArguments,
}

/// The output of a new shape, and its computation.
#[derive(Args, Debug)]
pub(crate) struct NewShapeArguments {
    /// The file to write; its extension tells its format
    #[arg(long, value_name = "OUT")]
    pub output: PathBuf,
    /// Write a report to this file
    #[arg(long, value_name = "REPORT.json")]
    pub report: Option<PathBuf>,
    /// Allow OUT to be an input file; the original is kept beside it
    #[arg(long)]
    pub replace: bool,
    /// The welding of vertices.
    #[command(flatten)]
    pub weld: WeldArguments,
    /// The threads and vectors.
    #[command(flatten)]
    pub compute: ComputeArguments,
}

impl NewShapeArguments {
    /// The choice for an OUT that is an input file.
    pub fn replace(&self) -> Replace {
        match self.replace {
            true => Replace::WithOriginalKept,
            false => Replace::Never,
        }
    }
}
