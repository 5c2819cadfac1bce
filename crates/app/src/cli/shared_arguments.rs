//! Arguments that several commands have.

use std::path::Path;

use clap::Args;
use clap::builder::RangedU64ValueParser;
use pliant_deform::Budget;
use pliant_editor::Beginning;
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, memory, read_edit};
use pliant_mesh::{Vectors, WeldOptions};

use super::method_argument::method_argument;

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

/// The bending by an edit.
#[derive(Args, Debug)]
pub(crate) struct BendingArguments {
    /// Use this method instead of the edit's, with its defaults or with options set: NAME[:OPTION=VALUE..]
    #[arg(long, value_name = "NAME")]
    pub method: Option<String>,
    /// The most memory for binding, beside the mesh, such as 8GB or 500MB; by default 16GiB, and at most the free
    /// memory. A larger system is solved with less memory in more time, or refused
    #[arg(long, value_name = "SIZE", value_parser = pliant_engine::memory::bytes)]
    pub memory: Option<u64>,
    /// The welding of vertices.
    #[command(flatten)]
    pub weld: WeldArguments,
    /// The threads and vectors.
    #[command(flatten)]
    pub compute: ComputeArguments,
}

impl BendingArguments {
    /// Reads an edit, and gives it the method that was asked for.
    ///
    /// # Errors
    /// A method that is not known, or an edit that can't be read.
    pub fn edit(&self, path: &Path, watch: &Watch) -> Result<Beginning, EngineError> {
        let method = self.method.as_deref();
        let method = method.map(|name| method_argument("--method", name)).transpose()?;
        let mut edit = read_edit(path, watch)?;
        if let Some(method) = method {
            edit.set_method(method);
        }
        Ok(edit)
    }

    /// The memory that bindings may take.
    pub fn budget(&self) -> Budget {
        memory::budget_within(self.memory)
    }
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
