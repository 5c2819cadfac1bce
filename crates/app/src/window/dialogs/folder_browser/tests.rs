//! Laws of the browser's state; nothing here is drawn or read from a disk unless a test says so.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use super::browser::{Asked, Contents, FolderBrowser};
use super::row::size;
use super::typed_path::{begun_anew, candidates, completed};
use crate::window::files::listing::{Column, Entry, Order, read, shown_entries};

const NAMES: [&str; 9] = [
    "scan 10.ply",
    "Scan 9.ply",
    "scan 9.obj",
    ".hidden.ply",
    "notes.txt",
    "scans/",
    "Bones/",
    "scan",
    "zebra.PLY",
];

/// Entries of a folder; names that end in a slash are folders.
fn entries(folder: &str, names: &[&str]) -> Vec<Entry> {
    let entry = |(number, name): (u64, &&str)| {
        let plain = name.trim_end_matches('/');
        Entry {
            name: plain.to_owned(),
            path: Path::new(folder).join(plain),
            is_folder: plain != *name,
            bytes: 7919 * number % 31,
            modified: Some(SystemTime::UNIX_EPOCH + Duration::from_secs(104_729 * number % 97)),
        }
    };
    (0..).zip(names).map(entry).collect()
}

fn names(shown: &[&Entry]) -> Vec<String> {
    shown.iter().map(|entry| entry.name.clone()).collect()
}

const BY_NAME: Order = Order {
    column: Column::Name,
    is_reversed: false,
};

#[test]
fn folders_are_before_files_in_every_order_and_a_second_click_turns_each_group_round() {
    let entries = entries("/a", &NAMES);
    for column in [Column::Name, Column::Size, Column::Modified] {
        let order = Order {
            column,
            is_reversed: false,
        };
        let shown = shown_entries(&entries, &[], "", order);
        let reversed = shown_entries(&entries, &[], "", order.after_click(column));
        assert_eq!(order.after_click(column).after_click(column), order);
        let folders = shown.iter().filter(|entry| entry.is_folder).count();
        assert!(folders == 2 && shown[..folders].iter().all(|entry| entry.is_folder));
        let turned: Vec<&Entry> = reversed[..folders]
            .iter()
            .rev()
            .chain(reversed[folders..].iter().rev())
            .copied()
            .collect();
        assert_eq!(shown, turned, "{column:?}");
        for pair in shown[folders..].windows(2) {
            let is_in_order = match column {
                Column::Name => true,
                Column::Size => pair[0].bytes <= pair[1].bytes,
                Column::Modified => pair[0].modified <= pair[1].modified,
            };
            assert!(is_in_order, "{column:?}: {pair:?}");
        }
    }
}

#[test]
fn names_are_sorted_whatever_their_case_and_by_the_numbers_in_them() {
    let entries = entries("/a", &NAMES);
    let shown = names(&shown_entries(&entries, &[], "scan", BY_NAME));
    assert_eq!(shown, ["scans", "scan", "scan 9.obj", "Scan 9.ply", "scan 10.ply"]);
}

#[test]
fn only_what_was_asked_for_and_matches_is_listed() {
    let entries = entries("/a", &NAMES);
    let models = names(&shown_entries(&entries, &["ply"], "", BY_NAME));
    assert_eq!(models, ["Bones", "scans", "Scan 9.ply", "scan 10.ply", "zebra.PLY"]);
    assert_eq!(names(&shown_entries(&entries, &["ply"], "BRA", BY_NAME)), ["zebra.PLY"]);
    assert_eq!(
        names(&shown_entries(&entries, &["ply"], ".h", BY_NAME)),
        [".hidden.ply"]
    );
}

#[test]
fn completing_loses_no_candidate_and_adds_nothing_twice() {
    let entries = entries("/a", &NAMES);
    let all: Vec<&Entry> = entries.iter().collect();
    for typed in ["s", "S", "sc", "scan", "scan ", "scan 9", "scans", "b", "z", "q", ""] {
        let Some(once) = completed(typed, &all) else { continue };
        assert!(
            once.to_lowercase().starts_with(&typed.to_lowercase()),
            "{typed} became {once}"
        );
        let plain = once.trim_end_matches('/');
        assert_eq!(
            names(&candidates(typed, &all)),
            names(&candidates(plain, &all)),
            "{typed}"
        );
        assert_eq!(completed(&once, &all), None, "{typed}");
    }
    assert_eq!(completed("b", &all).as_deref(), Some("Bones/"));
    assert_eq!(completed("q", &all), None);
}

fn browser(asked: Asked, suggested: &str) -> FolderBrowser {
    FolderBrowser::new(
        asked,
        &["ply", "glb"],
        Path::new(suggested),
        Vec::new(),
        Some("/home/me".into()),
    )
}

/// Hands in the contents of the folder that is wanted now.
fn answer(browser: &mut FolderBrowser, names: &[&str]) {
    let folder = browser.take_wanted().unwrap();
    let contents = entries(&folder.to_string_lossy(), names);
    browser.set_contents(&folder, Ok(contents));
}

#[test]
fn the_way_back_is_the_way_there_and_forward_takes_it_again() {
    let mut browser = browser(Asked::ToOpen, "/a");
    for folder in ["/b", "/c", "/d"] {
        browser.go(folder.into());
    }
    let mut seen = Vec::new();
    while browser.has_ways()[0] {
        browser.go_back();
        seen.push(browser.folder().to_owned());
    }
    assert_eq!(seen, ["/c", "/b", "/a"].map(PathBuf::from));
    while browser.has_ways()[1] {
        browser.go_forward();
    }
    assert_eq!(browser.folder(), Path::new("/d"));
    browser.go_back();
    browser.go("/e".into());
    assert_eq!(browser.has_ways(), [true, false], "another way ends the old one");
}

#[test]
fn a_path_typed_letter_by_letter_leads_where_it_leads_at_once_and_one_step_back_undoes_it() {
    let mut browser = browser(Asked::ToOpen, "/a");
    let path = "/x/y z/../w/fi";
    for end in 1..=path.len() {
        browser.set_path(&path[..end]);
    }
    assert_eq!(browser.folder(), Path::new("/x/w"));
    browser.go_back();
    assert_eq!(browser.folder(), Path::new("/a"));
    browser.set_path("~/scans/");
    assert_eq!(browser.folder(), Path::new("/home/me/scans"));
}

#[test]
fn enter_before_a_folder_was_read_waits_and_what_another_folder_holds_is_not_shown() {
    let mut browser = browser(Asked::ToOpen, "/a");
    let first = browser.take_wanted().unwrap();
    browser.set_path("/b/scan 9.ply");
    browser.enter();
    assert_eq!(browser.take_found(), None);
    browser.set_contents(&first, Ok(entries("/a", &NAMES)));
    assert_eq!(*browser.contents(), Contents::Awaited);
    answer(&mut browser, &["scan 9.ply", "scan 9.ply.glb"]);
    assert_eq!(browser.take_found(), Some("/b/scan 9.ply".into()));
    assert_eq!(browser.take_found(), None, "once");
}

#[test]
fn enter_goes_into_folders_opens_what_is_typed_or_chosen_and_says_what_is_missing() {
    let mut browser = browser(Asked::ToOpen, "/a");
    answer(&mut browser, &NAMES);
    browser.enter();
    assert_eq!(
        (browser.take_found(), browser.folder()),
        (None, Path::new("/a")),
        "nothing is chosen yet"
    );
    browser.set_path("/a/bo");
    browser.enter();
    assert_eq!(browser.folder(), Path::new("/a/Bones"));
    answer(&mut browser, &["leg.ply", "arm.ply", "old/"]);
    browser.choose_next(1);
    browser.choose_next(1);
    browser.enter();
    assert_eq!(
        browser.take_found(),
        Some("/a/Bones/arm.ply".into()),
        "folders come first"
    );
    browser.set_path("/a/Bones/none.ply");
    browser.enter();
    assert_eq!(browser.take_found(), None);
    assert!(browser.problem().unwrap().contains("none.ply"));
    // An entry that is hidden or of another kind opens by its full name.
    browser.set_path("/a/notes.txt");
    answer(&mut browser, &NAMES);
    browser.enter();
    assert_eq!(browser.take_found(), Some("/a/notes.txt".into()));
}

#[test]
fn a_name_to_save_under_gets_its_extension_may_be_a_path_and_may_be_taken_from_the_list() {
    let mut browser = browser(Asked::ToSave, "/a/leg.glb");
    answer(&mut browser, &NAMES);
    assert_eq!((browser.folder(), browser.name()), (Path::new("/a"), "leg.glb"));
    browser.enter();
    assert_eq!(browser.take_found(), Some("/a/leg.glb".into()));
    browser.set_name("foot".to_owned());
    browser.enter();
    assert_eq!(browser.take_found(), Some("/a/foot.glb".into()));
    browser.set_name("foot.ply".to_owned());
    browser.enter();
    assert_eq!(browser.take_found(), Some("/a/foot.ply".into()));
    let place =
        |browser: &FolderBrowser, name: &str| browser.shown().iter().position(|entry| entry.name == name).unwrap();
    browser.choose(place(&browser, "zebra.PLY"));
    assert_eq!(browser.name(), "zebra.PLY");
    browser.set_name("scans".to_owned());
    browser.enter();
    assert_eq!(
        (browser.take_found(), browser.folder()),
        (None, Path::new("/a/scans")),
        "that is a folder"
    );
    browser.set_name("../Bones/toe.ply".to_owned());
    browser.enter();
    answer(&mut browser, &[]);
    assert_eq!(browser.take_found(), Some("/a/Bones/toe.ply".into()));
    // After going up, no folder is selected that saving would enter again.
    browser.go_up();
    answer(&mut browser, &NAMES);
    browser.enter();
    assert_eq!(browser.take_found(), Some("/a/toe.ply".into()));
}

#[test]
fn a_folder_is_read_with_its_links_and_one_that_can_not_be_read_is_named_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.ply"), [0; 1500]).unwrap();
    std::fs::create_dir(folder.path().join("b")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("nowhere", folder.path().join("broken")).unwrap();
    let entries = read(folder.path()).unwrap();
    let shown = shown_entries(&entries, &[], "", BY_NAME);
    assert_eq!(names(&shown), ["b", "a.ply"]);
    assert!(shown[1].bytes == 1500 && shown[1].modified.is_some());
    let refusals = ["gone", "a.ply"].map(|name| read(&folder.path().join(name)).unwrap_err());
    assert!(
        refusals[0].contains("gone") && refusals[0].contains("no such folder"),
        "{}",
        refusals[0]
    );
    assert!(
        refusals[1].contains("a.ply") && refusals[1].contains("it is a file"),
        "{}",
        refusals[1]
    );
}

#[test]
fn sizes_have_three_digits_at_most() {
    let sizes = [0, 999, 1000, 9_949, 9_951, 999_499, 999_500, 12_345_678, u64::MAX].map(size);
    assert_eq!(
        sizes,
        [
            "0 B", "999 B", "1.0 kB", "9.9 kB", "10 kB", "999 kB", "1.0 MB", "12 MB", "18 EB"
        ]
    );
}

#[test]
fn a_chosen_format_replaces_the_ending_of_another_one_and_nothing_else() {
    let endings = &["glb", "obj", "ply"];
    let saving = |name: &str| FolderBrowser::new(Asked::ToSave, endings, &Path::new("/a").join(name), Vec::new(), None);
    for (name, chosen, wanted) in [
        ("cat.glb", "obj", "cat.obj"),
        ("cat.GLB", "ply", "cat.ply"),
        ("cat.v2.obj", "glb", "cat.v2.glb"),
        ("cat.v2", "ply", "cat.v2.ply"),
        ("cat", "ply", "cat.ply"),
    ] {
        let mut browser = saving(name);
        browser.set_format(chosen);
        assert_eq!((browser.name(), browser.format()), (wanted, Some(chosen)), "{name}");
    }
    let mut browser = saving("cat.glb");
    assert_eq!(browser.format(), Some("glb"));
    browser.set_name("dog".to_owned());
    assert_eq!(
        browser.format(),
        Some("glb"),
        "a name without an ending gets the first one's"
    );
    browser.set_name("dog.txt".to_owned());
    assert_eq!(browser.format(), None);
    browser.set_name(String::new());
    browser.set_format("obj");
    browser.set_name("dog".to_owned());
    assert_eq!(browser.format(), Some("obj"));
}

#[test]
fn a_typed_extension_of_a_format_replaces_the_one_that_typing_leaves() {
    let endings = &["glb", "obj", "ply"];
    for (name, typed, wanted) in [
        ("cat.obj", "dog.obj", "dog.obj"),
        ("cat.obj", "dog.g.obj", "dog.g.obj"),
        ("cat.obj", "dog.glb.obj", "dog.glb"),
        ("cat.obj", "dog.v2.PLY.obj", "dog.v2.PLY"),
        ("cat.obj", "dog.v2.obj", "dog.v2.obj"),
        ("cat.obj", "dog.obj.obj", "dog.obj"),
        ("cat.obj", "dog.ply", "dog.ply"),
        // It was there before.
        ("cat.glb.obj", "dog.glb.obj", "dog.glb.obj"),
        ("cat", "dog.glb.obj", "dog.glb.obj"),
    ] {
        let mut browser = FolderBrowser::new(Asked::ToSave, endings, &Path::new("/a").join(name), Vec::new(), None);
        browser.type_name(typed.to_owned());
        assert_eq!(browser.name(), wanted, "{name}, {typed}");
    }
}

#[cfg(unix)]
#[test]
fn a_whole_path_typed_behind_the_shown_folder_begins_anew() {
    for (typed, wanted) in [
        ("/a/b/c.ply", "/a/b/c.ply"),
        ("/a/b//", "/"),
        ("/a/b//d/c.ply", "/d/c.ply"),
        ("/a//b//d", "/d"),
        ("/a/b/~/c.ply", "~/c.ply"),
        ("/a/b/~c.ply", "/a/b/~c.ply"),
        ("~/c", "~/c"),
        ("", ""),
    ] {
        assert_eq!(begun_anew(typed), wanted, "{typed}");
    }
}
