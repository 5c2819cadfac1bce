//! `cargo xtask run`: builds Pliant and opens the sample.

use std::path::{Path, PathBuf};

use crate::install::{Consent, Prepared, prepare};
use crate::process::{succeed, target_folder};
use crate::profile::Profile;
use crate::requirement::{PICTURES, WINDOW};

/// Builds Pliant and opens its window on `file` or on the sample. Without a display, applies the sample's edit
/// headless.
///
/// # Errors
/// One sentence naming the failure.
pub fn run(file: Option<&Path>, profile: Profile, consent: Consent) -> Result<(), String> {
    let has_display = ["DISPLAY", "WAYLAND_DISPLAY"]
        .iter()
        .any(|name| std::env::var_os(name).is_some_and(|v| !v.is_empty()));
    let has_window = has_display || !cfg!(all(unix, not(target_os = "macos")));
    if has_window {
        if let Prepared::Without(sentence) = prepare(&[PICTURES, WINDOW], "the window and its pictures", consent)? {
            println!("{sentence}");
        }
        build(profile)?;
        let sample = crate::root::root().join("assets/creature.glb");
        let file = file.map_or(Ok(sample), std::path::absolute);
        let file = file.map_err(|e| format!("The file's path can't be completed: {e}."))?;
        return pliant(profile, &[&file.display().to_string()]);
    }
    if let Some(file) = file {
        return Err(format!(
            "There is no display to open {} on; use `pliant apply` or `pliant render` on it.",
            file.display()
        ));
    }
    headless(profile, consent)
}

/// Applies the sample's edit from the command line, and renders a picture before and after if possible.
fn headless(profile: Profile, consent: Consent) -> Result<(), String> {
    println!("There is no display, so the sample's edit is applied without the window.");
    let pictures = match prepare(&[PICTURES], "the pictures", consent) {
        Ok(Prepared::Complete) => true,
        Ok(Prepared::Without(sentence)) | Err(sentence) => {
            println!("{sentence}");
            false
        }
    };
    build(profile)?;
    let (sample, edit) = ("assets/creature.glb", "assets/creature.edit.json");
    let folder = target_folder().join("sample");
    std::fs::create_dir_all(&folder).map_err(|e| format!("{} can't be made: {e}.", folder.display()))?;
    let at = |name: &str| folder.join(name).display().to_string();
    let edited = at("creature-edited.glb");
    pliant(profile, &["apply", sample, "--edit", edit, "--output", &edited])?;
    let mut made: Vec<PathBuf> = vec![edited.into()];
    if pictures {
        for (name, edit) in [("creature-before.png", None), ("creature-after.png", Some(edit))] {
            let picture = at(name);
            let mut arguments = vec!["render", sample, "--output", &picture];
            arguments.extend(edit.iter().flat_map(|edit| ["--edit", edit]));
            pliant(profile, &arguments)?;
            made.push(picture.into());
        }
    }
    println!("\n{sample} was bent by {edit}:");
    for file in made {
        println!("  {}", file.display());
    }
    Ok(())
}

/// Builds Pliant, and says beforehand what that takes.
fn build(profile: Profile) -> Result<(), String> {
    match profile {
        Profile::Quick => println!(
            "Building Pliant. The first time takes about six minutes on two cores and 2 GB of disk. \
             `--release` takes about ten and optimises all of it."
        ),
        Profile::Release => println!("Building Pliant for speed; the first time takes about ten minutes on two cores."),
    }
    profile.build()
}

/// Runs the built program in the workspace's folder.
fn pliant(profile: Profile, arguments: &[&str]) -> Result<(), String> {
    succeed(&mut profile.cargo("run", &[&["--quiet", "--"], arguments].concat()))
}
