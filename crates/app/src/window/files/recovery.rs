//! What a session leaves for the next one should it end without saving: a project, written every few seconds while
//! there is unsaved work, and taken away when the work is saved or the window is closed.
//!
//! Each session holds a lock on a file of its own. The system lets go of it however the process ends, so a project
//! whose lock can be had belongs to a session that is gone.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use pliant_editor::{Snapshot, SnapshotKey};
use pliant_mesh::{Cancel, Progress};

use super::project_file::{self, MeshSource};
use crate::engine::Loaded;
use crate::files::{Staging, shown};

/// How often unsaved work is kept. A write takes less than a second even on a large mesh, so no more than twice this
/// can be lost.
const EVERY: Duration = Duration::from_secs(8);

/// The keeper of one session's work.
#[derive(Debug)]
pub struct Recovery {
    project: PathBuf,
    lock_path: PathBuf,
    _lock: File,
    /// The state that was kept last, and the one that is being written.
    kept: Option<SnapshotKey>,
    writing: Option<SnapshotKey>,
    last: Instant,
    every: Duration,
    /// Whether the last write failed: it is said once.
    failed: bool,
}

/// What is to be kept.
#[derive(Clone)]
pub struct Work {
    snapshot: Snapshot,
    loaded: Arc<Loaded>,
    source: MeshSource,
    project: PathBuf,
}

/// The newest state of the window that runs in this process, for the moment of a panic.
static LATEST: Mutex<Option<Work>> = Mutex::new(None);

/// A session that ended without saving.
#[derive(Clone, PartialEq, Debug)]
pub struct Left {
    /// Its project.
    pub project: PathBuf,
    /// What people call the model that was worked on, where that can be told.
    pub name: Option<String>,
    /// When that was written.
    pub written: SystemTime,
}

impl Recovery {
    /// Begins to keep a session's work in `folder`.
    ///
    /// # Errors
    /// Where the folder or the lock can't be made, in a sentence.
    pub fn begin(folder: &Path) -> Result<Self, String> {
        let refuse =
            |error: std::io::Error| format!("unsaved work can't be kept in {} ({error}): save often", shown(folder));
        make_private_folder(folder).map_err(refuse)?;
        for number in 0..1000 {
            let name = format!("session-{}-{number}", std::process::id());
            let lock_path = folder.join(&name).with_extension("lock");
            let lock = private_file(&lock_path).map_err(refuse)?;
            if lock.try_lock().is_ok() && !folder.join(&name).with_extension("pliant").exists() {
                return Ok(Self {
                    project: folder.join(&name).with_extension("pliant"),
                    lock_path,
                    _lock: lock,
                    kept: None,
                    writing: None,
                    last: Instant::now(),
                    every: EVERY,
                    failed: false,
                });
            }
        }
        Err(refuse(std::io::Error::other("a thousand sessions are there")))
    }

    /// The sessions in `folder` that ended without saving, the newest first.
    pub fn left_in(folder: &Path) -> Vec<Left> {
        let Ok(entries) = fs::read_dir(folder) else {
            return Vec::new();
        };
        let mut left: Vec<Left> = entries
            .filter_map(|entry| entry.ok().map(|entry| entry.path()))
            .filter(|path| crate::engine::is_project(path) && is_gone(&path.with_extension("lock")))
            .map(|project| {
                let written = fs::metadata(&project).and_then(|metadata| metadata.modified());
                Left {
                    written: written.unwrap_or(SystemTime::UNIX_EPOCH),
                    name: project_file::mesh_name(&project),
                    project,
                }
            })
            .collect();
        left.sort_by_key(|left| std::cmp::Reverse(left.written));
        left
    }

    /// Takes note of the present state: what is to be written now, if anything is, for [`Work::write`] elsewhere.
    pub fn note(
        &mut self,
        key: SnapshotKey,
        unsaved: bool,
        snapshot: impl FnOnce() -> Option<Snapshot>,
        loaded: &Arc<Loaded>,
        source: &MeshSource,
    ) -> Option<Work> {
        if !unsaved {
            self.forget(key);
            return None;
        }
        if self.writing.is_some() || self.kept == Some(key) {
            return None;
        }
        let work = Work {
            snapshot: snapshot()?,
            loaded: Arc::clone(loaded),
            source: source.clone(),
            project: self.project.clone(),
        };
        *LATEST.lock().unwrap_or_else(PoisonError::into_inner) = Some(work.clone());
        if self.kept.is_some() && self.last.elapsed() < self.every {
            return None;
        }
        self.writing = Some(key);
        Some(work)
    }

    /// Whether this state was kept.
    pub fn has(&self, key: SnapshotKey) -> bool {
        self.kept == Some(key) && !self.failed
    }

    /// When the window should look again though nothing happens; `None` while nothing waits.
    pub fn wait(&self, key: SnapshotKey, unsaved: bool) -> Option<Duration> {
        (unsaved && self.kept != Some(key)).then(|| self.every.saturating_sub(self.last.elapsed()))
    }

    /// A write has ended. A sentence if it failed, once.
    pub fn written(&mut self, key: SnapshotKey, result: Result<(), String>) -> Option<String> {
        self.writing = None;
        self.last = Instant::now();
        // A failed one counts as well: the disk is asked again when something changes.
        self.kept = Some(key);
        match result {
            Ok(()) => {
                self.failed = false;
                None
            }
            Err(sentence) => {
                let is_new = !std::mem::replace(&mut self.failed, true);
                is_new.then(|| format!("Unsaved work can't be kept for a recovery: {sentence}"))
            }
        }
    }

    /// There is nothing to recover.
    fn forget(&mut self, key: SnapshotKey) {
        if self.writing.is_none() && self.kept.is_some() {
            self.kept = None;
            remove(&self.project);
        }
        let mut latest = LATEST.lock().unwrap_or_else(PoisonError::into_inner);
        if latest.is_some() && self.writing != Some(key) {
            *latest = None;
        }
    }
}

impl Drop for Recovery {
    /// The window closes in good order: whoever closed it was asked about unsaved work.
    fn drop(&mut self) {
        if std::thread::panicking() {
            return;
        }
        *LATEST.lock().unwrap_or_else(PoisonError::into_inner) = None;
        remove(&self.project);
        let _ = fs::remove_file(&self.lock_path);
    }
}

impl Work {
    /// Writes it.
    ///
    /// # Errors
    /// What stands in the way, in a sentence.
    pub fn write(&self) -> Result<(), String> {
        project_file::write(
            &self.snapshot,
            &self.loaded,
            &self.source,
            &self.project,
            &Staging::private(),
            &Progress::new(),
            &Cancel::new(),
        )
        .map_err(|error| error.to_string())
    }
}

/// Writes the newest state at once, in the middle of a panic; where to, if there was one.
pub fn write_latest() -> Option<PathBuf> {
    // Whoever holds it may be the one that panics.
    let work = LATEST.try_lock().ok()?.clone()?;
    work.write().ok().map(|()| work.project)
}

/// Makes the folder of a user's unsaved work, which is nobody else's business.
fn make_private_folder(folder: &Path) -> std::io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{DirBuilderExt, PermissionsExt};
        fs::DirBuilder::new().recursive(true).mode(0o700).create(folder)?;
        // One that an earlier version made may be open to all.
        fs::set_permissions(folder, fs::Permissions::from_mode(0o700))
    }
    #[cfg(not(unix))]
    fs::create_dir_all(folder)
}

/// Makes or opens a file that only its owner may read.
fn private_file(path: &Path) -> std::io::Result<File> {
    let mut options = fs::OpenOptions::new();
    options.write(true).create(true).truncate(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.open(path)
}

/// Takes a left session away.
pub fn remove(project: &Path) {
    // What is not there need not go.
    let _ = fs::remove_file(project);
    let Some(stem) = project.file_stem() else { return };
    let prefix = format!("{}.source.", stem.to_string_lossy());
    let folder = project.parent().and_then(|folder| fs::read_dir(folder).ok());
    for entry in folder.into_iter().flatten().flatten() {
        if entry.file_name().to_string_lossy().starts_with(&prefix) {
            let _ = fs::remove_file(entry.path());
        }
    }
    if is_gone(&project.with_extension("lock")) {
        let _ = fs::remove_file(project.with_extension("lock"));
    }
}

/// Whether nobody holds the lock.
fn is_gone(lock: &Path) -> bool {
    match File::open(lock) {
        Ok(file) => file.try_lock().is_ok(),
        Err(_) => true,
    }
}

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that can't go on fails, and the child says what it did"
)]
mod tests {
    use std::io::{BufRead, BufReader};
    use std::process::{Command, Stdio};

    use pliant_editor::{Beginning, Editor, Event, HandleTransform, InlineExecutor, JobKind, ToolMode};
    use pliant_mesh::{WeldOptions, shapes};

    use super::*;
    use crate::engine;
    use crate::watch::Watch;

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
        Arc::new(engine::load(path, &WeldOptions::default(), &Watch::default()).unwrap())
    }

    /// Works without an end, keeping every state, until it is killed. Does nothing where no folder is named.
    #[test]
    fn child() {
        let Some(folder) = std::env::var_os(FOLDER).map(PathBuf::from) else {
            return;
        };
        let loaded = loaded(&folder.join("ball.off"));
        let source = MeshSource::File(folder.join("ball.off"));
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
                // A drag that goes on has a solve waiting: every other state is kept before it.
                let is_last = done.kind == JobKind::Solve;
                editor.handle(Event::JobDone(done));
                if is_last {
                    break;
                }
            }
            act(&mut editor, round);
            let key = editor.snapshot_key();
            let work = recovery.note(key, true, || editor.snapshot(), &loaded, &source);
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
            // At least one state is kept; then it dies anywhere.
            let mut said: Vec<String> = Vec::new();
            while !said.iter().any(|line| line == "kept true") {
                said.push(lines.next().unwrap().unwrap());
            }
            std::thread::sleep(Duration::from_micros(kill * 7919 % 60_000));
            child.kill().unwrap();
            child.wait().unwrap();
            said.extend(lines.map_while(Result::ok));

            let recovery = folder.path().join("recovery");
            let left = Recovery::left_in(&recovery);
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
            assert!(Recovery::left_in(&recovery).is_empty());
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
        // As an earlier version left it.
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
            loaded,
            // Gone: the mesh is kept beside the project.
            source: MeshSource::Gone,
            project: recovery.project.clone(),
        };
        work.write().unwrap();
        let source = recovery.project.with_extension("source.off");
        assert_eq!((mode(&recovery.project), mode(&source)), (0o600, 0o600));
    }

    #[test]
    fn a_session_that_lives_is_not_taken_for_one_that_is_gone_and_one_that_closes_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let mut recovery = Recovery::begin(folder.path()).unwrap();
        let other = Recovery::begin(folder.path()).unwrap();
        assert_ne!(recovery.project, other.project);
        fs::write(&recovery.project, "{}").unwrap();
        assert!(Recovery::left_in(folder.path()).is_empty());
        recovery.kept = Some(SnapshotKey::default());
        drop((recovery, other));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
