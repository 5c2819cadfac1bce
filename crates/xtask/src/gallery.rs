//! `cargo xtask gallery`: draws the samples' edits by every method into the docs, with their figures, and two adjacent
//! legs, one of which is moved, by the methods that bend space.

use std::fs;
use std::process::Command;

use crate::assets::SAMPLES;
use crate::process::{cargo, said, target_folder};
use crate::profile::Profile;

/// The methods of the gallery. Besides each method with its defaults, options that change its abilities.
const METHODS: &str = "bilaplacian,poisson,laplacian,frames,frames:iterations=300,arap,arap:energy=smooth,primo,\
                       shells,rbf,mls,embedded,space-primo,lattice,cage";

/// The coordinates of cages for the legs' pictures, and the other methods for their figures.
const CAGES: [&str; 3] = [
    "cage:coordinates=mean-value",
    "cage:coordinates=green",
    "cage:coordinates=harmonic",
];
const OF_SPACE: [&str; 5] = ["rbf", "mls", "lattice", "embedded", "space-primo"];

/// The sample drawn with wrinkles and without, instead of by all methods.
const FACE: &str = "face";

/// Discrete shells from paper to rubber.
const PAPER_TO_RUBBER: &str = "shells:bending=1e-6,shells:bending=1e-4,shells:bending=1e-3";

/// The samples whose figures are tall, and the size of their sheets in pixels; the size of the others'.
const TALL: [&str; 2] = ["bar", "creature"];
const TALL_SIZE: &str = "1200x900";
const SIZE: &str = "1200x720";

/// Draws `docs/gallery/NAME.png` for each sample and for the legs, and puts the tables of figures into
/// `docs/methods.md`, each between its marks.
///
/// # Errors
/// One sentence naming the failed build, picture or file.
pub fn gallery() -> Result<(), String> {
    Profile::Release.build()?;
    let root = crate::root::root();
    let page = root.join("docs/methods.md");
    let mut text = fs::read_to_string(&page).map_err(|e| format!("{} can't be read: {e}.", page.display()))?;
    let folder = root.join("docs/gallery");
    fs::create_dir_all(&folder).map_err(|e| format!("{} can't be made: {e}.", folder.display()))?;
    let mut put = |name: &str, table: &str| {
        text = with_table(&text, name, table).ok_or_else(|| {
            format!(
                "{} has no place for the table of {name}: {}",
                page.display(),
                mark(name)
            )
        })?;
        println!("{name}\n{table}");
        Ok::<_, String>(())
    };
    for name in SAMPLES.iter().map(|sample| sample.name).filter(|name| *name != FACE) {
        let size = if TALL.contains(&name) { TALL_SIZE } else { SIZE };
        put(name, &sheet(name, name, name, METHODS, &["--size", size])?)?;
    }
    let look = ["--size", "960x560", "--view", "front"];
    put(FACE, &sheet(FACE, FACE, FACE, "bilaplacian,wrinkles", &look)?)?;
    let look = ["--size", "960x420", "--view", "front"];
    sheet("cylinder-stiffness", "cylinder", "cylinder", PAPER_TO_RUBBER, &look)?;
    let look = ["--size", "480x420", "--view", "front", "--shading", "stiffness"];
    sheet("cylinder-painted", "cylinder", "cylinder-painted", "shells", &look)?;
    let look = ["--size", "960x320", "--view", "bottom", "--shading", "distortion"];
    sheet("legs-cage", "creature", "legs-cage", &CAGES.join(","), &look)?;
    let mut legs = cargo(&["run", "--release", "-p", "pliant-tests", "--example", "legs", "--"]);
    put("legs", &said(legs.args(CAGES).args(OF_SPACE))?)?;
    fs::write(&page, text).map_err(|e| format!("{} can't be written: {e}.", page.display()))
}

/// Draws an edit of a sample by these methods into `docs/gallery/PICTURE.png`; returns the table of its figures.
fn sheet(picture: &str, sample: &str, edit: &str, methods: &str, look: &[&str]) -> Result<String, String> {
    let root = crate::root::root();
    let mut command = Command::new(target_folder().join("release/pliant"));
    command.current_dir(&root);
    command.args(["compare", &format!("assets/{sample}.glb"), "--methods", methods]);
    command.args(look);
    command.args(["--edit", &format!("assets/{edit}.edit.json"), "--output"]);
    let table = said(command.arg(root.join(format!("docs/gallery/{picture}.png"))))?;
    Ok(without_times(&table))
}

/// The table without its columns of times, which depend on the machine and its load. Lines of another length than the
/// header are sentences and stay.
fn without_times(table: &str) -> String {
    let header = table.lines().next().unwrap_or_default();
    let Some(times_end) = header.find(LAST_TIME).map(|start| start + LAST_TIME.len()) else {
        return table.to_owned();
    };
    let is_row = |line: &&str| line.len() == header.len();
    let first = |line: &str| line.split(' ').next().unwrap_or_default().to_owned();
    let names = table.lines().filter(is_row).map(|line| first(line).len()).max();
    let width = names.unwrap_or_default();
    let row = |line: &str| match line.get(times_end..) {
        Some(rest) if is_row(&line) => format!("{:<width$}{rest}\n", first(line)),
        _ => format!("{line}\n"),
    };
    table.lines().map(row).collect()
}

/// The heading of the last column of times.
const LAST_TIME: &str = "frame ms";

/// The line before a sample's table.
fn mark(name: &str) -> String {
    format!("<!-- figures of {name} -->\n")
}

/// `text` with this table after the sample's mark, instead of the present block.
fn with_table(text: &str, name: &str, table: &str) -> Option<String> {
    let (before, rest) = text.split_once(&mark(name))?;
    let after = match rest.strip_prefix("```text\n") {
        Some(old) => old.split_once("```\n")?.1,
        None => rest,
    };
    Some(format!("{before}{}```text\n{table}```\n{after}", mark(name)))
}

#[cfg(test)]
mod tests {
    use super::{with_table, without_times};

    #[test]
    fn the_times_leave_a_table_and_nothing_else_does() {
        let table = "\
method           bind ms  frame ms  stretch
cage               72.41      0.16    1.169
arap:iterations   5372.4  13813.65    1.062
primo: this edit has no handle
";
        let kept = "\
method           stretch
cage               1.169
arap:iterations    1.062
primo: this edit has no handle
";
        assert_eq!(without_times(table), kept);
        assert_eq!(without_times("rbf  3.5%\n"), "rbf  3.5%\n");
    }

    #[test]
    fn a_table_takes_the_place_of_the_one_before() {
        let page = "# Bar\n<!-- figures of bar -->\n\nBehind.\n";
        let once = with_table(page, "bar", "a\n").unwrap_or_default();
        assert_eq!(once, "# Bar\n<!-- figures of bar -->\n```text\na\n```\n\nBehind.\n");
        assert_eq!(
            with_table(&once, "bar", "b\n"),
            Some("# Bar\n<!-- figures of bar -->\n```text\nb\n```\n\nBehind.\n".to_owned())
        );
        assert_eq!(with_table(&once, "cactus", "b\n"), None);
    }
}
