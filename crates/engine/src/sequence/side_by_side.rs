//! Frames of a sequence that are read side by side.

use rayon::prelude::*;

use crate::EngineError;
use crate::watch::Watch;

/// Reads frames in groups as large as the pool, so that only as many shapes are in memory, and gives what each yields, in
/// their order.
///
/// # Errors
/// The first refusal in the order of frames; [`EngineError::Interrupted`].
pub(super) fn side_by_side<T: Send>(
    frames: &[usize],
    of_frame: impl Fn(usize) -> Result<T, EngineError> + Sync,
    watch: &Watch,
) -> Result<Vec<T>, EngineError> {
    let progress = watch.begin("following the frames");
    let mut all = Vec::new();
    for group in frames.chunks(rayon::current_num_threads().max(1)) {
        let read: Vec<Result<T, EngineError>> = group
            .par_iter()
            .map(|frame| {
                watch.cancel.check().map_err(|_| EngineError::Interrupted)?;
                of_frame(*frame)
            })
            .collect();
        for read in read {
            all.push(read?);
        }
        progress.set(all.len() as f32 / frames.len() as f32);
    }
    Ok(all)
}
