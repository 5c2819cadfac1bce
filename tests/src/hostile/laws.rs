//! The laws after every command, for any content of the folder.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::named::neighbours_of;
use super::tree::{Node, Tree, What, place_of};
use crate::Ended;

/// A law that was broken.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Law {
    /// No command panics.
    NoPanic,
    /// No command ends the process by running out of memory or stack, or by a signal.
    NoDeath,
    /// A command ends within its time limit.
    InTime,
    /// A command uses at most 2 GB.
    InMemory,
    /// The status is 0, 1 or 2.
    Status,
    /// A refusal is one line of at most 1000 characters, without control characters; success prints nothing there.
    OneLine,
    /// Standard output has no control characters except line ends.
    PlainOutput,
    /// A refusal, and a command that only reads, leave every file unchanged.
    Untouched,
    /// A save changes the result, its own neighbours and the report, and nothing else.
    OnlyItsOwn,
    /// The report replaces no file that was read and no result, and the result replaces no other input.
    NothingGivenUp,
    /// Every other model in the folder shows the same shape as before.
    Strangers,
    /// A link at the result's place stays a link.
    LinkStays,
    /// A replaced file keeps its permissions.
    Rights,
    /// No temporary file is left.
    NothingLeft,
    /// The result can be read, and has as many vertices and triangles as the drawn shape.
    ReadsBack,
    /// The report is JSON with all its members.
    Report,
    /// The same command on the same folder gives the same result on any number of threads.
    Again,
    /// A result in another format has the same shape.
    SameShape,
    /// A shape that the file does not have counts as unsaved.
    Unsaved,
    /// A file that another program wrote, and a save replaces, is kept beside it, unless the person agreed to lose it.
    TheirsIsKept,
}

/// A law, and the violation.
#[derive(Clone, PartialEq, Debug)]
pub struct Violation {
    pub law: Law,
    pub what: String,
}

/// The longest refusal, in characters.
const LONGEST_LINE: usize = 1000;

pub fn violation(law: Law, what: impl Into<String>) -> Violation {
    Violation { law, what: what.into() }
}

/// Checks the output of a command.
pub fn of_words(ended: &Ended, found: &mut Vec<Violation>) {
    if ended.status > 2 {
        found.push(violation(Law::Status, format!("status {}", ended.status)));
    }
    let is_hidden = |c: char| c.is_control();
    let line = ended.err.strip_suffix('\n').unwrap_or(&ended.err);
    let as_it_should = match ended.status {
        0 => ended
            .err
            .lines()
            .all(|line| line.starts_with("pliant: warning: ") && !line.contains(is_hidden)),
        _ => {
            let length = line.chars().count();
            line.starts_with("pliant: ") && length <= LONGEST_LINE && !line.contains(is_hidden)
        }
    };
    if !as_it_should {
        found.push(violation(
            Law::OneLine,
            shortened(&format!("{} characters: {line:?}", line.chars().count())),
        ));
    }
    if let Some(at) = ended.out.lines().position(|line| line.contains(is_hidden)) {
        let line = ended.out.lines().nth(at).unwrap_or_default();
        found.push(violation(Law::PlainOutput, shortened(&format!("{line:?}"))));
    }
}

/// A text shortened to 300 characters.
pub fn shortened(text: &str) -> String {
    text.chars().take(300).collect()
}

/// The differences of two trees.
pub fn changed(before: &Tree, after: &Tree) -> Vec<PathBuf> {
    let all: BTreeSet<&PathBuf> = before.keys().chain(after.keys()).collect();
    let content = |node: &Node| (node.what.clone(), node.mode);
    all.into_iter()
        .filter(|place| before.get(*place).map(content) != after.get(*place).map(content))
        .cloned()
        .collect()
}

/// The paths that a save refers to, each with its links resolved.
#[derive(Clone, Default, Debug)]
pub struct Places {
    pub output: Option<PathBuf>,
    pub report: Option<PathBuf>,
    /// The input, the edit, and the files that the input names.
    pub inputs: BTreeSet<PathBuf>,
    /// The files named by the earlier file at the result's path, even through a link.
    pub old_neighbours: BTreeSet<PathBuf>,
}

impl Places {
    /// Collects the paths before the save. All of them begin with the case's folder.
    pub fn before(input: &Path, edit: &Path, output: &Path, report: Option<&Path>) -> Self {
        let mut inputs = neighbours_of(input);
        inputs.extend([input, edit].into_iter().filter_map(place_of));
        Self {
            output: place_of(output),
            report: report.and_then(place_of),
            inputs,
            old_neighbours: place_of(output).map(|place| neighbours_of(&place)).unwrap_or_default(),
        }
    }
}

/// Checks the changes of a successful save. `root` is the case's folder, without links in its path.
pub fn of_save(root: &Path, before: &Tree, after: &Tree, places: &Places, found: &mut Vec<Violation>) {
    let within = |path: &PathBuf| path.strip_prefix(root).ok().map(Path::to_owned);
    let output = places.output.as_ref().and_then(within);
    let report = places.report.as_ref().and_then(within);
    let identity = |tree: &Tree, place: &Option<PathBuf>| tree.get(place.as_ref()?).map(|node| node.identity);
    let input_files: BTreeSet<(u64, u64)> = places
        .inputs
        .iter()
        .filter_map(|path| identity(before, &within(path)))
        .collect();
    // Overwriting a file that was read loses it, except when the result replaces its own input.
    if identity(before, &report).is_some_and(|id| input_files.contains(&id)) {
        found.push(violation(
            Law::NothingGivenUp,
            format!("the report is {report:?}, which was read"),
        ));
    }
    if report.is_some() && report == output {
        found.push(violation(Law::NothingGivenUp, "the report is the result"));
    }
    let new_neighbours: BTreeSet<PathBuf> = match &places.output {
        Some(output) => neighbours_of(output).iter().filter_map(within).collect(),
        None => BTreeSet::new(),
    };
    let old_neighbours: BTreeSet<PathBuf> = places.old_neighbours.iter().filter_map(within).collect();
    if report.as_ref().is_some_and(|report| new_neighbours.contains(report)) {
        found.push(violation(
            Law::NothingGivenUp,
            format!("the report is the result's neighbour {report:?}"),
        ));
    }
    let own = |place: &PathBuf| {
        let is_kept = !before.contains_key(place) || old_neighbours.contains(place);
        Some(place) == output.as_ref() || Some(place) == report.as_ref() || (new_neighbours.contains(place) && is_kept)
    };
    let own_files: BTreeSet<(u64, u64)> = before
        .iter()
        .filter(|(place, _)| own(place))
        .map(|(_, node)| node.identity)
        .collect();
    for place in changed(before, after) {
        let name = place.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let (was, is) = (before.get(&place), after.get(&place));
        let is_other_name = was.is_some_and(|node| own_files.contains(&node.identity)) && is.is_some();
        if is_other_name && !own(&place) {
            // This is another name of one of the save's own files.
        } else if name.starts_with(".pliant") {
            found.push(violation(Law::NothingLeft, format!("{}", place.display())));
        } else if own(&place) {
            let (Some(was), Some(is)) = (was, is) else { continue };
            if was.mode & 0o777 != is.mode & 0o777 && matches!(was.what, What::File(..)) {
                found.push(violation(
                    Law::Rights,
                    format!("{place:?} had {:o} and has {:o}", was.mode, is.mode),
                ));
            }
            if matches!(was.what, What::Other) {
                found.push(violation(
                    Law::OnlyItsOwn,
                    format!("{place:?} was no plain file, and was replaced"),
                ));
            }
        } else if matches!(was.map(|node| &node.what), Some(What::Link(_))) {
            found.push(violation(Law::LinkStays, format!("{place:?} was a link")));
        } else if is.is_some_and(|node| node.what == What::Folder) && was.is_none() {
            let holds_own = after.keys().any(|inside| inside.starts_with(&place) && own(inside));
            if !holds_own {
                found.push(violation(Law::NothingLeft, format!("the folder {place:?}")));
            }
        } else {
            found.push(violation(Law::OnlyItsOwn, described(&place, was, is)));
        }
    }
}

fn described(place: &Path, was: Option<&Node>, is: Option<&Node>) -> String {
    let what = match (was, is) {
        (None, _) => "appeared",
        (_, None) => "is gone",
        _ => "was changed",
    };
    format!("{place:?} {what}")
}

/// Checks the report's members. Its numbers are finite, because JSON has no others.
pub fn of_report(text: &str, found: &mut Vec<Violation>) {
    let report: Value = match serde_json::from_str(text) {
        Ok(report) => report,
        Err(error) => {
            found.push(violation(Law::Report, shortened(&format!("{error}: {text}"))));
            return;
        }
    };
    let numbers = [
        "vertices",
        "welded_vertices",
        "free_vertices",
        "load_ms",
        "bind_ms",
        "save_ms",
        "iterations",
    ];
    let is_whole = numbers.iter().all(|name| report[name].is_number())
        && report["energy"]["final"].is_number()
        && report["distortion"]["edge_stretch_max"].is_number()
        && report["warnings"].is_array();
    if !is_whole {
        found.push(violation(Law::Report, "a member is missing"));
    }
    let energy = report["energy"]["final"].as_f64().unwrap_or(f64::MAX);
    if report["converged"] == true && energy >= f64::MAX {
        found.push(violation(Law::Report, "an infinite energy is told as converged"));
    }
}
