//! Rendering hostile files: `pliant render` gives one picture of the requested size, or one sentence.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use super::case::Case;
use super::exercise::Runner;
use super::laws::{self, Law, violation};
use super::named::neighbours_of;
use super::tree::{look, place_of, with_root};
use crate::trials::Chance;

/// Width and height in pixels: small, and multiples of nothing special.
const SIZE: [u32; 2] = [97, 61];

/// The place of a picture: usually beside the model, sometimes over a file that the model may need.
pub fn output(chance: &mut Chance) -> PathBuf {
    let free = "picture.png";
    let places = [free, free, free, free, "skin.png", "../target/picture.png", "sub/p.png"];
    (*chance.of(&places)).into()
}

/// Random arguments of `pliant render`.
pub fn more(chance: &mut Chance) -> Vec<OsString> {
    let shadings = [
        "clay",
        "material",
        "material",
        "distortion",
        "area",
        "curvature",
        "normals",
        "regions",
    ];
    let mut words: Vec<OsString> = vec![format!("--shading={}", chance.of(&shadings)).into()];
    for word in ["--edit=edit.json", "--wireframe", "--borders", "--outlines", "--flat"] {
        if chance.one_in(4) {
            words.push(word.into());
        }
    }
    words
}

/// Renders a case whose folder is `root`.
pub(super) fn draw(case: &Case, root: &Path, runner: &mut Runner<'_>) {
    let before = look(root);
    let at = |path: &Path| root.join("work").join(path);
    let mut read: BTreeSet<PathBuf> = neighbours_of(&at(&case.input));
    read.extend(
        [&case.input, &case.edit]
            .into_iter()
            .filter_map(|path| place_of(&at(path))),
    );
    let output = place_of(&at(&case.output));
    let mut words: Vec<OsString> = vec!["render".into(), format!("--size={}x{}", SIZE[0], SIZE[1]).into()];
    words.extend(case.more.iter().cloned());
    let mut word = OsString::from("--output=");
    word.push(&case.output);
    words.extend([word, "--".into(), with_root(&case.input, root).into()]);
    let Some(ended) = runner.run(&words) else { return };
    if ended.status != 0 {
        return runner.untouched(root, &before, "a refusal");
    }
    let found = &mut runner.result.violations;
    let Some(output) = output else {
        return found.push(violation(Law::ReadsBack, "a picture that is nowhere"));
    };
    if read.contains(&output) && before.keys().any(|place| root.join(place) == output) {
        found.push(violation(Law::NothingGivenUp, format!("the picture is {output:?}")));
    }
    let others = laws::changed(&before, &look(root));
    for place in others.iter().filter(|place| root.join(place) != output) {
        found.push(violation(Law::OnlyItsOwn, format!("{place:?} changed")));
    }
    if !fs::read(&output).is_ok_and(|bytes| is_picture(&bytes)) {
        found.push(violation(Law::ReadsBack, "no picture of the size that was asked for"));
    }
}

/// Returns true if a file is a complete PNG of [`SIZE`]: its first chunk has the size, and its last chunk ends it.
fn is_picture(bytes: &[u8]) -> bool {
    let size = SIZE.map(u32::to_be_bytes);
    bytes.starts_with(b"\x89PNG\r\n\x1a\n")
        && bytes.get(16..24) == Some(size.as_flattened())
        && bytes.ends_with(b"IEND\xae\x42\x60\x82")
}
