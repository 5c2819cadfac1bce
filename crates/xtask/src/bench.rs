//! `cargo xtask bench`: measurements as tables, on creatures of several sizes, kept as JSON in `target/bench`.
//!
//! To add a section: an example in the crate that is measured prints one flat JSON object a line (texts and numbers);
//! a module in `bench` with a function from [`Scale`] to rows runs it with [`table::measured`] on the meshes of
//! [`meshes`]; and [`SECTIONS`] names it. Printing and keeping are done here.

mod arap;
mod cholesky;
mod editor;
mod files;
mod frames;
mod linear;
mod meshes;
mod peers;
mod primo;
mod table;
mod view;

use table::Row;

/// How large the meshes get.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Scale {
    /// Up to 200 thousand vertices.
    Usual,
    /// Up to a million and more.
    Full,
}

/// One table.
struct Section {
    name: &'static str,
    title: &'static str,
    rows: fn(Scale) -> Result<Vec<Row>, String>,
}

const SECTIONS: &[Section] = &[
    Section {
        name: "linear",
        title: "The linear shell step by step: milliseconds, medians; megabytes",
        rows: linear::rows,
    },
    Section {
        name: "cholesky",
        title: "Sparse Cholesky beside faer's, same order and threads: milliseconds, medians; megabytes",
        rows: cholesky::rows,
    },
    Section {
        name: "frames",
        title: "Binding and drag frames: `pliant apply --frames 60 --report` of assets/creature.edit.json, milliseconds",
        rows: frames::rows,
    },
    Section {
        name: "primo",
        title: "Coupled prisms on the survey's scenes, from the rest shape to 1% of the least energy: milliseconds",
        rows: primo::rows,
    },
    Section {
        name: "arap",
        title: "As rigid as possible beside libigl: milliseconds; energies without unit; distances in diagonals",
        rows: arap::rows,
    },
    Section {
        name: "files",
        title: "Reading and saving: megabytes a second, beside a plain read of the file; medians",
        rows: files::rows,
    },
    Section {
        name: "view",
        title: "Drawing at 1280×800, moving and asking: milliseconds, medians; the processor's side and the device's own clock",
        rows: view::rows,
    },
    Section {
        name: "editor",
        title: "Events on 400k triangles, drawing and jobs apart: milliseconds; a hundred strokes: megabytes",
        rows: editor::rows,
    },
    Section {
        name: "peers",
        title: "The same edit of horse.ply by others, in the same minute: milliseconds",
        rows: peers::rows,
    },
];

/// Runs the sections that `names` asks for, or all: prints their tables and keeps them.
///
/// # Errors
/// One sentence naming an unknown section or what failed.
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
