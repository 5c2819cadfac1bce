//! No file of a crate depends on itself through other files, and no folder through other folders: understanding a file
//! requires only those below it, and understanding a folder only the folders and files beside it that are below it.
//!
//! The paths that a file names (`crate::…`, `super::…`, `self::…`, in `use` lines and elsewhere) are resolved to the
//! file that defines the item, through folders' `mod.rs` and their `pub use` re-exports. Unit tests and comments are
//! left out.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A module: its file, and the names that it uses from elsewhere.
#[derive(Debug, Default)]
struct Module {
    file: PathBuf,
    /// For each name that a `use` imports, its full path.
    imports: BTreeMap<String, Vec<String>>,
    /// Every path in the code outside `use` lines, and those in private `use` lines.
    paths: Vec<Vec<String>>,
    /// Every path outside `use` lines that begins with a name in lower case.
    relative_paths: Vec<Vec<String>>,
    /// Every word outside `use` lines.
    words: BTreeSet<String>,
    /// Those that do more than declare a module.
    used: BTreeSet<String>,
}

/// The modules of a crate by path; the crate's root has the empty path.
type Modules = BTreeMap<Vec<String>, Module>;

/// The files, or folders, that each depends on.
type Arrows = BTreeMap<PathBuf, BTreeSet<PathBuf>>;

#[test]
fn no_file_and_no_folder_needs_itself_through_others() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
    let mut folders: Vec<PathBuf> = std::fs::read_dir(&crates)
        .unwrap()
        .map(|entry| entry.unwrap().path().join("src"))
        .filter(|folder| folder.is_dir())
        .collect();
    folders.sort();
    assert!(folders.len() > 5, "{folders:?}");
    let mut found = Vec::new();
    for folder in folders {
        let modules = modules_of(&folder);
        let arrows = arrows(&modules);
        let count: usize = arrows.values().map(BTreeSet::len).sum();
        assert!(count > 0 || modules.len() < 3, "{} has arrows", folder.display());
        let of_folders = arrows_of_folders(&arrows, &folder);
        for arrows in std::iter::once(&arrows).chain(of_folders.values()) {
            for circle in circles(arrows) {
                found.push(told(&circle, arrows, &crates));
            }
        }
    }
    assert!(found.is_empty(), "circles of files or folders:\n{}", found.join("\n"));
}

/// Tests the scan itself: the circles that it must find in a made-up crate, and those that it must not find.
#[test]
fn the_scan_sees_grouped_paths_and_follows_what_is_handed_on() {
    let mut modules = Modules::new();
    let mut add = |path: &[&str], text: &str| {
        let path: Vec<String> = path.iter().map(|segment| (*segment).to_owned()).collect();
        let file = PathBuf::from(format!("{}.rs", path.join("/")));
        modules.insert(path.clone(), module(file, &path, text));
    };
    add(&[], "mod a; mod b; pub use a::{A, inner::Deep}; pub use b::B;");
    add(
        &["a"],
        "mod inner; use crate::{B as Other, b::C}; /* use crate::z::Z; */ pub struct A;",
    );
    add(
        &["a", "inner"],
        "use super::A; // use crate::b::B;\npub struct Deep(A);",
    );
    add(
        &["b"],
        "pub struct C; fn f() -> crate::Deep { \"crate::a::A\" }\n#[cfg(test)]\nmod tests { use crate::A; }",
    );
    add(
        &["d"],
        "use crate::b; pub(in crate::a) fn g() { b::h(); inner::deeper(); std::mem::swap() }",
    );
    add(&["d", "inner"], "pub fn deeper() {}");
    let arrows = arrows(&modules);
    let to = |from: &str| -> Vec<&str> {
        let to = arrows.get(Path::new(from)).into_iter().flatten();
        to.map(|path| path.to_str().unwrap()).collect()
    };
    assert_eq!(to("a.rs"), ["b.rs"]);
    assert_eq!(to("a/inner.rs"), ["a.rs"]);
    assert_eq!(
        to("b.rs"),
        ["a/inner.rs"],
        "through the root, and not what its test names"
    );
    assert_eq!(to(".rs"), Vec::<&str>::new(), "handing on is not needing");
    assert_eq!(
        to("d.rs"),
        ["b.rs", "d/inner.rs"],
        "by paths that begin with an imported or a child module"
    );
    let names: Vec<Vec<PathBuf>> = circles(&arrows);
    assert_eq!(names.len(), 1);
    assert_eq!(names[0], ["a/inner.rs", "a.rs", "b.rs"].map(PathBuf::from));
    let of_folders = arrows_of_folders(&arrows, Path::new(""));
    let of_d: Vec<_> = of_folders[Path::new("")][Path::new("d.rs")].iter().collect();
    assert_eq!(of_d, [Path::new("b.rs"), Path::new("d")]);
    assert!(of_folders[Path::new("")][Path::new("a")].contains(Path::new("a.rs")));
}

/// The dependencies between the files and folders of each folder under `root`: one depends on another if a file in it
/// depends on a file in the other.
fn arrows_of_folders(arrows: &Arrows, root: &Path) -> BTreeMap<PathBuf, Arrows> {
    let mut of_folders: BTreeMap<PathBuf, Arrows> = BTreeMap::new();
    for (from, to) in arrows
        .iter()
        .flat_map(|(from, all)| all.iter().map(move |to| (from, to)))
    {
        let shared = from.ancestors().find(|folder| to.starts_with(folder)).unwrap_or(root);
        let child = |file: &Path| shared.join(file.strip_prefix(shared).unwrap().iter().next().unwrap());
        let of_folder = of_folders.entry(shared.to_owned()).or_default();
        of_folder.entry(child(from)).or_default().insert(child(to));
    }
    of_folders
}

/// The modules under a `src` folder.
fn modules_of(source: &Path) -> Modules {
    let mut modules = Modules::new();
    let mut folders = vec![source.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                let within = path.strip_prefix(source).unwrap().with_extension("");
                let mut name: Vec<String> = within.iter().map(|part| part.to_str().unwrap().to_owned()).collect();
                // A binary beside a library is a crate of its own, which uses the library from outside.
                let is_binary = name == ["main"] && source.join("lib.rs").exists();
                let is_test = name
                    .last()
                    .is_some_and(|name| name == "tests" || name.ends_with("_tests"));
                if is_binary || is_test {
                    continue;
                }
                if matches!(name.last().map(String::as_str), Some("mod" | "lib" | "main")) {
                    name.pop();
                }
                modules.insert(name.clone(), module(path, &name, &text));
            }
        }
    }
    modules
}

/// Reads one file.
fn module(file: PathBuf, own: &[String], text: &str) -> Module {
    let code = without_comments_and_texts(text);
    let code: &str = &without_visibility(without_tests(&code));
    let mut module = Module {
        file,
        ..Module::default()
    };
    let mut rest = String::new();
    let mut statements = code;
    while let Some(start) = next_use(statements) {
        rest.push_str(&statements[..start]);
        let end = statements[start..]
            .find(';')
            .map_or(statements.len(), |end| start + end);
        let is_handed_on = rest.trim_end().ends_with("pub") || rest.trim_end().ends_with(')');
        for (path, name) in expanded(&statements[start + 4..end]) {
            let path = absolute(&path, own);
            if !is_handed_on {
                module.paths.push(path.clone());
            }
            module.imports.insert(name, path);
        }
        statements = &statements[(end + 1).min(statements.len())..];
    }
    rest.push_str(statements);
    for path in paths_in(&rest) {
        match path[0].as_str() {
            "crate" | "super" | "self" => module.paths.push(absolute(&path, own)),
            _ => module.relative_paths.push(path),
        }
    }
    let words: Vec<&str> = rest
        .split(|letter: char| !letter.is_alphanumeric() && letter != '_')
        .filter(|word| !word.is_empty())
        .collect();
    let used = words
        .iter()
        .enumerate()
        .filter(|(place, _)| *place == 0 || words[place - 1] != "mod");
    module.used = used.map(|(_, word)| (*word).to_owned()).collect();
    module.words = words.into_iter().map(str::to_owned).collect();
    module
}

/// The code before its unit tests.
fn without_tests(code: &str) -> &str {
    let opens_tests = |start: &usize| {
        let (condition, mut rest) = code[*start..].split_once(']').unwrap_or_default();
        while let Some(attribute) = rest.trim_start().strip_prefix("#[") {
            rest = attribute.split_once(']').unwrap_or_default().1;
        }
        let rest = rest.trim_start();
        let name = rest.strip_prefix("pub(crate) ").unwrap_or(rest);
        let name = name.strip_prefix("mod ").unwrap_or(";");
        let name = name.trim_start_matches(|letter: char| letter.is_alphanumeric() || letter == '_');
        ["#[cfg(test", "#[cfg(all(test"]
            .iter()
            .any(|test| condition.starts_with(test))
            && name.starts_with(" {")
    };
    let mut starts = code.match_indices("#[cfg(").map(|(start, _)| start);
    starts.find(opens_tests).map_or(code, |start| &code[..start])
}

/// The code with `pub(crate)` for each `pub(in …)`, whose path names no dependency.
fn without_visibility(code: &str) -> String {
    let mut parts = code.split("pub(in ");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |code, part| {
        code + "pub(crate)" + part.split_once(')').map_or("", |(_, behind)| behind)
    })
}

/// The start of the next `use` statement.
fn next_use(code: &str) -> Option<usize> {
    code.match_indices("use ").map(|(start, _)| start).find(|&start| {
        let before = code[..start].chars().next_back();
        before.is_none_or(|letter| letter.is_whitespace() || ";{})".contains(letter))
    })
}

/// The paths of a `use` tree, each with its imported name.
fn expanded(tree: &str) -> Vec<(Vec<String>, String)> {
    let tree = tree.trim();
    if let Some(open) = tree.find('{') {
        let prefix = tree[..open].trim().trim_end_matches("::");
        let inner = &tree[open + 1..tree.rfind('}').unwrap_or(tree.len())];
        let mut parts = Vec::new();
        let (mut depth, mut start) = (0, 0);
        for (place, letter) in inner.char_indices() {
            match letter {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    parts.push(&inner[start..place]);
                    start = place + 1;
                }
                _ => {}
            }
        }
        parts.push(&inner[start..]);
        let whole = parts.iter().filter(|part| !part.trim().is_empty());
        return whole
            .flat_map(|part| expanded(&format!("{prefix}::{}", part.trim())))
            .collect();
    }
    let (path, name) = match tree.split_once(" as ") {
        Some((path, name)) => (path, Some(name.trim().to_owned())),
        None => (tree, None),
    };
    let mut path: Vec<String> = path.split("::").map(|segment| segment.trim().to_owned()).collect();
    path.retain(|segment| !segment.is_empty());
    if path.len() > 1 && path.last().is_some_and(|last| last == "self") {
        path.pop();
    }
    let name = name.unwrap_or_else(|| path.last().cloned().unwrap_or_default());
    vec![(path, name)]
}

/// Every path of several segments in the code that begins with a name in lower case.
fn paths_in(code: &str) -> Vec<Vec<String>> {
    let is_of_path = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == ':';
    let mut paths = Vec::new();
    let mut rest = code;
    while let Some(start) = rest.find(is_of_path) {
        let before = rest[..start].chars().next_back();
        let end = rest[start..].find(|letter| !is_of_path(letter));
        let end = end.map_or(rest.len(), |end| start + end);
        let path: Vec<String> = rest[start..end].split("::").map(str::to_owned).collect();
        let begins_low = path[0].starts_with(|letter: char| letter.is_lowercase() || letter == '_');
        if before != Some('$') && path.len() > 1 && begins_low {
            paths.push(path.into_iter().filter(|segment| !segment.is_empty()).collect());
        }
        rest = &rest[end..];
    }
    paths
}

/// The path from the crate's root. A path into another crate keeps its first segment, which no module has.
fn absolute(path: &[String], own: &[String]) -> Vec<String> {
    let mut absolute = own.to_vec();
    for (place, segment) in path.iter().enumerate() {
        match segment.as_str() {
            "crate" => absolute.clear(),
            "self" => {}
            "super" => {
                absolute.pop();
            }
            _ => {
                absolute.extend_from_slice(&path[place..]);
                break;
            }
        }
    }
    absolute
}

/// The file that defines a path's item, if it is one of the crate's files.
fn definer<'a>(modules: &'a Modules, path: &[String], depth: usize) -> Option<&'a Path> {
    if depth == 0 {
        return None;
    }
    let mut at: Vec<String> = Vec::new();
    for (place, segment) in path.iter().enumerate() {
        let below: Vec<String> = at.iter().chain([segment]).cloned().collect();
        if modules.contains_key(&below) {
            at = below;
            continue;
        }
        let module = &modules[&at];
        if let Some(behind) = module.imports.get(segment).filter(|behind| **behind != path[..=place]) {
            let whole: Vec<String> = behind.iter().chain(&path[place + 1..]).cloned().collect();
            return definer(modules, &whole, depth - 1);
        }
        // A word that the module never contains comes from another crate or from a macro.
        let is_own = segment == "*" || module.words.contains(segment);
        return is_own.then_some(module.file.as_path());
    }
    modules.get(&at).map(|module| module.file.as_path())
}

/// The dependencies of each file.
fn arrows(modules: &Modules) -> Arrows {
    let mut arrows = Arrows::new();
    for (own, module) in modules {
        let used = module
            .imports
            .iter()
            .filter(|(name, _)| module.used.contains(*name))
            .map(|(_, path)| path.clone());
        // A path may begin with an imported name, or with a module below.
        let relative = module.relative_paths.iter().filter_map(|path| {
            let below = || own.iter().cloned().chain([path[0].clone()]).collect::<Vec<_>>();
            let imported = module.imports.get(&path[0]).cloned();
            let first = imported.or_else(|| Some(below()).filter(|below| modules.contains_key(below)))?;
            Some(first.into_iter().chain(path[1..].iter().cloned()).collect())
        });
        for path in module.paths.iter().cloned().chain(used).chain(relative) {
            // Naming a child module does not make a dependency on it.
            let is_child = modules.contains_key(&path) && path.starts_with(own);
            match definer(modules, &path, 8) {
                Some(file) if file != module.file && !is_child => {
                    arrows.entry(module.file.clone()).or_default().insert(file.to_owned());
                }
                _ => {}
            }
        }
    }
    arrows
}

/// The groups of files that reach each other, each in sorted order.
fn circles(arrows: &Arrows) -> Vec<Vec<PathBuf>> {
    let reached = |start: &PathBuf| {
        let (mut seen, mut stack) = (BTreeSet::new(), vec![start.clone()]);
        while let Some(file) = stack.pop() {
            for next in arrows.get(&file).into_iter().flatten() {
                if seen.insert(next.clone()) {
                    stack.push(next.clone());
                }
            }
        }
        seen
    };
    let all: BTreeMap<&PathBuf, BTreeSet<PathBuf>> = arrows.keys().map(|file| (file, reached(file))).collect();
    let mut circles = BTreeSet::new();
    for (file, reaches) in all.iter().filter(|(file, reaches)| reaches.contains(**file)) {
        let both = reaches
            .iter()
            .filter(|other| all.get(other).is_some_and(|back| back.contains(*file)));
        circles.insert(both.cloned().collect::<Vec<_>>());
    }
    circles.into_iter().collect()
}

/// A circle in words: each of its files with the others of the circle that it depends on.
fn told(circle: &[PathBuf], arrows: &Arrows, crates: &Path) -> String {
    let short = |file: &PathBuf| file.strip_prefix(crates).unwrap_or(file).display().to_string();
    let lines = circle.iter().map(|file| {
        let to: Vec<String> = arrows[file]
            .iter()
            .filter(|to| circle.contains(to))
            .map(short)
            .collect();
        format!("  {} names {}", short(file), to.join(", "))
    });
    format!("{} files:\n{}", circle.len(), lines.collect::<Vec<_>>().join("\n"))
}

/// The code with every comment and every string literal blanked.
fn without_comments_and_texts(text: &str) -> String {
    let mut code = String::with_capacity(text.len());
    let letters: Vec<char> = text.chars().collect();
    let mut at = 0;
    while at < letters.len() {
        let next = letters.get(at + 1).copied();
        match letters[at] {
            '/' if next == Some('/') => {
                while at < letters.len() && letters[at] != '\n' {
                    at += 1;
                }
            }
            '/' if next == Some('*') => {
                at += 2;
                while at + 1 < letters.len() && !(letters[at] == '*' && letters[at + 1] == '/') {
                    at += 1;
                }
                at += 2;
            }
            '"' => {
                at += 1;
                while at < letters.len() && letters[at] != '"' {
                    at += if letters[at] == '\\' { 2 } else { 1 };
                }
                at += 1;
            }
            // A quote in a character literal would otherwise open a string.
            '\'' if next == Some('"') => at += 3,
            '\'' if next == Some('\\') => at += 4,
            letter => {
                code.push(letter);
                at += 1;
            }
        }
    }
    code
}
