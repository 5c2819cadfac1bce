//! The harness of the whole-program tests: it runs the program inside the test, keeps each test's files in a temporary
//! folder, and finds the data that may be beside the project. Its verbs: `run`, `apply`, `open`, `write_mesh`.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stderr,
    missing_docs,
    reason = "the rig is a part of tests: it fails by panicking, says what it skips, and its names are its words"
)]

#[cfg(unix)]
pub mod hostile;
pub mod morphs;
pub mod sources;
pub mod trials;

use std::ffi::OsString;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;
use pliant_app::cli::{self, Console};
use pliant_engine::Loaded;
use pliant_engine::watch::Watch;
use pliant_mesh::{Drawn, WeldOptions};
use serde_json::{Value, json};

/// The program's output, and its exit status.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Ended {
    pub status: u8,
    pub out: String,
    pub err: String,
}

/// Runs `pliant ARGUMENTS`.
pub fn run<S: Into<OsString>>(arguments: impl IntoIterator<Item = S>) -> Ended {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let mut console = Console {
        out: &mut out,
        err: &mut err,
        watch: Watch::default(),
        staging: Default::default(),
    };
    let words = std::iter::once("pliant".into())
        .chain(arguments.into_iter().map(Into::into))
        .collect();
    let status = cli::run(words, &mut console);
    let text = |bytes| String::from_utf8(bytes).expect("the program speaks UTF-8");
    Ended {
        status,
        out: text(out),
        err: text(err),
    }
}

impl Ended {
    /// Asserts status 0 and only warnings on standard error.
    #[track_caller]
    pub fn done(self) -> Self {
        let is_warning = |line: &str| line.starts_with("pliant: warning: ");
        assert!(self.status == 0 && self.err.lines().all(is_warning), "{self:?}");
        self
    }

    /// Asserts the given status, and one line on standard error that contains all of `words`.
    #[track_caller]
    pub fn refused(self, status: u8, words: &[&str]) -> Self {
        assert_eq!(self.status, status, "{self:?}");
        assert_eq!(self.err.lines().count(), 1, "one line: {:?}", self.err);
        assert!(
            self.err.starts_with("pliant: ") && self.err.ends_with('\n'),
            "{:?}",
            self.err
        );
        for word in words {
            assert!(self.err.contains(word), "{word:?} is not in {:?}", self.err);
        }
        self
    }
}

/// A folder for a test's files, removed when it is dropped.
pub struct Folder(tempfile::TempDir);

impl Default for Folder {
    fn default() -> Self {
        Self(tempfile::tempdir().unwrap())
    }
}

impl Folder {
    pub fn new() -> Self {
        Self::default()
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    pub fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.at(name);
        fs::write(&path, content).unwrap();
        path
    }

    /// The names of everything in the folder, sorted.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.path()).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// Writes a mesh as an OFF file with every digit of its positions.
    pub fn write_mesh(&self, name: &str, drawn: &Drawn) -> PathBuf {
        let mut text = format!("OFF\n{} {} 0\n", drawn.positions.len(), drawn.triangles.len());
        for p in &drawn.positions {
            writeln!(text, "{:?} {:?} {:?}", p.x, p.y, p.z).unwrap();
        }
        for [a, b, c] in &drawn.triangles {
            writeln!(text, "3 {} {} {}", a.0, b.0, c.0).unwrap();
        }
        self.write(name, text)
    }

    /// Applies an edit to a file, with further arguments.
    pub fn apply(&self, file: &Path, edit: &Value, output: &Path, more: &[&str]) -> Ended {
        let edit_path = self.write("edit.json", edit.to_string());
        let mut arguments: Vec<OsString> = vec!["apply".into(), file.into()];
        arguments.extend(["--edit".into(), edit_path.into(), "--output".into(), output.into()]);
        arguments.extend(more.iter().map(Into::into));
        let ended = run(arguments);
        fs::remove_file(self.at("edit.json")).unwrap();
        ended
    }
}

/// Reads and welds a file like the program.
pub fn open(path: &Path) -> Loaded {
    try_open(path).unwrap_or_else(|error| panic!("{error}"))
}

/// Like [`open`], for a file that may be refused.
pub fn try_open(path: &Path) -> Result<Loaded, pliant_engine::EngineError> {
    pliant_engine::load(path, &WeldOptions::default(), &Watch::default())
}

/// An edit that contains only its method.
pub fn bare_edit() -> Value {
    json!({ "version": 1, "method": { "name": "bilaplacian" } })
}

/// The edit that works for every mesh: the lower end of its longest axis is fixed, and `transform` moves the upper end.
pub fn bend(transform: &Value) -> Value {
    json!({
        "version": 1, "method": { "name": "bilaplacian" },
        "fixed": { "slab": { "axis": "longest", "from": 0.0, "to": 0.05 } },
        "handles": [{
            "name": "head", "select": { "slab": { "axis": "longest", "from": 0.95, "to": 1.0 } },
            "transform": transform,
        }],
    })
}

/// The largest distance between vertices with the same index.
pub fn largest_distance(a: &[DVec3], b: &[DVec3]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// The diagonal of the box around finite positions.
pub fn diagonal(positions: &[DVec3]) -> f64 {
    let finite = || positions.iter().copied().filter(|p| p.is_finite());
    match (finite().reduce(DVec3::min), finite().reduce(DVec3::max)) {
        (Some(min), Some(max)) => min.distance(max),
        _ => 0.0,
    }
}

/// The files in `folders` of the data folder that the program can read, sorted. If a folder is missing, the list is
/// empty and standard error names the skipped tests.
pub fn data(folders: &[&str]) -> Vec<PathBuf> {
    let root = data_folder();
    let mut files = Vec::new();
    for folder in folders {
        let before = files.len();
        collect(&root.join(folder), &mut files);
        if files.len() == before {
            eprintln!("skipped: there is no {}", root.join(folder).display());
        }
    }
    files.sort();
    files
}

/// One file of the data folder. If it is missing, `None` and a message on standard error.
pub fn datum(name: &str) -> Option<PathBuf> {
    let path = data_folder().join(name);
    if !path.exists() {
        eprintln!("skipped: there is no {}", path.display());
    }
    path.exists().then_some(path)
}

/// The folder in `PLIANT_DATA`; `.cargo/config.toml` has its default.
fn data_folder() -> PathBuf {
    std::env::var_os("PLIANT_DATA").unwrap_or_default().into()
}

/// The folder with the samples that ship with the program.
pub fn assets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets")
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, files);
        } else if pliant_io::Format::of_name(&path.to_string_lossy()).is_ok() {
            files.push(path);
        }
    }
}

/// The extension of a path, in lower case.
pub fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}
