//! The crates' sources as tokens: the paths that a file names outside tests.
//!
//! Scanning tokens rather than lines finds a path in a grouped `use`, after a unit test's module or inside a macro call
//! like any other, and ignores comments and strings.

use std::fs;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use proc_macro2::{Delimiter, Spacing, TokenStream, TokenTree};

/// A source file and the paths that it names.
#[derive(Clone, Debug)]
pub struct Source {
    pub file: PathBuf,
    /// Every path that it names outside tests, with grouped `use`s expanded: `["std", "fs"]`. A name on its own is a
    /// path of one segment.
    pub paths: Vec<Vec<String>>,
}

/// The sources of a crate, sorted by path, without those of its tests (`tests.rs`, `.._tests.rs`).
pub fn of_crate(name: &str) -> Vec<Source> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../crates")
        .join(name)
        .join("src");
    let mut files = Vec::new();
    collect(&folder, &mut files);
    files.sort();
    let read = |file: PathBuf| Source {
        paths: paths(&fs::read_to_string(&file).unwrap()),
        file,
    };
    files.into_iter().map(read).collect()
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") && !is_of_tests(&path) {
            files.push(path);
        }
    }
}

fn is_of_tests(path: &Path) -> bool {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    name == "tests" || name.ends_with("_tests")
}

/// The paths that a source text names outside items marked `#[cfg(test)]`.
///
/// # Panics
/// If the text is not Rust.
pub fn paths(text: &str) -> Vec<Vec<String>> {
    let tokens = TokenStream::from_str(text).unwrap_or_else(|error| panic!("no Rust: {error}"));
    let mut paths = Vec::new();
    walk(tokens, &mut paths);
    paths
}

fn walk(tokens: TokenStream, paths: &mut Vec<Vec<String>>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut at = 0;
    while at < tokens.len() {
        if is_test_attribute(&tokens, at) {
            at = end_of_item(&tokens, at);
            continue;
        }
        match &tokens[at] {
            // A lifetime is not a name.
            TokenTree::Punct(punct) if punct.as_char() == '\'' => at += 2,
            TokenTree::Ident(_) => at = path_from(&tokens, at, &[], paths),
            TokenTree::Group(group) => {
                walk(group.stream(), paths);
                at += 1;
            }
            TokenTree::Punct(_) | TokenTree::Literal(_) => at += 1,
        }
    }
}

/// Reads the path that begins at `at`, appends it to `prefix`, and returns the position after it.
fn path_from(tokens: &[TokenTree], mut at: usize, prefix: &[String], paths: &mut Vec<Vec<String>>) -> usize {
    let mut path = prefix.to_vec();
    while let Some(TokenTree::Ident(segment)) = tokens.get(at) {
        path.push(segment.to_string());
        at += 1;
        if !is_path_separator(tokens, at) {
            break;
        }
        at += 2;
    }
    match tokens.get(at) {
        Some(TokenTree::Group(group))
            if at >= 2 && group.delimiter() == Delimiter::Brace && is_path_separator(tokens, at - 2) =>
        {
            let members: Vec<TokenTree> = group.stream().into_iter().collect();
            for member in members.split(|token| matches!(token, TokenTree::Punct(punct) if punct.as_char() == ',')) {
                path_from(member, 0, &path, paths);
            }
            at += 1;
        }
        _ => paths.push(path),
    }
    at
}

fn is_path_separator(tokens: &[TokenTree], at: usize) -> bool {
    let is_colon = |token: Option<&TokenTree>| matches!(token, Some(TokenTree::Punct(p)) if p.as_char() == ':');
    let is_joint = matches!(tokens.get(at), Some(TokenTree::Punct(p)) if p.spacing() == Spacing::Joint);
    is_joint && is_colon(tokens.get(at)) && is_colon(tokens.get(at + 1))
}

/// Returns true if there is a `#[cfg(test)]` at `at`.
fn is_test_attribute(tokens: &[TokenTree], at: usize) -> bool {
    let Some([TokenTree::Punct(hash), TokenTree::Group(attribute)]) = tokens.get(at..at + 2) else {
        return false;
    };
    hash.as_char() == '#' && attribute.stream().to_string().replace(' ', "") == "cfg(test)"
}

/// The position after the item whose attributes begin at `at`: after its first braces or its semicolon.
fn end_of_item(tokens: &[TokenTree], at: usize) -> usize {
    let is_end = |token: &TokenTree| match token {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        TokenTree::Punct(punct) => punct.as_char() == ';',
        TokenTree::Ident(_) | TokenTree::Literal(_) => false,
    };
    tokens[at..]
        .iter()
        .position(is_end)
        .map_or(tokens.len(), |end| at + end + 1)
}

#[cfg(test)]
mod tests {
    use super::paths;

    #[test]
    fn grouped_paths_are_spelled_out_and_tests_left_out() {
        let text = r#"
            use std::{fs, time::{Duration, Instant}};
            // std::net in a comment, "std::env" in a string
            fn one() { let a = "std::env"; vec![std::process::id()]; }
            #[cfg(test)]
            mod tests { use std::thread; }
            static AFTER: &'static str = "";
        "#;
        let found: Vec<String> = paths(text).iter().map(|path| path.join("::")).collect();
        for named in [
            "std::fs",
            "std::time::Duration",
            "std::time::Instant",
            "std::process::id",
            "AFTER",
            "static",
        ] {
            assert_eq!(
                found.iter().filter(|path| *path == named).count(),
                1,
                "{named}: {found:?}"
            );
        }
        for absent in ["std::net", "std::env", "std::thread"] {
            assert!(!found.iter().any(|path| path == absent), "{absent}");
        }
    }
}
