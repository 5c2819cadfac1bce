//! From the process' start to the first picture, as a person sees it: read from a virtual display.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::meshes::creature_glb;
use super::scale::Scale;
use super::table::{Row, folder};
use crate::display::{Display, Screen};
use crate::process::target_folder;
use crate::profile::Profile;
use crate::system;

/// The number of starts of each file; the median counts.
const STARTS: usize = 5;

/// The time without a change on the screen after which a picture counts as the last; a large file is read in less.
const STILL: Duration = Duration::from_secs(10);

/// The longest wait for it.
const PATIENCE: Duration = Duration::from_secs(60);

/// The shape is visible once a picture is nearer to the last one than this share of the farthest one's distance: it may
/// still be drawn coarsely.
const NEAR: f64 = 0.25;

/// One row per file.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    Profile::Release.build()?;
    let mut files = vec![(30_000, crate::root::root().join("assets/creature.glb"))];
    files.push((1_000_000, creature_glb(1_000_000)?));
    if scale == Scale::Full {
        files.push((5_000_000, creature_glb(5_000_000)?));
    }
    let framebuffer = folder().join("screen");
    let display = Display::with_framebuffer(&framebuffer)?;
    let screen = Screen::open(&framebuffer)?;
    let mut rows = Vec::new();
    for (triangles, file) in files {
        let mut starts = Vec::new();
        for _ in 0..STARTS {
            starts.push(start(&file, &display, &screen)?);
        }
        let median = |of: fn(&Start) -> Duration| {
            let mut times: Vec<Duration> = starts.iter().map(of).collect();
            times.sort();
            times[times.len() / 2].as_secs_f64() * 1e3
        };
        let row = Row::default()
            .number("triangles", f64::from(triangles))
            .number("window_ms", median(|start| start.window))
            .number("picture_ms", median(|start| start.picture));
        rows.push(row);
    }
    Ok(rows)
}

/// The time of the first appearance, since the start of the process.
struct Start {
    /// Any picture in the screen's middle.
    window: Duration,
    /// The shape.
    picture: Duration,
}

fn start(file: &Path, display: &Display, screen: &Screen) -> Result<Start, String> {
    let home = folder().join("home");
    let program: PathBuf = target_folder().join("release/pliant");
    let mut command = Command::new(&program);
    command
        .arg(file)
        .env("DISPLAY", display.name())
        .env_remove("WAYLAND_DISPLAY")
        // Without settings and files to restore.
        .env("HOME", &home)
        .env("XDG_CONFIG_HOME", home.join("config"))
        .env("XDG_STATE_HOME", home.join("state"))
        .env("XDG_DATA_HOME", home.join("data"))
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    if let Some(driver) = system::software_vulkan_driver() {
        command.env("VK_DRIVER_FILES", &driver).env("VK_ICD_FILENAMES", &driver);
    }
    let _ = std::fs::remove_dir_all(&home);
    let mut pictures = vec![(Duration::ZERO, screen.middle()?)];
    let begun = Instant::now();
    let mut child = command
        .spawn()
        .map_err(|e| format!("{} can't be started: {e}.", program.display()))?;
    let watched = watch(screen, begun, &mut pictures);
    // The window's state does not matter: nothing is saved.
    let _ = child.kill();
    let _ = child.wait();
    watched?;
    let (_, last) = &pictures[pictures.len() - 1];
    let distances: Vec<f64> = pictures.iter().map(|(_, picture)| distance(picture, last)).collect();
    let farthest = distances.iter().copied().fold(0.0, f64::max);
    let after = pictures.iter().zip(&distances).skip(1);
    let mut shown = after.filter(|(_, distance)| **distance < NEAR * farthest);
    match (pictures.get(1), shown.next()) {
        (Some((window, _)), Some(((picture, _), _))) => Ok(Start {
            window: *window,
            picture: *picture,
        }),
        _ => Err(format!("{} was not shown.", file.display())),
    }
}

/// Keeps each picture that differs from the last one, until nothing changes.
fn watch(screen: &Screen, begun: Instant, pictures: &mut Vec<(Duration, Vec<u8>)>) -> Result<(), String> {
    let mut changed = begun;
    loop {
        let picture = screen.middle()?;
        let now = begun.elapsed();
        if pictures.last().is_some_and(|(_, last)| *last != picture) {
            pictures.push((now, picture));
            changed = Instant::now();
        } else if (pictures.len() > 1 && changed.elapsed() > STILL) || now > PATIENCE {
            return Ok(());
        }
        std::thread::sleep(Duration::from_millis(4));
    }
}

/// The mean difference of two pictures' bytes.
fn distance(a: &[u8], b: &[u8]) -> f64 {
    let sum: u64 = a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / a.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_as_far_apart_as_their_bytes() {
        assert_eq!(distance(&[1, 2, 3, 4], &[1, 2, 3, 4]), 0.0);
        assert_eq!(distance(&[0, 9, 3, 4], &[2, 7, 3, 4]), 1.0);
    }
}
