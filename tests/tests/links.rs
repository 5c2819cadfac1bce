//! Links between the pages of the documentation have existing targets, and the manual has all of its pages.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::path::{Component, Path, PathBuf};

use pliant_tests::run;

/// The pages' texts by their paths from the root. The manual's generated pages have the manual's paths.
fn pages() -> BTreeMap<PathBuf, String> {
    let root = root();
    let mut pages = BTreeMap::new();
    for folder in [
        "",
        "bench",
        "crates",
        "crates/deform",
        "crates/python",
        "shaders",
        "docs",
    ] {
        for entry in fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|extension| extension == "md") {
                let name = path.strip_prefix(&root).unwrap().to_owned();
                pages.insert(name, fs::read_to_string(path).unwrap());
            }
        }
    }
    let generated = tempfile::tempdir().unwrap();
    run([OsStr::new("generate"), generated.path().as_os_str()]).done();
    for name in ["commands.md", "command-line.md"] {
        let text = fs::read_to_string(generated.path().join(name)).unwrap();
        pages.insert(Path::new("docs").join(name), text);
    }
    pages
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// The lines outside code.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut is_code = false;
    text.lines().filter(move |line| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence
    })
}

/// The targets of the links and pictures of a page.
fn links(text: &str) -> Vec<&str> {
    let after_words = prose(text).flat_map(|line| line.split("](").skip(1));
    after_words.filter_map(|rest| Some(rest.split_once(')')?.0)).collect()
}

/// The anchors of a page's headings.
fn anchors(text: &str) -> Vec<String> {
    let headings = prose(text).filter_map(|line| Some(line.strip_prefix('#')?.trim_start_matches('#').trim()));
    let anchor = |heading: &str| {
        let letters = heading.to_lowercase().replace(' ', "-");
        let kept = letters
            .chars()
            .filter(|letter| letter.is_alphanumeric() || "-_".contains(*letter));
        kept.collect()
    };
    headings.map(anchor).collect()
}

/// A path without `..` in it.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::ParentDir => assert!(plain.pop(), "{} leaves the repository", path.display()),
            other => plain.push(other),
        }
    }
    plain
}

/// A sentence for each broken link of these pages.
fn broken(pages: &BTreeMap<PathBuf, String>) -> Vec<String> {
    let mut broken = Vec::new();
    for (page, text) in pages {
        for link in links(text).into_iter().filter(|link| !link.contains("://")) {
            let (path, anchor) = link
                .split_once('#')
                .map_or((link, None), |(path, anchor)| (path, Some(anchor)));
            let target = match path {
                "" => page.clone(),
                path => plain(&page.with_file_name(path)),
            };
            let is_there = match (pages.get(&target), anchor) {
                (Some(text), Some(anchor)) => anchors(text).iter().any(|own| own == anchor),
                (Some(_), None) => true,
                (None, _) => root().join(&target).exists(),
            };
            if !is_there {
                broken.push(format!("{}: {link}", page.display()));
            }
        }
    }
    broken
}

#[test]
fn every_link_leads_to_a_page_and_to_a_heading_on_it() {
    let pages = pages();
    let counted: usize = pages.values().map(|text| links(text).len()).sum();
    assert!(counted > 40, "only {counted} links were found");
    assert_eq!(broken(&pages), Vec::<String>::new());
}

#[test]
fn a_link_that_leads_nowhere_is_found() {
    let page = "# One page\n[a](#one-page) [b](#other) ![c](none.png) [d](b.md#it)\n```\n[e](in-code.md)\n```\n";
    let pages = BTreeMap::from([
        ("docs/a.md".into(), page.to_owned()),
        ("docs/b.md".into(), "## `It`".to_owned()),
    ]);
    assert_eq!(broken(&pages), ["docs/a.md: #other", "docs/a.md: none.png"]);
}

#[test]
fn the_manual_lists_each_of_its_pages_once() {
    let pages = pages();
    let summary = Path::new("docs/SUMMARY.md");
    let mut listed: Vec<PathBuf> = links(&pages[summary])
        .iter()
        .map(|link| summary.with_file_name(link))
        .collect();
    listed.sort();
    let of_manual = pages.keys().filter(|page| page.starts_with("docs") && *page != summary);
    assert_eq!(listed, of_manual.cloned().collect::<Vec<_>>());
}
