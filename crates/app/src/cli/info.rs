//! `pliant info`: what a file holds and what is wrong with its mesh.

use std::fmt::Write as _;

use pliant_mesh::{FindingKind, WeldOptions};
use serde_json::{Value, json};

use super::arguments::InfoArguments;
use super::{Console, on_threads, print};
use crate::AppError;
use crate::engine::{self, Loaded};

/// How many components are listed one by one.
const LISTED_COMPONENTS: usize = 12;

pub(super) fn run(arguments: &InfoArguments, console: &mut Console<'_>) -> Result<(), AppError> {
    let watch = &console.watch;
    let loaded = on_threads(None, || engine::load(&arguments.file, &WeldOptions::default(), watch))??;
    let text = if arguments.json {
        format!("{:#}\n", as_json(&loaded))
    } else {
        as_text(&loaded)
    };
    print(console.out, &text)
}

/// What is told of a file, for a person.
fn as_text(loaded: &Loaded) -> String {
    let (model, summary) = (&loaded.model, loaded.scene.summary());
    let mut text = format!("{}: {}\n", loaded.path.display(), loaded.scene.format());
    let mut line = |what: &str, said: String| {
        // A String takes whatever is written to it.
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
    let surface = &model.surface;
    line(
        "vertices",
        format!(
            "{} in the file, {} drawn, {} welded",
            model.drawn.file_vertex_count,
            model.drawn.positions.len(),
            surface.positions.len()
        ),
    );
    if surface.triangles.is_empty() {
        line("triangles", "none: there is nothing to edit in it".to_owned());
    } else {
        line(
            "triangles",
            format!(
                "{} drawn, {} kept",
                model.drawn.triangles.len(),
                surface.triangles.len()
            ),
        );
    }
    if let Some(bounds) = model.bounds() {
        let (min, max) = (bounds.min, bounds.max);
        line(
            "bounds",
            format!(
                "{:.6} {:.6} {:.6} to {:.6} {:.6} {:.6}",
                min.x, min.y, min.z, max.x, max.y, max.z
            ),
        );
    }
    let sizes: Vec<usize> = model
        .topology
        .components()
        .iter()
        .map(|component| component.vertices.len())
        .collect();
    if !sizes.is_empty() {
        let listed: Vec<String> = sizes.iter().take(LISTED_COMPONENTS).map(usize::to_string).collect();
        let more = if sizes.len() > LISTED_COMPONENTS { ", .." } else { "" };
        line(
            "components",
            format!("{} (vertices: {}{more})", sizes.len(), listed.join(", ")),
        );
    }
    for sentence in model.findings.sentences() {
        line("found", sentence);
    }
    for note in loaded.scene.notes() {
        line("note", note.clone());
    }
    text
}

/// What is told of a file, for a program.
fn as_json(loaded: &Loaded) -> Value {
    let (model, findings) = (&loaded.model, &loaded.model.findings);
    let appearance = loaded.scene.appearance();
    let bounds = model
        .bounds()
        .map(|bounds| json!({ "min": bounds.min.to_array(), "max": bounds.max.to_array() }));
    let components: Vec<Value> = model
        .topology
        .components()
        .iter()
        .map(|component| {
            json!({
                "vertices": component.vertices.len(), "triangles": component.face_count,
                "first_vertex": component.first_file_vertex.0,
            })
        })
        .collect();
    let diagnoses = model.diagnoses();
    let mut found = serde_json::Map::new();
    for kind in FindingKind::ALL
        .into_iter()
        .filter(|kind| *kind != FindingKind::Components)
    {
        let finding = findings.of(kind);
        let diagnosis = diagnoses.iter().find(|diagnosis| diagnosis.kind == kind);
        let places = diagnosis.into_iter().flat_map(|diagnosis| &diagnosis.examples);
        let places: Vec<Value> = places
            .map(|example| example.position.map_or(Value::Null, |place| json!(place.to_array())))
            .collect();
        let mut told = json!({ "count": finding.count, "examples": finding.examples });
        if !places.is_empty() {
            told["positions"] = places.into();
        }
        found.insert(kind.key().to_owned(), told);
    }
    json!({
        "file": loaded.path.to_string_lossy(),
        "format": loaded.scene.format().extension(),
        "holds": loaded.scene.summary(),
        "vertices": model.drawn.file_vertex_count,
        "drawn_vertices": model.drawn.positions.len(),
        "welded_vertices": model.surface.positions.len(),
        "drawn_triangles": model.drawn.triangles.len(),
        "triangles": model.surface.triangles.len(),
        "bounding_box": bounds,
        "components": components,
        "normals": appearance.normals.is_some(),
        "texture_coordinates": appearance.uvs.is_some(),
        "colours": appearance.colours.is_some(),
        "materials": appearance.materials.iter().map(|material| &material.name).collect::<Vec<_>>(),
        "findings": found,
        "sentences": findings.sentences(),
        "notes": loaded.scene.notes(),
    })
}
