//! Arguments that several commands have.

use clap::Args;
use clap::builder::RangedU64ValueParser;
use pliant_mesh::{Vectors, WeldOptions};

/// The welding of a file's vertices.
#[derive(Args, Clone, Copy, PartialEq, Debug, Default)]
pub struct WeldArguments {
    /// Weld vertices that are closer than this, in the file's units; 0 welds only vertices at equal positions. By
    /// default the distance follows from the mesh's edges and the rounding of the file's numbers
    #[arg(long, value_name = "DISTANCE", value_parser = length)]
    pub weld: Option<f64>,
}

impl WeldArguments {
    /// The options of loading.
    pub fn options(self) -> WeldOptions {
        WeldOptions { distance: self.weld }
    }
}

/// The threads and vectors of a computation. They do not change the result.
#[derive(Args, Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct ComputeArguments {
    /// The number of threads, at most four a core; by default all cores. The result does not depend on it
    #[arg(long, value_name = "N", value_parser = RangedU64ValueParser::<usize>::new().range(1..=65_536))]
    pub threads: Option<usize>,
    /// The processor's vectors to use: avx512, avx2 or baseline; by default the widest. The result does not depend on
    /// them
    #[arg(long, value_name = "VECTORS", value_parser = vectors)]
    pub vectors: Option<Vectors>,
}

/// Vectors by name.
fn vectors(name: &str) -> Result<Vectors, String> {
    Vectors::from_name(name).ok_or_else(|| {
        let names = Vectors::ALL.map(Vectors::name).join(", ");
        format!("use {names}")
    })
}

fn length(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|number: &f64| number.is_finite() && *number >= 0.0)
        .ok_or_else(|| "a distance is a number from 0".to_owned())
}
