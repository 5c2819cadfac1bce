use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::sync::Arc;

use pliant_editor::{Beginning, Editor, Event, HandleTransform, InlineExecutor, JobKind, ToolMode};
use pliant_mesh::{WeldOptions, shapes};

use super::left::{left_in, opened_project, remove};
use super::*;
use crate::window::files::rest_mesh::MeshSource;
use pliant_engine::Loaded;
use pliant_engine::watch::Watch;

const FOLDER: &str = "PLIANT_TEST_RECOVERY";
const KILLS: u64 = 50;

fn mesh(folder: &Path) -> PathBuf {
    let path = folder.join("ball.off");
    let drawn = shapes::icosphere(4);
    let mut text = format!("OFF\n{} {} 0\n", drawn.positions.len(), drawn.triangles.len());
    for p in &drawn.positions {
        text.push_str(&format!("{:?} {:?} {:?}\n", p.x, p.y, p.z));
    }
    for t in &drawn.triangles {
        text.push_str(&format!("3 {} {} {}\n", t[0].0, t[1].0, t[2].0));
    }
    fs::write(&path, text).unwrap();
    path
}

fn loaded(path: &Path) -> Arc<Loaded> {
    Arc::new(pliant_engine::load(path, &WeldOptions::default(), &Watch::default()).unwrap())
}

/// Works without an end, keeping every state, until it is killed. Does nothing if no folder is named.
#[test]
fn child() {
    let Some(folder) = std::env::var_os(FOLDER).map(PathBuf::from) else {
        return;
    };
    let file = folder.join("ball.off");
    let loaded = loaded(&file);
    let mesh = RestMesh::new(Arc::clone(&loaded), MeshSource::File(file.clone()));
    let mut recovery = Recovery::begin(&folder.join("recovery")).unwrap();
    recovery.every = Duration::ZERO;
    let jobs = InlineExecutor::new();
    let mut editor = Editor::new(Box::new(jobs.clone()));
    let size_px = glam::DVec2::new(800.0, 600.0);
    editor.handle(Event::Viewport { size_px });
    editor.handle(Event::Opened {
        model: Arc::clone(&loaded.model),
        name: "ball".to_owned(),
        beginning: None,
    });
    for round in 0_u32.. {
        while let Some(done) = jobs.run_next() {
            // A continuing drag has a waiting solve: every second state is written before it.
            let is_last = done.kind == JobKind::Solve;
            editor.handle(Event::JobDone(done));
            if is_last {
                break;
            }
        }
        act(&mut editor, round);
        let key = editor.snapshot_key();
        let work = recovery.note(key, true, || editor.snapshot(), &mesh, [Some(&file), None]);
        if let Some(work) = work {
            println!("writing {}", editor.document_hash().unwrap());
            let result = work.write();
            recovery.written(key, result.clone());
            println!("kept {}", result.is_ok());
        }
    }
}

fn act(editor: &mut Editor, round: u32) {
    use pliant_editor::{Button, Command, Modifiers, Pointer};
    let at = |x: f64, y: f64| Pointer {
        position_px: glam::DVec2::new(x, y),
        modifiers: Modifiers::NONE,
    };
    let spread = f64::from(round * 37 % 200);
    if round.is_multiple_of(3) {
        editor.handle(Event::Command(Command::Deselect));
        editor.handle(Event::Command(Command::SetTool(ToolMode::PaintHandle)));
        editor.handle(Event::PointerPressed(at(300.0 + spread, 300.0), Button::Primary));
        editor.handle(Event::PointerMoved(at(310.0 + spread, 200.0 + spread)));
        editor.handle(Event::PointerReleased(
            at(310.0 + spread, 200.0 + spread),
            Button::Primary,
        ));
    } else if let Some(id) = editor.view().selected {
        let transform = HandleTransform::Trs {
            translation: glam::DVec3::new(0.001 * spread, 0.01 * f64::from(round % 7), 0.0),
            rotation: glam::DQuat::IDENTITY,
            scale: glam::DVec3::ONE,
            pivot: None,
        };
        editor.handle(Event::Adjust(Command::SetHandleTransform(id, transform)));
    }
}

#[test]
fn killed_at_random_moments_it_leaves_a_whole_project_of_its_last_states() {
    let folder = tempfile::tempdir().unwrap();
    let file = mesh(folder.path());
    let loaded = loaded(&file);
    let mut recovered = 0;
    let (_, module) = module_path!().split_once("::").unwrap();
    let name = format!("{module}::child");
    for kill in 0..KILLS {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", &name, "--nocapture"])
            .env(FOLDER, folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        // At least one state is written; then the process dies anywhere.
        let mut said: Vec<String> = Vec::new();
        while !said.iter().any(|line| line == "kept true") {
            said.push(lines.next().unwrap().unwrap());
        }
        std::thread::sleep(Duration::from_micros(kill * 7919 % 60_000));
        child.kill().unwrap();
        child.wait().unwrap();
        said.extend(lines.map_while(Result::ok));

        let recovery = folder.path().join("recovery");
        let left = left_in(&recovery);
        assert_eq!(left.len(), 1, "kill {kill}: one session has left its work");
        let text = fs::read_to_string(&left[0].project).unwrap();
        let beginning = Beginning::parse(&text).unwrap();
        beginning.resolve(&loaded.model).unwrap();
        let Beginning::Project(project) = beginning else {
            unreachable!()
        };
        let states: Vec<&str> = said.iter().filter_map(|line| line.strip_prefix("writing ")).collect();
        let newest = &states[states.len().saturating_sub(2)..];
        assert!(
            newest.contains(&&*project.document_hash()),
            "kill {kill}: the last state or the one before it"
        );
        remove(&left[0].project);
        assert!(left_in(&recovery).is_empty());
        for half in fs::read_dir(&recovery).unwrap().flatten() {
            let _ = fs::remove_file(half.path());
        }
        recovered += 1;
    }
    assert_eq!(recovered, KILLS);
}

#[cfg(unix)]
#[test]
fn what_is_kept_can_be_read_by_its_owner_alone() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let file = mesh(folder.path());
    let kept = folder.path().join("kept");
    // The folder as an earlier version made it.
    fs::create_dir(&kept).unwrap();
    fs::set_permissions(&kept, fs::Permissions::from_mode(0o755)).unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
    let recovery = Recovery::begin(&kept).unwrap();
    assert_eq!((mode(&kept), mode(&recovery.lock_path)), (0o700, 0o600));
    fs::write(&recovery.project, "").unwrap();
    fs::set_permissions(&recovery.project, fs::Permissions::from_mode(0o644)).unwrap();
    let mut editor = Editor::new(Box::new(InlineExecutor::new()));
    let loaded = loaded(&file);
    editor.handle(Event::Opened {
        model: Arc::clone(&loaded.model),
        name: "ball".to_owned(),
        beginning: None,
    });
    let work = Work {
        snapshot: editor.snapshot().unwrap(),
        mesh: RestMesh::new(loaded, MeshSource::File(file.clone())),
        model: Some(file),
        opened: None,
        project: recovery.project.clone(),
    };
    work.write().unwrap();
    let source = recovery.project.with_extension("source.off");
    assert_eq!((mode(&recovery.project), mode(&source)), (0o600, 0o600));
}

#[test]
fn work_is_recovered_though_its_scan_is_gone_replaced_or_oddly_called() {
    let folder = tempfile::tempdir().unwrap();
    let made = mesh(folder.path());
    let mut names = vec![std::ffi::OsString::from("scan.off")];
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStringExt;
        names.push("back\\slash %41.off".into());
        names.push(std::ffi::OsString::from_vec(b"caf\xe9.off".to_vec()));
    }
    for name in names {
        for is_replaced in [false, true] {
            let file = folder.path().join(&name);
            fs::copy(&made, &file).unwrap();
            let loaded = loaded(&file);
            let mut recovery = Recovery::begin(&folder.path().join("recovery")).unwrap();
            recovery.every = Duration::ZERO;
            let mut editor = Editor::new(Box::new(InlineExecutor::new()));
            editor.handle(Event::Opened {
                model: Arc::clone(&loaded.model),
                name: "ball".to_owned(),
                beginning: None,
            });
            let mesh = RestMesh::new(Arc::clone(&loaded), MeshSource::File(file.clone()));
            let key = editor.snapshot_key();
            let work = recovery.note(key, true, || editor.snapshot(), &mesh, [Some(&file), None]);
            work.unwrap().write().unwrap();
            // The file on the disk comes first, wherever the project names it.
            let opened = project_file::read(&recovery.project, &Watch::default()).unwrap();
            assert_eq!(opened.source, MeshSource::File(file.clone()), "{}", file.display());
            if is_replaced {
                fs::write(&file, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").unwrap();
            } else {
                fs::remove_file(&file).unwrap();
            }
            let opened = project_file::read(&recovery.project, &Watch::default()).unwrap();
            assert_eq!(opened.loaded.model.rest_positions(), loaded.model.rest_positions());
            assert_eq!(opened.named, file);
        }
    }
}

#[test]
fn a_recovered_session_knows_its_project_unless_that_was_written_since() {
    let folder = tempfile::tempdir().unwrap();
    let file = mesh(folder.path());
    let opened = folder.path().join("back\\slash %41.pliant");
    let recovery = Recovery::begin(&folder.path().join("recovery")).unwrap();
    let mut editor = Editor::new(Box::new(InlineExecutor::new()));
    let loaded = loaded(&file);
    editor.handle(Event::Opened {
        model: Arc::clone(&loaded.model),
        name: "ball".to_owned(),
        beginning: None,
    });
    let work = |opened: Option<&Path>| Work {
        snapshot: editor.snapshot().unwrap(),
        mesh: RestMesh::new(Arc::clone(&loaded), MeshSource::File(file.clone())),
        model: Some(file.clone()),
        opened: opened.map(Path::to_owned),
        project: recovery.project.clone(),
    };
    fs::write(&opened, "{}").unwrap();
    work(Some(&opened)).write().unwrap();
    assert_eq!(opened_project(&recovery.project), Some(opened.clone()));
    let later = std::time::SystemTime::now() + Duration::from_secs(60);
    let theirs = File::options().write(true).open(&opened).unwrap();
    theirs.set_modified(later).unwrap();
    assert_eq!(opened_project(&recovery.project), None, "another program wrote it");
    fs::remove_file(&opened).unwrap();
    assert_eq!(opened_project(&recovery.project), None, "it is gone");
    work(None).write().unwrap();
    assert!(!recovery.project.with_extension("opened").exists());
    work(Some(&opened)).write().unwrap();
    remove(&recovery.project);
    drop(recovery);
    let left = fs::read_dir(folder.path().join("recovery")).unwrap();
    assert_eq!(left.count(), 0);
}

#[test]
fn a_session_that_lives_is_not_taken_for_one_that_is_gone_and_one_that_closes_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut recovery = Recovery::begin(folder.path()).unwrap();
    let other = Recovery::begin(folder.path()).unwrap();
    assert_ne!(recovery.project, other.project);
    fs::write(&recovery.project, "{}").unwrap();
    assert!(left_in(folder.path()).is_empty());
    recovery.kept = Some(SnapshotKey::default());
    drop((recovery, other));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
