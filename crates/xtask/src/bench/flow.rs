//! The steps of a flow, with the example `flow_steps` of `flow`.

use super::scale::Scale;
use super::table::{Row, measured};

/// One row per size, on one thread and on all.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    let all = std::thread::available_parallelism().map_or(1, usize::from).to_string();
    let sizes: &[&str] = match scale {
        Scale::Usual => &["100000"],
        Scale::Full => &["100000", "1000000"],
    };
    let mut rows = Vec::new();
    for &vertices in sizes {
        for threads in ["1", &all] {
            let arguments = [vertices.to_owned(), threads.to_owned()];
            rows.extend(measured("pliant-flow", "flow_steps", &arguments)?);
        }
    }
    Ok(rows)
}
