//! A new method needs only its folder and its line in `METHODS`. `identity`, which is compiled for tests, has only
//! these, and appears in the help, the edit format, the panel and the palette, and works.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stderr,
    reason = "tests fail by panicking and say what they skip"
)]

use std::path::Path;
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use pliant_app::window::{Application, Source};
use pliant_deform::{ConstraintKind, METHODS};
use pliant_mesh::shapes;
use pliant_tests::{Folder, bend, open, run};
use serde_json::{Value, json};

/// The sources of the program whose code, without comments and unit tests, contains one of these texts, by path below
/// the crates' folder.
fn naming(texts: &[String]) -> Vec<String> {
    fn search(folder: &Path, texts: &[String], found: &mut Vec<String>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                search(&path, texts, found);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                let code = text.split("\nmod tests {").next().unwrap_or_default();
                // A report's member may have the same name.
                let is_other = |line: &str| line.starts_with("//") || line.starts_with("#[serde");
                let is_code = |line: &&str| !is_other(line.trim_start());
                let mut lines = code.lines().filter(is_code);
                if lines.any(|line| texts.iter().any(|text| line.contains(text))) {
                    found.push(path.display().to_string().replace('\\', "/"));
                }
            }
        }
    }
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
    let mut found = Vec::new();
    for name in [
        "app", "deform", "editor", "engine", "flow", "io", "mesh", "python", "render", "stitch",
    ] {
        search(&crates.join(name).join("src"), texts, &mut found);
    }
    let from = crates.display().to_string().replace('\\', "/");
    let below = |path: String| path.trim_start_matches(&from).trim_start_matches('/').to_owned();
    found = found.into_iter().map(below).collect();
    found.sort();
    found
}

#[test]
fn no_file_of_the_program_but_those_of_its_folder_names_a_method() {
    for method in METHODS {
        let name = method.name;
        let folder = format!("deform/src/methods/{}/", name.replace('-', "_"));
        let mut found = naming(&[format!("\"{name}\""), format!("`{name}`")]);
        assert!(found.iter().any(|path| path.starts_with(&folder)), "{name}");
        found.retain(|path| !path.starts_with(&folder));
        assert!(found.is_empty(), "{name} is named by {found:?}");
    }
}

#[test]
fn the_smallest_method_is_in_no_file_but_its_own_the_list_of_modules_and_the_registry() {
    let found = naming(&["identity::".to_owned(), "mod identity".to_owned()]);
    assert_eq!(found, ["deform/src/methods/mod.rs", "deform/src/registry.rs"]);
}

#[test]
fn the_help_lists_it_with_its_options() {
    let help = run(["apply", "--help"]).done().out;
    let declaration = METHODS.iter().find(|method| method.name == "identity").unwrap();
    assert!(
        help.contains("  identity: Moves the handles and leaves the rest in place."),
        "{help}"
    );
    assert!(
        help.contains("share: share of the handles' motion; 0 to 1; default 1"),
        "{help}"
    );
    assert_eq!(declaration.options.len(), 1);
}

#[test]
fn an_edit_names_it_and_its_options_and_moves_the_handles_alone() {
    let folder = Folder::new();
    let file = folder.write_mesh("mesh.off", &shapes::icosphere(3));
    let out = folder.at("out.off");
    let rest = open(&file).model.rest_positions();
    let by = |method: Value| {
        let mut edit = bend(&json!({ "translation": [0, 0, 2] }));
        edit["method"] = method;
        edit
    };
    let moved = |edit: &Value, more: &[&str]| -> Vec<DVec3> {
        folder.apply(&file, edit, &out, more).done();
        let positions = open(&out).model.rest_positions();
        positions
            .iter()
            .zip(&rest)
            .map(|(moved, rest)| *moved - *rest)
            .collect()
    };
    let whole = moved(&by(json!({ "name": "identity" })), &[]);
    let count = whole.iter().filter(|way| **way != DVec3::ZERO).count();
    assert!(count > 0 && count < whole.len());
    let is_whole = |way: &DVec3| way.abs_diff_eq(DVec3::new(0.0, 0.0, 2.0), 1e-12);
    assert!(whole.iter().all(|way| is_whole(way) || *way == DVec3::ZERO));
    let half = moved(&by(json!({ "name": "identity", "share": 0.5 })), &[]);
    assert!(
        half.iter()
            .zip(&whole)
            .all(|(half, whole)| half.abs_diff_eq(*whole * 0.5, 1e-12))
    );
    // Named on the command line it replaces the edit's method, with its default options.
    let named = moved(&by(json!({ "name": "bilaplacian" })), &["--method", "identity"]);
    assert!(named == whole);

    for (method, words) in [
        (
            json!({ "name": "identity", "share": 2 }),
            ["method.share", "from 0 to 1"],
        ),
        (
            json!({ "name": "identity", "shear": 1 }),
            ["shear", "did you mean `share`?"],
        ),
        (json!({ "name": "identiti" }), ["identiti", "did you mean `identity`?"]),
    ] {
        folder.apply(&file, &by(method), &out, &[]).refused(1, &words);
    }

    // A warning names the inputs that the method ignores, and the methods that use them.
    let mut soft = by(json!({ "name": "identity" }));
    soft["handles"][0]["soft"] = json!(1);
    soft["stiffness"] = json!([{ "select": "all", "value": 10 }]);
    let report = folder.at("report.json");
    folder
        .apply(&file, &soft, &out, &["--report", report.to_str().unwrap()])
        .done();
    let report: Value = serde_json::from_str(&std::fs::read_to_string(report).unwrap()).unwrap();
    let said = report["warnings"].to_string();
    for (kind, purpose) in [
        (ConstraintKind::SoftHandles, "soft handles"),
        (ConstraintKind::Stiffness, "parts that are stiffer"),
    ] {
        let names: Vec<String> = METHODS
            .iter()
            .filter(|other| other.heeds(kind))
            .map(|other| format!("`{}`", other.name))
            .collect();
        let (last, others) = names.split_last().unwrap();
        let expected = format!("take {} or {last} for {purpose}", others.join(", "));
        assert!(said.contains(&expected), "{said}\n{expected}");
    }
}

#[test]
fn the_palette_and_the_panel_have_it() {
    if let Err(error) = pliant_render::Headless::new() {
        eprintln!("skipped: the panel and the palette ({error})");
        return;
    }
    let mut harness = Harness::builder()
        .with_size(vec2(1000.0, 900.0))
        .with_max_steps(64)
        .wgpu()
        .build_eframe(|context| Application::new(context, Source::Sample).expect("the device was just there"));
    settle(&mut harness);
    harness.key_press_modifiers(Modifiers::NONE, Key::F1);
    harness.step();
    harness.event(Event::Text("Handles alone".to_owned()));
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::NONE, Key::Enter);
    settle(&mut harness);
    assert_eq!(harness.state().editor().document().method().name(), "identity");

    // The panel shows its sentence, and a widget for its option on the method's page.
    harness.get_by_label("Identity. Moves the handles and leaves the rest in place.");
    harness.get_by_role_and_label(Role::Tab, "Method").click();
    harness.run_steps(8);
    assert!(harness.query_all_by_label("Share").next().is_some());
}

fn settle(harness: &mut Harness<'static, Application>) {
    let start = Instant::now();
    harness.step();
    while !harness.state().is_settled() {
        assert!(start.elapsed() < Duration::from_secs(120), "still busy");
        std::thread::sleep(Duration::from_millis(5));
        harness.step();
    }
    harness.step();
}
