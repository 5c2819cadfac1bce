//! An artist's session, and the same edit by way of the edit file.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

use crate::rig;
use std::sync::Arc;

use crate::rig::{CENTRE_PX, ITERATED, Rig};
use glam::{DQuat, DVec2, DVec3};
use pliant_deform::Role;
use pliant_editor::{
    Command, EditFile, Editor, Event, ExportError, GizmoPart, HandleTransform, InlineExecutor, JobKind, Key, Modifiers,
    Paint, SavedAs, ToolMode,
};
use pliant_mesh::shapes;

#[test]
fn a_fresh_document_holds_everything_still_and_a_handle_brings_its_region() {
    let mut rig = Rig::open(shapes::icosphere(4));
    assert!(rig.editor.roles().iter().all(|role| *role == Role::Fixed));
    rig.paint_handle();
    rig.drain();
    let counts = rig.editor.view().counts;
    assert!(
        counts.handle > 3 && counts.free > counts.handle && counts.fixed > counts.free,
        "{counts:?}"
    );
    assert_eq!(
        counts.handle + counts.free + counts.fixed,
        rig.model.surface.positions.len()
    );
}

#[test]
fn a_loose_part_within_reach_follows_and_what_extends_beyond_is_held() {
    let bit = |radius: f64, centre: DVec3| {
        let mut bit = shapes::icosphere(2);
        bit.positions
            .iter_mut()
            .for_each(|position| *position = *position * radius + centre);
        bit
    };
    // A wart beside the handle, a moon behind, and a ring's worth of another body that only begins near the handle.
    let wart = bit(0.02, DVec3::new(-1.02, 0.0, 0.2));
    let moon = bit(0.1, DVec3::new(1.2, 0.0, 0.0));
    let body = bit(0.6, DVec3::new(-0.6, 1.4, 0.0));
    let mut rig = Rig::open(shapes::together(&[shapes::icosphere(4), wart, moon, body]));
    let roles_near = |rig: &Rig, place: DVec3, radius: f64| {
        let positions = rig.model.surface.positions.iter();
        let roles = positions
            .zip(rig.editor.roles())
            .filter(|(position, _)| position.distance(place) < radius);
        roles.map(|(_, role)| *role).collect::<Vec<_>>()
    };
    rig.command(Command::View(pliant_editor::NamedView::Left));
    rig.command(Command::FrameAll);
    let middle = rig
        .editor
        .view()
        .camera
        .project(DVec3::NEG_X, rig::VIEWPORT_PX)
        .unwrap();
    rig.paint(ToolMode::PaintHandle, &[middle]);
    rig.drain();
    let wart = roles_near(&rig, DVec3::new(-1.02, 0.0, 0.2), 0.021);
    assert!(
        wart.iter().filter(|role| **role == Role::Free).count() >= 162,
        "{wart:?}"
    );
    assert!(
        roles_near(&rig, DVec3::new(1.2, 0.0, 0.0), 0.11)
            .iter()
            .all(|role| *role == Role::Fixed)
    );
    assert!(
        roles_near(&rig, DVec3::new(-0.6, 1.8, 0.0), 0.25)
            .iter()
            .all(|role| *role == Role::Fixed)
    );
}

#[test]
fn dragging_the_gizmo_moves_the_handle_by_what_the_pointer_says() {
    let mut rig = Rig::open(shapes::icosphere(4));
    rig.command(Command::View(pliant_editor::NamedView::Front));
    rig.paint_handle();
    rig.drain();
    let centre = rig.editor.view().handles[0].centre();
    let per_px = rig.editor.view().camera.world_per_px(centre, rig::VIEWPORT_PX);
    assert!(rig.drag(GizmoPart::Arrow(0), DVec2::new(40.0, 13.0)));
    rig.drain();
    let way = rig.editor.view().handles[0].centre() - centre;
    assert!(
        (way.x - 40.0 * per_px).abs() < 1e-3 && way.y == 0.0 && way.z == 0.0,
        "{way}"
    );
    assert!(rig.editor.view().undo == Some("Move handle 1"));
    let free_moved = rig
        .editor
        .roles()
        .iter()
        .zip(rig.editor.document().from_file().iter())
        .filter(|(role, displacement)| **role == Role::Free && displacement.length() > 1e-6)
        .count();
    assert!(free_moved > 10, "the surface follows");
    for (role, displacement) in rig.editor.roles().iter().zip(rig.editor.document().from_file().iter()) {
        assert!(*role != Role::Fixed || *displacement == DVec3::ZERO);
    }
}

#[test]
fn a_soft_handle_only_pulls_and_undo_makes_it_hold_again() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.drain();
    rig.move_by('y', ".5");
    rig.drain();
    let id = rig.editor.view().handles[0].id;
    let lag = |rig: &Rig| {
        let moved = rig.editor.roles().iter().zip(rig.editor.document().from_file().iter());
        let own = moved.filter(|(role, _)| matches!(role, Role::Handle(_)));
        own.map(|(_, d)| d.distance(DVec3::Y * 0.5)).fold(0.0, f64::max)
    };
    let hard = rig.fingerprint();
    assert!(lag(&rig) < 1e-6);
    let lags = [100.0, 1.0, 0.01].map(|weight| {
        rig.command(Command::SetSoft(id, Some(weight)));
        rig.drain();
        lag(&rig)
    });
    assert!(
        lags[0] > 1e-6 && lags[1] > lags[0] && lags[2] > lags[1] && lags[2] < 0.5,
        "{lags:?}"
    );
    for weight in [0.0, 1e9, f64::NAN] {
        rig.command(Command::SetSoft(id, Some(weight)));
        assert!(
            rig.editor.view().problem.is_some_and(|said| said.contains("weight")),
            "{weight}"
        );
    }
    for _ in lags {
        rig.undo();
    }
    rig.drain();
    assert_eq!(rig.fingerprint(), hard);
}

#[test]
fn typed_numbers_and_constraints_say_exactly_what_happens() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.drain();
    let transform = |rig: &Rig| rig.editor.view().handles[0].transform;
    rig.move_by('y', "-.5");
    let HandleTransform::Trs { translation, .. } = transform(&rig) else {
        panic!()
    };
    assert_eq!(translation, DVec3::new(0.0, -0.5, 0.0));
    rig.type_keys("rz90");
    rig.key(Key::Enter);
    let HandleTransform::Trs { rotation, .. } = transform(&rig) else {
        panic!()
    };
    assert!((rotation * DVec3::X - DVec3::Y).length() < 1e-12);
    rig.type_keys("s");
    rig.editor.handle(Event::Key(Key::Character('z'), Modifiers::SHIFT));
    rig.type_keys("2");
    rig.key(Key::Enter);
    let HandleTransform::Trs { scale, .. } = transform(&rig) else {
        panic!()
    };
    assert_eq!(scale, DVec3::new(2.0, 2.0, 1.0));
    rig.command(Command::ResetHandle);
    rig.drain();
    assert_eq!(rig.largest_displacement(), 0.0);
}

#[test]
fn turns_add_up_past_a_full_circle() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.command(Command::View(pliant_editor::NamedView::Front));
    rig.paint_handle();
    rig.drain();
    let centre_px = rig
        .editor
        .view()
        .camera
        .project(rig.editor.view().handles[0].centre(), rig::VIEWPORT_PX)
        .unwrap();
    rig.move_to(centre_px + DVec2::new(100.0, 0.0));
    rig.type_keys("r");
    for step in 0..=45 {
        let angle_rad = f64::from(step) * std::f64::consts::PI / 18.0;
        rig.move_to(centre_px + DVec2::new(angle_rad.cos(), -angle_rad.sin()) * 100.0);
    }
    assert!(
        rig.editor.view().status.contains("450.0°"),
        "{}",
        rig.editor.view().status
    );
    rig.key(Key::Escape);
    assert!(!rig.editor.view().handles[0].is_displaced());
}

#[test]
fn a_stroke_paints_without_gaps_however_fast() {
    let mut fast = Rig::open(shapes::grid(200, 200));
    let mut slow = Rig::open(shapes::grid(200, 200));
    let (from_px, to_px) = (CENTRE_PX - DVec2::new(150.0, 40.0), CENTRE_PX + DVec2::new(150.0, 40.0));
    for rig in [&mut fast, &mut slow] {
        rig.command(Command::View(pliant_editor::NamedView::Front));
        rig.command(Command::SetBrushRadius(12.0));
    }
    fast.paint(ToolMode::PaintFixed, &[from_px, to_px]);
    let way: Vec<DVec2> = (0..=600)
        .map(|step| from_px.lerp(to_px, f64::from(step) / 600.0))
        .collect();
    slow.paint(ToolMode::PaintFixed, &way);
    let (fast, slow) = (fast.count(Paint::Fixed), slow.count(Paint::Fixed));
    assert!(slow > 500 && fast as f64 > 0.985 * slow as f64, "{fast} of {slow}");
}

#[test]
fn the_brush_leaves_the_back_alone() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.command(Command::View(pliant_editor::NamedView::Front));
    rig.command(Command::SetBrushRadius(400.0));
    rig.paint(ToolMode::PaintFixed, &[CENTRE_PX]);
    let front = rig.model.surface.positions.iter().zip(rig.editor.document().paint());
    for (position, paint) in front {
        assert!(position.z > -0.1 || *paint == Paint::Bare);
        assert!(position.z < 0.6 || *paint == Paint::Fixed);
    }
}

#[test]
fn the_edit_file_says_what_was_done() {
    for method in ["bilaplacian", "arap"] {
        let mut rig = Rig::open(shapes::bar(24, 4, 4));
        rig.choose(method);
        rig.paint_handle();
        rig.command(Command::NewHandle);
        rig.paint(ToolMode::PaintHandle, &[CENTRE_PX + DVec2::new(120.0, 0.0)]);
        rig.drain();
        rig.move_by('y', ".8");
        rig.type_keys("rx25");
        rig.key(Key::Enter);
        rig.drain();
        assert_eq!(rig.editor.view().handles.len(), 2);

        let text = rig.editor.edit_file().unwrap().to_json();
        let edit = EditFile::parse(&text).unwrap();
        let jobs = InlineExecutor::new();
        let mut editor = Editor::new(Box::new(jobs.clone()));
        editor.handle(Event::Opened {
            model: Arc::clone(&rig.model),
            name: "again".to_owned(),
            beginning: Some((edit).into()),
        });
        while let Some(done) = jobs.run_next() {
            editor.handle(Event::JobDone(done));
        }
        assert!(editor.document().is_settled());
        assert_eq!(editor.roles(), rig.editor.roles());
        assert_eq!(editor.document().method(), rig.editor.document().method());
        let (again, shape) = (editor.document().from_file(), rig.editor.document().from_file());
        if method == "arap" {
            let size = rig.model.bounds().unwrap().diagonal();
            let apart = again.iter().zip(shape.iter()).map(|(a, b)| a.distance(*b));
            assert!(apart.fold(0.0, f64::max) < ITERATED * size);
        } else {
            assert_eq!(again, shape, "the same positions, to the bit");
        }
        assert!(!editor.view().unsaved && rig.editor.view().unsaved);

        rig.command(Command::Apply);
        assert_eq!(rig.editor.edit_file(), Err(ExportError::Applied));
    }
}

#[test]
fn saving_is_remembered_through_undo_and_redo() {
    let mut rig = Rig::open(shapes::icosphere(3));
    assert!(!rig.editor.view().unsaved);
    rig.paint_handle();
    rig.drain();
    let mark = rig.editor.save_mark();
    rig.editor.handle(Event::Saved(SavedAs::Model, mark));
    assert!(!rig.editor.view().unsaved);
    rig.undo();
    assert!(rig.editor.view().unsaved);
    rig.redo();
    assert!(!rig.editor.view().unsaved);
    rig.undo();
    rig.paint_handle();
    assert!(rig.editor.view().unsaved, "what was saved can't be reached any more");
}

#[test]
fn a_save_has_the_state_at_which_it_began_and_no_later_one() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.drain();
    let mark = rig.editor.save_mark();
    rig.move_by('x', ".1");
    rig.drain();
    rig.editor.handle(Event::Saved(SavedAs::Model, mark));
    assert!(rig.editor.view().unsaved, "it was moved while the file was written");
    rig.undo();
    assert!(!rig.editor.view().unsaved);
    // The same holds for a shape that arrives after its step.
    let mut rig = Rig::open(shapes::icosphere(5));
    rig.choose("shells");
    rig.paint_handle();
    rig.drain();
    rig.type_keys("rx150");
    rig.key(Key::Enter);
    assert!(rig.run(JobKind::Solve));
    assert!(!rig.editor.document().is_settled());
    for waits in [false, true] {
        let mark = rig.editor.save_mark();
        if waits {
            rig.run(JobKind::Solve);
        }
        rig.editor.handle(Event::Saved(SavedAs::Model, mark));
        assert_eq!(rig.editor.view().unsaved, waits);
    }
    rig.drain();
    assert!(rig.editor.view().unsaved, "it has settled since");
    let mark = rig.editor.save_mark();
    rig.editor.handle(Event::Saved(SavedAs::Model, mark));
    assert!(!rig.editor.view().unsaved);
}

#[test]
fn a_drag_that_another_method_ends_says_so() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.drain();
    rig.type_keys("gx.1");
    rig.choose("bilaplacian");
    assert!(rig.editor.view().problem.unwrap().contains("was cancelled"));
    assert_eq!(rig.largest_displacement(), 0.0);
    rig.move_by('x', ".1");
    rig.drain();
    assert_eq!(rig.editor.view().problem, None);
    rig.choose("arap");
    assert_eq!(rig.editor.view().problem, None, "nothing was under way");
}

#[test]
fn what_a_project_has_is_saved_with_the_project_alone() {
    let mut rig = Rig::open(shapes::icosphere(3));
    let save = |rig: &mut Rig, what| {
        let mark = rig.editor.save_mark();
        rig.editor.handle(Event::Saved(what, mark));
    };
    rig.paint_handle();
    rig.drain();
    save(&mut rig, SavedAs::Project);
    rig.move_by('x', ".1");
    rig.drain();
    save(&mut rig, SavedAs::Model);
    assert!(rig.editor.view().unsaved, "the model has no handles");
    save(&mut rig, SavedAs::Project);
    assert!(!rig.editor.view().unsaved);
}

#[test]
fn revisions_grow_only_with_what_they_stand_for() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.drain();
    let revisions = |rig: &Rig| {
        let view = rig.editor.view();
        [view.shape_revision, view.regions_revision, view.camera_revision]
    };
    let before = revisions(&rig);
    rig.move_to(CENTRE_PX + DVec2::new(5.0, 5.0));
    rig.move_to(CENTRE_PX + DVec2::new(200.0, 5.0));
    assert_eq!(before, revisions(&rig), "hovering changes none of them");
    rig.editor.handle(Event::Wheel {
        pointer: rig::at(CENTRE_PX),
        lines: 1.0,
    });
    let zoomed = revisions(&rig);
    assert_eq!([before[0], before[1]], [zoomed[0], zoomed[1]]);
    assert!(zoomed[2] > before[2]);
    rig.move_by('x', ".1");
    rig.drain();
    let moved = revisions(&rig);
    assert!(moved[0] > zoomed[0] && moved[1] == zoomed[1] && moved[2] == zoomed[2]);
}

#[test]
fn nothing_open_nothing_breaks() {
    let mut editor = Editor::new(Box::new(InlineExecutor::new()));
    for listed in Command::all_listed() {
        editor.handle(Event::Command(listed.command.clone()));
    }
    editor.handle(Event::PointerPressed(
        rig::at(CENTRE_PX),
        pliant_editor::Button::Primary,
    ));
    editor.handle(Event::PointerMoved(rig::at(DVec2::ZERO)));
    editor.handle(Event::PointerReleased(
        rig::at(CENTRE_PX),
        pliant_editor::Button::Primary,
    ));
    let mark = editor.save_mark();
    editor.handle(Event::Saved(SavedAs::Model, mark));
    assert_eq!(editor.edit_file(), Err(ExportError::NoFile));
    assert!(editor.view().model.is_none());
}

#[test]
fn a_widget_that_is_dragged_is_one_step_and_escape_takes_it_back() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.drain();
    let before = rig.fingerprint();
    let id = rig.editor.view().selected.unwrap();
    let put = |rig: &mut Rig, x: f64| {
        let transform = HandleTransform::Trs {
            translation: DVec3::new(x, 0.0, 0.0),
            rotation: DQuat::IDENTITY,
            scale: DVec3::ONE,
            pivot: None,
        };
        rig.editor
            .handle(Event::Adjust(Command::SetHandleTransform(id, transform)));
    };
    for x in [0.1, 0.2, 0.3] {
        put(&mut rig, x);
        rig.drain();
    }
    rig.editor.handle(Event::Adjusted);
    assert_eq!(
        rig.editor.history().names().1,
        2,
        "the paint, and all of the widget's values"
    );
    assert!(rig.largest_displacement() > 0.29);
    rig.undo();
    rig.drain();
    assert_eq!(rig.fingerprint(), before);
    put(&mut rig, 0.4);
    rig.editor.handle(Event::Adjust(Command::Undo));
    rig.key(Key::Escape);
    rig.drain();
    assert_eq!(rig.fingerprint(), before);
}

#[test]
fn regions_can_be_cleared_where_there_are_some() {
    let mut rig = Rig::open(shapes::icosphere(3));
    let is_offered = |rig: &Rig| rig.editor.is_enabled(&Command::ClearRegions);
    assert!(!is_offered(&rig));
    rig.paint(ToolMode::PaintFixed, &[CENTRE_PX]);
    assert!(is_offered(&rig));
    rig.command(Command::ClearRegions);
    assert!(!is_offered(&rig));
    rig.undo();
    assert!(is_offered(&rig));
    rig.undo();
    assert!(!is_offered(&rig));
}
