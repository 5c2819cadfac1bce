//! A `.pliant` project on the command line.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests fail by panicking")]

use std::ffi::OsStr;
use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_editor::{
    Beginning, Button, Command, Correction, CorrectionBrush, Editor, Event, HandleTransform, InlineExecutor,
    MeshReference, Modifiers, Pointer, ToolMode, geometry_hash,
};
use pliant_engine::Loaded;
use pliant_mesh::shapes;
use pliant_tests::{Ended, Folder, open, run};

fn apply(file: &Path, edit: &Path, output: &Path) -> Ended {
    run([
        "apply".as_ref(),
        file.as_os_str(),
        OsStr::new("--edit"),
        edit.as_os_str(),
        "--output".as_ref(),
        output.as_os_str(),
    ])
}

/// An editor with the bar open and one end of it a handle, from an edit.
fn editor(loaded: &Loaded) -> (Editor, InlineExecutor) {
    let jobs = InlineExecutor::new();
    let mut editor = Editor::new(Box::new(jobs.clone()));
    let edit = pliant_editor::EditFile::parse(
        r#"{"version": 1, "method": {"name": "bilaplacian"},
            "fixed": {"slab": {"axis": "longest", "from": 0.0, "to": 0.1}},
            "handles": [{"name": "end", "select": {"slab": {"axis": "longest", "from": 0.9, "to": 1.0}}}]}"#,
    )
    .unwrap();
    editor.handle(Event::Opened {
        model: Arc::clone(&loaded.model),
        name: "bar".to_owned(),
        beginning: Some(edit.into()),
    });
    drain(&mut editor, &jobs);
    (editor, jobs)
}

fn drain(editor: &mut Editor, jobs: &InlineExecutor) {
    while let Some(done) = jobs.run_next() {
        editor.handle(Event::JobDone(done));
    }
}

fn move_end(editor: &mut Editor, jobs: &InlineExecutor, by: DVec3) {
    let handle = editor.document().handles()[0].clone();
    let transform = HandleTransform::IDENTITY;
    let HandleTransform::Trs { rotation, scale, .. } = transform else {
        unreachable!()
    };
    let transform = HandleTransform::Trs {
        translation: by,
        rotation,
        scale,
        pivot: None,
    };
    editor.handle(Event::Command(Command::SetHandleTransform(handle.id, transform)));
    drain(editor, jobs);
}

#[test]
fn a_project_bends_its_mesh_to_the_shape_that_was_on_the_screen_with_what_was_applied() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &shapes::bar(12, 3, 3));
    let loaded = open(&file);
    let (mut editor, jobs) = editor(&loaded);
    move_end(&mut editor, &jobs, DVec3::new(0.0, 0.4, 0.0));
    editor.handle(Event::Command(Command::Apply));
    drain(&mut editor, &jobs);
    move_end(&mut editor, &jobs, DVec3::new(0.1, 0.0, 0.3));
    let mesh = MeshReference {
        name: None,
        path: Some("bar.off".to_owned()),
        geometry: geometry_hash(&loaded.model),
    };
    let text = editor.snapshot().unwrap().project(mesh).to_json();
    let project = folder.write("bar.pliant", &text);
    let output = folder.at("out.off");
    apply(&file, &project, &output).done();
    let mut shown = Vec::new();
    loaded.model.drawn_positions(editor.view().displacements, &mut shown);
    let bent = open(&output);
    let size = loaded.model.bounds().unwrap().diagonal();
    for (a, b) in bent.model.rest_positions().iter().zip(&shown) {
        assert!(a.distance(*b) < 1e-6 * size, "{a} {b}");
    }
    let rest = DVec3::new(0.1, 0.4, 0.3);
    let farthest = editor
        .document()
        .from_file()
        .iter()
        .map(|d| d.length())
        .fold(0.0, f64::max);
    assert!((farthest - rest.length()).abs() < 0.2, "both bends are in it");

    // At rest and without an applied shape, the save has the file's own bytes.
    let (fresh, _) = self::editor(&loaded);
    let mesh = MeshReference {
        name: None,
        path: None,
        geometry: geometry_hash(&loaded.model),
    };
    let text = fresh.snapshot().unwrap().project(mesh).to_json();
    let project = folder.write("rest.pliant", &text);
    let output = folder.at("same.off");
    apply(&file, &project, &output).done();
    assert_eq!(std::fs::read(&file).unwrap(), std::fs::read(&output).unwrap());
}

/// Drags the surface under the view's middle by hand.
fn grab(editor: &mut Editor, jobs: &InlineExecutor, by_px: DVec2) {
    let size_px = DVec2::new(800.0, 600.0);
    editor.handle(Event::Viewport { size_px });
    let correction = CorrectionBrush {
        correction: Correction::Grab,
        ..CorrectionBrush::default()
    };
    for command in [
        Command::FrameAll,
        Command::SetTool(ToolMode::Correct),
        Command::SetCorrection(correction),
        Command::SetBrushRadius(60.0),
    ] {
        editor.handle(Event::Command(command));
    }
    drain(editor, jobs);
    let at = |position_px| Pointer {
        position_px,
        modifiers: Modifiers::NONE,
    };
    let (from, to) = (size_px / 2.0, size_px / 2.0 + by_px);
    editor.handle(Event::PointerMoved(at(from)));
    editor.handle(Event::PointerPressed(at(from), Button::Primary));
    editor.handle(Event::PointerMoved(at(to)));
    editor.handle(Event::PointerReleased(at(to), Button::Primary));
    drain(editor, jobs);
}

#[test]
fn what_was_corrected_by_hand_is_in_the_project_and_in_the_exported_edit() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &shapes::bar(12, 3, 3));
    let loaded = open(&file);
    let size = loaded.model.bounds().unwrap().diagonal();
    let same = |editor: &Editor, case: &str| {
        let mut shown = Vec::new();
        loaded.model.drawn_positions(editor.view().displacements, &mut shown);
        let mesh = MeshReference {
            name: None,
            path: None,
            geometry: geometry_hash(&loaded.model),
        };
        let project = editor.snapshot().unwrap().project(mesh).to_json();
        let edit = editor.edit_file().unwrap().to_json();
        for (name, text) in [("bar.pliant", project), ("edit.json", edit)] {
            let edit = folder.write(name, &text);
            let output = folder.at("out.off");
            apply(&file, &edit, &output).done();
            let bent = open(&output).model.rest_positions();
            let off = bent.iter().zip(&shown).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(off < 1e-6 * size, "{case}, {name}: {off}");
            // The window also opens it in that shape.
            let jobs = InlineExecutor::new();
            let mut again = Editor::new(Box::new(jobs.clone()));
            again.handle(Event::Opened {
                model: Arc::clone(&loaded.model),
                name: "again".to_owned(),
                beginning: Some(Beginning::parse(&text).unwrap()),
            });
            drain(&mut again, &jobs);
            let own = again
                .document()
                .from_file()
                .iter()
                .zip(editor.document().from_file().iter());
            let off = own.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(off < 1e-6 * size, "{case}, {name} opened: {off}");
        }
    };
    let (mut editor, jobs) = editor(&loaded);
    let largest = |editor: &Editor| {
        let lengths = editor.document().from_file().iter().map(|d| d.length());
        lengths.fold(0.0, f64::max)
    };
    grab(&mut editor, &jobs, DVec2::new(0.0, 30.0));
    assert!(largest(&editor) > 0.01 * size, "it was dragged");
    same(&editor, "corrected at rest");
    move_end(&mut editor, &jobs, DVec3::new(0.0, 0.02, 0.01));
    same(&editor, "bent a little from there");
    grab(&mut editor, &jobs, DVec2::new(15.0, -20.0));
    same(&editor, "corrected where it is bent");
}

#[test]
fn a_project_on_another_mesh_and_a_project_as_the_mesh_are_refused() {
    let folder = Folder::new();
    let file = folder.write_mesh("bar.off", &shapes::bar(12, 3, 3));
    let other = folder.write_mesh("other.off", &shapes::bar(13, 3, 3));
    let loaded = open(&file);
    let (editor, _) = editor(&loaded);
    let mesh = MeshReference {
        name: None,
        path: None,
        geometry: geometry_hash(&loaded.model),
    };
    let project = folder.write("bar.pliant", editor.snapshot().unwrap().project(mesh).to_json());
    let output = folder.at("out.off");
    apply(&other, &project, &output).refused(1, &["bar.pliant", "another mesh"]);
    apply(&project, &project, &output).refused(1, &["bar.pliant", "--edit"]);
    let broken = folder.write("broken.pliant", "{\"mesh\": {}, \"version\": 1}");
    apply(&file, &broken, &output).refused(1, &["broken.pliant", "mesh", "geometry"]);
    assert!(!output.exists());
}
