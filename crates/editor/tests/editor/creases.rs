//! Creases found by strokes: made sharper and flatter, undone, saved, reopened and continued.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::curve_strokes::{curve, px};
use crate::project::{reopened, saved};
use crate::rig::{Fingerprint, Rig};
use glam::{DVec2, DVec3};
use pliant_editor::{
    Beginning, Command, EditFile, Event, JobKind, NamedView, Project, StrokeShape, Symmetry, ToolMode,
};
use pliant_mesh::shapes;

/// A sheet over the view's plane with a ridge along y at x = 1.5 and its mirror image at x = -1.5.
fn ridges() -> Rig {
    let mut right = shapes::grid(30, 40);
    for p in &mut right.positions {
        let (x, y) = (3.0 * p.x, 4.0 * p.y - 2.0);
        *p = DVec3::new(x, y, -0.5 * (x - 1.5).abs());
    }
    let mut left = right.clone();
    left.positions.iter_mut().for_each(|p| p.x = -p.x);
    left.triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
    let mut rig = Rig::open(shapes::together(&[left, right]));
    rig.choose("bilaplacian");
    rig.command(Command::View(NamedView::Front));
    rig.command(Command::SetBrushRadius(40.0));
    rig.command(Command::SetTool(ToolMode::PaintHandle));
    rig.command(Command::SetStrokeShape(StrokeShape::Crease));
    rig.drain();
    rig
}

/// Draws beside the ridge at x = 1.5.
fn draw_beside_ridge(rig: &mut Rig) {
    let way = (0..=20).map(|step| px(rig, DVec3::new(1.3, f64::from(step) * 0.1 - 1.0, -0.1)));
    let way: Vec<DVec2> = way.collect();
    rig.swipe(&way);
    rig.drain();
}

#[test]
fn a_stroke_beside_a_crease_finds_it_and_its_sharpness_is_a_number_that_is_undone_and_kept() {
    let mut rig = ridges();
    draw_beside_ridge(&mut rig);
    assert_eq!(rig.editor.view().problem, None);
    let found = curve(&rig);
    for point in found.rest().points() {
        assert!((point.x - 1.5).abs() < 1e-9 && point.z.abs() < 1e-9, "{point}");
    }
    let crease = rig.editor.selected_crease().unwrap();
    assert!(crease.sharpen() == 0.0 && rig.largest_displacement() == 0.0);

    let before = Fingerprint::of(rig.editor.document());
    rig.send(Event::Adjust(Command::SharpenCrease(0.5)));
    rig.send(Event::Adjust(Command::SharpenCrease(1.0)));
    let waiting = rig.jobs.waiting();
    assert!(
        waiting.contains(&JobKind::Solve) && !waiting.contains(&JobKind::Bind),
        "{waiting:?}"
    );
    rig.send(Event::Adjusted);
    rig.drain();
    let lift = |rig: &Rig, x: f64| {
        let at = (0..rig.model.surface.positions.len()).find(|v| {
            let p = rig.model.surface.positions[*v];
            (p.x - x).abs() < 1e-9 && p.y.abs() < 1e-9
        });
        rig.editor.view().displacements[at.unwrap()].z
    };
    assert!(lift(&rig, 1.5) > 0.02, "{}", lift(&rig, 1.5));
    let text = rig.editor.edit_file().unwrap().to_json();
    let edit = EditFile::parse(&text).unwrap();
    assert_eq!(
        edit.handles[0].curve.as_ref().unwrap().crease(),
        rig.editor.selected_crease()
    );
    let setup = edit.resolve(&rig.model).unwrap();
    assert!(!setup.lines.is_empty());

    rig.undo();
    rig.drain();
    assert_eq!(Fingerprint::of(rig.editor.document()), before);
    assert_eq!(rig.largest_displacement(), 0.0);
    rig.redo();
    rig.drain();
    assert_eq!(rig.editor.selected_crease().unwrap().sharpen(), 1.0);
    rig.command(Command::SharpenCrease(9.0));
    assert!(rig.editor.view().problem.unwrap().contains("-1 (flat) to 4"));
    // Flat where nothing is.
    rig.swipe(&[
        px(&rig, DVec3::new(0.75, -0.5, -0.4)),
        px(&rig, DVec3::new(0.75, 0.3, -0.4)),
    ]);
    rig.drain();
    assert!(rig.editor.view().problem.unwrap().contains("no crease or border"));
    assert_eq!(rig.editor.document().handles().len(), 1);
}

#[test]
fn with_symmetry_a_crease_has_a_twin_that_is_as_sharp() {
    let mut rig = ridges();
    rig.command(Command::SetSymmetry(Symmetry::Axis(0)));
    rig.drain();
    draw_beside_ridge(&mut rig);
    rig.command(Command::SharpenCrease(-1.0));
    let width = rig.editor.selected_crease().unwrap().width();
    rig.command(Command::SetCreaseWidth(0.8 * width));
    rig.drain();
    let handles = rig.editor.document().handles();
    let creases = handles.iter().map(|handle| handle.line.as_ref()?.curve()?.crease());
    let creases: Vec<_> = creases.map(Option::unwrap).collect();
    assert!(creases.len() == 2 && creases[0] == creases[1] && creases[0].sharpen() == -1.0);
    assert_eq!(creases[0].width(), 0.8 * width);
    let count = |place: usize| rig.count(pliant_editor::Paint::Handle(handles[place].id));
    assert_eq!(count(0), count(1));
    let view = rig.editor.view();
    let positions = rig.model.surface.positions.iter().zip(view.displacements.iter());
    let (left, right): (Vec<_>, Vec<_>) = positions.partition(|(p, _)| p.x < 0.0);
    let [left, right] = [left, right].map(|side| side.iter().map(|(_, way)| way.z).sum::<f64>());
    assert!(left < -1.0 && (left / right - 1.0).abs() < 1e-6, "{left} {right}");
}

/// A rig with the ridge's handle, sharpened and lifted.
fn sharpened(method: &str) -> Rig {
    let mut rig = ridges();
    rig.choose(method);
    draw_beside_ridge(&mut rig);
    rig.command(Command::SharpenCrease(1.5));
    rig.drain();
    rig.move_by('z', "0.2");
    rig.drain();
    assert!(rig.editor.document().is_settled());
    rig
}

#[test]
fn a_project_with_a_crease_is_reopened_to_the_bit_and_continued() {
    for method in ["bilaplacian", "arap"] {
        let rig = sharpened(method);
        let text = saved(&rig);
        let mut again = reopened(&rig, &text);
        assert_eq!(again.fingerprint(), rig.fingerprint(), "{method}");
        assert_eq!(saved(&again), text, "{method}");
        // It is continued as the rig itself is.
        let mut own = rig;
        let id = own.editor.document().handles()[0].id;
        for rig in [&mut own, &mut again] {
            rig.command(Command::SelectHandle(id));
            rig.command(Command::SharpenCrease(-0.5));
            rig.drain();
            assert_eq!(rig.editor.view().problem, None);
            assert_eq!(rig.editor.selected_crease().unwrap().sharpen(), -0.5);
        }
        let apart = farthest(&shape(&own), &shape(&again));
        assert!(apart < 1e-6, "{method}: {apart:e}");
        again.undo();
        again.drain();
        assert_eq!(again.editor.selected_crease().unwrap().sharpen(), 1.5);
    }
}

#[test]
fn an_exported_edit_with_a_crease_is_reopened_and_resolved_to_the_shown_shape() {
    for method in ["bilaplacian", "arap"] {
        let rig = sharpened(method);
        let exported = rig.editor.edit_file().unwrap().to_json();
        let mut again = reopened(&rig, &exported);
        let of = |rig: &Rig| (curve(rig), rig.editor.document().handles()[0].transform);
        assert_eq!(of(&again), of(&rig), "{method}");
        let apart = farthest(&shape(&rig), &shape(&again));
        assert!(apart < 1e-3, "{method}: {apart:e}");
        let id = again.editor.document().handles()[0].id;
        again.command(Command::SelectHandle(id));
        again.command(Command::SharpenCrease(0.0));
        again.drain();
        assert_eq!(again.editor.selected_crease().unwrap().sharpen(), 0.0);
        // A project is bent by the command line as in the window.
        let project = Project::parse(&saved(&rig)).unwrap();
        for beginning in [Beginning::from(project), Beginning::parse(&exported).unwrap()] {
            assert!(!beginning.resolve(&rig.model).unwrap().lines.is_empty(), "{method}");
        }
    }
}

/// The shape, as displacements from the file's.
fn shape(rig: &Rig) -> Vec<DVec3> {
    rig.editor.document().from_file().to_vec()
}

fn farthest(one: &[DVec3], other: &[DVec3]) -> f64 {
    let pairs = one.iter().zip(other);
    pairs.map(|(one, other)| one.distance(*other)).fold(0.0, f64::max)
}

fn width(rig: &Rig) -> f64 {
    rig.editor.selected_crease().unwrap().width()
}

#[test]
fn a_widened_crease_is_the_one_that_a_wider_brush_finds_in_one_step_that_is_undone() {
    let drawn = |radius_px: f64| {
        let mut rig = ridges();
        rig.command(Command::SetBrushRadius(radius_px));
        draw_beside_ridge(&mut rig);
        rig.command(Command::SharpenCrease(1.0));
        rig.drain();
        rig
    };
    let wide = drawn(60.0);
    for radius_px in [40.0, 90.0] {
        let mut rig = drawn(radius_px);
        let (before, members) = (
            Fingerprint::of(rig.editor.document()),
            rig.editor.document().paint().to_vec(),
        );
        // On its way a slider passes other widths.
        for share in [1.7, 0.6, 1.0] {
            rig.send(Event::Adjust(Command::SetCreaseWidth(share * width(&wide))));
            rig.drain();
        }
        rig.send(Event::Adjusted);
        rig.drain();
        assert_eq!(rig.editor.view().problem, None);
        assert_eq!(
            rig.editor.document().paint(),
            wide.editor.document().paint(),
            "{radius_px}"
        );
        assert!(farthest(&shape(&rig), &shape(&wide)) < 1e-9, "{radius_px}");
        rig.undo();
        rig.drain();
        assert_eq!(rig.editor.document().paint(), members);
        assert_eq!(Fingerprint::of(rig.editor.document()), before);
        rig.redo();
        rig.drain();
        assert!(farthest(&shape(&rig), &shape(&wide)) < 1e-9, "{radius_px}");
    }
}

#[test]
fn a_crease_that_moves_only_its_line_is_known_to_be_narrow() {
    let mut rig = ridges();
    draw_beside_ridge(&mut rig);
    rig.command(Command::SharpenCrease(1.5));
    let whole = width(&rig);
    let mut narrow = 0;
    for share in [1.0, 0.5, 0.25, 0.1] {
        rig.command(Command::SetCreaseWidth(share * whole));
        rig.drain();
        let ways = shape(&rig);
        let moved = rig
            .model
            .surface
            .positions
            .iter()
            .zip(&ways)
            .filter(|(_, way)| way.length() > 1e-9);
        // The rows of vertices beside the ridge are a tenth away from it.
        let farthest = moved.map(|(p, _)| (p.x - 1.5).abs()).fold(0.0, f64::max);
        let is_line = farthest < 0.05;
        assert_eq!(rig.editor.is_crease_narrow(), is_line, "{share}: {farthest} of {whole}");
        narrow += usize::from(is_line);
    }
    assert!((1..4).contains(&narrow), "{narrow}");
}

#[test]
fn a_crease_without_width_is_refused() {
    let mut rig = sharpened("bilaplacian");
    let before = (width(&rig), rig.fingerprint());
    rig.command(Command::SetCreaseWidth(0.0));
    assert!(rig.editor.view().problem.unwrap().contains("above 0"));
    assert_eq!((width(&rig), rig.fingerprint()), before);
}

#[test]
fn an_edit_finds_creases_and_borders_that_its_rough_points_mean_and_a_document_has_the_found_ones() {
    let rig = ridges();
    let found = |points: &str, members: &str| {
        let rough = format!(r#"{{"points": {points}, "snap": 0.5 {members}}}"#);
        let handle = format!(r#"{{"name": "line", "curve": {rough}}}"#);
        let text = format!(r#"{{"version": 1, "method": {{"name": "arap"}}, "handles": [{handle}]}}"#);
        let again = reopened(&rig, &text);
        let exported = again.editor.edit_file().unwrap();
        let setup = EditFile::parse(&text).unwrap().resolve(&rig.model).unwrap();
        let of_setup = setup.handles[0].line.as_ref().unwrap().curve().unwrap().clone();
        assert_eq!(Some(&of_setup), exported.handles[0].curve.as_ref());
        assert_eq!(of_setup.snap(), None);
        assert_eq!(curve(&again), of_setup);
        of_setup
    };
    let ridge = found(
        "[[1.2, -1, 0], [1.8, 1, 0]]",
        r#", "crease": {"width": 0.3, "sharpen": 1}"#,
    );
    assert_eq!(ridge.crease().unwrap().width(), 0.3);
    for point in ridge.rest().points() {
        assert!((point.x - 1.5).abs() < 1e-9 && point.y.abs() < 1.3, "{point}");
    }
    let border = found("[[0.3, 1.9, 0], [2.5, 1.8, 0]]", "");
    for point in border.rest().points() {
        assert!((point.y - 2.0).abs() < 1e-9, "{point}");
    }
    assert!(border.rest().length() > 2.0);
}
