//! `pliant info`: the contents of a file and the faults of its mesh.

use std::fmt::Write as _;
use std::path::Path;

use pliant_io::{Scene, SceneAndDrawn};
use pliant_mesh::{FindingKind, Inspection, WeldOptions};
use serde_json::{Value, json};

use super::arguments::InfoArguments;
use super::shared_arguments::ComputeArguments;
use crate::cli::console::{Console, print, print_json};
use crate::cli::threads::on_threads;
use pliant_engine::EngineError;
use pliant_engine::files::shown;
use pliant_engine::watch::Watch;

/// The number of components that are listed one by one.
const LISTED_COMPONENTS: usize = 12;

pub(super) fn run(arguments: &InfoArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let watch = &console.watch;
    let looked_at = on_threads(ComputeArguments::default(), || {
        look_at(&arguments.file, arguments.weld.options(), watch)
    })??;
    if arguments.json {
        print_json(console.out, &as_json(&looked_at))
    } else {
        print(console.out, &as_text(&looked_at))
    }
}

/// A file and its geometry.
struct LookedAt<'a> {
    path: &'a Path,
    scene: Scene,
    inspection: Inspection,
}

fn look_at<'a>(path: &'a Path, weld: WeldOptions, watch: &Watch) -> Result<LookedAt<'a>, EngineError> {
    let SceneAndDrawn { scene, drawn } = pliant_engine::open(path, watch)?;
    let progress = watch.begin("welding");
    let inspection = Inspection::of(drawn, &weld, &progress, &watch.cancel);
    let inspection = inspection.map_err(|_| EngineError::Interrupted)?;
    Ok(LookedAt {
        path,
        scene,
        inspection,
    })
}

/// The report on a file, for a person.
fn as_text(
    LookedAt {
        path,
        scene,
        inspection,
    }: &LookedAt<'_>,
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

/// The report on a file, for a program.
fn as_json(
    LookedAt {
        path,
        scene,
        inspection,
    }: &LookedAt<'_>,
) -> Value {
    let findings = &inspection.findings;
    let appearance = scene.appearance();
    let bounds = inspection
        .bounds
        .map(|bounds| json!({ "min": bounds.min.to_array(), "max": bounds.max.to_array() }));
    let components: Vec<Value> = inspection
        .components
        .iter()
        .map(|component| {
            json!({
                "vertices": component.vertex_count, "triangles": component.face_count,
                "first_vertex": component.first_file_vertex.0,
            })
        })
        .collect();
    let mut found = serde_json::Map::new();
    for kind in FindingKind::ALL
        .into_iter()
        .filter(|kind| *kind != FindingKind::Components)
    {
        let finding = findings.of(kind);
        let located = inspection.located_findings.iter().find(|finding| finding.kind == kind);
        let places = located.into_iter().flat_map(|located| &located.examples);
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
        "file": path.to_string_lossy(),
        "format": scene.format().extension(),
        "holds": scene.summary(),
        "vertices": inspection.file_vertices,
        "drawn_vertices": inspection.drawn_vertices,
        "welded_vertices": inspection.surface_vertices,
        "points": inspection.bare_points,
        "drawn_triangles": inspection.drawn_triangles,
        "triangles": inspection.surface_triangles,
        "bounding_box": bounds,
        "components": components,
        "normals": appearance.normals.is_some(),
        "texture_coordinates": appearance.uvs.is_some(),
        "colours": appearance.colours.is_some(),
        "materials": appearance.materials.iter().map(|material| &material.name).collect::<Vec<_>>(),
        "findings": found,
        "sentences": findings.sentences(),
        "notes": scene.notes(),
    })
}
