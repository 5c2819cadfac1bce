//! The test programs of the workspace, by name.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Programs with this prefix drive the real window. They wait most of the time, so they run beside the others.
const REAL_WINDOW: &str = "real_";

/// The names of the workspace's test programs. Those with the most source come first, because they run the longest:
/// none of them is left to run alone when the others have ended.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct TestPrograms {
    /// Those that drive the real window.
    pub of_window: Vec<String>,
    /// All others.
    pub others: Vec<String>,
}

/// Finds the test programs where cargo finds them: `tests/NAME.rs` and `tests/NAME/main.rs` of every crate.
///
/// # Errors
/// One sentence if a folder can't be read.
pub fn test_programs(root: &Path) -> Result<TestPrograms, String> {
    let mut names = of_crate(&root.join("tests"))?;
    for folder in entries(&root.join("crates"))? {
        names.extend(of_crate(&folder)?);
    }
    // Several crates may have a program of one name; cargo runs them all by it.
    let mut sizes = BTreeMap::<String, u64>::new();
    for (name, size) in names {
        *sizes.entry(name).or_default() += size;
    }
    let mut names = sizes.into_iter().collect::<Vec<_>>();
    names.sort_by_key(|&(_, size)| std::cmp::Reverse(size));
    let names = names.into_iter().map(|(name, _)| name);
    let (of_window, others) = names.partition(|name| name.starts_with(REAL_WINDOW));
    Ok(TestPrograms { of_window, others })
}

/// The programs of a crate, each with the bytes of its source.
fn of_crate(folder: &Path) -> Result<Vec<(String, u64)>, String> {
    let tests = folder.join("tests");
    if !tests.is_dir() || !folder.join("Cargo.toml").is_file() {
        return Ok(Vec::new());
    }
    let is_program = |path: &Path| path.extension().is_some_and(|end| end == "rs") || path.join("main.rs").is_file();
    let programs = entries(&tests)?.into_iter().filter(|path| is_program(path));
    programs
        .filter_map(|path| Some((path.file_stem()?.to_str()?.to_owned(), path)))
        .map(|(name, path)| Ok((name, bytes(&path)?)))
        .collect()
}

/// The bytes of a file, or of all files in a folder.
fn bytes(path: &Path) -> Result<u64, String> {
    if path.is_dir() {
        return entries(path)?.iter().map(|path| bytes(path)).sum();
    }
    fs::metadata(path)
        .map(|metadata| metadata.len())
        .map_err(|e| format!("{} can't be read: {e}.", path.display()))
}

fn entries(folder: &Path) -> Result<Vec<std::path::PathBuf>, String> {
    let cannot = |e: std::io::Error| format!("{} can't be read: {e}.", folder.display());
    let all = fs::read_dir(folder).map_err(cannot)?;
    all.map(|entry| entry.map(|entry| entry.path()).map_err(cannot))
        .collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn every_program_is_found_once_and_in_one_list() {
        let found = test_programs(&crate::root::root()).unwrap();
        for name in ["real_session", "real_window"] {
            assert!(found.of_window.contains(&name.to_owned()), "{name}");
        }
        for name in ["deform", "window", "circles"] {
            assert!(found.others.contains(&name.to_owned()), "{name}");
        }
        assert!(found.others.iter().all(|name| !found.of_window.contains(name)));
        let place = |name: &str| found.others.iter().position(|other| other == name).unwrap();
        assert!(
            place("window") < place("atomic"),
            "the longest first: {:?}",
            found.others
        );
        assert!(
            !found.others.contains(&"desktop".to_owned()),
            "no program, but a module of some"
        );
    }
}
