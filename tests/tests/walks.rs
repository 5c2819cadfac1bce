//! After any actions in the window, `apply` of its project and of its exported edit gives the visible shape.
//!
//! `PLIANT_WALKS=1000 cargo test --release -p pliant-tests --test walks` takes more walks than the 50 of every run.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../../crates/editor/tests/editor/rig/mod.rs"]
mod rig;

use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_deform::{METHODS, Method};
use pliant_editor::{
    Command, Editor, Event, ExportError, GizmoPart, HandleId, InlineExecutor, Key, MeshReference, Reach, ToolMode,
    geometry_hash,
};
use pliant_mesh::{Drawn, shapes};
use pliant_tests::{Folder, assets, diagonal, largest_distance, open, run};
use rig::{Random, Rig, VIEWPORT_PX};
use serde_json::{Value, json};

/// The largest distance between the shapes, in diagonals: a linear solution is found again to its rounding.
const ALIKE: f64 = 1e-6;

/// A program with a file of this mesh open, and with `edit`, if there is one.
fn opened(file: &Path, edit: Option<&Value>) -> Rig {
    let model = open(file).model;
    let jobs = InlineExecutor::new();
    let mut editor = Editor::new(Box::new(jobs.clone()));
    editor.handle(Event::Viewport { size_px: VIEWPORT_PX });
    editor.handle(Event::Opened {
        model: Arc::clone(&model),
        name: "a shape".to_owned(),
        beginning: edit.map(|edit| pliant_editor::Beginning::parse(&edit.to_string()).unwrap()),
    });
    let mut rig = Rig::of(editor, jobs, model);
    rig.drain();
    rig
}

/// The drawn positions of a save.
fn seen(rig: &Rig) -> Vec<DVec3> {
    let mut positions = Vec::new();
    rig.model
        .drawn_positions(rig.editor.document().from_file(), &mut positions);
    positions
}

/// The result of `apply` for the text of `edit`.
fn applied(folder: &Folder, file: &Path, edit: &str) -> Vec<DVec3> {
    let (edit, out) = (folder.write("walk.json", edit), folder.at("out.off"));
    let mut arguments: Vec<OsString> = vec!["apply".into(), file.into(), "--edit".into(), edit.into()];
    arguments.extend(["--output".into(), out.clone().into()]);
    run(arguments).done();
    open(&out).model.rest_positions()
}

fn project(rig: &Rig) -> String {
    let mesh = MeshReference {
        path: Some("in.off".to_owned()),
        name: None,
        geometry: geometry_hash(&rig.model),
    };
    rig.editor.snapshot().unwrap().project(mesh).to_json()
}

/// The visible file, the applied project and the applied edit have the same shape.
fn assert_found_again(rig: &Rig, folder: &Folder, file: &Path, case: &str) {
    let seen = seen(rig);
    let alike = |positions: &[DVec3], of: &str| {
        let off = largest_distance(positions, &seen) / diagonal(&rig.model.rest_positions());
        assert!(
            off <= ALIKE,
            "{case}: {of} gives a shape that is {off:.1e} diagonals off"
        );
    };
    alike(&applied(folder, file, &project(rig)), "the project");
    match rig.editor.edit_file() {
        Ok(edit) => alike(&applied(folder, file, &edit.to_json()), "the edit"),
        Err(ExportError::Applied) => {}
        Err(error) => panic!("{case}: {error}"),
    }
}

fn meshes() -> [(&'static str, Drawn); 3] {
    let mut apart = shapes::icosphere(2);
    apart.positions.iter_mut().for_each(|position| position.x += 1.6);
    [
        ("sphere", shapes::icosphere(3)),
        ("tube", shapes::tube(16, 12, 3.0)),
        ("two parts", shapes::together(&[shapes::icosphere(3), apart])),
    ]
}

/// An action that an artist might take.
fn act(rig: &mut Rig, random: &mut Random) {
    const MODES: [ToolMode; 4] = [
        ToolMode::PaintHandle,
        ToolMode::PaintFree,
        ToolMode::PaintFixed,
        ToolMode::PaintStiffness,
    ];
    const MOVES: [&str; 8] = ["gx.3", "gy-.5", "gz.4", "rx120", "ry-80", "rz45", "s1.2", "sz.8"];
    const PARTS: [GizmoPart; 3] = [GizmoPart::Centre, GizmoPart::Arrow(0), GizmoPart::Ring(1)];
    match random.below(13) {
        0..2 => {
            let way: Vec<DVec2> = (0..2).map(|_| random.position_px()).collect();
            rig.paint(MODES[random.below(4) as usize], &way);
        }
        2..6 => {
            rig.type_keys(MOVES[random.below(8) as usize]);
            rig.key(Key::Enter);
        }
        6..8 => {
            let by_px = DVec2::new(random.unit() - 0.5, random.unit() - 0.5) * 120.0;
            rig.drag(PARTS[random.below(3) as usize], by_px);
        }
        8 => rig.undo(),
        9 => rig.command(Command::SetStrength(random.unit())),
        10 => {
            rig.paint(ToolMode::Correct, &[random.position_px(), random.position_px()]);
        }
        11 => {
            let name = METHODS[random.below(METHODS.len() as u64) as usize].name;
            rig.command(Command::SetMethod(Method::from_name(name).unwrap()));
        }
        _ => rig.command([Command::Apply, Command::NextHandle, Command::Redo][random.below(3) as usize].clone()),
    }
    rig.drain();
}

#[test]
fn random_walks_are_found_again() {
    let walks = std::env::var("PLIANT_WALKS").ok().and_then(|count| count.parse().ok());
    let meshes = meshes();
    for seed in 0..walks.unwrap_or(50_u64) {
        let (name, drawn) = &meshes[seed as usize % meshes.len()];
        let method = METHODS[seed as usize / meshes.len() % METHODS.len()].name;
        let folder = Folder::new();
        let file = folder.write_mesh("in.off", drawn);
        let (mut rig, mut random) = (opened(&file, None), Random(seed));
        rig.choose(method);
        rig.paint_handle();
        rig.drain();
        rig.command(Command::SetReach(HandleId(0), Reach::Length(0.5 + random.unit())));
        rig.drain();
        for _ in 0..4 + random.below(6) {
            act(&mut rig, &mut random);
        }
        assert_found_again(&rig, &folder, &file, &format!("walk {seed} on the {name} by {method}"));
    }
}

/// A bar that is compressed and then turned ends in another minimum than one that is moved and turned at once.
fn pressed_and_turned(file: &Path) -> Rig {
    let slab = |from: f64, to: f64| json!({ "slab": { "axis": "y", "from": from, "to": to } });
    let edit = json!({
        "version": 1, "method": { "name": "arap", "energy": "smooth" },
        "fixed": slab(0.0, 0.1),
        "handles": [{ "name": "top", "select": slab(0.9, 1.0) }],
    });
    let mut rig = opened(file, Some(&edit));
    rig.command(Command::SelectHandle(HandleId(0)));
    for keys in ["gy-.5", "rx120"] {
        rig.type_keys(keys);
        rig.key(Key::Enter);
        rig.drain();
    }
    rig
}

#[test]
fn a_shape_that_depends_on_the_way_is_found_again() {
    let folder = Folder::new();
    let file = assets().join("bar.glb");
    let rig = pressed_and_turned(&file);
    assert_found_again(&rig, &folder, &file, "the bar");
}
