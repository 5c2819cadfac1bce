//! The flow tool in the whole window: poured, played, kept as colours, saved with the bent shape; skipped by name if
//! there is no graphics device at all.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stderr,
    reason = "tests fail by panicking and say what they skip"
)]

use std::ffi::OsStr;
use std::path::Path;

use crate::disk::{await_words, click, save};
use crate::window_rig::Session;
use egui::{Key, Modifiers, Pos2, vec2};
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use pliant_app::window::{AppDirectories, KeepOriginal, Source};
use pliant_editor::{Command, NamedView, ToolMode};
use pliant_mesh::DrawnVertex;
use pliant_tests::{Folder, assets, open, run};

/// A place on the sample's flank.
fn flank(session: &Session) -> Pos2 {
    session.point_of(|positions| {
        let middle = positions.iter().sum::<DVec3>() / positions.len() as f64;
        let off_px = |p: &DVec3| (p.y - middle.y).hypot(p.z - middle.z) - p.x;
        *positions.iter().min_by(|a, b| off_px(a).total_cmp(&off_px(b))).unwrap()
    })
}

fn from_the_right(session: &mut Session) {
    for command in [Command::View(NamedView::Right), Command::FrameAll] {
        session.harness.state_mut().command(command);
        session.settle();
    }
}

#[test]
fn colour_is_poured_played_kept_and_saved_with_the_bent_shape() {
    let Some(mut session) = Session::begin() else { return };
    from_the_right(&mut session);
    session.key(Key::Num9, Modifiers::NONE);
    assert_eq!(session.harness.state().editor().view().tool, ToolMode::Flow);
    let from = flank(&session);
    session.stroke(from, from + vec2(60.0, 0.0));
    assert!(session.harness.state().editor().document().fluid().has_dye());

    session.key(Key::Space, Modifiers::NONE);
    assert!(session.harness.state().editor().view().is_playing);
    let before = session.harness.state().editor().view().regions_revision;
    for _ in 0..200 {
        session.harness.step();
        if session.harness.state().editor().view().regions_revision > before + 3 {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(
        session.harness.state().editor().view().regions_revision > before + 3,
        "it plays"
    );
    session.key(Key::Space, Modifiers::NONE);
    session.settle();
    assert_eq!(session.harness.state().editor().history().undo_name(), Some("Flow"));

    // At rest nothing is drawn.
    std::thread::sleep(std::time::Duration::from_millis(400));
    session.harness.run_steps(8);
    let drawings = session.harness.state().drawings();
    session.harness.run_steps(20);
    assert_eq!(session.harness.state().drawings(), drawings);

    let folder = Folder::new();
    let frames = exported(&mut session, folder.path());
    session.harness.state_mut().command(Command::KeepDye);
    session
        .harness
        .state_mut()
        .command(Command::SetTool(ToolMode::PaintHandle));
    let pressed = flank(&session);
    session.stroke(pressed, pressed + vec2(4.0, 0.0));
    for key in [Key::G, Key::Y, Key::Num1, Key::Enter] {
        session.key(key, Modifiers::NONE);
    }
    session.settle();
    let application = session.harness.state();
    let model = std::sync::Arc::clone(application.editor().view().model.unwrap());
    let kept = application.editor().document().fluid().kept.clone().unwrap();
    let mut bent = Vec::new();
    model.drawn_positions(&session.shape(), &mut bent);
    assert!(session.shape().iter().any(|d| d.length() > 0.1), "it is bent");

    let own = open(&assets().join("creature.glb")).scene.appearance().colours;
    let own = own.unwrap_or_else(|| vec![[u16::MAX; 4]; bent.len()]);
    for name in ["flowed.glb"] {
        let path = folder.path().join(name);
        session.harness.state_mut().save_to(path.clone(), KeepOriginal::No);
        session.settle();
        let saved = open(&path);
        let colours = saved.scene.appearance().colours.unwrap();
        let positions = saved.model.rest_positions();
        // Formats without the file's own order are compared by position.
        let place = |p: DVec3| p.to_array().map(|value| (value * 1e4).round() as i64);
        let coloured: std::collections::HashMap<_, _> = positions.iter().map(|p| place(*p)).zip(&colours).collect();
        let mut dyed = 0;
        for (vertex, position) in bent.iter().enumerate() {
            let Some(colour) = coloured.get(&place(*position)) else {
                continue;
            };
            let surface = model.drawn.surface_vertex(DrawnVertex(vertex as u32));
            let dye = surface.map_or([0.0; 4], |v| kept[v.index()]);
            dyed += usize::from(dye[3] > 0.9);
            for channel in 0..3 {
                let clear = f64::from(1.0 - dye[3]) * f64::from(own[vertex][channel]);
                let wanted = f64::from(dye[channel]) * f64::from(u16::MAX) + clear;
                // Text formats have 8 bits a channel.
                let off = (wanted - f64::from(colour[channel])).abs();
                assert!(off < 700.0, "{name}: {off} of 65535 at vertex {vertex}");
            }
        }
        assert!(dyed > 10, "{name}: {dyed} dyed vertices at their bent places");
    }
    // The last frame of the flow has the colours that were kept from it, and not those of the first.
    let flowed = colours(&folder.at("flowed.glb"));
    assert!(apart(&flowed, &colours(frames.last().unwrap())) <= 1);
    assert!(apart(&flowed, &colours(&frames[0])) > 2000);
    // The same colours are in a morph target's file, and in that of the project by the command line.
    let (morph, project, applied) = (
        folder.at("morph.glb"),
        folder.at("flow.pliant"),
        folder.at("applied.glb"),
    );
    session.harness.state_mut().save_morph_to(morph.clone());
    session.harness.state_mut().save_project_to(project.clone());
    session.settle();
    assert!(colours(&morph) == flowed, "the morph target's file has the dye");
    assert_eq!(open(&morph).scene.morph_targets(), ["morph"]);
    let [apply, edit, output] = ["apply", "--edit", "--output"].map(OsStr::new);
    let sample = assets().join("creature.glb");
    run([
        apply,
        sample.as_os_str(),
        edit,
        project.as_os_str(),
        output,
        applied.as_os_str(),
    ])
    .done();
    assert!(colours(&applied) == flowed, "`apply` of the project has the dye");

    let stl = folder.path().join("flowed.stl");
    session.harness.state_mut().save_to(stl, KeepOriginal::No);
    session.settle();
    let said = session.harness.state().headline().unwrap().to_owned();
    assert!(
        said.contains("Saved") && said.contains("takes no new vertex colours"),
        "{said}"
    );
}

/// Exports the flow that was played as numbered files, without and with the question about files that are there.
fn exported(session: &mut Session, folder: &Path) -> Vec<std::path::PathBuf> {
    let recording = session.harness.state().editor().flow_recording().unwrap();
    let (fps, seconds) = (
        session.harness.state().editor().document().animation().fps(),
        recording.seconds(),
    );
    let count = (fps * seconds - 1e-6).ceil() as usize + 1;
    let name = folder.join("played.glb");
    session.harness.state_mut().export_flow(&name);
    session.settle();
    let frames: Vec<_> = (0..count).map(|k| folder.join(format!("played-{k:04}.glb"))).collect();
    assert!(frames.iter().all(|frame| frame.exists()), "{count} frames");
    assert!(!folder.join(format!("played-{count:04}.glb")).exists());
    session.harness.state_mut().export_flow(&name);
    session.settle();
    click(session, "Replace");
    session.settle();
    let said = session.harness.state().headline().unwrap();
    assert!(said.starts_with("Saved"), "{said}");
    // A format without colours is refused in words.
    session.harness.state_mut().export_flow(&folder.join("played.stl"));
    session.settle();
    let said = session.harness.state().headline().unwrap();
    assert!(said.contains("colours") && !said.starts_with("Saved"), "{said}");
    frames
}

/// The largest difference of two files' colours, in 65535ths.
fn apart(some: &[[u16; 4]], others: &[[u16; 4]]) -> u16 {
    let pairs = some.as_flattened().iter().zip(others.as_flattened());
    pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap()
}

fn colours(path: &Path) -> Vec<[u16; 4]> {
    open(path).scene.appearance().colours.unwrap()
}

#[test]
fn dye_that_a_file_has_already_comes_on_it_only_once() {
    let folder = Folder::new();
    let file = folder.at("scan.glb");
    std::fs::copy(assets().join("creature.glb"), &file).unwrap();
    let begin = |path: &Path| Session::begin_in(Source::File(path.to_owned()), AppDirectories::default());
    let Some(mut session) = begin(&file) else { return };
    from_the_right(&mut session);
    session.key(Key::Num9, Modifiers::NONE);
    let from = flank(&session);
    session.stroke(from, from + vec2(60.0, 0.0));
    session.harness.state_mut().command(Command::KeepDye);
    let kept = session
        .harness
        .state()
        .editor()
        .document()
        .fluid()
        .kept
        .clone()
        .unwrap();
    assert!(
        kept.iter().any(|dye| (0.2..0.8).contains(&dye[3])),
        "some of it is half transparent"
    );
    let project = folder.at("scan.pliant");
    session.harness.state_mut().save_project_to(project.clone());
    session.settle();
    session.harness.state_mut().save_to(file.clone(), KeepOriginal::Yes);
    session.settle();
    let once = colours(&file);

    // The project's mesh is the original, not the file of the same shape in other colours.
    let mut again = begin(&project).unwrap();
    let out = folder.at("from-project.glb");
    again.harness.state_mut().save_to(out.clone(), KeepOriginal::No);
    again.settle();
    assert!(colours(&out) == once);
    drop(again);

    // Another program moves the saved file: read again, it has the dye.
    let moved = r#"{"version": 1, "method": {"name": "bilaplacian"}, "handles":
        [{"name": "all", "select": "all", "transform": {"translation": [0, 1, 0]}}]}"#;
    let (edit_at, theirs) = (folder.write("moved.json", moved), folder.at("theirs.glb"));
    let [apply, edit, output] = ["apply", "--edit", "--output"].map(OsStr::new);
    run([
        apply,
        file.as_os_str(),
        edit,
        edit_at.as_os_str(),
        output,
        theirs.as_os_str(),
    ])
    .done();
    std::fs::rename(&theirs, &file).unwrap();
    save(&mut session);
    if session.harness.query_by_label("Save").is_some() {
        click(&mut session, "Save");
    }
    await_words(&mut session, "scan.glb has changed");
    click(&mut session, "Reload with the edit");
    session.settle();
    let out = folder.at("reloaded.glb");
    session.harness.state_mut().save_to(out.clone(), KeepOriginal::No);
    session.settle();
    assert!(colours(&out) == once);
}
