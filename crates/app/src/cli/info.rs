//! `pliant info`: the contents of a file and the faults of its mesh.

use std::fmt::Write as _;

use super::arguments::InfoArguments;
use super::shared_arguments::ComputeArguments;
use crate::cli::console::{Console, print, print_json};
use crate::cli::threads::on_threads;
use pliant_engine::files::shown;
use pliant_engine::{EngineError, Inspected, inspect};

/// The number of components that are listed one by one.
const LISTED_COMPONENTS: usize = 12;

pub(super) fn run(arguments: &InfoArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let watch = &console.watch;
    let inspected = on_threads(ComputeArguments::default(), || {
        inspect(&arguments.file, arguments.weld.options(), watch)
    })??;
    if arguments.json {
        print_json(console.out, &inspected.to_json())
    } else {
        print(console.out, &as_text(&inspected))
    }
}

/// The report on a file, for a person.
fn as_text(
    Inspected {
        path,
        scene,
        inspection,
    }: &Inspected<'_>,
) -> String {
    let summary = scene.summary();
    let mut text = format!("{}: {}\n", shown(path), scene.format());
    let mut line = |what: &str, said: String| {
        // Writing to a String can't fail.
        let _ = writeln!(text, "  {what:<12}{said}");
    };
    let counts = [
        (summary.meshes, "mesh", "meshes"),
        (summary.primitives, "primitive", "primitives"),
        (summary.nodes, "node", "nodes"),
        (summary.materials, "material", "materials"),
        (summary.images, "image", "images"),
        (summary.skins, "skin", "skins"),
        (summary.animations, "animation", "animations"),
        (summary.morph_targets, "morph target", "morph targets"),
    ];
    let held: Vec<String> = counts
        .iter()
        .filter(|(count, ..)| *count > 0)
        .map(|(count, one, many)| format!("{count} {}", if *count == 1 { one } else { many }))
        .collect();
    if !held.is_empty() {
        line("holds", held.join(", "));
    }
    line(
        "vertices",
        format!(
            "{} in the file, {} drawn, {} welded",
            inspection.file_vertices, inspection.drawn_vertices, inspection.surface_vertices
        ),
    );
    if inspection.surface_vertices == 0 {
        line("triangles", "none: the file has nothing to edit".to_owned());
    } else if inspection.surface_triangles == 0 {
        let space = pliant_deform::Remedy::OfSpace;
        line("triangles", format!("none: {space} bend the points"));
    } else {
        line(
            "triangles",
            format!(
                "{} drawn, {} kept",
                inspection.drawn_triangles, inspection.surface_triangles
            ),
        );
    }
    if inspection.bare_points > 0 {
        line("points", format!("{} that no triangle uses", inspection.bare_points));
    }
    if let Some(bounds) = inspection.bounds {
        let (min, max) = (bounds.min, bounds.max);
        line(
            "bounds",
            format!(
                "{:.6} {:.6} {:.6} to {:.6} {:.6} {:.6}",
                min.x, min.y, min.z, max.x, max.y, max.z
            ),
        );
    }
    let sizes: Vec<usize> = inspection
        .components
        .iter()
        .map(|component| component.vertex_count)
        .collect();
    if !sizes.is_empty() {
        let listed: Vec<String> = sizes.iter().take(LISTED_COMPONENTS).map(usize::to_string).collect();
        let more = if sizes.len() > LISTED_COMPONENTS { ", .." } else { "" };
        line(
            "components",
            format!("{} (vertices: {}{more})", sizes.len(), listed.join(", ")),
        );
    }
    for sentence in inspection.findings.sentences() {
        line("found", sentence);
    }
    for note in scene.notes() {
        line("note", note.clone());
    }
    text
}
