//! A very large mesh is ordered where it bends, and bends as any other does.

use crate::rig::Rig;
use pliant_deform::METHODS;
use pliant_editor::{Command, HandleId, JobKind, Reach};
use pliant_mesh::shapes;

/// Runs all jobs; returns the number of orderings among them.
fn orderings(rig: &mut Rig) -> usize {
    let mut made = 0;
    while let Some(&next) = rig.jobs.waiting().first() {
        made += usize::from(next == JobKind::Order);
        rig.run(next);
    }
    made
}

/// Bends a ball by a handle in its middle whose reach grows; returns the orderings for each reach.
fn session(rig: &mut Rig, method: &str) -> Vec<usize> {
    rig.choose(method);
    rig.paint_handle();
    let bend = |reach: f64| {
        rig.command(Command::SetReach(HandleId(0), Reach::Length(reach)));
        let made = orderings(rig);
        rig.move_by('x', ".05");
        made + orderings(rig)
    };
    [0.35, 0.36, 0.7, 0.35, 3.0, 0.7].into_iter().map(bend).collect()
}

#[test]
fn it_is_ordered_once_it_bends_and_again_only_where_a_region_leaves_the_ordered_part() {
    for declaration in METHODS {
        let drawn = shapes::icosphere(4);
        let (mut large, mut usual) = (Rig::open_as_large(drawn.clone()), Rig::open(drawn));
        let made = session(&mut large, declaration.name);
        session(&mut usual, declaration.name);
        let needs_it = large.editor.document().method().ordering_power().is_some();
        let expected = if needs_it { [1, 0, 1, 0, 1, 0] } else { [0; 6] };
        assert_eq!(made, expected, "{}", declaration.name);
        large.assert_as_meant(declaration.name);
        let [large, usual] = [&large, &usual].map(|rig| rig.editor.document().from_file().to_vec());
        let apart = large
            .iter()
            .zip(&usual)
            .map(|(a, b)| a.distance(*b))
            .fold(0.0, f64::max);
        assert!(apart < 1e-4, "{}: {apart:e}", declaration.name);
    }
}
