//! Laws of the document, on random walks through the whole program.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

use crate::rig;
use crate::rig::{Fingerprint, Random, Rig};
use glam::{DVec2, DVec3};
use pliant_deform::Loose;
use pliant_editor::{
    BrushMetric, Button, Command, Cursor, Depth, Event, GizmoOrientation, GizmoPart, Handle, Key, Modifiers,
    ObjectAction, Paint, PivotPlace, Pointer, Reach, RegionAction, StiffnessAction, StiffnessBrush, StrokeShape,
    ToolMode,
};
use pliant_mesh::{Drawn, Object, shapes};

/// Meshes that are closed, with boundary, and in several parts.
fn meshes() -> Vec<(&'static str, Drawn)> {
    let mut apart = shapes::icosphere(2);
    for position in &mut apart.positions {
        position.x += 1.6;
    }
    vec![
        ("sphere", shapes::icosphere(3)),
        ("tube", shapes::tube(16, 12, 3.0)),
        ("two parts", shapes::together(&[shapes::icosphere(3), apart])),
    ]
}

/// The first and the second half of the triangles, two objects.
fn halves(drawn: &Drawn) -> Vec<Object> {
    let count = drawn.triangles.len() as u32;
    let half = |triangles| Object {
        triangles: std::iter::once(triangles).collect(),
        ..Object::default()
    };
    vec![half(0..count / 2), half(count / 2..count)]
}

const MODES: [ToolMode; 4] = [
    ToolMode::PaintHandle,
    ToolMode::PaintFree,
    ToolMode::PaintFixed,
    ToolMode::Erase,
];
const PARTS: [GizmoPart; 6] = [
    GizmoPart::Centre,
    GizmoPart::Arrow(0),
    GizmoPart::Arrow(2),
    GizmoPart::Square(1),
    GizmoPart::Ring(1),
    GizmoPart::Box(0),
];

/// A possible action of a person. Some are strokes and changes of role, which must move nothing.
fn act(rig: &mut Rig, random: &mut Random) {
    match random.below(24) {
        22..24 => act_on_objects(rig, random),
        16..18 => act_on_regions(rig, random),
        18..20 => act_on_handles(rig, random),
        20 => stiffness_stroke(rig, random),
        21 => {
            let steps = rig.editor.history().names().0.len() as u64;
            rig.command(Command::GoToStep(random.below(steps + 1) as usize));
        }
        0..4 => stroke(rig, random),
        4..8 => {
            let part = PARTS[random.below(PARTS.len() as u64) as usize];
            let by_px = DVec2::new(random.unit() - 0.5, random.unit() - 0.5) * 60.0;
            rig.drag(part, by_px);
        }
        8 => {
            rig.type_keys(["gx.2", "gz-.1", "ry30", "r45", "s1.1", "sz.9", "gx.3"][random.below(7) as usize]);
            rig.key(if random.below(2) == 0 { Key::Enter } else { Key::Escape });
        }
        9 => rig.undo(),
        10 => rig.redo(),
        11 => {
            let reaches = [
                Reach::Radii(2.0),
                Reach::Length(0.3),
                Reach::Creased(0.4),
                Reach::Bounded(0.4),
                Reach::Radii(4.0),
            ];
            let reach = reaches[random.below(reaches.len() as u64) as usize];
            if let Some(id) = rig.editor.view().selected {
                unmoved(rig, |rig| rig.command(Command::SetReach(id, reach)));
            }
        }
        12 => {
            let command = [
                Command::NewHandle,
                Command::NextHandle,
                Command::DeleteHandle,
                Command::PinOrUnpin,
                Command::Apply,
            ][random.below(5) as usize]
                .clone();
            match command {
                Command::Apply => unmoved_but_in_numbers(rig, |rig| rig.command(command)),
                _ => unmoved(rig, |rig| rig.command(command)),
            }
        }
        13 => {
            let stiffness = (0..rig.model.surface.positions.len())
                .map(|v| 1.0 + (v % 3) as f64)
                .collect();
            rig.command(if random.below(3) == 0 {
                Command::ResetShape
            } else {
                Command::SetStiffness(stiffness)
            });
        }
        14 if random.below(3) == 0 => {
            let part = random.below(rig.model.topology.components().len() as u64) as u32;
            let loose = [None, Some(Loose::Follow), Some(Loose::Rest), Some(Loose::Bend)][random.below(4) as usize];
            match rig.editor.view().selected {
                Some(id) if random.below(2) == 0 => {
                    rig.command(Command::SetContinuity(
                        id,
                        [None, Some(0.0), Some(1.3)][random.below(3) as usize],
                    ));
                }
                _ => rig.command(Command::SetLoosePart(part, loose)),
            }
        }
        14 => {
            let soft = [None, Some(0.3), Some(40.0)][random.below(3) as usize];
            match rig.editor.view().selected {
                Some(id) if random.below(2) == 0 => rig.command(Command::SetSoft(id, soft)),
                _ => rig.command(Command::ResetHandle),
            }
        }
        _ => {
            let alt = |position_px| Pointer {
                position_px,
                modifiers: Modifiers::ALT,
            };
            rig.editor
                .handle(Event::PointerPressed(alt(DVec2::ZERO), Button::Primary));
            rig.editor
                .handle(Event::PointerMoved(alt(DVec2::new(random.unit() * 200.0, 30.0))));
            rig.editor
                .handle(Event::PointerReleased(alt(DVec2::ZERO), Button::Primary));
        }
    }
}

/// A whole region changes its role or shape: nothing moves.
fn act_on_regions(rig: &mut Rig, random: &mut Random) {
    let actions = [
        RegionAction::Grow,
        RegionAction::Shrink,
        RegionAction::Invert,
        RegionAction::EverythingBut,
        RegionAction::SmoothBorder,
        RegionAction::FillParts,
        RegionAction::Mirror(0),
        RegionAction::Mirror(2),
        RegionAction::ToFree,
        RegionAction::ToFixed,
        RegionAction::ToHandle,
    ];
    rig.command(Command::SetTool(MODES[random.below(4) as usize]));
    let action = actions[random.below(actions.len() as u64) as usize];
    unmoved(rig, |rig| rig.command(Command::Region(action)));
}

/// An action from the list of objects, or on the part under the pointer: nothing moves.
fn act_on_objects(rig: &mut Rig, random: &mut Random) {
    let actions = [
        ObjectAction::Hide,
        ObjectAction::Show,
        ObjectAction::Solo,
        ObjectAction::Lock,
        ObjectAction::Unlock,
    ];
    let objects = rig.model.all_objects().len() as u64;
    let command = match random.below(6) {
        0 => Command::Isolate,
        1 => Command::ShowEverything,
        _ => Command::Objects(actions[random.below(5) as usize], vec![random.below(objects) as u32]),
    };
    rig.move_to(random.position_px());
    unmoved(rig, |rig| rig.command(command));
}

/// An action from the list of handles. All except the reset of a region move nothing.
fn act_on_handles(rig: &mut Rig, random: &mut Random) {
    let Some(id) = rig.editor.view().selected else { return };
    let command = match random.below(14) {
        0 => Command::SetHandleColour(id, [random.below(256) as u8, 20, 200, 255]),
        1 => Command::ToggleHandleVisible(id),
        2 => Command::ToggleHandleLocked(id),
        3 => Command::SetPivotPlace(id, PivotPlace::Border),
        4 => Command::SetPivotPlace(id, PivotPlace::Centroid),
        5 => Command::DuplicateHandle,
        6 => {
            // Its twin gets the mirrored transform of a handle that has already moved.
            let is_displaced = |handle: &Handle| handle.id == id && handle.is_displaced();
            let moves = rig.editor.document().handles().iter().any(is_displaced);
            let twin = Command::MakeTwin(random.below(3) as usize);
            match moves {
                true => rig.command(twin),
                false => unmoved(rig, |rig| rig.command(twin)),
            }
            return;
        }
        7 => Command::Untwin,
        8 => Command::ToggleSelected(rig.editor.document().handles()[0].id),
        9 => Command::SetOrientation([GizmoOrientation::Local, GizmoOrientation::View][random.below(2) as usize]),
        10 => Command::SetPivot(id, DVec3::new(random.unit(), random.unit(), 0.3)),
        11 | 12 => {
            // Children move with their parents, and circles are refused.
            let handles = rig.editor.document().handles();
            let parent = handles[random.below(handles.len() as u64) as usize].id;
            Command::SetParent(id, (random.below(4) > 0).then_some(parent))
        }
        _ => {
            rig.command(Command::ResetRegion);
            return;
        }
    };
    match command {
        // The numbers are about the pivot.
        Command::SetPivotPlace(..) | Command::SetPivot(..) => {
            unmoved_but_in_numbers(rig, |rig| rig.command(command));
        }
        _ => unmoved(rig, |rig| rig.command(command)),
    }
}

fn stiffness_stroke(rig: &mut Rig, random: &mut Random) {
    let action = [StiffnessAction::Paint, StiffnessAction::Smooth, StiffnessAction::Erase][random.below(3) as usize];
    rig.command(Command::SetStiffnessBrush(StiffnessBrush {
        action,
        value: [0.01, 5.0, 1e9][random.below(3) as usize],
        strength: random.unit(),
        falloff: random.unit(),
    }));
    rig.command(Command::SetTool(ToolMode::PaintStiffness));
    let (from_px, to_px) = (random.position_px(), random.position_px());
    unmoved(rig, |rig| rig.swipe(&[from_px, to_px]));
}

/// Whether a press takes the painted handle along, which is no stroke.
fn takes_handle(rig: &mut Rig, position_px: DVec2) -> bool {
    rig.move_to(position_px);
    rig.editor.view().cursor == Cursor::Grab
}

fn stroke(rig: &mut Rig, random: &mut Random) {
    rig.command(Command::SetTool(MODES[random.below(4) as usize]));
    rig.command(Command::SetBrushRadius(10.0 + 40.0 * random.unit()));
    rig.command(Command::SetBrushMetric(
        [BrushMetric::Screen, BrushMetric::Surface][random.below(2) as usize],
    ));
    let shapes = [
        StrokeShape::Brush,
        StrokeShape::Brush,
        StrokeShape::Lasso,
        StrokeShape::Box,
        StrokeShape::Component,
    ];
    let shape = shapes[random.below(5) as usize];
    rig.command(Command::SetStrokeShape(shape));
    rig.command(Command::SetDepth(
        [Depth::Visible, Depth::Through][random.below(2) as usize],
    ));
    let way_px: Vec<DVec2> = (0..1 + random.below(4)).map(|_| random.position_px()).collect();
    if takes_handle(rig, way_px[0]) {
        return rig.swipe(&way_px);
    }
    if random.below(5) == 0 && shape != StrokeShape::Component {
        let before = rig.fingerprint();
        unmoved(rig, |rig| {
            rig.press(way_px[0]);
            rig.move_to(random.position_px());
            rig.key(Key::Escape);
        });
        assert!(before == rig.fingerprint(), "an aborted stroke leaves nothing");
    } else {
        unmoved(rig, |rig| rig.swipe(&way_px));
    }
}

/// Executes an action that must not move a drawn vertex, now or when its jobs are done, and must keep each handle's
/// numbers.
fn unmoved(rig: &mut Rig, action: impl FnOnce(&mut Rig)) {
    let before = rig.editor.document().handles().to_vec();
    unmoved_but_in_numbers(rig, action);
    for handle in rig.editor.document().handles() {
        if let Some(former) = before.iter().find(|former| former.id == handle.id) {
            assert!(
                (former.transform, former.turn_deg) == (handle.transform, handle.turn_deg),
                "{} was put elsewhere: {:?} became {:?}",
                handle.name,
                former.transform,
                handle.transform
            );
        }
    }
}

/// Executes an action that must not move a drawn vertex, now or when its jobs are done.
fn unmoved_but_in_numbers(rig: &mut Rig, action: impl FnOnce(&mut Rig)) {
    let before = rig.drawn();
    action(rig);
    assert!(before == rig.drawn(), "a drawn vertex moved");
    rig.drain();
    assert!(before == rig.drawn(), "a drawn vertex moved when the jobs were done");
}

#[test]
fn strokes_move_nothing_and_every_step_comes_back_to_the_bit() {
    let meshes = meshes();
    for seed in 0..10 {
        let ((name, drawn), method) = (&meshes[seed as usize % 3], ["arap", "bilaplacian"][seed as usize % 2]);
        let mut random = Random(seed);
        let mut rig = Rig::open_with_objects(drawn.clone(), halves(drawn));
        // The document at each position of the history.
        let mut states = vec![rig.fingerprint()];
        rig.choose(method);
        if states[0] != rig.fingerprint() {
            states.push(rig.fingerprint());
        }
        for step in 0..1000 {
            act(&mut rig, &mut random);
            rig.drain();
            assert!(
                rig.editor.is_settled() && rig.editor.document().is_settled(),
                "{name} {seed} {step}: {:?}, {}",
                rig.editor.view().problem,
                rig.editor.view().status
            );
            let (names, done) = rig.editor.history().names();
            let total = names.len();
            if states.len() <= done {
                assert_eq!(
                    states.len(),
                    done,
                    "one act is at most one step: {name} {seed} {step} {names:?}"
                );
                states.push(rig.fingerprint());
            } else if states[done] != rig.fingerprint() {
                assert_eq!(total, done, "a new step ends what could be redone");
                states.truncate(done);
                states.push(rig.fingerprint());
            }
            assert!(rig.editor.document().from_file().iter().all(|d| d.is_finite()));
            if step % 10 == 9 {
                rig.assert_as_meant(&format!("{name} {seed} {step}"));
            }
        }
        let (_, done) = rig.editor.history().names();
        for state in states[..done].iter().rev() {
            rig.undo();
            assert!(*state == rig.fingerprint(), "undo on {name} {seed}");
        }
        assert!(rig.editor.view().undo.is_none());
        for state in &states[1..] {
            rig.redo();
            assert!(*state == rig.fingerprint(), "redo on {name} {seed}");
        }
        rig.drain();
        assert_eq!(states.last(), Some(&rig.fingerprint()), "nothing is owed after redo");
    }
}

#[test]
fn with_jobs_that_come_late_strokes_still_move_nothing_and_all_comes_back_in_the_end() {
    for (name, drawn) in meshes() {
        for (seed, method) in [(10, "arap"), (11, "bilaplacian"), (12, "arap"), (13, "bilaplacian")] {
            let mut random = Random(seed);
            let mut rig = Rig::open_with_objects(drawn.clone(), halves(&drawn));
            rig.choose(method);
            let (first, begun) = (rig.fingerprint(), rig.editor.history().names().1);
            for _ in 0..120 {
                if random.below(3) == 0 {
                    rig.run(pliant_editor::JobKind::ALL[random.below(6) as usize]);
                    continue;
                }
                // The picking structure is kept up to date, so that strokes have hits; everything else is late.
                while rig.run(pliant_editor::JobKind::Pick) {}
                if random.below(2) == 0 {
                    late_stroke(&mut rig, &mut random);
                } else {
                    let part = PARTS[random.below(PARTS.len() as u64) as usize];
                    rig.drag(part, DVec2::new(random.unit() * 40.0, random.unit() * 40.0 - 20.0));
                }
            }
            rig.drain();
            let last = rig.fingerprint();
            let (_, done) = rig.editor.history().names();
            for _ in begun..done {
                rig.undo();
                rig.drain();
            }
            assert_eq!(first, rig.fingerprint(), "{name} {seed}");
            for _ in begun..done {
                rig.redo();
                rig.drain();
            }
            assert!(last == rig.fingerprint(), "{name} {seed}");
        }
    }
}

/// A stroke while jobs are late: nothing moves while it lasts.
fn late_stroke(rig: &mut Rig, random: &mut Random) {
    rig.command(Command::SetTool(MODES[random.below(4) as usize]));
    let from_px = random.position_px();
    if rig.editor.pick(from_px).is_none() || takes_handle(rig, from_px) {
        return;
    }
    let before = rig.drawn();
    rig.press(from_px);
    rig.move_to(random.position_px());
    rig.run(pliant_editor::JobKind::Solve);
    rig.run(pliant_editor::JobKind::Bind);
    rig.release(random.position_px());
    assert!(before == rig.drawn(), "a drawn vertex moved");
}

#[test]
fn an_aborted_drag_leaves_nothing() {
    for end in [Key::Escape, Key::Character('?')] {
        let mut rig = Rig::open(shapes::icosphere(3));
        rig.paint_handle();
        rig.drain();
        rig.move_by('x', ".2");
        rig.drain();
        let before: Fingerprint = rig.fingerprint();
        let from_px = rig.grip(GizmoPart::Arrow(1)).unwrap();
        rig.press(from_px);
        rig.move_to(from_px + DVec2::new(0.0, -50.0));
        rig.drain();
        assert_ne!(before, rig.fingerprint(), "the drag is seen");
        if end == Key::Escape {
            rig.key(end);
        } else {
            rig.editor
                .handle(Event::PointerPressed(rig::at(from_px), Button::Secondary));
        }
        assert_eq!(before, rig.fingerprint());
        rig.drain();
        assert_eq!(before, rig.fingerprint());
        assert_eq!(rig.editor.view().undo, Some("Move handle 1"));
        assert_eq!(rig.editor.history().names().1, 2, "the paint and the first move");
    }
}

#[test]
fn what_changes_nothing_leaves_no_step() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.drain();
    let steps = rig.editor.history().names().1;
    rig.paint_handle();
    rig.type_keys("gx0");
    rig.key(Key::Enter);
    rig.drag(GizmoPart::Centre, DVec2::ZERO);
    rig.command(Command::SetMethod(rig.editor.document().method().clone()));
    rig.command(Command::Apply);
    rig.command(Command::ResetHandle);
    rig.drain();
    assert_eq!(rig.editor.history().names().1, steps);
}

/// Laws of every document, after any action.
fn assert_sound(rig: &Rig, at: &str) {
    let document = rig.editor.document();
    for paint in document.paint() {
        if let Paint::Handle(id) = paint {
            assert!(
                document.handle(*id).is_some(),
                "{at}: {id:?} is painted and not in the list"
            );
        }
    }
    for handle in document.handles() {
        assert!(
            rig.count(Paint::Handle(handle.id)) > 0,
            "{at}: {} has no vertex",
            handle.name
        );
        assert!(
            handle.affine().is_finite() && handle.pivot.is_finite(),
            "{at}: {handle:?}"
        );
        if let Some(twin) = handle.twin {
            let other = document.handle(twin.handle).and_then(|other| other.twin);
            assert_eq!(
                other.map(|back| back.handle),
                Some(handle.id),
                "{at}: twins know each other"
            );
        }
    }
    assert!(document.from_file().iter().all(|d| d.is_finite()), "{at}");
    let stiffness = document.stiffness().unwrap_or_default();
    assert!(
        stiffness
            .iter()
            .all(|value| pliant_editor::STIFFNESS_RANGE.contains(value)),
        "{at}"
    );
    let view = rig.editor.view();
    assert!(view.selected.is_none_or(|id| document.handle(id).is_some()), "{at}");
    assert!(
        view.companions
            .iter()
            .all(|id| document.handle(*id).is_some() && view.selected != Some(*id)),
        "{at}"
    );
    assert!(document.is_settled() && rig.editor.is_settled(), "{at}");
}

#[test]
fn ten_thousand_commands_keep_the_document_sound_and_undo_comes_back_to_the_first_state() {
    let mut random = Random(2026);
    let mut rig = Rig::open_with_objects(shapes::icosphere(2), halves(&shapes::icosphere(2)));
    let first = rig.fingerprint();
    for step in 0..10_000 {
        act(&mut rig, &mut random);
        rig.drain();
        if step % 16 == 0 {
            assert_sound(&rig, &format!("step {step}"));
        }
    }
    assert_sound(&rig, "the end");
    let last = rig.fingerprint();
    let (_, done) = rig.editor.history().names();
    rig.command(Command::GoToStep(0));
    rig.drain();
    assert!(first == rig.fingerprint(), "undo of {done} steps");
    rig.command(Command::GoToStep(done));
    rig.drain();
    assert!(last == rig.fingerprint(), "redo of {done} steps");
}
