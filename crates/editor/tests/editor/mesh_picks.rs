//! The rims that are clicked and the lines that are drawn for changes of the mesh.

use std::sync::Arc;

use glam::DVec2;
use pliant_editor::{
    Button, Command, CutCurve, CutSight, Event, KeptSide, Key, MeshChange, Modifiers, NamedView, Pointer, RimUse,
    ToolMode,
};
use pliant_mesh::{SurfaceVertex, shapes};

use crate::rig::new_mesh::{bowl, open_shapes, used};
use crate::rig::{CENTRE_PX, Rig, VIEWPORT_PX};

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
fn of_both_sides_of_an_opening_behind_each_other_the_nearer_one_is_pointed_at() {
    let mut rig = Rig::open(bowl());
    rig.command(Command::View(NamedView::Front));
    rig.command(Command::ToggleProjection);
    rig.command(Command::FillHole);
    rig.drain();
    let model = Arc::clone(&rig.model);
    let rim = model.topology.boundary_loops().concat();
    let at = |vertex: SurfaceVertex| model.surface.positions[vertex.index()];
    // Beside the silhouette a rim's vertices are not behind each other.
    let widest = rim.iter().map(|vertex| at(*vertex).x).fold(0.0, f64::max);
    let mut far = 0;
    for &vertex in rim.iter().filter(|vertex| at(**vertex).x.abs() < 0.8 * widest) {
        rig.move_to(rig.editor.view().camera.project(at(vertex), VIEWPORT_PX).unwrap());
        let pointed = rig.editor.view().rim.unwrap().vertex;
        assert!(at(pointed).z > 0.0, "{} behind {}", at(pointed), at(vertex));
        far += usize::from(at(vertex).z < 0.0);
    }
    assert!(far > 5, "{far}");
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
                let MeshChange::Cut(plane, side, spared) = request.change else {
                    panic!("{:?}", request.change)
                };
                assert_eq!((side, spared), (kept, Vec::new()));
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
    // With Shift, the other side goes.
    let shift = |position_px| Pointer {
        position_px,
        modifiers: Modifiers::SHIFT,
    };
    for (kept, turned) in [
        (KeptSide::Positive, KeptSide::Negative),
        (KeptSide::Negative, KeptSide::Positive),
        (KeptSide::Both, KeptSide::Both),
    ] {
        let mut rig = Rig::open(bowl());
        rig.command(Command::CutAlongLine(kept));
        rig.press(DVec2::new(300.0, 320.0));
        rig.send(Event::PointerMoved(shift(DVec2::new(520.0, 250.0))));
        rig.send(Event::PointerReleased(shift(DVec2::new(520.0, 250.0)), Button::Primary));
        let MeshChange::Cut(_, side, _) = rig.editor.take_stitch().unwrap().change else {
            panic!()
        };
        assert_eq!(side, turned);
    }
    // A click draws no line.
    let mut rig = Rig::open(bowl());
    rig.command(Command::CutAlongLine(KeptSide::Positive));
    rig.press(CENTRE_PX);
    rig.release(CENTRE_PX);
    assert!(rig.editor.take_stitch().is_none() && rig.editor.view().wants_cut.is_some());
    rig.key(Key::Escape);
    assert!(rig.editor.view().wants_cut.is_none());
    // A press belongs to the last thing that was chosen.
    rig.command(Command::CutAlongLine(KeptSide::Both));
    rig.command(Command::FillHole);
    assert!(rig.editor.view().wants_cut.is_none() && rig.editor.view().wants_rim.is_some());
    rig.command(Command::SetTool(ToolMode::PaintFixed));
    assert!(rig.editor.view().wants_rim.is_none());
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

/// Draws along points over the view, and gives the curve along which the shape is cut.
fn curve_of(rig: &mut Rig, kept: KeptSide, way_px: &[DVec2]) -> (CutCurve, KeptSide) {
    rig.command(Command::CutAlongCurve(kept));
    rig.swipe(way_px);
    match rig.editor.take_stitch().unwrap().change {
        MeshChange::CutAlong(curve, side, _) => (curve, side),
        change => panic!("{change:?}"),
    }
}

#[test]
fn a_curve_over_the_shape_is_drawn_onto_it_and_closed_where_it_comes_back() {
    for is_parallel in [false, true] {
        // The second one crosses itself before it ends.
        for turns in [0.99, 1.1] {
            let mut rig = Rig::open(bowl());
            if is_parallel {
                rig.command(Command::ToggleProjection);
            }
            let at = |step: i32| {
                let share = turns * f64::from(step) / 60.0;
                let out = 60.0 + 8.0 * (10.0 * share.min(turns - share)).min(1.0);
                CENTRE_PX + out * DVec2::from_angle(std::f64::consts::TAU * share)
            };
            let way: Vec<DVec2> = (0..=60).map(at).collect();
            let (curve, side) = curve_of(&mut rig, KeptSide::Both, &way);
            assert!(curve.is_closed && side == KeptSide::Both && curve.points.len() > 8);
            assert_eq!(matches!(curve.sight, CutSight::Along(_)), is_parallel);
            assert!(rig.editor.view().wants_cut.is_none(), "one drag, one cut");
            let camera = *rig.editor.view().camera;
            for point in &curve.points {
                let px = camera.project(*point, VIEWPORT_PX).unwrap();
                let beside = way.iter().map(|other| other.distance(px)).fold(f64::INFINITY, f64::min);
                assert!(beside < 8.0, "{beside} px from the line");
            }
        }
    }
}

#[test]
fn a_curve_across_a_limb_goes_on_behind_it_and_one_across_a_sheet_ends_at_its_borders() {
    let across = [-1.0, 1.0].map(|side| CENTRE_PX + DVec2::new(side * 390.0, 10.0 * side));
    let way: Vec<DVec2> = (0..=80)
        .map(|step| across[0].lerp(across[1], f64::from(step) / 80.0))
        .collect();
    let mut rig = Rig::open(shapes::icosphere(3));
    let (curve, side) = curve_of(&mut rig, KeptSide::Positive, &way);
    assert!(curve.is_closed && side == KeptSide::Positive);
    let forward = rig.editor.view().camera.forward();
    let behind = curve.points.iter().filter(|point| point.dot(forward) > 0.3).count();
    assert_eq!(behind, 3);
    let mut rig = Rig::open(shapes::grid(16, 16));
    let (curve, _) = curve_of(&mut rig, KeptSide::Positive, &way);
    assert!(!curve.is_closed && curve.points.len() >= 2);
    // A click draws no curve, and says so.
    let mut rig = Rig::open(bowl());
    rig.command(Command::CutAlongCurve(KeptSide::Positive));
    rig.swipe(&[CENTRE_PX, CENTRE_PX + DVec2::X]);
    assert!(rig.editor.take_stitch().is_none());
    assert!(
        rig.editor
            .view()
            .problem
            .is_some_and(|problem| problem.contains("too short"))
    );
}
