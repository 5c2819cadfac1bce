//! A typed path: the folder that it leads to so far, and the text after that.

use std::path::{Component, MAIN_SEPARATOR, Path, PathBuf, is_separator};

use crate::window::files::listing::Entry;

/// The folder's part of a typed path, up to the last separator, and the rest. A text without a separator has no
/// folder's part.
pub fn split(typed: &str) -> (&str, &str) {
    let end = typed.rfind(is_separator).map_or(0, |place| place + 1);
    typed.split_at(end)
}

/// The text from the place on where it begins anew: a whole path or the home folder that is typed behind a folder, as in
/// `/a//b/c` and `/a/~/c`.
pub fn begun_anew(typed: &str) -> &str {
    let begins = |rest: &&str| {
        let of_home = rest
            .strip_prefix('~')
            .is_some_and(|rest| rest.starts_with(is_separator));
        of_home || Path::new(rest).is_absolute()
    };
    let mut behind = typed
        .match_indices(is_separator)
        .map(|(place, found)| &typed[place + found.len()..]);
    behind.rfind(begins).unwrap_or(typed)
}

/// The path that the folder's part of a text means: `~` is the home folder, and a part that does not begin at a root
/// begins at `folder`. `..` is the folder above.
pub fn folder_of(head: &str, folder: &Path, home: Option<&Path>) -> PathBuf {
    let of_home = head.strip_prefix('~').filter(|rest| rest.starts_with(is_separator));
    let path = match (of_home, home) {
        (Some(rest), Some(home)) => home.join(rest.trim_start_matches(is_separator)),
        _ => folder.join(head),
    };
    let mut plain = PathBuf::new();
    for step in path.components() {
        match step {
            Component::CurDir => {}
            Component::ParentDir => _ = plain.pop(),
            step => plain.push(step),
        }
    }
    plain
}

/// A folder as text that can be typed on.
pub fn text_of(folder: &Path) -> String {
    let mut text = folder.to_string_lossy().into_owned();
    if !text.ends_with(is_separator) {
        text.push(MAIN_SEPARATOR);
    }
    text
}

/// Tab's completion of `rest`: the common beginning of all entries that begin so; a single folder gets its separator.
/// `None` if that adds nothing.
pub fn completed(rest: &str, entries: &[&Entry]) -> Option<String> {
    let candidates = candidates(rest, entries);
    let [first, others @ ..] = candidates.as_slice() else {
        return None;
    };
    let mut common = first.name.clone();
    for other in others {
        let is_same = |(a, b): &(char, char)| a.to_lowercase().eq(b.to_lowercase());
        let letters = common.chars().zip(other.name.chars()).take_while(is_same).count();
        common = common.chars().take(letters).collect();
    }
    if others.is_empty() && first.is_folder {
        common.push(MAIN_SEPARATOR);
    }
    (common != rest && !rest.is_empty() && common.chars().count() >= rest.chars().count()).then_some(common)
}

/// The entries whose names begin with the typed text, in any case.
pub fn candidates<'a>(rest: &str, entries: &[&'a Entry]) -> Vec<&'a Entry> {
    let wanted = rest.to_lowercase();
    let begins = |entry: &&&Entry| entry.name.to_lowercase().starts_with(&wanted);
    entries.iter().filter(begins).copied().collect()
}
