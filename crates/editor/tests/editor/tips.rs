//! The parts that a reach cuts off from the body, free or fixed: chosen by a command, undone, and exported.
#![allow(clippy::unwrap_used, reason = "a test that can't go on fails")]

use glam::{DAffine3, DVec2, DVec3};
use pliant_deform::Role;
use pliant_editor::{Command, EditFile, Reach, Tips, ToolMode};
use pliant_mesh::shapes;

use crate::rig::{CENTRE_PX, Rig};

/// A long bar across the view with a handle to the right of its middle, whose reach cuts off the right end. The numbers
/// of the vertices at the left and the right end.
fn bar_with_a_tip() -> (Rig, usize, usize) {
    let flat = DAffine3::from_scale(DVec3::new(1.0, 0.5, 0.5));
    let mut rig = Rig::open(shapes::moved(&shapes::bar(40, 4, 4), flat));
    let right_of_middle = CENTRE_PX + DVec2::new(110.0, 0.0);
    rig.paint(ToolMode::PaintHandle, &[right_of_middle]);
    let id = rig.editor.document().handles()[0].id;
    rig.command(Command::SetReach(id, Reach::Length(5.0)));
    rig.drain();
    let x = |&v: &usize| rig.model.surface.positions[v].x;
    let vertices = 0..rig.model.surface.positions.len();
    let left = vertices.clone().min_by(|a, b| x(a).total_cmp(&x(b))).unwrap();
    let right = vertices.max_by(|a, b| x(a).total_cmp(&x(b))).unwrap();
    (rig, left, right)
}

#[test]
fn holding_the_tips_nails_them_down_and_undo_lets_them_go_again() {
    let (mut rig, left, right) = bar_with_a_tip();
    let ends = |rig: &Rig| [left, right].map(|v| rig.editor.roles()[v]);
    assert_eq!(ends(&rig), [Role::Fixed, Role::Free]);
    rig.move_by('y', "2");
    rig.drain();
    let way = |rig: &Rig| rig.editor.document().from_file()[right].length();
    assert!(way(&rig) > 1.0, "the tip comes along");
    let before = rig.fingerprint();
    rig.command(Command::SetTips(Tips::Held));
    rig.drain();
    assert_eq!(ends(&rig), [Role::Fixed, Role::Fixed]);
    assert_eq!(way(&rig), 0.0);
    assert!(Command::SetTips(Tips::Held).listed().is_some());
    rig.undo();
    rig.drain();
    assert!(before == rig.fingerprint());
    assert_eq!(ends(&rig), [Role::Fixed, Role::Free]);
    rig.redo();
    rig.drain();
    assert_eq!(rig.editor.document().tips(), Tips::Held);
}

#[test]
fn an_exported_edit_has_the_same_roles_with_and_without_tips() {
    let (mut rig, _, right) = bar_with_a_tip();
    for tips in [Tips::ComeAlong, Tips::Held] {
        rig.command(Command::SetTips(tips));
        rig.drain();
        let edit = EditFile::parse(&rig.editor.edit_file().unwrap().to_json()).unwrap();
        let roles = edit.resolve(&rig.model).unwrap().roles;
        assert_eq!(roles, rig.editor.roles());
        assert_eq!(roles[right] == Role::Free, tips == Tips::ComeAlong);
    }
}
