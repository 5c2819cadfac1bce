//! The original of a file that a save replaces: it is kept beside it, unless a file with its content already is.

use std::path::{Path, PathBuf};

use pliant_mesh::{Cancel, Progress, WeldOptions};

use super::names::{is_gltf, original_names};
use pliant_engine::files::{self, Destination, NewFile, Staged, Staging};
use pliant_engine::saving::{self, SaveAs};
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded};

/// The place of a file's original.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Kept {
    /// A file beside it already has the same content.
    Already(PathBuf),
    /// This name is free for it.
    Under(PathBuf),
    /// The file is gone and was another one, so there is nothing to keep.
    Nothing,
}

/// The original of one file.
pub struct Original {
    path: PathBuf,
    content: Content,
}

/// The kept data.
enum Content {
    /// Its bytes.
    Bytes(Vec<u8>),
    /// A glTF with its neighbours, packed into a GLB: they are saved over along with it.
    Packed(Box<Loaded>),
    /// The open file as it was read, a glTF with its neighbours packed into a GLB.
    Open,
    /// There is no such file.
    Nothing,
}

impl Original {
    /// The original of the file at `path` as it is now; `loaded` is the open one, which may be the same.
    ///
    /// # Errors
    /// If it can't be read.
    pub fn of(path: &Path, loaded: &Loaded, cancel: &Cancel) -> Result<Self, EngineError> {
        let is_alone = |loaded: &Loaded| !is_gltf(path) && loaded.neighbours.is_empty();
        let content = if !path.exists() {
            // Another program has moved or removed it: the data in memory is the last copy.
            match files::is_same(&loaded.path, path) {
                true => Content::Open,
                false => Content::Nothing,
            }
        } else if !is_kind_of_gltf(path) {
            Content::Bytes(files::read(path)?)
        } else if is_as_read(path, loaded) {
            match is_alone(loaded) {
                true => Content::Bytes(files::read(path)?),
                false => Content::Open,
            }
        } else {
            let watch = Watch::cancelled_by(cancel);
            match pliant_engine::load(path, &WeldOptions::default(), &watch) {
                Ok(other) if !is_alone(&other) => Content::Packed(Box::new(other)),
                Err(error) if is_gltf(path) => return Err(error),
                _ => Content::Bytes(files::read(path)?),
            }
        };
        Ok(Self {
            path: path.to_owned(),
            content,
        })
    }

    /// The open file as it was read from `path`, if another one is there now but its neighbours are unchanged: saves
    /// would replace them.
    pub fn as_read(path: &Path, loaded: &Loaded) -> Option<Self> {
        let is_other = path.exists() && files::is_same(&loaded.path, path) && !is_as_read(path, loaded);
        let mut neighbours = loaded.neighbours.iter();
        let has_neighbours = is_gltf(path) && neighbours.any(|(path, stamp)| stamp.is_current(path));
        (is_other && has_neighbours).then(|| Self {
            path: path.to_owned(),
            content: Content::Open,
        })
    }

    /// Whether it is already kept, or the name under which it will be.
    ///
    /// # Errors
    /// If it can't be encoded, or if a thousand names are taken.
    pub fn place(&self, loaded: &Loaded, cancel: &Cancel) -> Result<Kept, EngineError> {
        self.place_beside(&[], loaded, cancel)
    }

    fn place_beside(&self, taken: &[PathBuf], loaded: &Loaded, cancel: &Cancel) -> Result<Kept, EngineError> {
        let packed;
        let bytes = match (&self.content, self.packed(loaded)) {
            (Content::Nothing, _) => return Ok(Kept::Nothing),
            (Content::Bytes(bytes), _) => bytes,
            (_, of) => {
                let name = original_names(&self.path).next().unwrap_or_default();
                packed = saving::bytes_at_rest(of, &name, &Progress::new(), cancel)?;
                &packed
            }
        };
        free_or_same(original_names(&self.path).filter(|name| !taken.contains(name)), bytes)
    }

    /// Returns true if it is the open file as it was read, and its path now has another one.
    pub fn is_former(&self, loaded: &Loaded) -> bool {
        matches!(self.content, Content::Open) && !is_as_read(&self.path, loaded)
    }

    /// Stages it at [`place`](Self::place), but under none of the names `taken`. Gives the path where it is then kept,
    /// and the staged files if it was not kept before.
    ///
    /// # Errors
    /// As [`place`](Self::place); if it can't be written.
    pub fn keep(
        &self,
        taken: &[PathBuf],
        loaded: &Loaded,
        staging: &Staging,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<(Kept, Option<Staged>), EngineError> {
        let kept = self.place_beside(taken, loaded, cancel)?;
        let Kept::Under(place) = &kept else {
            return Ok((kept, None));
        };
        let staged = match &self.content {
            Content::Bytes(bytes) => {
                let file = NewFile {
                    to: Destination::of(place)?,
                    bytes,
                };
                staging.stage_watched(&[file], None, progress, cancel)?
            }
            _ => {
                let of = self.packed(loaded);
                let at_rest = of.model.rest_positions();
                saving::stage(of, &SaveAs::shape(&at_rest, place), staging, progress, cancel)?.staged
            }
        };
        Ok((kept, Some(staged)))
    }

    /// The packed file, if it is packed.
    fn packed<'a>(&'a self, open: &'a Loaded) -> &'a Loaded {
        match &self.content {
            Content::Packed(loaded) => loaded,
            _ => open,
        }
    }
}

/// The first of these names that is free, or whose file has these bytes.
///
/// # Errors
/// All of them are taken.
pub fn free_or_same(names: impl Iterator<Item = PathBuf>, bytes: &[u8]) -> Result<Kept, EngineError> {
    let mut last = PathBuf::new();
    for name in names {
        // A dangling link is not a free name: its file may come back.
        if std::fs::symlink_metadata(&name).is_err() {
            return Ok(Kept::Under(name));
        }
        if files::holds(&name, bytes) {
            return Ok(Kept::Already(name));
        }
        last = name;
    }
    Err(EngineError::System(format!(
        "{} and all names before it are taken: move the files that are kept there to another folder",
        files::shown(&last)
    )))
}

/// Returns true if the file at `path` and its neighbours are those that were opened, and unchanged.
pub fn is_as_read(path: &Path, loaded: &Loaded) -> bool {
    loaded.stamp.is_some()
        && files::is_same(&loaded.path, path)
        && loaded.stamps().all(|(path, stamp)| stamp.is_current(path))
}

fn is_kind_of_gltf(path: &Path) -> bool {
    is_gltf(path)
        || path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("glb"))
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use std::fs;

    use pliant_mesh::shapes;

    use super::*;

    fn read(path: &Path) -> Loaded {
        pliant_engine::load(path, &WeldOptions::default(), &Watch::default()).unwrap()
    }

    /// Writes a ball as a file in the format of its name.
    fn ball(path: &Path, level: u32) {
        let drawn = shapes::icosphere(level);
        let mut text = format!("OFF\n{} {} 0\n", drawn.positions.len(), drawn.triangles.len());
        drawn
            .positions
            .iter()
            .for_each(|p| text.push_str(&format!("{} {} {}\n", p.x, p.y, p.z)));
        drawn
            .triangles
            .iter()
            .for_each(|[a, b, c]| text.push_str(&format!("3 {} {} {}\n", a.0, b.0, c.0)));
        let off = path.with_extension("off");
        fs::write(&off, text).unwrap();
        save(&read(&off), path);
    }

    fn save(loaded: &Loaded, path: &Path) {
        let at_rest = loaded.model.rest_positions();
        let (staging, progress, cancel) = (Staging::default(), Progress::new(), Cancel::new());
        let saved = saving::stage(loaded, &SaveAs::shape(&at_rest, path), &staging, &progress, &cancel).unwrap();
        saved.staged.commit().unwrap();
    }

    fn keep(path: &Path, loaded: &Loaded) -> Kept {
        let (staging, progress, cancel) = (Staging::default(), Progress::new(), Cancel::new());
        let original = Original::of(path, loaded, &cancel).unwrap();
        let (kept, staged) = original.keep(&[], loaded, &staging, &progress, &cancel).unwrap();
        if let Some(staged) = staged {
            staged.commit().unwrap();
        }
        kept
    }

    #[test]
    fn two_files_whose_originals_have_one_name_are_both_kept_and_each_once() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let (glb, gltf) = (at("scan.glb"), at("scan.gltf"));
        ball(&glb, 1);
        ball(&gltf, 2);
        let names = [at("scan.original.glb"), at("scan.original-2.glb")];
        for (path, name) in [&glb, &gltf].into_iter().zip(&names) {
            let loaded = read(path);
            assert_eq!(keep(path, &loaded), Kept::Under(name.clone()));
            assert_eq!(keep(path, &loaded), Kept::Already(name.clone()));
            assert_eq!(read(name).model.rest_positions(), loaded.model.rest_positions());
        }
        assert_eq!(fs::read(&names[0]).unwrap(), fs::read(&glb).unwrap(), "to the byte");
        // If another program's glTF is in its place, that one is kept, and not the one that was read.
        let loaded = read(&gltf);
        ball(&gltf, 3);
        assert_eq!(keep(&gltf, &loaded), Kept::Under(at("scan.original-3.glb")));
        let (kept, theirs) = (read(&at("scan.original-3.glb")), read(&gltf));
        assert_eq!(kept.model.rest_positions(), theirs.model.rest_positions());
        // The file that was read here is kept, too, whether another file is here or none.
        let former = Original::as_read(&gltf, &loaded).unwrap();
        let place = former.place(&loaded, &Cancel::new()).unwrap();
        assert_eq!(place, Kept::Already(at("scan.original-2.glb")));
        assert!(Original::as_read(&glb, &loaded).is_none());
        fs::remove_file(&gltf).unwrap();
        assert_eq!(keep(&gltf, &loaded), Kept::Already(at("scan.original-2.glb")));
        assert_eq!(keep(&gltf, &read(&glb)), Kept::Nothing);
    }
}
