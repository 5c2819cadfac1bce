//! The test programs of the workspace, by name.

use std::fs;
use std::path::Path;

/// Programs with this prefix drive the real window. They wait most of the time, so they run beside the others.
const REAL_WINDOW: &str = "real_";

/// The names of the workspace's test programs, sorted.
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
    names.sort();
    names.dedup();
    let (of_window, others) = names.into_iter().partition(|name| name.starts_with(REAL_WINDOW));
    Ok(TestPrograms { of_window, others })
}

fn of_crate(folder: &Path) -> Result<Vec<String>, String> {
    let tests = folder.join("tests");
    if !tests.is_dir() || !folder.join("Cargo.toml").is_file() {
        return Ok(Vec::new());
    }
    let is_program = |path: &Path| path.extension().is_some_and(|end| end == "rs") || path.join("main.rs").is_file();
    let programs = entries(&tests)?.into_iter().filter(|path| is_program(path));
    Ok(programs
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .collect())
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
        assert!(
            !found.others.contains(&"desktop".to_owned()),
            "no program, but a module of some"
        );
    }
}
