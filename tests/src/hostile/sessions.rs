//! A session like the window's, without the picture: a file is opened and bent, other programs write meanwhile, and it
//! is saved, sometimes before the shape has settled.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_app::window::saving::{
    Changed, Content, KeepOriginal, MeshSource, Model, RestMesh, SaveRequest, Shape, Unwritten, Written, WrittenKind,
    read_project, write,
};
use pliant_deform::{METHODS, Method};
use pliant_editor::{Beginning, Command, Editor, Event, InlineExecutor, SavedAs};
use pliant_engine::files::KnownFiles;
use pliant_engine::watch::Watch;
use pliant_mesh::{Cancel, Progress, WeldOptions};

use super::case::{Case, Entry};
use super::exercise::Runner;
use super::laws::{self, Law, Places, violation};
use super::named::neighbours_of;
use super::tree::{Tree, What, look, place_of};
use super::{models, shapes, strangers};
use crate::trials::Chance;

/// The most jobs until a shape has settled.
const JOBS: usize = 20_000;

/// The allowed difference of a saved file from the shown shape, in the size of its coordinates; quantised files have
/// coarse steps.
const ALIKE: f64 = 1e-3;

/// The window's state of an open file.
struct Desk {
    editor: Editor,
    jobs: InlineExecutor,
    mesh: RestMesh,
    known: KnownFiles,
    path: PathBuf,
    may_write_over: bool,
    /// The session's own files, by place, which may be overwritten.
    own: BTreeMap<PathBuf, What>,
}

/// The kind of a save.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Kind {
    /// The model, in place.
    Model,
    Copy,
    Project,
    Morph,
    Edit,
}

/// A save, and the files that the person has agreed to lose for it.
struct Save {
    kind: Kind,
    path: PathBuf,
    is_agreed: bool,
    is_settled: bool,
}

/// Runs a case whose folder is `root`.
pub(super) fn work(case: &Case, root: &Path, runner: &mut Runner<'_>) {
    let mut chance = Chance(case.seed ^ 0x0005_e551);
    let input = root.join("work").join(&case.input);
    let before = look(root);
    let words = |verb: &str, path: &Path| [verb.into(), path.as_os_str().to_owned()];
    let opened = runner.metered(&words("open", &input), || Desk::open(case, &input));
    let Some(Some(mut desk)) = opened else {
        runner.result.refused += 1;
        return runner.untouched(root, &before, "opening");
    };
    runner.untouched(root, &before, "opening");
    for round in 0..2 + chance.below(3) {
        let words: Vec<OsString> = vec!["bend".into(), format!("round {round}").into()];
        if runner.metered(&words, || desk.act(&mut chance)).is_none() {
            return;
        }
        for _ in 0..chance.below(3) {
            strangers::meddle(&root.join("work"), &case.input, &mut chance);
        }
        let save = desk.wish(round, &mut chance);
        if !desk.save(&save, root, runner, &mut chance) {
            return;
        }
    }
}

impl Desk {
    /// Opens the file with the case's edit; `None` if it is refused.
    fn open(case: &Case, input: &Path) -> Option<Self> {
        let loaded = pliant_engine::load(input, &WeldOptions::default(), &Watch::default()).ok()?;
        let known = KnownFiles::default();
        loaded
            .stamps()
            .for_each(|(path, stamp)| known.note(path, stamp.clone()));
        let jobs = InlineExecutor::new();
        let mut editor = Editor::new(Box::new(jobs.clone()));
        editor.handle(Event::Viewport {
            size_px: DVec2::new(800.0, 600.0),
        });
        let beginning = match case.entries.get(&Path::new("work").join(&case.edit)) {
            Some(Entry::File(text)) => Beginning::parse(&String::from_utf8_lossy(text)).ok(),
            _ => None,
        };
        editor.handle(Event::Opened {
            model: Arc::clone(&loaded.model),
            name: "in".to_owned(),
            beginning,
        });
        Some(Self {
            editor,
            jobs,
            mesh: RestMesh::new(Arc::new(loaded), MeshSource::File(input.to_owned())),
            known,
            path: input.to_owned(),
            may_write_over: false,
            own: BTreeMap::new(),
        })
    }

    fn run_jobs(&mut self, most: usize) {
        for _ in 0..most {
            let Some(done) = self.jobs.run_next() else { return };
            self.editor.handle(Event::JobDone(done));
        }
    }

    /// Executes an artist's action, and continues at once or waits until the shape has settled.
    fn act(&mut self, chance: &mut Chance) {
        let command = match chance.below(5) {
            0 | 1 => Command::SetStrength(chance.between(0.0, 1.0)),
            2 => Command::Undo,
            3 => Command::Apply,
            _ => Command::SetMethod(Method::from_name(chance.of(METHODS).name).unwrap()),
        };
        self.run_jobs(chance.below(12));
        self.editor.handle(Event::Command(command));
        let most = if chance.one_in(2) { JOBS } else { chance.below(12) };
        self.run_jobs(most);
    }

    /// The next save, and its place. A taken name was confirmed in the dialog for files.
    fn wish(&self, round: usize, chance: &mut Chance) -> Save {
        let kind = *chance.of(&[
            Kind::Model,
            Kind::Model,
            Kind::Model,
            Kind::Copy,
            Kind::Project,
            Kind::Project,
            Kind::Morph,
            Kind::Edit,
        ]);
        let extension = models::extension(&self.path);
        let other = *chance.of(&["glb", "gltf", "obj", "ply", "stl", "off"]);
        let name = match kind {
            Kind::Model => String::new(),
            Kind::Copy if chance.one_in(2) => format!("copy.{extension}"),
            Kind::Copy => format!("copy.{other}"),
            Kind::Project => "pose.pliant".to_owned(),
            Kind::Morph => format!("morph{round}.glb"),
            Kind::Edit => "work.edit.json".to_owned(),
        };
        let path = match kind {
            Kind::Model => self.path.clone(),
            _ => self.path.with_file_name(name),
        };
        Save {
            kind,
            is_agreed: kind != Kind::Model && self.known.stamp(&path).is_none(),
            is_settled: self.editor.is_settled(),
            path,
        }
    }

    fn request(&self, save: &Save) -> Option<SaveRequest> {
        let shape = || Shape {
            displacements: Arc::clone(self.editor.view().displacements),
            inside_out: Arc::clone(self.editor.document().inside_out()),
            dye: None,
        };
        let content = match save.kind {
            Kind::Model | Kind::Copy => Content::Model(Model {
                mesh: self.mesh.clone(),
                shape: shape(),
                keep_original: match save.kind == Kind::Model && !self.may_write_over {
                    true => KeepOriginal::Yes,
                    false => KeepOriginal::No,
                },
            }),
            Kind::Project => Content::Project(Box::new(self.editor.snapshot()?), self.mesh.clone()),
            Kind::Morph => Content::Morph(shape(), self.mesh.clone()),
            Kind::Edit => {
                let model = Arc::clone(self.editor.view().model?);
                Content::Edit(Box::new(self.editor.edit_file().ok()?), model)
            }
        };
        Some(SaveRequest {
            path: save.path.clone(),
            content,
            sources: self.mesh.loaded.sources().map(|(_, path)| path.to_owned()).collect(),
            known: self.known.clone(),
            changed: Changed::Ask,
            mark: self.editor.save_mark(),
            opened: 1,
        })
    }

    /// Saves and checks the disk afterwards. False if it panicked.
    fn save(&mut self, save: &Save, root: &Path, runner: &mut Runner<'_>, chance: &mut Chance) -> bool {
        let Some(request) = self.request(save) else { return true };
        let words: [OsString; 3] = [
            "save".into(),
            format!("{:?}", save.kind).into(),
            save.path.clone().into(),
        ];
        let before = look(root);
        let (seen, old) = (self.seen(), (shapes::shape(&save.path), neighbours_of(&save.path)));
        let go = |request| write(request, &Progress::new(), &Cancel::new());
        let Some(mut ended) = runner.metered(&words, || go(request)) else {
            return false;
        };
        let mut is_agreed = save.is_agreed;
        if let Err(Unwritten::Changed(_, mut request)) = ended {
            runner.untouched(root, &before, "a question");
            if chance.one_in(3) {
                runner.result.refused += 1;
                return true;
            }
            request.changed = Changed::Replace;
            match &mut request.content {
                Content::Model(model) => model.keep_original = KeepOriginal::Yes,
                _ => is_agreed = true,
            }
            let Some(second) = runner.metered(&words, || go(*request)) else {
                return false;
            };
            ended = second;
        }
        match ended {
            Ok(written) => {
                runner.result.done += 1;
                self.judge(save, is_agreed, (root, &before), (old.0.as_ref(), &old.1), runner);
                self.reads_back(save, &seen, runner);
                return self.took(written, save, &seen, runner);
            }
            Err(Unwritten::Refused(sentence)) => {
                runner.result.refused += 1;
                let is_one_line = !sentence.is_empty() && !sentence.contains(|c: char| c.is_control());
                if !is_one_line {
                    let found = &mut runner.result.violations;
                    found.push(violation(Law::OneLine, laws::shortened(&format!("{sentence:?}"))));
                }
                runner.untouched(root, &before, "a refusal");
            }
            // These sessions export no animation.
            Err(Unwritten::FramesExist { .. }) => runner.result.refused += 1,
            Err(Unwritten::Changed(..)) => {
                let found = &mut runner.result.violations;
                found.push(violation(Law::TheirsIsKept, "the person is asked again and again"));
            }
        }
        true
    }

    /// The drawn positions for a save now.
    fn seen(&self) -> Vec<DVec3> {
        let mut positions = Vec::new();
        let model = &self.mesh.loaded.model;
        model.drawn_positions(self.editor.view().displacements, &mut positions);
        positions
    }

    /// Checks the changes of a save on the disk, and notes the session's new files. `old` is the file's earlier shape,
    /// and its neighbours.
    fn judge(
        &mut self,
        save: &Save,
        is_agreed: bool,
        (root, before): (&Path, &Tree),
        (old, old_neighbours): (Option<&shapes::Shape>, &BTreeSet<PathBuf>),
        runner: &mut Runner<'_>,
    ) {
        let after = look(root);
        let output = place_of(&save.path);
        let found = &mut runner.result.violations;
        let places = Places {
            output: output.clone(),
            old_neighbours: old_neighbours.clone(),
            ..Places::default()
        };
        // Originals and a project's mesh are kept under free names.
        let mut others = after.clone();
        others.retain(|place, _| before.contains_key(place) || !is_kept(place));
        laws::of_save(root, before, &others, &places, found);

        let is_there = |what: &What| after.values().any(|node| node.what == *what);
        let shows_old = |place: &PathBuf| {
            let is_old = |new: shapes::Shape| old.is_some_and(|old| shapes::is_same(&new, old));
            is_kept(place) && shapes::shape(&root.join(place)).is_some_and(is_old)
        };
        for place in laws::changed(before, &after) {
            let Some(was) = before.get(&place).filter(|node| matches!(node.what, What::File(..))) else {
                continue;
            };
            let is_given_up = is_agreed && output.as_ref() == Some(&root.join(&place));
            let is_own = self.own.get(&place) == Some(&was.what);
            if !is_given_up && !is_own && !is_there(&was.what) && !after.keys().any(shows_old) {
                found.push(violation(Law::TheirsIsKept, format!("{place:?} by a {:?}", save.kind)));
            }
        }
        // The files that it wrote, and existing ones that it would have written identically.
        let written = output.iter().cloned().chain(neighbours_of(&save.path));
        let written = written.filter_map(|place| Some(place.strip_prefix(root).ok()?.to_owned()));
        for place in written.chain(laws::changed(before, &after)) {
            if let Some(node) = after.get(&place) {
                self.own.insert(place, node.what.clone());
            }
        }
    }

    /// Checks that a written file can be read, and has the shown shape.
    fn reads_back(&self, save: &Save, seen: &[DVec3], runner: &mut Runner<'_>) {
        let found = &mut runner.result.violations;
        let model = &self.mesh.loaded.model;
        let shown = match save.kind {
            Kind::Edit | Kind::Morph => return,
            Kind::Project => {
                if let Err(error) = read_project(&save.path, &Watch::default()) {
                    found.push(violation(Law::ReadsBack, format!("the project: {error}")));
                }
                return;
            }
            Kind::Model | Kind::Copy => shapes::shape(&save.path),
        };
        let Some(mut shown) = shown else {
            return found.push(violation(Law::ReadsBack, format!("{:?} is refused", save.path)));
        };
        let triangles = model.drawn_triangles();
        let mut wanted: shapes::Shape = triangles.iter().map(|t| t.map(|v| seen[v.index()])).collect();
        let is_finite = |corners: &[DVec3; 3]| corners.iter().all(|p| p.is_finite());
        wanted.retain(is_finite);
        shown.retain(is_finite);
        let size = wanted
            .iter()
            .flatten()
            .map(|p| p.abs().max_element())
            .fold(0.0, f64::max);
        if let Some((a, b)) = shapes::stray_corner(&wanted, &shown, ALIKE * size) {
            let what = format!("{b} in the file where {a} was seen, by a {:?}", save.kind);
            found.push(violation(Law::SameShape, what));
        }
    }

    /// Continues with the written file, like the window, and lets the shape settle: if it changes, it is unsaved. False
    /// if it panicked.
    fn took(&mut self, written: Written, save: &Save, seen: &[DVec3], runner: &mut Runner<'_>) -> bool {
        let saved = match written.what {
            WrittenKind::Model { source, .. } => {
                if let Some(source) = source {
                    self.mesh.source = source;
                }
                // Like after *Save as*, the session continues with the written file.
                self.path = written.path;
                self.may_write_over = true;
                SavedAs::Model
            }
            WrittenKind::Project => SavedAs::Project,
            WrittenKind::Picture
            | WrittenKind::Edit
            | WrittenKind::Morph
            | WrittenKind::Animation
            | WrittenKind::Frames => return true,
        };
        self.editor.handle(Event::Saved(saved, written.mark));
        if runner.metered(&["settle".into()], || self.run_jobs(JOBS)).is_none() {
            return false;
        }
        let now = self.seen();
        let apart = now.iter().zip(seen).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        let size = seen.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        if apart > 1e-9 * size && !self.editor.view().unsaved {
            let what = format!(
                "{apart} of {size} after a save of a {:?}, settled: {}",
                save.kind, save.is_settled
            );
            runner.result.violations.push(violation(Law::Unsaved, what));
        }
        true
    }
}

/// Returns true if a place has the name of a kept original or of a project's mesh.
fn is_kept(place: &Path) -> bool {
    let name = place.file_name().unwrap_or_default().to_string_lossy();
    name.contains(".original") || name.contains(".source")
}
