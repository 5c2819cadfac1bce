//! The thin plate by its own factor and by the Laplacian's, with the example `capacitance` of `deform`.

use super::meshes::creature_off;
use super::scale::Scale;
use super::table::{Row, measured};

/// Two rows for each size, on all threads: the own factor and the Laplacian's. Only one if the own factor is not
/// measured.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    // The number of subdivisions of a mesh of 50,000 vertices, and the measured factors.
    let sizes: &[(u32, &[&str])] = match scale {
        Scale::Usual => &[(0, &["factor", "laplacian"]), (1, &["factor", "laplacian"])],
        Scale::Full => &[
            (0, &["factor", "laplacian"]),
            (1, &["factor", "laplacian"]),
            (2, &["factor", "laplacian"]),
            (3, &["laplacian"]),
        ],
    };
    let all = std::thread::available_parallelism().map_or(1, usize::from).to_string();
    let file = creature_off(50_000)?.display().to_string();
    let mut rows = Vec::new();
    for &(times, factors) in sizes {
        // Each runs in a separate process, so that its peak of memory is its own.
        for &factor in factors {
            let arguments = [file.clone(), all.clone(), times.to_string(), factor.to_owned()];
            rows.extend(measured("pliant-deform", "capacitance", &arguments)?);
        }
    }
    Ok(rows)
}
