//! Reads a file, moves its vertices by a formula and saves it as another: a way to try formats without a solver.
//!
//! `cargo run --example bend -p pliant-io -- IN OUT [none|shift|turn|twist|half]`

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "an example speaks")]

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use glam::{DQuat, DVec3};
use pliant_io::{Bytes, Format, Placement, Resolver, Save, read};
use pliant_mesh::{Cancel, Progress};

struct Folder(PathBuf);

impl Resolver for Folder {
    fn read(&self, uri: &str) -> Result<Bytes, String> {
        std::fs::read(self.0.join(uri))
            .map(Bytes::from)
            .map_err(|error| error.to_string())
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, output, how @ ..] = &arguments[..] else {
        eprintln!("bend IN OUT [none|shift|turn|twist|half]");
        return ExitCode::from(2);
    };
    match bend(
        Path::new(input),
        Path::new(output),
        how.first().map_or("twist", String::as_str),
    ) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn bend(input: &Path, output: &Path, how: &str) -> Result<(), Box<dyn std::error::Error>> {
    let name = |path: &Path| {
        path.file_name()
            .map(|name| name.to_string_lossy().into_owned())
            .unwrap_or_default()
    };
    let folder = |path: &Path| path.parent().map(Path::to_path_buf).unwrap_or_default();
    let bytes = std::fs::read(input)?;
    let start = Instant::now();
    let resolver = Folder(folder(input));
    let format = Format::of_name(&name(input))?;
    let opened = read(bytes, format, &name(input), &resolver, &Progress::new(), &Cancel::new())?;
    let read_ms = start.elapsed().as_secs_f64() * 1e3;
    let (scene, drawn) = (opened.scene, opened.drawn);
    println!(
        "read {read_ms:.1} ms: {} drawn vertices, {} triangles, {} file vertices, {:?}",
        drawn.positions.len(),
        drawn.triangles.len(),
        drawn.file_vertex_count,
        scene.summary()
    );
    scene.notes().iter().for_each(|note| println!("note: {note}"));
    let start = Instant::now();
    let looks = scene.appearance();
    println!(
        "appearance {:.1} ms, {} groups",
        start.elapsed().as_secs_f64() * 1e3,
        looks.groups.len()
    );

    let finite = || drawn.positions.iter().filter(|p| p.is_finite());
    let low = finite().copied().reduce(DVec3::min).unwrap_or_default();
    let high = finite().copied().reduce(DVec3::max).unwrap_or_default();
    let (centre, size) = ((low + high) / 2.0, (high - low).length().max(1e-30));
    let new: Vec<DVec3> = drawn
        .positions
        .iter()
        .map(|&p| {
            let from_centre = p - centre;
            let turned = |angle: f64| centre + DQuat::from_rotation_y(angle) * from_centre;
            match how {
                "shift" => p + DVec3::new(0.1, 0.2, 0.3) * size,
                "turn" => turned(1.0),
                "twist" => turned(2.0 * from_centre.y / size + 0.2),
                "half" if from_centre.x > 0.0 => p + DVec3::new(0.1 * from_centre.x, 0.2 * from_centre.x, 0.0),
                _ => p,
            }
        })
        .collect();
    let placement = match (input == output, folder(input) == folder(output)) {
        (true, _) => Placement::SameFile,
        (_, true) => Placement::SameFolder,
        _ => Placement::OtherFolder,
    };
    let out_name = name(output);
    let format = Format::of_name(&out_name)?;
    let start = Instant::now();
    let saved = scene.save(
        &Save {
            deltas: pliant_io::MorphDeltas::WhereFarOff,
            turned: &[],
            drawn: &drawn,
            positions: &new,
            format,
            name: &out_name,
            placement,
        },
        &Progress::new(),
        &Cancel::new(),
    )?;
    println!("save {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
    saved.warnings.iter().for_each(|warning| println!("warning: {warning}"));
    for file in &saved.files {
        let path = folder(output).join(&file.name);
        std::fs::create_dir_all(folder(&path))?;
        std::fs::write(&path, &file.bytes)?;
        println!("wrote {} ({} bytes)", file.name, file.bytes.len());
    }
    Ok(())
}
