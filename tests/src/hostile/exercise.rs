//! Runs a case: makes the folder, runs the commands, and checks every law.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde_json::Value;

use super::case::{Case, Entry, Kind};
use super::laws::{self, Law, Places, Violation, shortened, violation};
use super::shapes::{self, Shape, is_same, shape};
use super::tree::{Tree, lay, look, place_of, with_root};
use super::{pictures, sessions};
use crate::trials::Chance;
use crate::{Ended, run};

/// The resources that a command used.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub struct Used {
    /// The most memory held at once, in bytes.
    pub peak: u64,
    /// Processor time of all threads.
    pub cpu_ms: u64,
}

/// Measures commands.
pub trait Meter {
    /// Called before a command runs, with its words.
    fn begin(&mut self, words: &[OsString]);
    /// Returns the command's resources.
    fn end(&mut self) -> Used;
}

/// Measures nothing.
pub struct Unmetered;

impl Meter for Unmetered {
    fn begin(&mut self, _words: &[OsString]) {}
    fn end(&mut self) -> Used {
        Used::default()
    }
}

/// The limits of a command: 2 GB and 10 s, or 20 s if something is bound.
const MEMORY: u64 = 2 << 30;
const SECONDS: u64 = 10;
const BINDING_SECONDS: u64 = 20;

/// The result of a case.
#[derive(Clone, Default, Debug)]
pub struct Exercised {
    pub done: usize,
    pub refused: usize,
    pub violations: Vec<Violation>,
    /// The largest values of any of its commands, each maximum taken separately.
    pub worst: Used,
}

static PANIC: Mutex<String> = Mutex::new(String::new());

/// Records the place and the message of a panic, for the report of the violation, and keeps it off standard error.
pub fn listen_for_panics() {
    std::panic::set_hook(Box::new(|panic| {
        *PANIC.lock().unwrap_or_else(PoisonError::into_inner) = panic.to_string().replace('\n', " ");
    }));
}

pub(super) struct Runner<'a> {
    meter: &'a mut dyn Meter,
    pub(super) result: Exercised,
}

impl Runner<'_> {
    /// Runs a command in the current folder. `None` if it panicked.
    pub(super) fn run(&mut self, words: &[OsString]) -> Option<Ended> {
        let ended = self.metered(words, || run(words.iter().cloned()))?;
        match ended.status {
            0 => self.result.done += 1,
            _ => self.result.refused += 1,
        }
        laws::of_words(&ended, &mut self.result.violations);
        Some(ended)
    }

    /// Executes the command in `words` under its limits. `None` if it panicked.
    pub(super) fn metered<T>(&mut self, words: &[OsString], work: impl FnOnce() -> T) -> Option<T> {
        self.meter.begin(words);
        let ended = catch_unwind(AssertUnwindSafe(work));
        let used = self.meter.end();
        let found = &mut self.result.violations;
        self.result.worst.peak = self.result.worst.peak.max(used.peak);
        self.result.worst.cpu_ms = self.result.worst.cpu_ms.max(used.cpu_ms);
        if used.peak > MEMORY {
            found.push(violation(Law::InMemory, format!("{} MB by {words:?}", used.peak >> 20)));
        }
        let binds = words.iter().any(|word| word.as_encoded_bytes().starts_with(b"--edit="));
        if used.cpu_ms > 1000 * if binds { BINDING_SECONDS } else { SECONDS } {
            found.push(violation(Law::InTime, format!("{} ms by {words:?}", used.cpu_ms)));
        }
        let Ok(ended) = ended else {
            let panic = PANIC.lock().unwrap_or_else(PoisonError::into_inner).clone();
            found.push(violation(Law::NoPanic, shortened(&panic)));
            return None;
        };
        Some(ended)
    }

    /// Runs a command that only reads.
    fn look(&mut self, words: &[OsString], root: &Path, tree: &Tree) -> Option<Ended> {
        let ended = self.run(words)?;
        self.untouched(root, tree, "a command that reads");
        Some(ended)
    }

    pub(super) fn untouched(&mut self, root: &Path, tree: &Tree, who: &str) {
        let changed = laws::changed(tree, &look(root));
        if let Some(first) = changed.first() {
            self.result
                .violations
                .push(violation(Law::Untouched, format!("{who} changed {first:?}")));
        }
    }
}

/// Runs a case through the program's commands in new folders below `scratch`, an empty folder. Meanwhile the process's
/// current folder is the case's.
pub fn exercise(case: &Case, scratch: &Path, meter: &mut dyn Meter) -> Exercised {
    let scratch = std::fs::canonicalize(scratch).unwrap();
    let mut runner = Runner {
        meter,
        result: Exercised::default(),
    };
    whole(case, &scratch, &mut runner);
    let _ = std::env::set_current_dir(&scratch);
    runner.result
}

fn whole(case: &Case, scratch: &Path, runner: &mut Runner<'_>) {
    let mut chance = Chance(case.seed ^ 0x00c0_ffee);
    let root = scratch.join("case");
    enter(case, &root);
    if case.kind == Kind::Render {
        return pictures::draw(case, &root, runner);
    }
    if case.kind == Kind::Session {
        return sessions::work(case, &root, runner);
    }
    let input = with_root(&case.input, &root);
    let mut before = look(&root);
    if chance.one_in(2) {
        let words = ["info".into(), "--".into(), input.clone().into_os_string()];
        runner.look(&words, &root, &before);
    }
    let old = told(&input, &root, &before, runner);

    let at = |path: &Path| root.join("work").join(with_root(path, &root));
    let (output, report) = (at(&case.output), case.report.as_deref().map(at));
    let places = Places::before(&at(&case.input), &at(&case.edit), &output, report.as_deref());
    let models: BTreeMap<PathBuf, Shape> = if case.kind == Kind::Mesh {
        BTreeMap::new()
    } else {
        shapes::of_folder(case, &root)
    };
    let Some(ended) = runner.run(&apply_words(case, &case.output, &root, None)) else {
        return;
    };
    if ended.status != 0 {
        runner.untouched(&root, &before, "a refusal");
        if chance.one_in(8) {
            again(case, &ended, None, scratch, runner);
        }
        return;
    }
    let after = look(&root);
    laws::of_save(&root, &before, &after, &places, &mut runner.result.violations);
    strangers(&models, &places, runner);
    if let Some(text) = report.and_then(|path| std::fs::read(path).ok()) {
        laws::of_report(&String::from_utf8_lossy(&text), &mut runner.result.violations);
    }
    before = after.clone();
    reads_back(old.as_ref(), &output, &root, &before, runner);
    if chance.one_in(3) {
        let output = with_root(&case.output, &root).into_os_string();
        runner.look(&["diff".into(), "--".into(), input.into(), output], &root, &before);
    }
    let is_morph = case.more.iter().any(|word| word == "--as-morph");
    match chance.below(6) {
        0 => again(case, &ended, Some(&after), scratch, runner),
        1 if !is_morph => same_shape(case, &output, scratch, runner, &mut chance),
        _ => {}
    }
}

/// Makes a case's folder and changes into it.
fn enter(case: &Case, root: &Path) {
    std::fs::create_dir_all(root).unwrap();
    lay(case, root);
    std::env::set_current_dir(root.join("work")).unwrap();
}

fn apply_words(case: &Case, output: &Path, root: &Path, threads: Option<&str>) -> Vec<OsString> {
    let at = |path: &Path| with_root(path, root).into_os_string();
    let joined = |name: &str, path: &Path| {
        let mut word = OsString::from(name);
        word.push(at(path));
        word
    };
    let mut words: Vec<OsString> = vec![
        "apply".into(),
        joined("--edit=", &case.edit),
        joined("--output=", output),
    ];
    if let Some(report) = &case.report {
        words.push(joined("--report=", report));
    }
    let mut more = case.more.iter();
    while let Some(word) = more.next() {
        if threads.is_some() && word == "--threads" {
            more.next();
        } else {
            words.push(word.clone());
        }
    }
    words.extend(
        threads
            .into_iter()
            .map(|count| OsString::from(format!("--threads={count}"))),
    );
    words.extend(["--".into(), at(&case.input)]);
    words
}

/// Runs the same command in another folder with the same content. Its path has the same length, because messages
/// contain byte positions within texts that contain the path.
fn again(case: &Case, first: &Ended, after: Option<&Tree>, scratch: &Path, runner: &mut Runner<'_>) {
    let root = scratch.join("twin");
    enter(case, &root);
    let Some(ended) = runner.run(&apply_words(case, &case.output, &root, Some("5"))) else {
        return;
    };
    let plain = |text: &str, root: &Path| text.replace(&*root.to_string_lossy(), "@ROOT@");
    let (one, two) = (plain(&first.err, &scratch.join("case")), plain(&ended.err, &root));
    if (first.status, &one) != (ended.status, &two) {
        runner
            .result
            .violations
            .push(violation(Law::Again, shortened(&format!("{one:?} and then {two:?}"))));
    } else if let Some(after) = after {
        let tree = look(&root);
        // Reports contain times, and links with an absolute path lead into one of the two folders.
        let report = case.report.as_ref();
        let report = report.and_then(|report| place_of(&root.join("work").join(with_root(report, &root))));
        let differs = laws::changed(after, &tree).into_iter().find(|place| {
            let is_file = |tree: &Tree| {
                matches!(
                    tree.get(place).map(|node| &node.what),
                    Some(super::tree::What::File(..))
                )
            };
            let names_root = matches!(case.entries.get(place), Some(Entry::File(bytes)) if names_root(bytes));
            report.as_ref() != Some(&root.join(place)) && (is_file(after) || is_file(&tree)) && !names_root
        });
        if let Some(place) = differs.filter(|_| {
            !case
                .entries
                .values()
                .any(|entry| matches!(entry, Entry::File(bytes) if names_root(bytes)))
        }) {
            runner
                .result
                .violations
                .push(violation(Law::Again, format!("{place:?} is another")));
        }
    }
}

fn names_root(bytes: &[u8]) -> bool {
    bytes.windows(6).any(|window| window == b"@ROOT@")
}

/// The output of `pliant info` about a file; `None` if the file is refused.
fn told(path: &Path, root: &Path, tree: &Tree, runner: &mut Runner<'_>) -> Option<Value> {
    let words = ["info".into(), "--json".into(), "--".into(), path.as_os_str().to_owned()];
    let ended = runner.look(&words, root, tree).filter(|ended| ended.status == 0)?;
    serde_json::from_str(&ended.out).ok()
}

/// Checks that the result can be read and has all drawn triangles.
fn reads_back(old: Option<&Value>, output: &Path, root: &Path, tree: &Tree, runner: &mut Runner<'_>) {
    let Some(new) = told(output, root, tree, runner) else {
        runner
            .result
            .violations
            .push(violation(Law::ReadsBack, "the result is refused"));
        return;
    };
    let Some(old) = old else {
        runner
            .result
            .violations
            .push(violation(Law::ReadsBack, "what can't be read was bent"));
        return;
    };
    // A glTF can't hold numbers that are not finite, so it leaves out the triangles that have one.
    let is_finite = old["findings"]["non_finite_vertices"]["count"] == 0;
    let mut members = if is_finite { vec!["drawn_triangles"] } else { Vec::new() };
    if old["format"] == new["format"] {
        members.push("drawn_vertices");
    }
    for member in members {
        if old[member] != new[member] {
            let what = format!(
                "{member}: {} in {}, {} in {}",
                old[member], old["format"], new[member], new["format"]
            );
            runner.result.violations.push(violation(Law::ReadsBack, what));
        }
    }
}

/// Checks that models other than the result show the same shape as before.
fn strangers(models: &BTreeMap<PathBuf, Shape>, places: &Places, runner: &mut Runner<'_>) {
    for (path, old) in models {
        let place = place_of(path);
        if place.is_some() && (place == places.output || place == places.report) {
            continue;
        }
        let is_other_name = place.is_some_and(|place| same_file(&place, places.output.as_deref()));
        if !is_other_name && !shape(path).is_some_and(|new| is_same(&new, old)) {
            let name = path.file_name().unwrap_or_default();
            runner
                .result
                .violations
                .push(violation(Law::Strangers, format!("{name:?} lost its shape")));
        }
    }
}

fn same_file(a: &Path, b: Option<&Path>) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let identity = |path: &Path| {
        std::fs::metadata(path)
            .ok()
            .map(|metadata| (metadata.dev(), metadata.ino()))
    };
    b.is_some_and(|b| identity(a).is_some() && identity(a) == identity(b))
}

/// Checks that the same command with a result in another format gives the same shape.
fn same_shape(case: &Case, output: &Path, scratch: &Path, runner: &mut Runner<'_>, chance: &mut Chance) {
    let root = scratch.join("shape");
    enter(case, &root);
    let other = PathBuf::from("../target/shape").with_extension(*chance.of(&["ply", "glb", "off", "stl", "obj"]));
    let Some(ended) = runner.run(&apply_words(case, &other, &root, None)) else {
        return;
    };
    if ended.status != 0 {
        return;
    }
    // A glTF leaves out triangles with numbers that are not finite.
    let finite = |path: &Path| {
        let mut shape = shape(path)?;
        shape.retain(|corners| corners.iter().all(|p| p.is_finite()));
        Some(shape)
    };
    let input = root.join("work").join(with_root(&case.input, &root));
    let second = root.join("work").join(&other);
    let (Some(one), Some(two)) = (finite(output), finite(&second)) else {
        return;
    };
    let size = one.iter().flatten().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    if one.len() != two.len() {
        let what = format!("{} and {} triangles, the latter in {other:?}", one.len(), two.len());
        runner.result.violations.push(violation(Law::SameShape, what));
        return;
    }
    // A reader triangulates a bent polygon by its bent shape, while a triangle format holds the triangles from before
    // the bend.
    let is_cut_anew = shapes::may_hold_polygons(&input) && [output, &second].into_iter().any(shapes::may_hold_polygons);
    let compare = if is_cut_anew {
        shapes::stray_corner
    } else {
        shapes::farthest
    };
    if let Some((a, b)) = compare(&one, &two, 1e-5 * size) {
        let what = format!("{a} in the place of {b}, in {other:?}");
        runner
            .result
            .violations
            .push(violation(Law::SameShape, shortened(&what)));
    }
}
