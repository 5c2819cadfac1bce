//! Saves that are killed at a random moment, and pairs of saves at once: afterwards the folder has the complete old
//! state or the complete new one, and the next save leaves only files that belong there.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use pliant_engine::watch::Watch;
use pliant_mesh::{WeldOptions, shapes};

/// Ways to save, each a source and an output in the trial's folder.
const SAVES: [(&str, &str); 10] = [
    ("in/scan.glb", "in/scan.glb"),
    ("in/scan.gltf", "in/scan.gltf"),
    ("in/scan.gltf", "in/other.gltf"),
    ("in/scan.gltf", "out/scan.gltf"),
    ("in/scan.glb", "out/scan.gltf"),
    ("in/scan.obj", "in/scan.obj"),
    ("in/scan.obj", "out/scan.obj"),
    ("in/scan.ply", "out/scan.ply"),
    ("in/scan.stl", "in/scan.stl"),
    ("in/scan.off", "out/scan.off"),
];

/// The way in which a save is ended.
const ENDS: [&str; 5] = ["KILL", "TERM", "HUP", "XFSZ", "limit"];

/// Figures of many trials.
#[derive(Default, Debug)]
pub struct Tally {
    /// Trials that ended with the old state.
    pub old: usize,
    /// Trials that ended with the new one.
    pub new: usize,
    /// Trials that left a file, which the next save removed.
    pub left_over: usize,
}

/// The program and the trials' initial files.
pub struct Rig {
    program: PathBuf,
    /// Sources, edits and bystanders.
    pristine: tempfile::TempDir,
    random: u64,
}

type Result<T> = std::result::Result<T, String>;

fn words<T, E: std::fmt::Display>(result: std::result::Result<T, E>, what: &str) -> Result<T> {
    result.map_err(|error| format!("{what}: {error}"))
}

impl Rig {
    /// Makes the files of all kinds.
    ///
    /// # Errors
    /// The failure, in words.
    pub fn new(program: &Path, seed: u64) -> Result<Self> {
        let pristine = words(tempfile::tempdir(), "a folder")?;
        let rig = Self {
            program: program.to_owned(),
            pristine,
            random: seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1,
        };
        let at = |name: &str| rig.pristine.path().join(name);
        for folder in ["in", "out"] {
            words(fs::create_dir(at(folder)), folder)?;
        }
        let ball = shapes::icosphere(4);
        let mut off = format!("OFF\n{} {} 0\n", ball.positions.len(), ball.triangles.len());
        for p in &ball.positions {
            off += &format!("{:?} {:?} {:?}\n", p.x, p.y, p.z);
        }
        for [a, b, c] in &ball.triangles {
            off += &format!("3 {} {} {}\n", a.0, b.0, c.0);
        }
        let write = |name: &str, bytes: &[u8]| words(fs::write(at(name), bytes), name);
        write("in/scan.off", off.as_bytes())?;
        write("rest.json", edit(None).as_bytes())?;
        write("edit-1.json", edit(Some(0.5)).as_bytes())?;
        write("edit-2.json", edit(Some(-0.5)).as_bytes())?;
        for kind in ["glb", "gltf", "obj", "ply", "stl"] {
            let out = format!("in/scan.{kind}");
            rig.apply(rig.pristine.path(), "in/scan.off", "rest.json", &out)?;
        }
        // A library and a texture, which a save copies to another folder.
        let obj = words(fs::read(at("in/scan.obj")), "scan.obj")?;
        write(
            "in/scan.obj",
            &[b"mtllib scan.mtl\nusemtl skin\n".as_slice(), &obj].concat(),
        )?;
        write("in/scan.mtl", b"newmtl skin\nKd 1 1 1\nmap_Kd skin.png\n")?;
        write("in/skin.png", b"\x89PNG of a kind")?;
        // Files of others, which no save may touch.
        for folder in ["in", "out"] {
            write(
                &format!("{folder}/stranger.gltf"),
                b"{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":3,\"uri\":\"stranger.bin\"}]}",
            )?;
            write(&format!("{folder}/stranger.bin"), b"abc")?;
        }
        Ok(rig)
    }

    fn below(&mut self, most: u64) -> u64 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        self.random % most.max(1)
    }

    fn start(&self, folder: &Path, file: &str, edit: &str, out: &str, limit: Option<u64>) -> Result<Child> {
        let arguments = ["apply", file, "--edit", edit, "--output", out, "--threads", "1"];
        let mut command = match limit {
            None => Command::new(&self.program),
            Some(blocks) => {
                let mut shell = Command::new("sh");
                shell
                    .arg("-c")
                    .arg(format!("ulimit -f {blocks}; exec \"$0\" \"$@\""))
                    .arg(&self.program);
                shell
            }
        };
        let command = command.current_dir(folder).args(arguments);
        words(
            command.stdout(Stdio::null()).stderr(Stdio::null()).spawn(),
            "the program",
        )
    }

    /// One complete save.
    fn apply(&self, folder: &Path, file: &str, edit: &str, out: &str) -> Result<()> {
        let status = words(self.start(folder, file, edit, out, None)?.wait(), "the program")?;
        if status.success() {
            Ok(())
        } else {
            Err(format!("{file} to {out} by {edit}: {status}"))
        }
    }

    /// A fresh copy of the start, with an earlier output of `edit-1` if requested.
    fn fresh(&self, file: &str, earlier: Option<&str>) -> Result<tempfile::TempDir> {
        let folder = words(tempfile::tempdir(), "a folder")?;
        copy(self.pristine.path(), folder.path())?;
        if let Some(out) = earlier {
            self.apply(folder.path(), file, "edit-1.json", out)?;
        }
        Ok(folder)
    }

    /// Kills `count` saves.
    ///
    /// # Errors
    /// The first trial that ended with anything but the old state or the new one.
    pub fn kills(&mut self, count: usize, tally: &mut Tally) -> Result<()> {
        for trial in 0..count {
            let (file, out) = SAVES[trial % SAVES.len()];
            let in_place = file == out;
            let earlier = (!in_place && self.below(2) == 0).then_some(out);
            let end = ENDS[self.below(ENDS.len() as u64) as usize];
            let here = format!("trial {trial}, {file} to {out}, {end}");
            // The result of an undisturbed save, and its time.
            let whole = self.fresh(file, earlier)?;
            let old = shape(&whole.path().join(out));
            let start = Instant::now();
            self.apply(whole.path(), file, "edit-2.json", out)?;
            let takes = start.elapsed();
            let new = shape(&whole.path().join(out));
            let wanted = contents(whole.path())?;

            let folder = self.fresh(file, earlier)?;
            let limit = (end == "limit").then(|| 1 + self.below(800));
            let mut child = self.start(folder.path(), file, "edit-2.json", out, limit)?;
            if limit.is_none() {
                // Files are written in the later half.
                let micros = takes.as_micros() as u64;
                let wait = if self.below(3) == 0 {
                    self.below(micros)
                } else {
                    micros / 2 + self.below(micros * 2 / 3)
                };
                std::thread::sleep(Duration::from_micros(wait));
                let id = child.id().to_string();
                // A save that has ended can't be killed.
                let _ = Command::new("kill")
                    .args([&format!("-{end}"), &id])
                    .stderr(Stdio::null())
                    .status();
            }
            words(child.wait(), "the program")?;
            let found = shape(&folder.path().join(out));
            if found == new {
                tally.new += 1;
            } else if found == old {
                tally.old += 1;
            } else {
                return Err(format!("{here}: neither the old shape nor the new one"));
            }
            tally.left_over += usize::from(names(folder.path())?.iter().any(|name| name.contains(".pliant")));
            if in_place && found == new {
                // The next save bends the bent file.
                self.apply(folder.path(), file, "edit-2.json", out)?;
                let left = names(folder.path())?;
                let wanted: Vec<String> = wanted.keys().cloned().collect();
                if left != wanted {
                    return Err(format!("{here}: {left:?} after the next save instead of {wanted:?}"));
                }
                continue;
            }
            self.apply(folder.path(), file, "edit-2.json", out)?;
            let left = contents(folder.path())?;
            if left.keys().ne(wanted.keys()) {
                return Err(format!(
                    "{here}: {:?} after the next save instead of {:?}",
                    left.keys(),
                    wanted.keys()
                ));
            }
            if shape(&folder.path().join(out)) != new {
                return Err(format!("{here}: the next save gave another shape"));
            }
            for (name, bytes) in &left {
                let is_written = Path::new(name).file_stem() == Path::new(out).file_stem();
                if !is_written && wanted.get(name) != Some(bytes) {
                    return Err(format!("{here}: {name} is another file now"));
                }
            }
        }
        Ok(())
    }

    /// Starts `count` pairs of saves at once: by two edits to one output, or of two files with equally named buffers
    /// into one folder.
    ///
    /// # Errors
    /// The first pair that ended with anything but one of the two, or of which one was refused.
    pub fn pairs(&mut self, count: usize, tally: &mut Tally) -> Result<()> {
        for trial in 0..count {
            let (file, out) = SAVES[trial % SAVES.len()];
            let (file, out) = if file == out {
                ("in/scan.gltf", "out/scan.gltf")
            } else {
                (file, out)
            };
            let is_two_files = out == "out/scan.gltf" && trial % 2 == 1;
            let second_out = if is_two_files { "out/second.gltf" } else { out };
            let earlier = (self.below(2) == 0).then_some(out);
            let here = format!("pair {trial}, {file} to {out} and {second_out}");
            let shapes = ["edit-1.json", "edit-2.json"].map(|edit| -> Result<Option<Shape>> {
                let folder = self.fresh(file, None)?;
                self.apply(folder.path(), file, edit, out)?;
                Ok(shape(&folder.path().join(out)))
            });
            let [first, second] = shapes;
            let (first, second) = (first?, second?);
            let folder = self.fresh(file, earlier)?;
            let mut a = self.start(folder.path(), file, "edit-1.json", out, None)?;
            std::thread::sleep(Duration::from_micros(self.below(3000)));
            let mut b = self.start(folder.path(), file, "edit-2.json", second_out, None)?;
            for child in [&mut a, &mut b] {
                let status = words(child.wait(), "the program")?;
                if !status.success() {
                    return Err(format!("{here}: {status}"));
                }
            }
            let found = shape(&folder.path().join(out));
            let is_sound = if is_two_files {
                found == first && shape(&folder.path().join(second_out)) == second
            } else {
                found == first || found == second
            };
            if !is_sound || found.is_none() {
                return Err(format!("{here}: the shapes are mixed"));
            }
            if found == first {
                tally.old += 1;
            } else {
                tally.new += 1;
            }
            let left = names(folder.path())?;
            if left.iter().any(|name| name.contains(".pliant")) {
                return Err(format!("{here}: left over {left:?}"));
            }
            let second_names = left
                .iter()
                .filter(|name| name.contains("scan-2.") || name.contains("other-2."))
                .count();
            if second_names > usize::from(is_two_files) {
                return Err(format!("{here}: neighbours twice in {left:?}"));
            }
        }
        Ok(())
    }
}

fn edit(way: Option<f64>) -> String {
    let Some(way) = way else {
        return r#"{"version":1,"method":{"name":"bilaplacian"}}"#.to_owned();
    };
    format!(
        r#"{{"version":1,"method":{{"name":"bilaplacian"}},"fixed":{{"slab":{{"axis":"x","from":0.0,"to":0.2}}}},
"handles":[{{"select":{{"slab":{{"axis":"x","from":0.9,"to":1.0}}}},"transform":{{"translation":[0.3,{way},0.1]}}}}]}}"#
    )
}

/// The bits of a file's positions; `None` if it can't be read.
type Shape = Vec<[u64; 3]>;

fn shape(path: &Path) -> Option<Shape> {
    let loaded = pliant_engine::load(path, &WeldOptions::default(), &Watch::default()).ok()?;
    let positions = loaded.model.rest_positions();
    Some(positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect())
}

/// All files below a folder with their bytes.
fn contents(folder: &Path) -> Result<BTreeMap<String, Vec<u8>>> {
    let mut out = BTreeMap::new();
    for name in names(folder)? {
        let path = folder.join(&name);
        if path.is_file() {
            out.insert(name.clone(), words(fs::read(&path), &name)?);
        }
    }
    Ok(out)
}

/// The names of all files below a folder, sorted.
fn names(folder: &Path) -> Result<Vec<String>> {
    let mut out = Vec::new();
    let mut folders = vec![String::new()];
    while let Some(below) = folders.pop() {
        for entry in words(fs::read_dir(folder.join(&below)), "a folder")? {
            let entry = words(entry, "a folder")?;
            let name = format!("{below}{}", entry.file_name().to_string_lossy());
            if entry.path().is_dir() {
                folders.push(format!("{name}/"));
            } else {
                out.push(name);
            }
        }
    }
    out.sort();
    Ok(out)
}

fn copy(from: &Path, to: &Path) -> Result<()> {
    for entry in words(fs::read_dir(from), "a folder")? {
        let entry = words(entry, "a folder")?;
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            words(fs::create_dir(&target), "a folder")?;
            copy(&entry.path(), &target)?;
        } else {
            words(fs::copy(entry.path(), &target), "a copy")?;
        }
    }
    Ok(())
}
