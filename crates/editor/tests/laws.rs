//! Laws of the document, on random walks through the whole program.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

mod rig;

use glam::DVec2;
use pliant_editor::{Button, Command, Event, GizmoPart, Key, Modifiers, Pointer, Reach, ToolMode};
use pliant_mesh::{Drawn, shapes};
use rig::{Fingerprint, Random, Rig};

/// Closed, with boundary, in several parts.
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

/// One thing that a person might do. Some are strokes and changes of role, which must move nothing.
fn act(rig: &mut Rig, random: &mut Random) {
    match random.below(16) {
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
            let reach = [Reach::Radii(2.0), Reach::Length(0.3), Reach::Radii(4.0)][random.below(3) as usize];
            if let Some(id) = rig.editor.view().selected {
                unmoved(rig, |rig| rig.command(Command::SetReach(id, reach)));
            }
        }
        12 => {
            let command = [
                Command::NewHandle,
                Command::NextHandle,
                Command::DeleteHandle,
                Command::Apply,
            ][random.below(4) as usize]
                .clone();
            unmoved(rig, |rig| rig.command(command));
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
        14 => {
            rig.command(Command::ResetHandle);
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

fn stroke(rig: &mut Rig, random: &mut Random) {
    rig.command(Command::SetTool(MODES[random.below(4) as usize]));
    rig.command(Command::SetBrushRadius(10.0 + 40.0 * random.unit()));
    let way_px: Vec<DVec2> = (0..1 + random.below(4)).map(|_| random.position_px()).collect();
    // What the gizmo covers is not painted but dragged, which may move the surface.
    let on_gizmo = is_on_gizmo(rig, way_px[0]);
    if on_gizmo {
        rig.swipe(&way_px);
    } else if random.below(5) == 0 {
        let before = rig.fingerprint();
        unmoved(rig, |rig| {
            rig.press(way_px[0]);
            rig.move_to(random.position_px());
            rig.key(Key::Escape);
        });
        assert_eq!(before, rig.fingerprint(), "an aborted stroke leaves nothing");
    } else {
        unmoved(rig, |rig| rig.swipe(&way_px));
    }
}

fn is_on_gizmo(rig: &Rig, position_px: DVec2) -> bool {
    let view = rig.editor.view();
    pliant_editor::hit_gizmo(view.gizmo, position_px, view.camera, rig::VIEWPORT_PX).is_some()
}

/// Does something that must not move a drawn vertex, now or when its jobs are done.
fn unmoved(rig: &mut Rig, action: impl FnOnce(&mut Rig)) {
    let before = rig.drawn();
    action(rig);
    assert!(before == rig.drawn(), "a drawn vertex moved");
    rig.drain();
    assert!(before == rig.drawn(), "a drawn vertex moved when the jobs were done");
}

#[test]
fn strokes_move_nothing_and_every_step_comes_back_to_the_bit() {
    for (name, drawn) in meshes() {
        for seed in 0..3 {
            let mut random = Random(seed);
            let mut rig = Rig::open(drawn.clone());
            // The document at each position of the history.
            let mut states = vec![rig.fingerprint()];
            for step in 0..150 {
                act(&mut rig, &mut random);
                rig.drain();
                assert!(
                    rig.editor.is_settled() && rig.editor.document().is_settled(),
                    "{name} {seed} {step}"
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
                    assert!(
                        rig.shape_of_document() == rig.editor.document().from_rest(),
                        "{name} {seed} {step}"
                    );
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
}

#[test]
fn with_jobs_that_come_late_strokes_still_move_nothing_and_all_comes_back_in_the_end() {
    for (name, drawn) in meshes() {
        for seed in 10..14 {
            let mut random = Random(seed);
            let mut rig = Rig::open(drawn.clone());
            let first = rig.fingerprint();
            for _ in 0..120 {
                if random.below(3) == 0 {
                    rig.run(pliant_editor::JobKind::ALL[random.below(5) as usize]);
                    continue;
                }
                // The picking structure is kept up, so that strokes are answered; everything else is late.
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
            for _ in 0..done {
                rig.undo();
                rig.drain();
            }
            assert_eq!(first, rig.fingerprint(), "{name} {seed}");
            for _ in 0..done {
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
    if is_on_gizmo(rig, from_px) || rig.editor.pick(from_px).is_none() {
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
