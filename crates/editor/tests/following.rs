//! An editor that follows another bends the same handles by its own method.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

mod rig;

use glam::DVec3;
use pliant_deform::Method;
use pliant_editor::{Command, Editor, Event, InlineExecutor};
use pliant_mesh::shapes;
use rig::Rig;

fn drain(editor: &mut Editor, jobs: &InlineExecutor) {
    while let Some(done) = jobs.run_next() {
        editor.handle(Event::JobDone(done));
    }
}

#[test]
fn the_follower_shows_its_own_methods_shape_of_the_leaders_handles() {
    let [linear, rigid] = ["bilaplacian", "arap"].map(|name| Method::from_name(name).unwrap());
    let mut leader = Rig::open(shapes::tube(16, 24, 3.0));
    leader.command(Command::SetMethod(linear.clone()));
    let jobs = InlineExecutor::new();
    let mut follower = Editor::new(Box::new(jobs.clone()));
    let mut alone = Rig::open(shapes::tube(16, 24, 3.0));
    alone.command(Command::SetMethod(rigid.clone()));
    let shape = |editor: &Editor| editor.document().from_file().to_vec();
    for (number, keys) in ["", "gx.3", "ry40", "APPLY", "gz.2"].into_iter().enumerate() {
        for rig in [&mut leader, &mut alone] {
            match keys {
                "" => rig.paint_handle(),
                "APPLY" => {
                    rig.command(Command::SetMethod(linear.clone()));
                    rig.drain();
                    rig.command(Command::Apply);
                }
                keys => {
                    rig.type_keys(keys);
                    rig.key(pliant_editor::Key::Enter);
                }
            }
            rig.drain();
        }
        if keys == "APPLY" {
            alone.command(Command::SetMethod(rigid.clone()));
            alone.drain();
        }
        follower.handle(Event::Follow {
            leader: Box::new(leader.editor.snapshot().unwrap()),
            method: rigid.clone(),
        });
        drain(&mut follower, &jobs);
        assert!(follower.is_settled() && follower.document().is_settled(), "{number}");
        assert_eq!(follower.document().handles(), leader.editor.document().handles());
        let size = 3.0;
        let apart = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        let (ours, theirs) = (shape(&follower), shape(&leader.editor));
        // From another start it reaches nearly the same energy, so nearly the same shape.
        assert!(
            apart(&ours, &shape(&alone.editor)) < 0.02 * size,
            "{number}: {}",
            apart(&ours, &shape(&alone.editor))
        );
        if keys.starts_with('r') {
            assert!(apart(&ours, &theirs) > 1e-3 * size, "another method bends otherwise");
        }
    }
    // Nothing is sent back.
    assert_eq!(leader.editor.document().method(), &linear);
    assert!(follower.view().undo.is_none());
}
