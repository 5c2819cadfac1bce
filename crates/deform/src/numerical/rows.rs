//! Rows of vertices: the number in a task, and the place of a number in one.

/// The rows or faces of one task: fixed, so that results don't depend on the number of threads.
pub(crate) const CHUNK: usize = 1024;

/// The place of `number` in an ascending row. Most rows are short, so a linear search is faster.
pub(crate) fn place_in<T: Ord>(row: &[T], number: &T) -> Option<usize> {
    if row.len() <= 32 {
        row.iter().position(|own| own == number)
    } else {
        row.binary_search(number).ok()
    }
}
