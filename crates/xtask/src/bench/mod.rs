//! `cargo xtask bench`: measurements as tables, on creatures of several sizes, kept as JSON in `target/bench`.
//!
//! To add a section, write an example in the measured crate that prints flat JSON objects (strings and numbers), one
//! per line; add a module to `bench` that runs it with [`table::measured`] on the meshes of [`meshes`] and returns
//! rows; and list it in [`SECTIONS`]. Printing and saving happen here.

mod arap;
mod beside;
mod capacitance;
mod chart;
mod cholesky;
mod differential;
mod editor;
mod files;
mod flow;
mod frames;
mod growth;
mod linear;
mod machine;
mod meshes;
mod peers;
mod primo;
pub mod scale;
mod scenes;
mod shells;
mod space;
mod start;
mod table;
mod vectors;
mod view;

use scale::Scale;
use table::Row;

/// A section: one table.
struct Section {
    name: &'static str,
    title: &'static str,
    rows: fn(Scale) -> Result<Vec<Row>, String>,
}

const SECTIONS: &[Section] = &[
    Section {
        name: "linear",
        title: "The bi-Laplacian, step by step: milliseconds, medians; megabytes",
        rows: linear::rows,
    },
    Section {
        name: "cholesky",
        title: "Sparse Cholesky beside faer's, same order and threads: milliseconds, medians; megabytes",
        rows: cholesky::rows,
    },
    Section {
        name: "capacitance",
        title: "Binding by the thin plate's own factor (power 2) and by the Laplacian's (power 1): seconds; megabytes; distance in diagonals",
        rows: capacitance::rows,
    },
    Section {
        name: "growth",
        title: "Ordering and binding from 50 thousand to 5 million free vertices, by either factor: seconds; megabytes",
        rows: growth::rows,
    },
    Section {
        name: "frames",
        title: "Binding and drag frames: `pliant apply --frames 60 --report` of assets/creature.edit.json, milliseconds",
        rows: frames::rows,
    },
    Section {
        name: "primo",
        title: "Coupled prisms on the survey's scenes, from the rest shape to within 1% of the minimal energy: milliseconds",
        rows: primo::rows,
    },
    Section {
        name: "arap",
        title: "As-rigid-as-possible compared with libigl: milliseconds; energies without unit; distances in diagonals",
        rows: arap::rows,
    },
    Section {
        name: "shells",
        title: "Discrete shells beside a direct Gauss–Newton in Python: milliseconds; energies without unit",
        rows: shells::rows,
    },
    Section {
        name: "differential",
        title: "The differential methods and details beside the bi-Laplacian, medians of a drag: milliseconds; binding as a multiple of its",
        rows: differential::rows,
    },
    Section {
        name: "space",
        title: "The methods that bend space, medians of a drag, beside Blender's: milliseconds",
        rows: space::rows,
    },
    Section {
        name: "flow",
        title: "Dye on a bumpy torus, second-order steps of a sixtieth of a second: milliseconds, medians; megabytes",
        rows: flow::rows,
    },
    Section {
        name: "scenes",
        title: "Every method on the survey's scenes and on limbs of scans: steps, triangles turned over, ratios of edges and volume, the handles' residual in diagonals",
        rows: scenes::rows,
    },
    Section {
        name: "vectors",
        title: "The same with each of the processor's vectors: milliseconds, medians",
        rows: vectors::rows,
    },
    Section {
        name: "files",
        title: "Reading and saving, compared with a plain read of the file: megabytes per second, medians",
        rows: files::rows,
    },
    Section {
        name: "view",
        title: "Drawing at 1280×800, moving and picking: milliseconds, medians; CPU time and GPU time",
        rows: view::rows,
    },
    Section {
        name: "editor",
        title: "Events on 400k triangles, without drawing and jobs: milliseconds; a hundred strokes: megabytes",
        rows: editor::rows,
    },
    Section {
        name: "start",
        title: "From the process' start to the window and to the first picture of a file, on the software device: milliseconds, medians",
        rows: start::rows,
    },
    Section {
        name: "peers",
        title: "The same edit of horse.ply by other programs, in the same run: milliseconds",
        rows: peers::rows,
    },
];

/// Runs the sections in `names`, or all if it is empty; prints and saves their tables.
///
/// # Errors
/// One sentence naming an unknown section or the failure.
pub fn bench(names: &[String], scale: Scale) -> Result<(), String> {
    if let Some(name) = names
        .iter()
        .find(|name| SECTIONS.iter().all(|section| section.name != name.as_str()))
    {
        let known = SECTIONS
            .iter()
            .map(|section| section.name)
            .collect::<Vec<_>>()
            .join(", ");
        return Err(format!("There is no section `{name}`; there are: {known}."));
    }
    for section in SECTIONS
        .iter()
        .filter(|section| names.is_empty() || names.iter().any(|name| name == section.name))
    {
        println!("\n{}: {}", section.name, section.title);
        let rows = (section.rows)(scale)?;
        table::print(&rows);
        table::keep(section.name, &rows)?;
    }
    println!("\nkept in {}", table::folder().display());
    Ok(())
}
