//! Access by assistive technologies and the keyboard: every control has a name, and Tab comes to each. Skipped by name
//! if there is no graphics device at all.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "tests fail by panicking and say what they skip"
)]

use std::collections::BTreeSet;

use crate::window_rig::Session;
use egui::accesskit::{Action, Role};
use egui::{Key, Modifiers, pos2, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use pliant_deform::METHODS;
use pliant_editor::{Command, ToolMode};

const TOOLS: [ToolMode; 7] = [
    ToolMode::PaintHandle,
    ToolMode::PaintFree,
    ToolMode::PaintFixed,
    ToolMode::Erase,
    ToolMode::Select,
    ToolMode::PaintStiffness,
    ToolMode::Pose,
];

const PAGES: [&str; 3] = ["Handles", "Scene", "Method"];

/// A control for assistive technologies.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
struct Control {
    role: String,
    name: String,
    id: String,
}

/// All controls that can be focused or pressed, without greyed ones.
fn controls(session: &Session) -> Vec<Control> {
    let all = session.harness.root().children_recursive();
    let controls = all.filter_map(|node| {
        let node = node.accesskit_node();
        let can = |action| node.data().supports_action(action);
        let is_control = can(Action::Focus) || can(Action::Click);
        // Panels and scroll areas only pass the focus on, and a scroll bar needs no name besides its role. Text is its
        // own name, and can be clicked to be selected.
        let is_container = matches!(
            node.role(),
            Role::Unknown
                | Role::GenericContainer
                | Role::Window
                | Role::ScrollView
                | Role::ScrollBar
                | Role::TextRun
                | Role::Label
        );
        (is_control && !is_container && !node.is_disabled()).then(|| Control {
            role: format!("{:?}", node.role()),
            name: node.label().unwrap_or_default(),
            id: format!("{:?} at {:?}", node.id(), node.bounding_box()),
        })
    });
    controls.collect()
}

#[track_caller]
fn assert_named(session: &mut Session, place: &str) {
    session.harness.run_steps(2);
    let nameless: Vec<Control> = controls(session)
        .into_iter()
        .filter(|control| control.name.trim().is_empty())
        .collect();
    assert!(nameless.is_empty(), "{place}: {nameless:#?}");
}

/// The sample with a handle, a pose and everything in the panel unfolded, in a window that shows all of it.
fn begin() -> Option<Session> {
    let mut session = Session::with_handle()?;
    session.harness.set_size(vec2(1000.0, 2600.0));
    session.harness.state_mut().command(Command::KeepPose);
    session.settle();
    session.page("Method");
    session.harness.get_by_label("Advanced").click();
    session.harness.run_steps(3);
    Some(session)
}

#[test]
fn every_control_has_a_name_with_every_tool_and_method() {
    let Some(mut session) = begin() else { return };
    for tool in TOOLS {
        session.harness.state_mut().command(Command::SetTool(tool));
        session.settle();
        assert_named(&mut session, &format!("{tool:?}"));
    }
    for page in PAGES {
        session.page(page);
        assert_named(&mut session, page);
    }
    for method in METHODS {
        let command = Command::SetMethod((method.first_choice)());
        session.harness.state_mut().command(command);
        session.settle();
        assert_named(&mut session, method.name);
    }
}

#[test]
fn every_control_of_menus_and_dialogs_has_a_name() {
    let Some(mut session) = begin() else { return };
    for menu in ["File", "Edit", "Region", "View", "Window", "Help"] {
        let buttons = session.harness.get_all_by_role_and_label(Role::Button, menu);
        let at = buttons
            .map(|button| button.rect().center())
            .min_by(|a, b| a.y.total_cmp(&b.y));
        for pressed in [true, false] {
            session.pointer(at.unwrap(), Some(pressed));
        }
        assert_named(&mut session, menu);
        session.key(Key::Escape, Modifiers::NONE);
    }
    for dialog in ["keys", "log", "memory"] {
        session.palette(dialog);
        assert_named(&mut session, "the palette");
        session.key(Key::Enter, Modifiers::NONE);
        assert_named(&mut session, dialog);
    }
    session.harness.state_mut().browse_to_open();
    assert_named(&mut session, "the folder browser");
}

#[test]
fn tab_comes_to_every_control_of_the_bars_and_the_panel() {
    let Some(mut session) = begin() else { return };
    for page in PAGES {
        session.page(page);
        // Over the view Tab is the view's own key.
        session.pointer(pos2(5.0, 2.0), None);
        assert_tab_comes_everywhere(&mut session);
    }
}

#[track_caller]
fn assert_tab_comes_everywhere(session: &mut Session) {
    let expected: BTreeSet<Control> = controls(session).into_iter().collect();
    assert!(expected.len() > 40, "{expected:#?}");
    let mut reached = BTreeSet::new();
    for _ in 0..2 * expected.len() {
        session.key(Key::Tab, Modifiers::NONE);
        let all = session.harness.root().children_recursive();
        let focused = all.map(|node| node.accesskit_node()).find(|node| node.is_focused());
        reached.extend(focused.map(|node| node.id()).map(|id| format!("{id:?}")));
    }
    let missed: Vec<&Control> = expected
        .iter()
        .filter(|control| !reached.iter().any(|id| control.id.starts_with(&format!("{id} at"))))
        .collect();
    assert!(missed.is_empty(), "{missed:#?}");
}
