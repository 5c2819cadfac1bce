//! Changes of the mesh: the caller makes the new one, which is one step of the history. Undo and redo restore every bit
//! of the document on either mesh, and paint and handles stay on the vertices that survive.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_deform::Budget;
use pliant_editor::{Command, Event, HandleId, MeshChange, Paint, ToolMode};
use pliant_mesh::{Cancel, SurfaceVertex};

use crate::rig::new_mesh::{answer, bowl, closed, follow, open_shapes, present, state};
use crate::rig::{CENTRE_PX, Rig, weld};

#[test]
fn undo_and_redo_restore_every_bit_on_either_mesh() {
    for (case, shape) in open_shapes() {
        let mut rig = Rig::open(shape);
        let mut states = vec![state(&rig)];
        let mut note = |rig: &mut Rig| {
            rig.drain();
            follow(rig);
            states.push(state(rig));
        };
        rig.paint_handle();
        note(&mut rig);
        rig.move_by('x', "0.2");
        note(&mut rig);
        rig.command(Command::FillHoles);
        answer(&mut rig);
        note(&mut rig);
        rig.move_by('y', "0.1");
        note(&mut rig);
        let gone = (0..9).map(SurfaceVertex).collect();
        rig.command(Command::ChangeMesh(MeshChange::Delete(gone)));
        answer(&mut rig);
        note(&mut rig);
        rig.paint(ToolMode::PaintFixed, &[CENTRE_PX + DVec2::new(60.0, 0.0)]);
        note(&mut rig);
        let steps = states.len() - 1;
        assert_eq!(rig.editor.history().names().1, steps, "{case}: each is one step");
        for way in [0, 1] {
            for back in (0..steps).rev() {
                rig.undo();
                rig.drain();
                assert!(state(&rig) == states[back], "{case}: undo {way} to {back}");
            }
            for forth in 1..=steps {
                rig.redo();
                rig.drain();
                assert!(state(&rig) == states[forth], "{case}: redo {way} to {forth}");
            }
        }
        rig.command(Command::GoToStep(1));
        assert!(state(&rig) == states[1], "{case}");
        rig.command(Command::GoToStep(steps));
        assert!(state(&rig) == states[steps], "{case}");
    }
}

#[test]
fn paint_stiffness_and_handles_stay_where_vertices_do_and_a_new_one_continues_its_rim() {
    for (case, shape) in open_shapes() {
        let mut rig = Rig::open(shape);
        rig.paint_handle();
        rig.paint(ToolMode::PaintFree, &[CENTRE_PX + DVec2::new(50.0, 20.0)]);
        rig.paint(ToolMode::PaintFixed, &[CENTRE_PX - DVec2::new(50.0, 20.0)]);
        rig.paint(ToolMode::PaintStiffness, &[CENTRE_PX + DVec2::new(0.0, 60.0)]);
        rig.command(Command::SetTool(ToolMode::Select));
        rig.drain();
        let model = Arc::clone(&rig.model);
        let (paint, stiffness) = {
            let document = rig.editor.document();
            (document.paint().to_vec(), document.stiffness().map(<[f64]>::to_vec))
        };
        let names: Vec<String> = rig.editor.document().handles().iter().map(|h| h.name.clone()).collect();
        rig.command(Command::FillHoles);
        answer(&mut rig);
        let document = rig.editor.document();
        let handles: Vec<String> = document.handles().iter().map(|h| h.name.clone()).collect();
        assert_eq!(handles, names, "{case}");
        let place_in_old = |new: &DVec3| model.surface.positions.iter().position(|old| old == new);
        let mut new_count = 0;
        for (vertex, position) in rig.model.surface.positions.iter().enumerate() {
            let old = place_in_old(position);
            new_count += usize::from(old.is_none());
            let of = |field: Option<&[f64]>, at: usize| field.map_or(1.0, |field| field[at]);
            let now = (document.paint()[vertex], of(document.stiffness(), vertex));
            if let Some(old) = old {
                let before = (paint[old], of(stiffness.as_deref(), old));
                assert_eq!(now, before, "{case}: vertex {vertex}");
                continue;
            }
            let around = rig.model.topology.neighbours(SurfaceVertex(vertex as u32)).iter();
            let rim = around.map(|rim| (document.paint()[rim.index()], of(document.stiffness(), rim.index())));
            let rim: Vec<(Paint, f64)> = rim.collect();
            let range = rim.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), (_, own)| {
                (low.min(*own), high.max(*own))
            });
            assert!(rim.iter().any(|(paint, _)| *paint == now.0), "{case}: vertex {vertex}");
            assert!(
                (range.0 - 1e-12..=range.1 + 1e-12).contains(&now.1),
                "{case}: vertex {vertex}"
            );
        }
        assert_eq!(
            new_count,
            model.topology.boundary_loops().len(),
            "{case}: one for each fan"
        );

        // A handle goes with its last vertex.
        let of_handle = |paint: &Paint| matches!(paint, Paint::Handle(_));
        let painted = document
            .paint()
            .iter()
            .enumerate()
            .filter(|(_, paint)| of_handle(paint));
        let gone: Vec<SurfaceVertex> = painted.map(|(vertex, _)| SurfaceVertex(vertex as u32)).collect();
        rig.command(Command::ChangeMesh(MeshChange::Delete(gone)));
        answer(&mut rig);
        assert!(rig.editor.document().handles().is_empty(), "{case}");
        // The fixed vertices that still have a triangle are as many as before.
        let fixed = |rig: &Rig| rig.count(Paint::Fixed);
        let left = fixed(&rig);
        rig.undo();
        follow(&mut rig);
        assert!(left <= fixed(&rig) && (left > 0) == (fixed(&rig) > 0), "{case}: {left}");
    }
}

#[test]
fn a_bent_shape_rests_in_the_new_mesh_and_bends_on_from_there() {
    for (case, shape) in open_shapes() {
        let mut rig = Rig::open(shape);
        rig.paint_handle();
        rig.move_by('x', "0.3");
        rig.drain();
        let bent: Vec<DVec3> = {
            let shown = rig
                .model
                .surface
                .positions
                .iter()
                .zip(rig.editor.view().displacements.iter());
            shown.map(|(rest, displacement)| *rest + *displacement).collect()
        };
        rig.command(Command::FillHoles);
        assert!(!rig.editor.is_settled(), "{case}: a save waits for the new mesh");
        answer(&mut rig);
        assert!(rig.editor.is_settled() && rig.editor.view().unsaved, "{case}");
        assert_eq!(rig.largest_displacement(), 0.0, "{case}");
        let document = rig.editor.document();
        assert!(!document.is_displaced() && !document.is_applied(), "{case}");
        let now = &rig.model.surface.positions;
        assert!(
            bent.iter().all(|position| now.contains(position)),
            "{case}: the shape that was seen"
        );
        rig.move_by('y', "0.2");
        rig.drain();
        rig.assert_as_meant(case);
    }
}

#[test]
fn a_change_that_comes_too_late_or_fails_leaves_everything() {
    let mut rig = Rig::open(bowl());
    rig.paint_handle();
    rig.drain();
    rig.command(Command::FillHoles);
    assert!(!rig.editor.is_enabled(&Command::FillHoles), "one at a time");
    let request = rig.editor.take_stitch().unwrap();
    assert!(rig.editor.take_stitch().is_none(), "it is asked for once");
    rig.move_by('x', "0.1");
    rig.drain();
    let before = state(&rig);
    let new = weld(closed(present(&request, &rig.model), &rig.model));
    let made = request.onto(new, None, Budget::default(), &Cancel::new()).unwrap();
    rig.send(Event::Stitched(Ok(Box::new(made))));
    assert!(state(&rig) == before);
    let problem = rig.editor.view().problem.unwrap_or_default().to_owned();
    assert!(problem.contains("changed in the meantime"), "{problem}");

    rig.command(Command::FillHoles);
    assert!(rig.editor.take_stitch().is_some());
    rig.send(Event::Stitched(Err("it can't be: try another.".to_owned())));
    assert_eq!(rig.editor.view().problem, Some("it can't be: try another."));
    assert!(state(&rig) == before && rig.editor.is_enabled(&Command::FillHoles));

    // Outside a file, and in a work pose, there is a reason.
    rig.command(Command::WorkPose);
    let why = rig.editor.unavailable_because(&Command::FillHoles).unwrap_or_default();
    assert!(why.contains("work pose"), "{why}");
}

#[test]
fn the_paint_of_the_handle_or_region_is_deleted_and_a_locked_handle_refuses() {
    let mut rig = Rig::open(bowl());
    let why = rig.editor.unavailable_because(&Command::DeleteRegion);
    assert!(why.is_some_and(|why| why.contains("region")), "nothing is selected");
    rig.paint_handle();
    rig.paint(ToolMode::PaintFixed, &[CENTRE_PX + DVec2::new(80.0, 0.0)]);
    rig.drain();
    for (mode, role) in [
        (ToolMode::PaintFixed, Paint::Fixed),
        (ToolMode::Select, Paint::Handle(HandleId(0))),
    ] {
        rig.command(Command::SetTool(mode));
        rig.command(Command::SelectHandle(HandleId(0)));
        rig.command(Command::SetTool(mode));
        rig.command(Command::DeleteRegion);
        let request = rig.editor.take_stitch().unwrap();
        let MeshChange::Delete(vertices) = &request.change else {
            panic!("{:?}", request.change)
        };
        assert!(!vertices.is_empty() && vertices.len() == rig.count(role));
        let paint = rig.editor.document().paint();
        assert!(vertices.iter().all(|vertex| paint[vertex.index()] == role));
        rig.send(Event::Stitched(Err("not now".to_owned())));
    }
    rig.command(Command::ToggleHandleLocked(HandleId(0)));
    let why = rig
        .editor
        .unavailable_because(&Command::DeleteRegion)
        .unwrap_or_default();
    assert!(why.contains("locked"), "{why}");
}

#[test]
fn keys_go_on_in_the_new_mesh_and_play_ends_before_it() {
    let mut rig = Rig::open(bowl());
    rig.paint_handle();
    rig.command(Command::KeyHere);
    rig.command(Command::GoToTime(1.0));
    rig.move_by('x', "0.3");
    rig.drain();
    rig.command(Command::KeyHere);
    let farthest = |rig: &Rig| {
        let shown = rig
            .model
            .surface
            .positions
            .iter()
            .zip(rig.editor.view().displacements.iter());
        shown.map(|(rest, way)| (*rest + *way).x).fold(f64::MIN, f64::max)
    };
    let reached = farthest(&rig);
    rig.command(Command::GoToTime(0.0));
    rig.drain();
    rig.command(Command::PlayKeys);
    for _ in 0..4 {
        rig.send(Event::Tick);
        rig.drain();
    }
    assert!(rig.editor.view().is_animating);
    rig.command(Command::FillHoles);
    answer(&mut rig);
    assert!(!rig.editor.view().is_animating);
    assert_eq!(rig.editor.view().undo, Some("Fill holes"));
    let filled = state(&rig);
    rig.undo();
    rig.drain();
    let played = state(&rig);
    rig.undo();
    rig.redo();
    rig.drain();
    assert!(
        state(&rig) == played,
        "the stretch of play is a step on the former mesh"
    );
    rig.redo();
    rig.drain();
    follow(&mut rig);
    assert!(state(&rig) == filled);
    // The keys lead to the same shape, from the rest shape in which the mesh was filled.
    rig.command(Command::GoToTime(1.0));
    rig.drain();
    assert!(
        (farthest(&rig) - reached).abs() < 0.02,
        "{} is not {reached}",
        farthest(&rig)
    );
}
