//! A file on disk, read and welded.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use pliant_io::{Bytes, Format, Resolver, Saved, Scene, SceneAndDrawn};
use pliant_mesh::{Model, WeldOptions};
use tracing::info_span;

use crate::EngineError;
use crate::files::{self, Neighbours, Staged, Stamp};
use crate::watch::Watch;

/// A file, read and welded.
#[derive(Debug)]
pub struct Loaded {
    /// The path that it was read from.
    pub path: PathBuf,
    /// The stored file.
    pub scene: Scene,
    /// Its geometry.
    pub model: Arc<Model>,
    /// The files beside it that were read with it, in their state at that time.
    pub neighbours: Vec<(PathBuf, Stamp)>,
    /// The stamp of the file when it was read; `None` if its bytes came from elsewhere.
    pub stamp: Option<Stamp>,
}

impl Loaded {
    /// All of its input files, each with a description, to refuse outputs that would overwrite one.
    pub fn sources(&self) -> impl Iterator<Item = (&'static str, &Path)> {
        let neighbours = self.neighbours.iter();
        let neighbours = neighbours.map(|(path, _)| ("a file that FILE needs", &**path));
        std::iter::once(("FILE", &*self.path)).chain(neighbours)
    }

    /// Refuses to replace an input file that another program has changed since it was read.
    ///
    /// # Errors
    /// [`EngineError::Changed`], naming the file.
    pub fn refuse_changed(&self, staged: &Staged) -> Result<(), EngineError> {
        let is_changed = |target: &&Path| {
            let mut read = self.stamps().filter(|(path, _)| files::is_same(path, target));
            target.exists() && read.any(|(path, stamp)| !stamp.is_current(path))
        };
        match staged.targets().find(is_changed) {
            Some(changed) => Err(EngineError::Changed(changed.to_owned())),
            None => Ok(()),
        }
    }

    /// Their stamps when they were read, without input from elsewhere.
    pub fn stamps(&self) -> impl Iterator<Item = (&Path, &Stamp)> {
        let own = self.stamp.iter().map(|stamp| (&*self.path, stamp));
        own.chain(self.neighbours.iter().map(|(path, stamp)| (&**path, stamp)))
    }
}

/// Reads and welds a file.
///
/// # Errors
/// A file that can't be read; [`EngineError::Interrupted`] soon after `cancel` is raised.
pub fn load(path: &Path, weld: &WeldOptions, watch: &Watch) -> Result<Loaded, EngineError> {
    check_mesh(path)?;
    let _span = info_span!("load", file = %path.display()).entered();
    watch.begin("reading");
    let (bytes, stamp) = files::read_stamped(path)?;
    Ok(Loaded {
        stamp: Some(stamp),
        ..load_bytes(bytes, path, weld, watch)?
    })
}

/// Reads a file without welding it.
///
/// # Errors
/// Those of [`load`].
pub fn open(path: &Path, watch: &Watch) -> Result<SceneAndDrawn, EngineError> {
    check_mesh(path)?;
    watch.begin("reading");
    let (bytes, neighbours) = (files::read(path)?, Neighbours::of(path));
    open_bytes(bytes, path, &neighbours, watch)
}

/// Refuses a path without the extension of a mesh.
fn check_mesh(path: &Path) -> Result<(), EngineError> {
    if is_project(path) {
        return Err(EngineError::ProjectAsFile(path.to_owned()));
    }
    Format::of_name(&path.to_string_lossy())?;
    Ok(())
}

/// Reads and welds a file's bytes; `path` gives its name and the folder of its neighbours.
///
/// # Errors
/// Those of [`load`].
pub fn load_bytes(bytes: Vec<u8>, path: &Path, weld: &WeldOptions, watch: &Watch) -> Result<Loaded, EngineError> {
    let neighbours = Neighbours::of(path);
    let opened = open_bytes(bytes, path, &neighbours, watch)?;
    let loaded = welded(opened, path, weld, watch)?;
    let loaded = Loaded {
        neighbours: neighbours.were_read(),
        ..loaded
    };
    loaded.sources().for_each(|(what, path)| watch.note_read(what, path));
    Ok(loaded)
}

/// Reads and welds files that were saved in memory and are on no disk. Neighbours that are not among them are read beside
/// `path`.
///
/// # Errors
/// Those of [`load`].
pub(crate) fn load_saved(saved: Saved, path: &Path, weld: &WeldOptions, watch: &Watch) -> Result<Loaded, EngineError> {
    let mut files = saved.files.into_iter();
    let bytes = files.next().map(|file| file.bytes).unwrap_or_default();
    let resolver = InMemory {
        files: files.map(|file| (file.name, Bytes::from(file.bytes))).collect(),
        on_disk: Neighbours::of(path),
    };
    let name = path.to_string_lossy();
    let progress = watch.begin("reading");
    let format = Format::of_name(&name)?;
    let opened = pliant_io::read(bytes, format, &name, &resolver, &progress, &watch.cancel);
    let loaded = welded(opened?, path, weld, watch)?;
    Ok(Loaded {
        neighbours: resolver.on_disk.were_read(),
        ..loaded
    })
}

/// The neighbours of a file in memory.
struct InMemory {
    files: BTreeMap<String, Bytes>,
    on_disk: Neighbours,
}

impl Resolver for InMemory {
    fn read(&self, uri: &str) -> Result<Bytes, String> {
        match self.files.get(uri) {
            Some(bytes) => Ok(bytes.clone()),
            None => self.on_disk.read(uri),
        }
    }
}

fn open_bytes(
    bytes: Vec<u8>,
    path: &Path,
    neighbours: &Neighbours,
    watch: &Watch,
) -> Result<SceneAndDrawn, EngineError> {
    let name = path.to_string_lossy();
    let format = Format::of_name(&name)?;
    let progress = watch.begin("reading");
    let opened = pliant_io::read(bytes, format, &name, neighbours, &progress, &watch.cancel);
    watch.note_read("a file that is read", path);
    for place in neighbours.places() {
        watch.note_read("a file that the model names", &place);
    }
    Ok(opened?)
}

fn welded(opened: SceneAndDrawn, path: &Path, weld: &WeldOptions, watch: &Watch) -> Result<Loaded, EngineError> {
    let progress = watch.begin("welding");
    let model = Model::weld(opened.drawn, weld, &progress, &watch.cancel).map_err(|_| EngineError::Interrupted)?;
    let model = model.with_objects(opened.scene.objects());
    Ok(Loaded {
        path: path.to_owned(),
        scene: opened.scene,
        model: Arc::new(model),
        neighbours: Vec::new(),
        stamp: None,
    })
}

/// Returns true if a path has the extension of a project.
pub fn is_project(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("pliant"))
}

/// Refuses a file without triangles and points.
///
/// # Errors
/// [`EngineError::Empty`].
pub fn check_not_empty(file: &Path, model: &Model) -> Result<(), EngineError> {
    if model.surface.positions.is_empty() {
        return Err(EngineError::Empty(file.to_owned()));
    }
    Ok(())
}
