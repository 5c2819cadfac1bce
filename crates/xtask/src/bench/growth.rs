//! The growth of binding with the mesh, by the thin plate's own factor and by the Laplacian's, with the example
//! `capacitance` of `deform`: a table, and with the large meshes the picture `bench/growth.svg`.

use super::chart::{Limit, Line, Panel, chart};
use super::machine::machine;
use super::meshes::creature_off;
use super::scale::Scale;
use super::table::{self, Row, measured};

/// The meshes: vertices, and the number of subdivisions of each.
const USUAL: &[(usize, u32)] = &[(50_000, 0), (50_000, 1)];
const FULL: &[(usize, u32)] = &[(50_000, 0), (50_000, 1), (50_000, 2), (83_000, 3)];

/// The name of each way in the example and in the picture, and its colour.
const WAYS: [(&str, &str, &str); 2] = [
    ("factor", "own factor", "#b4552d"),
    ("laplacian", "the Laplacian's factor", "#2d6fb4"),
];

/// The limits at this many free vertices: seconds to bind, and bytes.
const LIMITS: (f64, f64, f64) = (5e6, 60.0, 10e9);

/// One row for each mesh and way, on all threads. Measurements of an interrupted run are taken from
/// `target/bench/growth.json`; without that file everything is measured again.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    let meshes = match scale {
        Scale::Usual => USUAL,
        Scale::Full => FULL,
    };
    let all = std::thread::available_parallelism().map_or(1, usize::from).to_string();
    let mut rows = table::kept("growth");
    for &(vertices, times) in meshes {
        let file = creature_off(vertices)?;
        let mesh = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for (way, ..) in WAYS {
            let is_it = |row: &Row| {
                let is = |name: &str, value: &str| row.get(name).is_some_and(|own| own.trim_matches('"') == value);
                is("way", way) && is("mesh", &mesh) && is("subdivided", &times.to_string())
            };
            if rows.iter().any(is_it) {
                continue;
            }
            // Each runs in a separate process, so that its peak of memory is its own.
            let arguments = [
                file.display().to_string(),
                all.clone(),
                times.to_string(),
                way.to_owned(),
            ];
            let measured = measured("pliant-deform", "capacitance", &arguments)?;
            rows.extend(measured.into_iter().map(|row| Row::default().text("way", way).and(row)));
            table::keep("growth", &rows)?;
        }
    }
    rows.sort_by(|a, b| number(a, "free").total_cmp(&number(b, "free")));
    if scale == Scale::Full {
        table::write(&crate::root::root().join("bench/growth.svg"), picture(&rows).as_bytes())?;
    }
    Ok(rows)
}

fn number(row: &Row, name: &str) -> f64 {
    row.get(name).and_then(|value| value.parse().ok()).unwrap_or(f64::NAN)
}

fn picture(rows: &[Row]) -> String {
    let lines = |value: fn(&Row) -> f64| -> Vec<Line> {
        let line = |(way, name, colour): (&str, &'static str, &'static str)| Line {
            name,
            colour,
            points: rows
                .iter()
                .filter(|row| row.get("way").is_some_and(|own| own.trim_matches('"') == way))
                .map(|row| [number(row, "free"), value(row)])
                .collect(),
        };
        WAYS.into_iter().map(line).collect()
    };
    let (free, seconds, bytes) = LIMITS;
    let limit = |value: f64, name: &str| Limit {
        at: [free, value],
        name: name.to_owned(),
    };
    let panels = [
        Panel {
            title: "Ordering and binding, microseconds a free vertex",
            lines: lines(|row| 1e6 * (number(row, "order_s") + number(row, "bind_s")) / number(row, "free")),
            limit: limit(1e6 * seconds / free, "60 s"),
        },
        Panel {
            title: "Most memory beyond the mesh, bytes a free vertex",
            lines: lines(|row| 1024.0 * 1024.0 * number(row, "peak_mb") / number(row, "free")),
            limit: limit(bytes / free, "10 GB"),
        },
    ];
    chart(&panels, "free vertices", &machine())
}
