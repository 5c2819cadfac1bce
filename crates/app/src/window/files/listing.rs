//! The list of a folder's contents: folders first, then the wanted files, in the order of a column.

use std::cmp::Ordering;
use std::ffi::OsStr;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use pliant_engine::files::shown;
use pliant_io::quoted;

/// A folder or a file.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Entry {
    /// Its name, for a person.
    pub name: String,
    /// Its path.
    pub path: PathBuf,
    /// True if it is a folder, or a link to one.
    pub is_folder: bool,
    /// A file's size in bytes.
    pub bytes: u64,
    /// The time of its last change, if the system reports it.
    pub modified: Option<SystemTime>,
}

/// The key of the order.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Column {
    /// Names, in any case, with numbers in them by value.
    Name,
    /// Sizes.
    Size,
    /// Dates.
    Modified,
}

/// The order of the list.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Order {
    /// The column.
    pub column: Column,
    /// True if it is reversed. Folders stay before files.
    pub is_reversed: bool,
}

impl Order {
    /// The order after a click on a column's header: by that column, or reversed if it already was.
    pub fn after_click(self, column: Column) -> Self {
        Self {
            column,
            is_reversed: self.column == column && !self.is_reversed,
        }
    }

    fn compare(self, a: &Entry, b: &Entry) -> Ordering {
        let by_column = match self.column {
            Column::Name => Ordering::Equal,
            Column::Size => a.bytes.cmp(&b.bytes),
            Column::Modified => a.modified.cmp(&b.modified),
        };
        let within = by_column
            .then_with(|| compare_names(&a.name, &b.name))
            .then_with(|| a.path.cmp(&b.path));
        let within = if self.is_reversed { within.reverse() } else { within };
        b.is_folder.cmp(&a.is_folder).then(within)
    }
}

/// Reads a folder. Links are followed; entries that are neither a folder nor a file are left out.
///
/// # Errors
/// A sentence that names the folder and the remedy.
pub fn read(folder: &Path) -> Result<Vec<Entry>, String> {
    let refused = |error: std::io::Error| {
        let reason = match error.kind() {
            ErrorKind::NotFound => "there is no such folder; choose another".to_owned(),
            ErrorKind::NotADirectory => "it is a file; choose its folder".to_owned(),
            ErrorKind::PermissionDenied => "permission is denied; check its rights, or choose another".to_owned(),
            _ => quoted(&format!("{error}; choose another folder")),
        };
        format!("{} can't be read: {reason}", shown(folder))
    };
    let mut entries = Vec::new();
    for entry in fs::read_dir(folder).map_err(refused)? {
        let path = entry.map_err(refused)?.path();
        // A dangling link, or a file that was deleted meanwhile.
        let Ok(metadata) = fs::metadata(&path) else { continue };
        if metadata.is_dir() || metadata.is_file() {
            entries.push(Entry {
                name: quoted(&path.file_name().unwrap_or_default().to_string_lossy()),
                is_folder: metadata.is_dir(),
                bytes: if metadata.is_dir() { 0 } else { metadata.len() },
                modified: metadata.modified().ok(),
                path,
            });
        }
    }
    Ok(entries)
}

/// The entries to show, in order: those whose name contains `filter`, folders and files with one of these extensions
/// (all files if there are none). Hidden ones are left out unless the filter begins with a dot.
pub fn shown_entries<'a>(entries: &'a [Entry], endings: &[&str], filter: &str, order: Order) -> Vec<&'a Entry> {
    let wanted = filter.to_lowercase();
    let is_shown = |entry: &&Entry| {
        let is_hidden = entry.name.starts_with('.') && !wanted.starts_with('.');
        let is_asked_for = entry.is_folder || has_ending(&entry.path, endings);
        !is_hidden && is_asked_for && entry.name.to_lowercase().contains(&wanted)
    };
    let mut shown: Vec<&Entry> = entries.iter().filter(is_shown).collect();
    shown.sort_by(|a, b| order.compare(a, b));
    shown
}

fn has_ending(path: &Path, endings: &[&str]) -> bool {
    let own = path.extension().unwrap_or_default();
    endings.is_empty()
        || endings
            .iter()
            .any(|ending| own.eq_ignore_ascii_case(OsStr::new(ending)))
}

/// Compares names in natural order: "scan 9" is before "scan 10", and "Ab" between "aa" and "ac".
fn compare_names(a: &str, b: &str) -> Ordering {
    let (a, b) = (a.to_lowercase(), b.to_lowercase());
    let (mut a, mut b) = (a.as_str(), b.as_str());
    loop {
        let (run_a, run_b) = (first_run(a), first_run(b));
        if run_a.is_empty() || run_b.is_empty() {
            return run_a.len().cmp(&run_b.len());
        }
        let is_number = |run: &str| run.starts_with(|letter: char| letter.is_ascii_digit());
        let order = if is_number(run_a) && is_number(run_b) {
            let [a, b] = [run_a, run_b].map(|run| run.trim_start_matches('0'));
            a.len().cmp(&b.len()).then_with(|| a.cmp(b))
        } else {
            run_a.cmp(run_b)
        };
        if order.is_ne() {
            return order;
        }
        (a, b) = (&a[run_a.len()..], &b[run_b.len()..]);
    }
}

/// The digits, or the non-digits, with which a text begins.
fn first_run(text: &str) -> &str {
    let is_digit = |letter: char| letter.is_ascii_digit();
    let is_number = text.starts_with(is_digit);
    let end = text.find(|letter| is_digit(letter) != is_number);
    &text[..end.unwrap_or(text.len())]
}
