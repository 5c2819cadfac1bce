//! The surroundings of the model in the window: toolbars that are laid out again, messages that shift nothing, hints
//! that end, remembered settings, recovery, and materials whose images are still loading. Skipped by name if there is
//! no graphics device at all.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "tests fail by panicking and say what they skip"
)]

use std::fs;
use std::path::PathBuf;

use crate::window_rig::{Session, colour_at};
use egui::accesskit::Role;
use egui::{Key, Modifiers, Rect, pos2, vec2};
use egui_kittest::kittest::Queryable;
use glam::DVec2;
use image::Rgba;
use pliant_app::window::{AppDirectories, KeepOriginal, Source};
use pliant_editor::{Command, HandleTransform, Shading, UpAxis};
use pliant_tests::Folder;

fn places(folder: &Folder) -> AppDirectories {
    AppDirectories {
        settings: Some(folder.at("settings.json")),
        recovery: Some(folder.at("recovery")),
        pictures: Some(folder.at("pictures")),
    }
}

/// A member of the kept settings; null if there is none.
fn kept(folder: &Folder, member: &str) -> serde_json::Value {
    let text = fs::read_to_string(folder.at("settings.json")).unwrap_or_default();
    let settings: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    settings[member].clone()
}

/// Moves the selected handle.
fn bend(session: &mut Session) {
    let id = session.harness.state().editor().view().selected.unwrap();
    let transform = HandleTransform::Trs {
        translation: glam::DVec3::new(0.05, 0.0, 0.0),
        rotation: glam::DQuat::IDENTITY,
        scale: glam::DVec3::ONE,
        pivot: None,
    };
    session
        .harness
        .state_mut()
        .command(Command::SetHandleTransform(id, transform));
    session.settle();
}

/// The place of the button with this name.
fn place_of(session: &Session, label: &str) -> Rect {
    session
        .harness
        .query_by_label(label)
        .unwrap_or_else(|| panic!("{label} is not to be seen"))
        .rect()
}

/// After the window narrows and lowers, so that tools and choices show their icons alone, and grows again, the tools are
/// beside the view and the choices above it as soon as the frames that the window itself requests have run.
#[test]
fn bars_are_laid_out_anew_after_a_resize_without_any_input() {
    let Some(mut session) = Session::begin() else { return };
    for size in [vec2(700.0, 600.0), vec2(1200.0, 700.0), vec2(640.0, 400.0)] {
        session.harness.set_size(size);
        session.harness.run();
        let view = session.harness.state().view_rect();
        let tools = ["Paint handle", "Select", "Pose", "Scale"].map(|label| place_of(&session, label));
        for tool in tools {
            assert!(
                tool.right() <= view.left() && view.left() - tool.right() < 12.0 && tool.bottom() <= size.y,
                "{tool:?} in a window of {size:?} whose view is at {view:?}"
            );
        }
        // The tool's settings are in rows between them.
        let settings = place_of(&session, "Symmetry");
        assert!(
            settings.bottom() <= view.top() && view.top() - settings.bottom() < 12.0,
            "{settings:?} in a window of {size:?} whose view is at {view:?}"
        );
        let choices = ["Undo", "Clay", "Wireframe"].map(|label| place_of(&session, label));
        for choice in choices {
            assert!(
                choice.bottom() <= view.top() && view.x_range().contains(choice.right()),
                "{choice:?} in a window of {size:?} whose view is at {view:?}"
            );
        }
    }
}

/// A message about a file appears over the view, and the view does not move.
#[test]
fn a_message_does_not_move_the_view() {
    let Some(mut session) = Session::begin() else { return };
    let before = session.harness.state().view_rect();
    session
        .harness
        .state_mut()
        .open(PathBuf::from("/no/such/folder/scan.ply"));
    session.settle();
    session.harness.run_steps(3);
    let sentence = session.harness.state().headline().unwrap().to_owned();
    let message = place_of(&session, &sentence);
    assert_eq!(session.harness.state().view_rect(), before);
    assert!(before.contains_rect(message), "{message:?} in {before:?}");
    session.harness.get_by_label(&format!("Dismiss: {sentence}")).click();
    session.harness.run_steps(3);
    assert_eq!(session.harness.state().headline(), None);
}

/// The third hint says to save. It goes away once that is done, and stays away in the next session.
#[test]
fn the_last_hint_goes_once_the_bent_model_was_saved() {
    let folder = Folder::new();
    let Some(mut session) = Session::begin_in(Source::Sample, places(&folder)) else {
        return;
    };
    let top = session.point_of(|positions| *positions.iter().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap());
    session.stroke(top + vec2(0.0, 6.0), top + vec2(0.0, 16.0));
    bend(&mut session);
    place_of(&session, "3 of 3");
    let out = folder.at("bent.glb");
    session.harness.state_mut().save_to(out.clone(), KeepOriginal::No);
    session.settle();
    session.harness.run_steps(2);
    assert!(out.is_file());
    assert!(session.harness.query_by_label("3 of 3").is_none());
    drop(session);
    let again = Session::begin_in(Source::Sample, places(&folder)).unwrap();
    assert!(again.harness.query_by_label("1 of 3").is_none());
}

/// A window that filled the screen does so again the next time.
#[test]
fn a_maximised_window_is_remembered() {
    let folder = Folder::new();
    let Some(mut session) = Session::begin_in(Source::Sample, places(&folder)) else {
        return;
    };
    let remembered = || kept(&folder, "maximised").as_bool();
    for is_maximised in [true, false, true] {
        let input = session.harness.input_mut();
        let window = input.viewports.entry(egui::ViewportId::ROOT).or_default();
        window.maximized = Some(is_maximised);
        session.wait_until(|_| remembered() == Some(is_maximised));
    }
}

/// The memory limit of binding is chosen by pointer and keyboard, reaches the editor and is kept for the next time.
#[test]
fn the_memory_that_binding_may_take_is_remembered() {
    let folder = Folder::new();
    let Some(mut session) = Session::begin_in(Source::Sample, places(&folder)) else {
        return;
    };
    let most = |session: &Session| session.harness.state().editor().most_memory();
    let kept = || kept(&folder, "memory");
    assert_eq!(most(&session), None, "what the machine leaves");
    session.palette("memory");
    session.key(Key::Enter, Modifiers::NONE);
    session.harness.get_by_label("At most").click();
    session.harness.run_steps(2);
    assert_eq!(most(&session), Some(8_000_000_000));
    session.click_into("Most memory in GB");
    session.harness.event(egui::Event::Text("1.5".to_owned()));
    session.harness.run_steps(2);
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    assert_eq!((most(&session), kept()), (Some(1_500_000_000), "1.5GB".into()));
    drop(session);

    let mut session = Session::begin_in(Source::Sample, places(&folder)).unwrap();
    assert_eq!(most(&session), Some(1_500_000_000));
    session.palette("memory");
    session.key(Key::Enter, Modifiers::NONE);
    session.harness.get_by_label("All free memory").click();
    session.harness.run_steps(2);
    assert_eq!((most(&session), kept()), (None, serde_json::Value::Null));
    session.key(Key::Escape, Modifiers::NONE);
    assert!(session.harness.query_by_label("At most").is_none());
}

/// The leftovers of a session are listed by the model's name, and messages about it use that name.
#[test]
fn a_recovery_names_its_file() {
    let folder = Folder::new();
    let scan = folder.write_mesh("ball of clay.off", &pliant_mesh::shapes::icosphere(4));
    let Some(mut session) = Session::begin_in(Source::File(scan), places(&folder)) else {
        return;
    };
    let middle = session.harness.state().view_rect().center();
    session.stroke(middle, middle + vec2(12.0, 0.0));
    bend(&mut session);
    let kept = || {
        let entries = fs::read_dir(folder.at("recovery")).into_iter().flatten().flatten();
        entries
            .map(|entry| entry.path())
            .find(|path| path.extension().is_some_and(|extension| extension == "pliant"))
    };
    session.wait_until(|_| kept().is_some());
    // It is like the leftovers of a killed session: nothing holds its lock.
    fs::copy(kept().unwrap(), folder.at("recovery/session-0-0.pliant")).unwrap();
    drop(session);
    let mut session = Session::begin_in(Source::Sample, places(&folder)).unwrap();
    place_of(&session, "ball of clay.off");
    session.harness.get_by_label("Delete").click();
    session.harness.run_steps(3);
    assert_eq!(kept(), None);
    assert!(session.harness.query_by_label("ball of clay.off").is_none());
}

/// The up axis belongs to the file; changing it frames the whole model again.
#[test]
fn z_up_frames_the_model_and_ends_with_the_file() {
    let Some(mut session) = Session::begin() else { return };
    let folder = Folder::new();
    let scan = folder.write_mesh("ball.off", &pliant_mesh::shapes::icosphere(3));
    let command = |session: &mut Session, command| {
        session.harness.state_mut().command(command);
        session.settle();
    };
    let is_all_in_view = |session: &Session| {
        let view = session.harness.state().editor().view();
        let (camera, size_px) = (view.camera, view.viewport_px);
        let mut positions = view.model.unwrap().surface.positions.iter();
        positions.all(|&position| {
            let seen = camera.project(position, size_px);
            seen.is_some_and(|px| px.cmpge(DVec2::ZERO).all() && px.cmple(size_px).all())
        })
    };
    for _ in 0..3 {
        session.key(Key::Home, Modifiers::NONE);
    }
    command(&mut session, Command::SetUp(UpAxis::Z));
    assert!(is_all_in_view(&session), "turned to Z");
    session.harness.state_mut().open(scan);
    session.settle();
    assert_eq!(session.harness.state().editor().view().camera.up, UpAxis::Y);
    assert!(is_all_in_view(&session));
}

/// While a file's images are loading, the view shows clay, not the materials without their images.
#[test]
fn clay_is_seen_until_the_textures_are_there() {
    let folder = Folder::new();
    let red = image::RgbaImage::from_pixel(64, 64, Rgba([200, 20, 20, 255]));
    red.save(folder.at("skin.png")).unwrap();
    folder.write("ball.mtl", "newmtl skin\nKd 1 1 1\nmap_Kd skin.png\n");
    let ball = pliant_mesh::shapes::icosphere(3);
    let mut text = "mtllib ball.mtl\nusemtl skin\nvt 0.5 0.5\n".to_owned();
    for p in &ball.positions {
        text += &format!("v {} {} {}\n", p.x, p.y, p.z);
    }
    for t in &ball.triangles {
        let [a, b, c] = t.map(|vertex| vertex.0 + 1);
        text += &format!("f {a}/1 {b}/1 {c}/1\n");
    }
    let file = folder.write("ball.obj", text);
    let Some(mut session) = Session::begin_in(Source::File(file), AppDirectories::default()) else {
        return;
    };
    let middle = |session: &mut Session| {
        let at = session.harness.state().view_rect().center();
        let picture = session.harness.render().unwrap();
        colour_at(&picture, at)
    };
    let clay = middle(&mut session);
    session
        .harness
        .state_mut()
        .command(Command::SetShading(Shading::Material));
    session.harness.step();
    assert!(session.harness.state().is_loading_textures());
    assert!(session.harness.query_by_label("loading textures…").is_some());
    assert_eq!(middle(&mut session), clay);
    session.settle();
    session.harness.run_steps(2);
    assert!(!session.harness.state().is_loading_textures());
    let Rgba([red, green, blue, _]) = middle(&mut session);
    assert!(red > 2 * green && red > 2 * blue, "{red} {green} {blue}");
}

/// A file without colours is grey in the material view: its brightest places keep their shading.
#[test]
fn what_has_no_material_is_not_overexposed() {
    let folder = Folder::new();
    let file = folder.write_mesh("ball.off", &pliant_mesh::shapes::icosphere(4));
    let Some(mut session) = Session::begin_in(Source::File(file), AppDirectories::default()) else {
        return;
    };
    session
        .harness
        .state_mut()
        .command(Command::SetShading(Shading::Material));
    session.settle();
    session.harness.run_steps(2);
    let view = session.harness.state().view_rect().shrink(20.0);
    let picture = session.harness.render().unwrap();
    let of_ball = (view.left() as u32..view.right() as u32)
        .flat_map(|x| (view.top() as u32..view.bottom() as u32).map(move |y| pos2(x as f32, y as f32)))
        .filter(|place| place.distance(view.center()) < 0.2 * view.height());
    let mut brightness: Vec<u8> = of_ball
        .map(|place| {
            let Rgba([red, green, blue, _]) = colour_at(&picture, place);
            red.max(green).max(blue)
        })
        .collect();
    brightness.sort_unstable();
    let [middle, high] = [brightness.len() / 2, brightness.len() * 9 / 10].map(|place| brightness[place]);
    // In white, the same ball has 239 and 245.
    assert!(
        middle < 220 && high < 235,
        "{middle} in the middle, {high} in the brightest tenth"
    );
}

/// Every page of the panel leaves the view as wide as it was, and Play its neighbour where it was.
#[test]
fn pages_and_play_shift_nothing() {
    let Some(mut session) = Session::begin() else { return };
    let width = session.harness.state().view_rect().width();
    for page in ["Scene", "Method", "Handles"] {
        session.page(page);
        assert_eq!(session.harness.state().view_rect().width(), width, "{page}");
    }
    session.key(Key::Num9, Modifiers::NONE);
    session.harness.run_steps(2);
    let before = place_of(&session, "Step flow");
    session.harness.state_mut().command(Command::PlayFlow);
    session.harness.run_steps(2);
    assert!(session.harness.state().editor().view().is_playing);
    assert_eq!(place_of(&session, "Step flow"), before);
}

/// Vertex colours are shown when a file is opened, and clay again for one without.
#[test]
fn a_file_with_vertex_colours_opens_in_material() {
    let folder = Folder::new();
    let corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let faces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    let file = |name: &str, colours: [&str; 4]| {
        let mut text = "ply\nformat ascii 1.0\nelement vertex 4\n".to_owned();
        for number in [
            "float x",
            "float y",
            "float z",
            "uchar red",
            "uchar green",
            "uchar blue",
        ] {
            text += &format!("property {number}\n");
        }
        text += "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
        for ([x, y, z], colour) in corners.iter().zip(colours) {
            text += &format!("{x} {y} {z} {colour}\n");
        }
        folder.write(name, &(text + faces))
    };
    let plain = file("plain.ply", ["200 200 200"; 4]);
    let painted = file("painted.ply", ["200 0 0", "200 0 0", "0 200 0", "0 0 200"]);
    let source = Source::File(painted.clone());
    let Some(mut session) = Session::begin_in(source, AppDirectories::default()) else {
        return;
    };
    let shading = |session: &Session| session.harness.state().editor().view().look.shading;
    assert_eq!(shading(&session), Shading::Material);
    let open = |session: &mut Session, path: &PathBuf| {
        session.harness.state_mut().open(path.clone());
        session.settle();
        shading(session)
    };
    assert_eq!(open(&mut session, &plain), Shading::Clay);
    session.harness.state_mut().command(Command::SetShading(Shading::Zebra));
    assert_eq!(
        open(&mut session, &painted),
        Shading::Zebra,
        "a person's own choice stays"
    );
    assert_eq!(open(&mut session, &plain), Shading::Zebra);
}

#[test]
fn the_palette_offers_first_what_was_chosen_last_in_the_next_session_too() {
    let folder = Folder::new();
    let theme = || kept(&folder, "theme");
    let Some(mut session) = Session::begin_in(Source::Sample, places(&folder)) else {
        return;
    };
    for name in ["light or dark", "canvas hints"] {
        session.palette(name);
        session.key(Key::Enter, Modifiers::NONE);
    }
    session.palette("light or dark");
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    let chosen = theme();
    assert_eq!(
        kept(&folder, "recent_commands"),
        serde_json::json!(["Light or dark", "Canvas hints"])
    );
    drop(session);

    let mut session = Session::begin_in(Source::Sample, places(&folder)).unwrap();
    session.palette("");
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    assert_ne!(theme(), chosen, "Enter alone repeats it");
}

#[test]
fn in_a_small_view_a_hint_has_its_title_alone_until_it_is_pointed_at() {
    let folder = Folder::new();
    let Some(mut session) = Session::begin_in(Source::Sample, places(&folder)) else {
        return;
    };
    let shows = |session: &Session, text: &str| session.harness.query_by_label(text).is_some();
    assert!(shows(&session, "1 of 3") && shows(&session, "Hide hints"));
    session.harness.set_size(vec2(800.0, 520.0));
    session.harness.run_steps(3);
    assert!(shows(&session, "1 of 3") && !shows(&session, "Hide hints"));
    let title = session.harness.get_by_label("1 of 3").rect().center();
    session.pointer(title, None);
    session.harness.run_steps(3);
    session.harness.get_by_label("Hide hints").click();
    session.harness.run_steps(3);
    assert!(!shows(&session, "1 of 3"));
}

#[test]
fn every_setting_of_a_tool_is_beside_its_name_within_the_bar() {
    let Some(mut session) = Session::begin() else { return };
    // From 1280 × 800 at 150% to a large window.
    for width in (820..1300).step_by(32) {
        session.harness.set_size(vec2(width as f32, 560.0));
        session.harness.run_steps(4);
        let right = session.harness.state().view_rect().right();
        let of_role = |role, name| {
            let mut nodes = session.harness.query_all_by_role_and_label(role, name);
            nodes.next().map(|node| node.rect())
        };
        for name in ["Depth", "Symmetry"] {
            let label = of_role(Role::Label, name).unwrap_or_else(|| panic!("{name} at {width}"));
            let field = of_role(Role::ComboBox, name).unwrap_or_else(|| panic!("{name}'s field at {width}"));
            assert!(
                field.right() <= right && label.right() <= field.left(),
                "{name} at {width}"
            );
            assert!((label.center().y - field.center().y).abs() < 3.0, "{name} at {width}");
        }
    }
}
