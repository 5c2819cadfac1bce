//! The threads and the vectors of a command.

use pliant_engine::EngineError;
use pliant_mesh::Vectors;

use super::shared_arguments::ComputeArguments;

/// The most threads per core: more cost memory and gain nothing.
const MOST_THREADS_A_CORE: usize = 4;

/// Runs `work` on a pool of its own, with the requested number of threads and the requested vectors.
pub(super) fn on_threads<T: Send>(asked: ComputeArguments, work: impl FnOnce() -> T + Send) -> Result<T, EngineError> {
    let ComputeArguments { threads, vectors } = asked;
    if let Some(vectors) = vectors.filter(|vectors| !vectors.choose()) {
        let others = Vectors::ALL.into_iter().filter(|other| other.is_available());
        let others: Vec<&str> = others.map(Vectors::name).collect();
        return Err(EngineError::Arguments(format!(
            "--vectors {}: this processor does not have these vectors; leave it out, or give {}",
            vectors.name(),
            others.join(" or ")
        )));
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let most = MOST_THREADS_A_CORE * cores;
    if let Some(threads) = threads.filter(|&threads| threads > most) {
        return Err(EngineError::Arguments(format!(
            "--threads {threads} is more than four for each of this machine's cores: give at most {most}"
        )));
    }
    let mut builder = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = threads {
        builder = builder.num_threads(threads);
    }
    let pool = builder.build().map_err(|error| {
        EngineError::System(format!(
            "the threads can't be started ({error}): give a smaller --threads"
        ))
    })?;
    Ok(pool.install(work))
}
