//! Changes of the mesh: the caller makes the new one, which is one step of the history. Undo and redo restore every bit
//! of the document on either mesh, and paint and handles stay on the vertices that survive.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};
use pliant_editor::{
    Command, Event, HandleId, KeptSide, Key, MergeSettings, MeshChange, Paint, Placement, REACH_RANGE, RimUse,
    StitchRequest, ToolMode,
};
use pliant_mesh::{Drawn, DrawnVertex, FileVertex, Model, SurfaceVertex, shapes};

use crate::rig::{CENTRE_PX, Fingerprint, Rig, VIEWPORT_PX, weld};

/// A ball without its triangles below a plane: it has one hole.
fn bowl() -> Drawn {
    let mut ball = shapes::icosphere(3);
    let height = ball.positions.clone();
    ball.triangles
        .retain(|corners| corners.iter().any(|corner| height[corner.index()].y > -0.6));
    used(ball)
}

/// Meshes with holes, of several classes.
fn open_shapes() -> Vec<(&'static str, Drawn)> {
    let lid = shapes::moved(&bowl(), DAffine3::from_translation(DVec3::X * 2.5));
    vec![
        ("a bowl", bowl()),
        ("a tube", used(shapes::tube(16, 12, 2.0))),
        ("a sheet", shapes::grid(16, 16)),
        ("two bowls", shapes::together(&[bowl(), lid])),
        ("a bowl with broken triangles", shapes::broken(&bowl())),
    ]
}

/// The same without unused vertices.
fn used(shape: Drawn) -> Drawn {
    let is_used: BTreeSet<u32> = shape.triangles.iter().flatten().map(|corner| corner.0).collect();
    let number: Vec<u32> = is_used.iter().copied().collect();
    let place = |old: DrawnVertex| DrawnVertex(number.binary_search(&old.0).unwrap() as u32);
    Drawn {
        positions: number.iter().map(|&old| shape.positions[old as usize]).collect(),
        triangles: shape.triangles.iter().map(|corners| corners.map(place)).collect(),
        file_vertex: (0..number.len() as u32).map(FileVertex).collect(),
        file_vertex_count: number.len(),
        ..Drawn::default()
    }
}

/// The present shape of the surface, to be changed by hand.
fn present(request: &StitchRequest, model: &Model) -> Drawn {
    let surface = &model.surface;
    let shown = surface.positions.iter().zip(request.displacements());
    let count = surface.positions.len();
    let drawn = |vertex: SurfaceVertex| DrawnVertex(vertex.0);
    Drawn {
        positions: shown.map(|(rest, displacement)| *rest + *displacement).collect(),
        triangles: surface.triangles.iter().map(|corners| corners.map(drawn)).collect(),
        file_vertex: (0..count as u32).map(FileVertex).collect(),
        file_vertex_count: count,
        ..Drawn::default()
    }
}

/// Closes every hole by a fan around a point beside its middle, where no other vertex is.
fn closed(mut shape: Drawn, model: &Model) -> Drawn {
    for rim in model.topology.boundary_loops() {
        let apex = DrawnVertex(shape.positions.len() as u32);
        let sum: DVec3 = rim.iter().map(|vertex| shape.positions[vertex.index()]).sum();
        let beside = DVec3::new(0.031, 0.071, 0.113);
        shape.positions.push(sum / rim.len() as f64 + beside);
        shape.file_vertex.push(FileVertex(apex.0));
        for (place, from) in rim.iter().enumerate() {
            let to = rim[(place + 1) % rim.len()];
            shape.triangles.push([DrawnVertex(from.0), DrawnVertex(to.0), apex]);
        }
    }
    shape.file_vertex_count = shape.positions.len();
    shape
}

/// Gives the editor the mesh that it has asked for, made by hand.
fn answer(rig: &mut Rig) {
    let request = rig.editor.take_stitch().expect("a change was asked for");
    let model = Arc::clone(&rig.model);
    let shape = present(&request, &model);
    let shape = match &request.change {
        MeshChange::Delete(vertices) => {
            let gone: BTreeSet<u32> = vertices.iter().map(|vertex| vertex.0).collect();
            let mut left = shape;
            left.triangles
                .retain(|corners| !corners.iter().any(|corner| gone.contains(&corner.0)));
            used(left)
        }
        MeshChange::Append(_) => {
            let beside = DAffine3::from_translation(DVec3::X * 2.2);
            shapes::together(&[shape, shapes::moved(&bowl(), beside)])
        }
        _ => closed(shape, &model),
    };
    let made = request.onto(weld(shape), None);
    rig.send(Event::Stitched(Ok(Box::new(made))));
    follow(rig);
    rig.drain();
}

/// The rig's own mesh is the editor's.
fn follow(rig: &mut Rig) {
    rig.model = Arc::clone(rig.editor.view().model.unwrap());
}

/// The document and its mesh.
fn state(rig: &Rig) -> (Fingerprint, *const Model) {
    (rig.fingerprint(), Arc::as_ptr(rig.editor.view().model.unwrap()))
}

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
fn paint_stiffness_and_handles_stay_where_vertices_do_and_a_new_one_is_bare() {
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
            let expected = old.map_or(Paint::Bare, |old| paint[old]);
            assert_eq!(document.paint()[vertex], expected, "{case}: vertex {vertex}");
            let of = |field: Option<&[f64]>, at: usize| field.map_or(1.0, |field| field[at]);
            let before = old.map_or(1.0, |old| of(stiffness.as_deref(), old));
            assert_eq!(of(document.stiffness(), vertex), before, "{case}: vertex {vertex}");
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
    let made = request.onto(weld(closed(present(&request, &rig.model), &rig.model)), None);
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
fn the_rim_near_the_pointer_is_shown_with_its_length_and_a_click_takes_it() {
    for (case, shape) in open_shapes() {
        let mut rig = Rig::open(shape);
        rig.command(Command::FillHole);
        assert!(rig.editor.view().wants_rim == Some(RimUse::Fill), "{case}");
        for rim in rig.model.topology.boundary_loops() {
            let model = Arc::clone(&rig.model);
            let at = |vertex: SurfaceVertex| model.surface.positions[vertex.index()];
            let length: f64 = (0..rim.len())
                .map(|k| at(rim[k]).distance(at(rim[(k + 1) % rim.len()])))
                .sum();
            // A vertex of it that no other rim is near to on the screen.
            let camera = *rig.editor.view().camera;
            let px = |vertex: SurfaceVertex| camera.project(at(vertex), VIEWPORT_PX).unwrap();
            let others: Vec<DVec2> = rig
                .model
                .topology
                .boundary_loops()
                .iter()
                .filter(|other| **other != rim)
                .flatten()
                .map(|vertex| px(*vertex))
                .collect();
            let is_alone = |vertex: &SurfaceVertex| others.iter().all(|other| other.distance(px(*vertex)) > 45.0);
            let Some(vertex) = rim.iter().copied().find(is_alone) else {
                continue;
            };
            rig.move_to(px(vertex));
            let view = rig.editor.view();
            let shown = view.rim.expect(case);
            assert_eq!(shown.edges(), rim.len(), "{case}");
            assert!((shown.length - length).abs() < 1e-12 * length, "{case}");
            assert!(rim.contains(&shown.vertex), "{case}");
            assert!(
                view.status.contains(&format!("{} edges", rim.len())),
                "{case}: {}",
                view.status
            );
            rig.press(px(vertex));
            rig.release(px(vertex));
            let request = rig.editor.take_stitch().expect(case);
            assert!(
                matches!(request.change, MeshChange::FillAt(vertex) if rim.contains(&vertex)),
                "{case}"
            );
            assert!(rig.editor.view().wants_rim.is_none(), "{case}: one click, one hole");
            rig.send(Event::Stitched(Err("not now".to_owned())));
            rig.command(Command::FillHole);
        }
        rig.move_to(DVec2::new(3.0, 3.0));
        assert!(rig.editor.view().rim.is_none(), "{case}: far from every rim");
        rig.key(Key::Escape);
        assert!(rig.editor.view().wants_rim.is_none(), "{case}");
        assert!(
            rig.editor.view().shapes.is_empty(),
            "{case}: the rims are no longer shown"
        );
    }
}

#[test]
fn a_line_cuts_by_the_plane_through_it_and_the_eye_and_keeps_the_side_that_is_asked_for() {
    let ways = [
        [300.0, 320.0, 520.0, 250.0],
        [500.0, 200.0, 380.0, 410.0],
        [420.0, 100.0, 380.0, 500.0],
    ];
    for is_parallel in [false, true] {
        for [fx, fy, tx, ty] in ways {
            for kept in [KeptSide::Positive, KeptSide::Negative, KeptSide::Both] {
                let mut rig = Rig::open(bowl());
                if is_parallel {
                    rig.command(Command::ToggleProjection);
                }
                let (from, to) = (DVec2::new(fx, fy), DVec2::new(tx, ty));
                rig.command(Command::CutAlongLine(kept));
                assert!(
                    rig.editor.view().status.contains("Drag a line"),
                    "{}",
                    rig.editor.view().status
                );
                rig.press(from);
                rig.move_to(0.5 * (from + to));
                assert!(rig.editor.view().outline_px.len() > 2);
                rig.move_to(to);
                rig.release(to);
                let request = rig.editor.take_stitch().unwrap();
                let MeshChange::Cut(plane, side) = request.change else {
                    panic!("{:?}", request.change)
                };
                assert_eq!(side, kept);
                assert!(rig.editor.view().wants_cut.is_none(), "one drag, one cut");
                let camera = *rig.editor.view().camera;
                for point in &rig.model.surface.positions {
                    let px = camera.project(*point, VIEWPORT_PX).unwrap();
                    // y points down, so the left of the line is where this is negative.
                    let to_right = (to - from).perp_dot(px - from) / (to - from).length();
                    let level = plane.normal.dot(*point) - plane.distance;
                    if to_right.abs() > 1e-6 {
                        assert_eq!(level > 0.0, to_right < 0.0, "{to_right} px to the right of the line");
                    }
                }
            }
        }
    }
    // A click draws no line.
    let mut rig = Rig::open(bowl());
    rig.command(Command::CutAlongLine(KeptSide::Positive));
    rig.press(CENTRE_PX);
    rig.release(CENTRE_PX);
    assert!(rig.editor.take_stitch().is_none() && rig.editor.view().wants_cut.is_some());
    rig.key(Key::Escape);
    assert!(rig.editor.view().wants_cut.is_none());
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
fn a_bridge_takes_two_rims_and_esc_gives_the_first_one_up() {
    let mut rig = Rig::open(used(shapes::tube(16, 12, 2.0)));
    let rims = rig.model.topology.boundary_loops();
    let model = Arc::clone(&rig.model);
    let place = |rig: &Rig, rim: &[SurfaceVertex]| {
        let camera = *rig.editor.view().camera;
        let px = |vertex: &SurfaceVertex| {
            let position = model.surface.positions[vertex.index()];
            camera.project(position, VIEWPORT_PX).unwrap()
        };
        // The vertex furthest from the middle of the view.
        let places = rim.iter().map(px);
        places
            .max_by(|a, b| a.distance(CENTRE_PX).total_cmp(&b.distance(CENTRE_PX)))
            .unwrap()
    };
    for is_given_up in [true, false] {
        rig.command(Command::BridgeBorders);
        let first = place(&rig, &rims[0]);
        rig.press(first);
        rig.release(first);
        assert!(rig.editor.take_stitch().is_none());
        let wanted = rig.editor.view().wants_rim;
        let Some(RimUse::Bridge { first: Some(first) }) = wanted else {
            panic!("{wanted:?}")
        };
        assert!(rims[0].contains(&first));
        if is_given_up {
            rig.key(Key::Escape);
            assert!(rig.editor.view().wants_rim.is_none());
            continue;
        }
        let second = place(&rig, &rims[1]);
        rig.press(second);
        rig.release(second);
        let request = rig.editor.take_stitch().unwrap();
        let MeshChange::Bridge([a, b]) = request.change else {
            panic!("{:?}", request.change)
        };
        assert!(rims[0].contains(&a) && rims[1].contains(&b));
    }
}

/// A bowl with another one appended, whose handle is selected.
fn appended() -> Rig {
    let mut rig = Rig::open(bowl());
    rig.command(Command::ChangeMesh(MeshChange::Append("lid".to_owned())));
    answer(&mut rig);
    rig
}

#[test]
fn an_appended_part_gets_a_handle_that_moves_it_alone_wherever_it_touches() {
    let mut rig = appended();
    let count = used(bowl()).positions.len();
    let handle = rig.editor.document().handles()[0].clone();
    assert_eq!((&*handle.name, rig.editor.view().selected), ("lid", Some(handle.id)));
    assert_eq!(rig.count(Paint::Handle(handle.id)), count);
    assert!(
        rig.editor.document().paint()[..count]
            .iter()
            .all(|paint| *paint == Paint::Bare)
    );
    // Far into the other bowl, and on through it: each is a step, and the first bowl rests to the bit.
    let before = state(&rig);
    for _ in 0..2 {
        rig.move_by('x', "-1.7");
        rig.drain();
        let ways = rig.editor.document().from_file();
        assert!(ways[..count].iter().all(|way| *way == DVec3::ZERO));
        assert!(
            ways[count..]
                .iter()
                .all(|way| (way.x % 1.7).abs() < 1e-9 && way.x < -1.0)
        );
    }
    rig.undo();
    rig.undo();
    rig.drain();
    assert!(state(&rig) == before);
    rig.undo();
    assert_eq!(rig.editor.view().model.unwrap().surface.positions.len(), count);
    assert!(rig.editor.document().handles().is_empty());
}

#[test]
fn a_mirrored_part_is_turned_so_that_it_still_faces_outwards_and_undo_takes_both_back() {
    let mut rig = appended();
    let before = rig.fingerprint();
    let count = used(bowl()).positions.len();
    for axis in 0..3 {
        rig.command(Command::MirrorPart(axis));
        rig.drain();
        let document = rig.editor.document();
        let turned: Vec<u32> = document.inside_out().iter().copied().collect();
        let component = rig.model.topology.component(SurfaceVertex(count as u32));
        assert_eq!(turned, [component]);
        assert!(document.handles()[0].affine().matrix3.determinant() < 0.0);
        rig.command(Command::MirrorPart(axis));
        rig.drain();
        assert!(
            rig.editor.document().inside_out().is_empty(),
            "a second time mirrors it back"
        );
        rig.undo();
        rig.undo();
        rig.drain();
        assert_eq!(rig.fingerprint(), before);
    }
}

#[test]
fn a_merge_asks_for_the_part_of_the_selected_handle_and_sorts_the_picked_places() {
    let mut rig = Rig::open(bowl());
    rig.paint_handle();
    rig.drain();
    let why = rig.editor.unavailable_because(&Command::Merge).unwrap_or_default();
    assert!(why.contains("holds no whole part"), "{why}");

    let mut rig = appended();
    let count = used(bowl()).positions.len();
    let part: Vec<SurfaceVertex> = (count as u32..2 * count as u32).map(SurfaceVertex).collect();
    let settings = MergeSettings {
        reach: 7.0,
        placement: Placement::Fitted,
        ..MergeSettings::default()
    };
    rig.command(Command::SetMerge(settings));
    let settings = rig.editor.view().merge.clone();
    assert_eq!(
        (settings.reach, settings.placement),
        (*REACH_RANGE.end(), Placement::Fitted)
    );
    rig.command(Command::Merge);
    let asked = |rig: &mut Rig| {
        let request = rig.editor.take_stitch().unwrap();
        rig.send(Event::Stitched(Err("not now".to_owned())));
        match request.change {
            MeshChange::Merge(change) => change,
            other => panic!("{other:?}"),
        }
    };
    let change = asked(&mut rig);
    assert_eq!(
        (change.part, change.pairs, change.settings),
        (part.clone(), Vec::new(), settings.clone())
    );

    let rims = rig.model.topology.boundary_loops();
    let model = Arc::clone(&rig.model);
    let px = |rig: &Rig, vertex: SurfaceVertex| {
        let position = model.surface.positions[vertex.index()];
        rig.editor.view().camera.project(position, VIEWPORT_PX).unwrap()
    };
    rig.command(Command::FrameAll);
    let of_part = |held: bool| rims.iter().find(|rim| part.contains(&rim[0]) == held).unwrap()[0];
    for order in [[true, false], [false, true]] {
        rig.command(Command::MergePicked);
        for held in order {
            let at = px(&rig, of_part(held));
            rig.press(at);
            rig.release(at);
        }
        let change = asked(&mut rig);
        let [[a, b]] = change.pairs[..] else {
            panic!("{:?}", change.pairs)
        };
        assert!(!part.contains(&a) && part.contains(&b), "A comes first");
    }
    rig.command(Command::MergePicked);
    for _ in 0..2 {
        let at = px(&rig, of_part(true));
        rig.press(at);
        rig.release(at);
    }
    assert!(rig.editor.take_stitch().is_none());
    let problem = rig.editor.view().problem.unwrap_or_default().to_owned();
    assert!(problem.contains("on one side"), "{problem}");
}
