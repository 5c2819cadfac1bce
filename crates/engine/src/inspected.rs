//! The contents of a file and the faults of its mesh.

use std::path::Path;

use pliant_io::{Scene, SceneAndDrawn};
use pliant_mesh::{FindingKind, Inspection, WeldOptions};
use serde_json::{Value, json};

use crate::EngineError;
use crate::loading::open;
use crate::watch::Watch;

/// A file and its geometry.
pub struct Inspected<'a> {
    /// The file.
    pub path: &'a Path,
    /// Its contents.
    pub scene: Scene,
    /// Its mesh.
    pub inspection: Inspection,
}

/// Reads a file and looks for the faults of its mesh.
///
/// # Errors
/// A file that can't be read.
pub fn inspect<'a>(path: &'a Path, weld: WeldOptions, watch: &Watch) -> Result<Inspected<'a>, EngineError> {
    let SceneAndDrawn { scene, drawn } = open(path, watch)?;
    let progress = watch.begin("welding");
    let inspection = Inspection::of(drawn, &weld, &progress, &watch.cancel);
    let inspection = inspection.map_err(|_| EngineError::Interrupted)?;
    Ok(Inspected {
        path,
        scene,
        inspection,
    })
}

impl Inspected<'_> {
    /// The report for a program.
    pub fn to_json(&self) -> Value {
        let Self {
            path,
            scene,
            inspection,
        } = self;
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
}
