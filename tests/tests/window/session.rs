//! The whole application without a window: a session from opening to saving, by pointer and keyboard, on a software
//! device. Skipped by name if there is no graphics device at all.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stderr,
    reason = "tests fail by panicking and say what they skip"
)]

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::window_rig::{Session, colour_at};
use egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::{DVec2, DVec3};
use pliant_app::window::{AppDirectories, Application, KeepOriginal, NumpadDigits, Shared, Shell, Source};
use pliant_deform::{Loose, METHODS};
use pliant_editor::{BrushMetric, Command, Reach, Shading, ToolMode};
use pliant_tests::{Folder, assets, open, run};

/// The largest distance, in diagonals, between the ends of two descents to one minimum: the window's, which followed
/// the pointer, and the command line's, which started at the rest shape.
const DESCENDED: f64 = 1e-3;

fn moved(shape: &[DVec3]) -> usize {
    shape
        .iter()
        .filter(|displacement| **displacement != DVec3::ZERO)
        .count()
}

/// The method that bends like the bi-Laplacian, to the bit, as long as there are no examples.
const WITHOUT_EXAMPLES: &str = "wrinkles";

#[test]
fn a_session_from_opening_to_saving_gives_what_the_command_line_gives() {
    let Some(mut session) = Session::begin() else { return };
    let count = session.shape().len();
    assert!(count > 10_000, "the sample is a scan's size");
    assert_eq!(session.harness.state().editor().document().handles().len(), 0);

    // Paint a handle on the highest part: it gets its region, and nothing moves.
    let top = session.point_of(|positions| *positions.iter().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap());
    let from = top + vec2(0.0, 6.0);
    session.stroke(from, from + vec2(0.0, 10.0));
    let view = session.harness.state().editor().view();
    assert_eq!(
        view.handles.len(),
        1,
        "the stroke at {from:?} made a handle; {}",
        view.status
    );
    assert!(
        view.counts.handle > 0 && view.counts.free > view.counts.handle && view.counts.fixed > 0,
        "{:?}",
        view.counts
    );
    assert_eq!(moved(&session.shape()), 0);

    // Drag it by G, X, a number, Enter. If a handle moves farther than the width of its region there are several
    // minima, and the path determines the result: this drag stays well below that.
    let id = session.harness.state().editor().view().handles[0].id;
    session
        .harness
        .state_mut()
        .command(Command::SetReach(id, Reach::Radii(6.0)));
    session.settle();
    for key in [Key::G, Key::X] {
        session.key(key, Modifiers::NONE);
    }
    for key in [Key::Num0, Key::Period, Key::Num0, Key::Num5] {
        session.key(key, Modifiers::NONE);
    }
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    let typed = session.shape();
    assert!(session.status().contains("Settled"), "{}", session.status());
    let handle = session.harness.state().editor().document().handles()[0].clone();
    assert_eq!(session.harness.state().editor().document().method().name(), "arap");
    assert!(
        (handle.affine().translation - DVec3::new(0.05, 0.0, 0.0)).length() < 1e-12,
        "{:?}",
        handle.transform
    );
    let view_counts = session.harness.state().editor().view().counts;
    assert!(moved(&typed) > view_counts.handle, "the surface follows the handle");
    assert!(
        moved(&typed) <= view_counts.handle + view_counts.free,
        "what is held still stays"
    );

    // Then by the pointer, with G and a click.
    session.key(Key::G, Modifiers::NONE);
    let start = session.point_of(|positions| *positions.iter().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap());
    session.pointer(start, None);
    for step in 1..=5 {
        session.pointer(start + vec2(2.0 * step as f32, -(step as f32)), None);
    }
    session.pointer(start + vec2(10.0, -5.0), Some(true));
    session.pointer(start + vec2(10.0, -5.0), Some(false));
    session.settle();
    let dragged = session.shape();
    assert_ne!(dragged, typed);
    assert!(session.status().contains("Settled"), "{}", session.status());

    // The picture shows the editor's shape.
    let shown = session.harness.state().shown_displacements().unwrap().to_vec();
    assert_eq!(shown, dragged);

    // Undo and redo restore the same bits.
    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    assert_eq!(session.shape(), typed);
    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    assert_eq!(moved(&session.shape()), 0);
    for _ in 0..2 {
        session.key(Key::Z, Modifiers::COMMAND | Modifiers::SHIFT);
        session.settle();
    }
    assert_eq!(session.shape(), dragged);

    // Save, and compare with the command line's result for the same edit, which reaches the same minimum by another
    // path.
    let folder = Folder::new();
    let saved = folder.path().join("saved.glb");
    session.harness.state_mut().save_to(saved.clone(), KeepOriginal::No);
    session.settle();
    assert!(!session.harness.state().editor().view().unsaved);
    let edit = folder.path().join("edit.json");
    std::fs::write(&edit, session.harness.state().editor().edit_file().unwrap().to_json()).unwrap();
    let applied = folder.path().join("applied.glb");
    let sample = assets().join("creature.glb");
    run([sample.as_os_str(), edit.as_os_str(), applied.as_os_str()]
        .into_iter()
        .enumerate()
        .flat_map(|(i, path)| [["apply", "--edit", "--output"][i].into(), path.to_owned()]))
    .done();
    let (saved_file, applied_file) = (open(&saved), open(&applied));
    let size = saved_file.model.bounds().unwrap().diagonal();
    let [in_window, on_line] = [&saved_file, &applied_file].map(|file| file.model.rest_positions());
    for (a, b) in in_window.iter().zip(&on_line) {
        assert!(
            a.distance(*b) <= DESCENDED * size,
            "{a} in the window, {b} on the command line"
        );
    }

    // Reopen: the file has the shown shape.
    let before: Vec<DVec3> = {
        let editor = session.harness.state().editor();
        let mut positions = Vec::new();
        editor.view().model.unwrap().drawn_positions(&dragged, &mut positions);
        positions
    };
    session.harness.state_mut().open(saved);
    session.settle();
    let view = session.harness.state().editor().view();
    let reopened = view.model.unwrap().rest_positions();
    assert_eq!(reopened.len(), before.len());
    for (a, b) in reopened.iter().zip(&before) {
        assert!(a.distance(*b) <= 1e-6 * size);
    }
    assert_eq!(moved(&session.shape()), 0, "the saved shape is the new rest shape");
}

#[test]
fn a_stroke_of_stiffness_is_seen_while_it_goes_on_however_stiffness_is_shown() {
    let Some(mut session) = Session::begin() else { return };
    session
        .harness
        .state_mut()
        .command(Command::SetTool(ToolMode::PaintStiffness));
    let middle = session.point_of(|positions| positions[positions.len() / 2]);
    let away = middle + vec2(60.0, 150.0);
    for shading in [Shading::Clay, Shading::Stiffness] {
        session.harness.state_mut().command(Command::SetShading(shading));
        session.pointer(away, None);
        session.settle();
        let pixel = |session: &mut Session| {
            let picture = session.harness.render().unwrap();
            colour_at(&picture, middle).0
        };
        let before = pixel(&mut session);
        session.pointer(middle, Some(true));
        session.pointer(away, None);
        session.harness.step();
        let painted = pixel(&mut session);
        let apart = |a: [u8; 4], b: [u8; 4]| a.iter().zip(b).map(|(a, b)| a.abs_diff(b)).max();
        assert!(
            apart(before, painted) > Some(25),
            "{shading:?}: {before:?} became {painted:?}"
        );
        session.key(Key::Escape, Modifiers::NONE);
        session.pointer(away, Some(false));
        session.settle();
        assert!(apart(before, pixel(&mut session)) < Some(12), "{shading:?}");
    }
}

#[test]
fn nothing_is_drawn_or_solved_while_nothing_happens() {
    let Some(mut session) = Session::begin() else { return };
    let revisions = |session: &Session| {
        let view = session.harness.state().editor().view();
        (view.shape_revision, view.regions_revision, view.camera_revision)
    };
    let before = revisions(&session);
    let drawings = session.harness.state().drawings();
    std::thread::sleep(Duration::from_millis(400));
    // A resting view draws one smoother picture, and then no more.
    session.harness.run_steps(3);
    let rested = session.harness.state().drawings();
    assert!(rested <= drawings + 1);
    session.harness.run_steps(10);
    assert_eq!(session.harness.state().drawings(), rested);
    assert_eq!(revisions(&session), before);
}

#[test]
fn a_file_that_is_no_model_is_said_and_what_was_open_stays() {
    let Some(mut session) = Session::begin() else { return };
    let folder = Folder::new();
    let broken = folder.path().join("broken.glb");
    std::fs::write(&broken, b"no model at all").unwrap();
    session.harness.state_mut().open(broken);
    session.settle();
    assert!(
        session
            .harness
            .state()
            .headline()
            .is_some_and(|sentence| sentence.contains("broken.glb"))
    );
    let size = DVec2::new(f64::from(session.harness.state().view_rect().width()), 0.0);
    assert!(size.x > 100.0 && session.harness.state().editor().view().model.is_some());
}

#[test]
fn a_project_comes_back_as_it_was_though_its_mesh_was_saved_over() {
    let Some(mut session) = Session::begin() else { return };
    let folder = Folder::new();
    let mesh = folder.path().join("bar.glb");
    std::fs::copy(assets().join("bar.glb"), &mesh).unwrap();
    session.harness.state_mut().open(mesh.clone());
    session.settle();
    let middle = session.harness.state().view_rect().center();
    session.stroke(middle, middle + vec2(6.0, 4.0));
    for key in [Key::G, Key::Y, Key::Num0, Key::Period, Key::Num1, Key::Enter] {
        session.key(key, Modifiers::NONE);
    }
    session.settle();
    assert!(moved(&session.shape()) > 0);
    // Save over the source twice: after that, the input exists only as the backup of the original.
    for _ in 0..2 {
        session.harness.state_mut().save_to(mesh.clone(), KeepOriginal::Yes);
        session.settle();
    }
    let project = folder.path().join("bar.pliant");
    session.harness.state_mut().save_project_to(project.clone());
    session.settle();
    let text = std::fs::read_to_string(&project).unwrap();
    assert!(text.contains("bar.original.glb"), "{}", &text[..300]);
    let hash = |session: &Session| session.harness.state().editor().document_hash().unwrap();
    let (before, shape) = (hash(&session), session.shape());
    session.harness.state_mut().open(assets().join("plane.glb"));
    session.settle();
    assert_ne!(hash(&session), before);
    session.harness.state_mut().open(project);
    session.settle();
    assert_eq!(session.harness.state().headline(), None);
    assert_eq!(hash(&session), before);
    assert!(session.shape() == shape);
    assert_eq!(
        session.harness.state().path(),
        Some(&*mesh),
        "saving goes on where it went"
    );
}

/// Everything in one session: undo and redo restore the shape, and the saved file reopens unchanged.
#[test]
fn a_whole_session_undone_redone_saved_and_opened_again_is_the_same_document_by_its_hash() {
    let Some(mut session) = Session::begin() else { return };
    let hash = |session: &Session| session.harness.state().editor().document_hash().unwrap();
    let command = |session: &mut Session, command: Command| {
        session.harness.state_mut().command(command);
        session.settle();
    };
    let first = hash(&session);
    let top = session.point_of(|positions| *positions.iter().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap());
    let side = session.point_of(|positions| *positions.iter().max_by(|a, b| a.x.total_cmp(&b.x)).unwrap());

    // Two handles; the first one's region is widened by distance along the surface.
    command(&mut session, Command::SetBrushMetric(BrushMetric::Surface));
    command(&mut session, Command::SetBrushRadius(16.0));
    session.stroke(top + vec2(0.0, 8.0), top + vec2(3.0, 12.0));
    let one = session.harness.state().editor().view().selected.unwrap();
    command(&mut session, Command::SetReach(one, Reach::Radii(5.0)));
    command(&mut session, Command::NewHandle);
    session.stroke(side + vec2(-10.0, 0.0), side + vec2(-14.0, 2.0));
    assert_eq!(session.harness.state().editor().document().handles().len(), 2);
    // Paint stiffness too.
    command(&mut session, Command::SetTool(ToolMode::PaintStiffness));
    session.stroke(top + vec2(0.0, 40.0), top + vec2(10.0, 60.0));
    assert!(session.harness.state().editor().document().stiffness().is_some());

    // The same drag with each method: the handle's target is the same, the shapes differ.
    command(&mut session, Command::SelectHandle(one));
    for key in [Key::R, Key::Z, Key::Num4, Key::Num0, Key::Enter] {
        session.key(key, Modifiers::NONE);
    }
    session.settle();
    let mut shapes: Vec<Vec<DVec3>> = Vec::new();
    for declaration in METHODS {
        let name = declaration.name;
        command(&mut session, Command::SetMethod((declaration.default)()));
        assert!(session.harness.state().editor().view().problem.is_none(), "{name}");
        shapes.push(session.shape());
    }
    for (number, shape) in shapes.iter().enumerate() {
        assert!(moved(shape) > 0, "{}", METHODS[number].name);
        assert!(
            METHODS[number].name == WITHOUT_EXAMPLES || shapes[..number].iter().all(|other| other != shape),
            "{}",
            METHODS[number].name
        );
    }
    command(&mut session, Command::Apply);
    for key in [Key::G, Key::Y, Key::Num0, Key::Period, Key::Num1, Key::Enter] {
        session.key(key, Modifiers::NONE);
    }
    session.settle();
    let last = hash(&session);

    let steps = session.harness.state().editor().history().names().1;
    for _ in 0..steps {
        session.key(Key::Z, Modifiers::COMMAND);
    }
    session.settle();
    assert_eq!(hash(&session), first, "after undoing {steps} steps");
    for _ in 0..steps {
        session.key(Key::Z, Modifiers::COMMAND | Modifiers::SHIFT);
    }
    session.settle();
    assert_eq!(hash(&session), last, "after redoing {steps} steps");

    let folder = Folder::new();
    let project = folder.path().join("session.pliant");
    session.harness.state_mut().save_project_to(project.clone());
    session.settle();
    assert!(!session.harness.state().editor().view().unsaved);
    session.harness.state_mut().open(assets().join("plane.glb"));
    session.settle();
    session.harness.state_mut().open(project);
    session.settle();
    assert_eq!(session.harness.state().headline(), None);
    assert_eq!(hash(&session), last, "opened again");
}

/// Small views of all methods: they follow the handles and the camera, a click takes one as a step, Esc closes them.
#[test]
fn all_methods_are_compared_in_small_views_and_a_click_takes_one() {
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    let height = session.harness.state().view_rect().height();
    session.palette("compare methods");
    session.key(Key::Enter, Modifiers::NONE);
    for key in [Key::R, Key::Z, Key::Num5, Key::Num0, Key::Enter] {
        session.key(key, Modifiers::NONE);
    }
    session.settle();
    assert!(session.harness.state().view_rect().height() < 0.8 * height);
    let comparison = |session: &Session| -> Vec<Vec<DVec3>> {
        let comparison = session.harness.state().editor().comparison().unwrap();
        let alternatives = comparison.alternatives().iter();
        alternatives.map(|alternative| alternative.shape.to_vec()).collect()
    };
    let shapes = comparison(&session);
    assert_eq!(shapes.len(), METHODS.len());
    for (number, shape) in shapes.iter().enumerate() {
        let is_other = shapes[..number].iter().all(|other| other != shape);
        assert!(
            moved(shape) > 0 && (is_other || METHODS[number].name == WITHOUT_EXAMPLES),
            "{number}"
        );
    }
    // A click takes the shape shown there.
    let own = session.harness.state().editor().document().method().name();
    let (number, other) = (0..)
        .zip(METHODS)
        .find(|(_, method)| method.name != own && method.name != "identity")
        .unwrap();
    let label = format!("Use {}", other.title);
    let middle = session.harness.get_by_label(&label).rect().center();
    session.pointer(middle, Some(true));
    session.pointer(middle, Some(false));
    session.settle();
    assert_eq!(session.harness.state().editor().document().method().name(), other.name);
    let size = session
        .harness
        .state()
        .editor()
        .view()
        .model
        .unwrap()
        .bounds()
        .unwrap()
        .diagonal();
    let apart = session
        .shape()
        .into_iter()
        .zip(&shapes[number])
        .map(|(a, b)| a.distance(*b));
    assert!(
        apart.fold(0.0, f64::max) < DESCENDED * size,
        "the view shows what the small one showed"
    );
    assert_eq!(comparison(&session), shapes, "the small views stay as they are");
    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    assert_eq!(session.harness.state().editor().document().method().name(), own);
    session.key(Key::Escape, Modifiers::NONE);
    session.settle();
    assert!(session.harness.state().editor().comparison().is_none());
    assert_eq!(session.harness.state().view_rect().height(), height);
}

/// One of the compared methods large beside the view: one drag by two methods; making it small again leaves the first
/// unchanged.
#[test]
fn two_methods_are_compared_on_the_same_drag() {
    let folder = Folder::new();
    let ball = folder.write_mesh("ball.off", &pliant_mesh::shapes::icosphere(4));
    let Some(mut session) = Session::begin_in(Source::File(ball), AppDirectories::default()) else {
        return;
    };
    let top = session.point_of(|positions| *positions.iter().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap());
    session.stroke(top + vec2(0.0, 6.0), top + vec2(0.0, 16.0));
    session.settle();
    let width = session.harness.state().view_rect().width();
    session.harness.state_mut().command(Command::CompareMethods);
    session.settle();
    let own = session.harness.state().editor().document().method().name();
    let other = (0..METHODS.len()).find(|&number| METHODS[number].name != own).unwrap();
    let label = format!("Enlarge {}", METHODS[other].title);
    let middle = session.harness.get_by_label(&label).rect().center();
    session.pointer(middle, Some(true));
    session.pointer(middle, Some(false));
    session.settle();
    assert_eq!(
        session.harness.state().editor().comparison().unwrap().large(),
        Some(other)
    );
    assert_eq!(session.harness.state().editor().document().method().name(), own);
    assert!(
        session.harness.state().view_rect().width() < 0.6 * width,
        "half of the view is the second's"
    );
    for key in [Key::R, Key::Z, Key::Num5, Key::Num0, Key::Enter] {
        session.key(key, Modifiers::NONE);
    }
    session.settle();
    let first = session.shape();
    let bent = |session: &Session| {
        let comparison = session.harness.state().editor().comparison().unwrap();
        comparison.alternatives()[other].shape.to_vec()
    };
    assert!(
        moved(&bent(&session)) > 0 && bent(&session) != first,
        "the second bends otherwise"
    );
    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    assert_eq!(moved(&bent(&session)), 0, "it goes back along");
    session.harness.state_mut().command(Command::EnlargeMethod(None));
    session.settle();
    assert_eq!(session.harness.state().view_rect().width(), width);
    session.key(Key::Z, Modifiers::COMMAND | Modifiers::SHIFT);
    session.settle();
    assert_eq!(session.shape(), first);
}

#[test]
fn a_lost_graphics_device_is_opened_again_and_the_document_is_as_it_was() {
    if let Err(error) = pliant_render::Headless::new() {
        eprintln!("skipped: the window's session ({error})");
        return;
    }
    let shared = Shared::default();
    let window = || {
        let shared = shared.clone();
        Harness::builder()
            .with_size(vec2(600.0, 400.0))
            .with_max_steps(64)
            .wgpu()
            .build_eframe(move |context| {
                Shell::new(
                    context,
                    shared,
                    |context| Application::new(context, Source::Sample),
                    NumpadDigits::default(),
                )
                .expect("the device was just there")
            })
    };
    let settle = |harness: &mut Harness<'_, Shell>| {
        let start = Instant::now();
        harness.step();
        while !shared.borrow().as_ref().unwrap().is_settled() {
            assert!(start.elapsed() < Duration::from_secs(120), "still busy");
            std::thread::sleep(Duration::from_millis(5));
            harness.step();
        }
        harness.step();
    };
    let mut first = window();
    settle(&mut first);
    let with = |act: &dyn Fn(&mut Application)| act(shared.borrow_mut().as_mut().unwrap());
    with(&|application| application.command(Command::SetLoose(Loose::Rest)));
    with(&|application| application.command(Command::SetShading(Shading::Zebra)));
    settle(&mut first);
    with(&|application| application.lose_device());
    first.step();
    with(&|application| assert!(application.has_lost_its_device()));
    drop(first);
    let mut second = window();
    settle(&mut second);
    with(&|application| {
        assert!(!application.has_lost_its_device());
        assert!(
            application.headline().unwrap().contains("lost"),
            "{:?}",
            application.headline()
        );
        let view = application.editor().view();
        assert!(view.unsaved && view.undo.is_some() && view.look.shading == Shading::Zebra);
        assert_eq!(application.editor().document().loose(), Loose::Rest);
        assert!(application.drawings() > 0, "it is drawn on the new device");
    });
}

/// Keeps every thread that jobs share busy until it is dropped.
struct Crowd {
    gate: Arc<(Mutex<bool>, Condvar)>,
    jobs: Option<JoinHandle<()>>,
}

impl Crowd {
    fn gather() -> Self {
        let gate = Arc::new((Mutex::new(false), Condvar::new()));
        let present = Arc::new(AtomicUsize::new(0));
        let (its_gate, its_present) = (Arc::clone(&gate), Arc::clone(&present));
        // From a thread that belongs to no window.
        let jobs = std::thread::spawn(move || {
            rayon::broadcast(|_| {
                its_present.fetch_add(1, Ordering::SeqCst);
                let mut is_open = its_gate.0.lock().unwrap();
                while !*is_open {
                    is_open = its_gate.1.wait(is_open).unwrap();
                }
            });
        });
        let threads = std::thread::spawn(rayon::current_num_threads).join().unwrap();
        while present.load(Ordering::SeqCst) < threads {
            std::thread::sleep(Duration::from_millis(1));
        }
        let jobs = Some(jobs);
        Self { gate, jobs }
    }

    fn disperse(gate: &(Mutex<bool>, Condvar)) {
        *gate.0.lock().unwrap() = true;
        gate.1.notify_all();
    }
}

impl Drop for Crowd {
    fn drop(&mut self) {
        Self::disperse(&self.gate);
        if let Some(jobs) = self.jobs.take() {
            jobs.join().unwrap();
        }
    }
}

/// While jobs occupy every shared thread, the window still shows regions, rims and colours: none of its loops queues
/// behind jobs. If it would wait forever, the threads are released after two minutes and the test fails.
#[test]
fn the_windows_loops_wait_for_no_job() {
    let Some(mut session) = Session::begin() else { return };
    let top = session.point_of(|positions| *positions.iter().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap());
    session.stroke(top + vec2(0.0, 6.0), top + vec2(0.0, 16.0));
    let drawings = session.harness.state().drawings();

    let crowd = Crowd::gather();
    let gate = Arc::clone(&crowd.gate);
    let is_over = Arc::new(AtomicBool::new(false));
    let (its_end, was_stuck) = (Arc::clone(&is_over), Arc::new(AtomicBool::new(false)));
    let its_word = Arc::clone(&was_stuck);
    let watchdog = std::thread::spawn(move || {
        let start = Instant::now();
        while !its_end.load(Ordering::SeqCst) {
            if start.elapsed() > Duration::from_secs(120) {
                its_word.store(true, Ordering::SeqCst);
                return Crowd::disperse(&gate);
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    });
    let document = Command::all_listed().map(|listed| listed.command.clone());
    for command in document.filter(|command| !matches!(command, Command::Move | Command::Turn | Command::Scale)) {
        session.harness.state_mut().command(command);
        session.harness.run_steps(2);
    }
    session.pointer(top, None);
    session.pointer(top, Some(true));
    session.pointer(top + vec2(10.0, 10.0), None);
    session.pointer(top + vec2(10.0, 10.0), Some(false));
    is_over.store(true, Ordering::SeqCst);
    drop(crowd);
    watchdog.join().unwrap();
    assert!(
        !was_stuck.load(Ordering::SeqCst),
        "a loop of the window stood in line with jobs"
    );
    assert!(session.harness.state().drawings() > drawings, "and all that was shown");
}

/// "Make cage or lattice" is listed earlier, and the method must first be the lattice.
#[test]
fn the_palette_offers_what_can_be_done_now_first() {
    let Some(mut session) = Session::begin() else { return };
    session.palette("lattice");
    session.key(Key::Enter, Modifiers::NONE);
    assert_eq!(session.harness.state().editor().document().method().name(), "lattice");
    // Before any typing, too: Enter is not refused.
    session.palette("");
    assert!(session.harness.query_by_label("Command").is_some());
    session.key(Key::Enter, Modifiers::NONE);
    session.harness.run_steps(2);
    assert!(session.harness.query_by_label("Command").is_none());
}

#[test]
fn escape_closes_the_window_on_top_and_then_means_the_editor_again() {
    let Some(mut session) = Session::begin() else { return };
    let has = |session: &Session, label: &str| session.harness.query_by_label(label).is_some();
    let top = session.point_of(|positions| *positions.iter().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap());
    session.stroke(top + vec2(0.0, 6.0), top + vec2(0.0, 10.0));
    for name in ["log", "keys"] {
        session.palette(name);
        session.key(Key::Enter, Modifiers::NONE);
    }
    let (of_log, of_keys) = ("Copy all", "Default keys");
    assert!(has(&session, of_log) && has(&session, of_keys));
    // The palette closes first.
    session.palette("log");
    session.key(Key::Escape, Modifiers::NONE);
    assert!(has(&session, of_log) && has(&session, of_keys));
    // Then the wait for a key.
    session.harness.get_by_label("Key for Undo").click();
    session.harness.run_steps(2);
    session.key(Key::Escape, Modifiers::NONE);
    assert!(has(&session, of_log) && has(&session, of_keys));
    // Then the tool's current action.
    session.key(Key::G, Modifiers::NONE);
    assert!(session.harness.state().editor().is_acting());
    session.key(Key::Escape, Modifiers::NONE);
    assert!(!session.harness.state().editor().is_acting());
    assert!(has(&session, of_log) && has(&session, of_keys));
    // Then the windows, the last used one first.
    session.key(Key::Escape, Modifiers::NONE);
    assert!(has(&session, of_log) && !has(&session, of_keys));
    session.key(Key::Escape, Modifiers::NONE);
    assert!(!has(&session, of_log) && !has(&session, of_keys));
}

#[test]
fn what_can_not_be_done_now_says_why_in_the_palette() {
    let Some(mut session) = Session::begin() else { return };
    session.palette("delete handle");
    session.key(Key::Enter, Modifiers::NONE);
    let said = session.harness.query_by_label_contains("No handle is selected");
    assert!(said.is_some(), "it stays open and says why");
    session.key(Key::Escape, Modifiers::NONE);
    assert!(
        session
            .harness
            .query_by_label_contains("No handle is selected")
            .is_none()
    );
}

#[test]
fn a_key_that_the_window_has_is_refused_by_name_and_another_is_awaited() {
    let Some(mut session) = Session::begin() else { return };
    session.palette("keys");
    session.key(Key::Enter, Modifiers::NONE);
    session.harness.get_by_label("Key for Undo").click();
    session.harness.run_steps(2);
    session.key(Key::S, Modifiers::COMMAND);
    assert!(
        session.harness.query_by_label_contains("Save model").is_some(),
        "who has it is named"
    );
    session.key(Key::F5, Modifiers::NONE);
    assert!(
        session.harness.query_by_label_contains("F5").is_some(),
        "what is no command's key is said"
    );
    session.key(Key::J, Modifiers::COMMAND);
    let keys = session.harness.state().editor().shortcuts(&Command::Undo);
    assert_eq!(keys.iter().map(|key| key.label()).collect::<Vec<_>>(), ["Ctrl+J"]);
    assert!(session.harness.query_by_label_contains("Save model").is_none());
}

#[test]
fn nothing_at_the_panels_edge_lies_under_its_scroll_bar() {
    let Some(mut session) = Session::begin() else { return };
    session.page("Scene");
    // So low that the page scrolls.
    session.harness.set_size(vec2(1000.0, 420.0));
    session.harness.run_steps(4);
    let right = session.harness.get_by_label("Lock creature").rect().right();
    let width = session.harness.ctx.content_rect().width();
    let bar = session.harness.ctx.global_style().spacing.scroll.bar_width;
    assert!(right <= width - bar, "{right} of {width}, less the bar's {bar}");
}
