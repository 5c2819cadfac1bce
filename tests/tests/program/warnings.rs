//! The report and the window name motions that a method can't follow, with the handle's name.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::sync::Arc;

use pliant_deform::METHODS;
use pliant_editor::{Beginning, Editor, Event, InlineExecutor};
use pliant_engine::watch::Watch;
use pliant_mesh::{Damage, shapes};
use pliant_tests::{Folder, bend, open};
use serde_json::{Value, json};

/// A turn of a handle that this method can't follow, in radians.
const TOO_FAR: [(&str, f64); 2] = [("laplacian", 2.5), ("frames", 3.1)];

fn edit(method: &str, turn_rad: f64) -> Value {
    let (sin, cos) = (0.5 * turn_rad).sin_cos();
    let mut edit = bend(&json!({ "rotation": [sin, 0, 0, cos] }));
    edit["method"] = json!({ "name": method });
    edit["handles"][0]["name"] = json!("the trunk");
    edit
}

#[test]
fn a_warning_calls_the_handle_by_its_name_in_the_report_and_in_the_window() {
    let folder = Folder::new();
    let file = folder.write_mesh("mesh.off", &shapes::icosphere(3));
    let model = Arc::new(open(&file).model);
    for (method, turn_rad) in TOO_FAR {
        let told = |turn_rad: f64| -> [Vec<String>; 2] {
            let edit = edit(method, turn_rad);
            let report = folder.at("report.json");
            let arguments = ["--report", report.to_str().unwrap()];
            folder.apply(&file, &edit, &folder.at("out.off"), &arguments).done();
            let report: Value = serde_json::from_str(&std::fs::read_to_string(report).unwrap()).unwrap();
            let by_report = report["warnings"].as_array().unwrap().iter();

            let beginning = Beginning::parse(&edit.to_string()).unwrap();
            let jobs = InlineExecutor::new();
            let mut editor = Editor::new(Box::new(jobs.clone()));
            editor.handle(Event::Opened {
                model: Arc::clone(&model),
                name: "mesh.off".to_owned(),
                beginning: Some(beginning),
            });
            while let Some(done) = jobs.run_next() {
                editor.handle(Event::JobDone(done));
            }
            let by_report = by_report.map(|sentence| sentence.as_str().unwrap().to_owned());
            [by_report.collect(), editor.warnings()]
        };
        for sentences in told(turn_rad) {
            let said = sentences.iter().find(|sentence| sentence.contains("turns by"));
            let said = said.unwrap_or_else(|| panic!("{method}: {sentences:?}"));
            assert!(
                said.contains("\"the trunk\" turns by") && !said.contains("handle 0"),
                "{said}"
            );
        }
        for sentences in told(0.3) {
            let said = sentences.iter().find(|sentence| sentence.contains("turns by"));
            assert_eq!(said, None, "{method} follows a small turn");
        }
    }
}

/// A turn and a squeeze by which every method that holds the handle crushes triangles.
#[test]
fn every_method_says_what_came_out_badly_with_the_place_and_another_method() {
    let folder = Folder::new();
    let file = folder.write_mesh("mesh.off", &shapes::icosphere(2));
    let loaded = open(&file);
    for declaration in METHODS.iter().filter(|declaration| declaration.name != "identity") {
        let mut edit = bend(&json!({ "scale": [1e-3, 1e-3, 1e-3] }));
        edit["method"] = json!({ "name": declaration.name });
        let edit = Beginning::parse(&edit.to_string()).unwrap();
        let setup = edit.resolve(&loaded.model).unwrap();
        let solved = pliant_engine::solved(&file, &edit, None, &loaded, &setup, &Watch::default()).unwrap();
        let (surface, topology) = (&loaded.model.surface, &loaded.model.topology);
        let damage = Damage::of(surface, topology, &solved.surface_positions);
        let kinds = [damage.flipped, damage.collapsed, damage.shrunk, damage.stretched];
        let counts = kinds.iter().filter(|kind| kind.count > 0);
        let said: Vec<&String> = (solved.report.warnings.iter())
            .filter(|said| said.contains("leave more of the surface free"))
            .collect();
        assert_eq!(said.len(), counts.count(), "{}: {said:?}", declaration.name);
        assert!(
            damage.collapsed.count > 0 && damage.shrunk.count > 0,
            "{} crushes the handle",
            declaration.name
        );
        let has_other = |said: &&&String| {
            METHODS
                .iter()
                .any(|other| said.contains(&format!("or take `{}`", other.name)))
        };
        let named = said.iter().filter(has_other).count();
        assert!(
            named == said.len() || declaration.name == "shells",
            "{}: {said:?}",
            declaration.name
        );
        assert!(said.iter().all(|said| said.contains("at ")), "{said:?}");
        assert!(
            said.iter()
                .all(|said| !said.contains(&format!("take `{}`", declaration.name))),
            "{said:?}"
        );
    }
}
