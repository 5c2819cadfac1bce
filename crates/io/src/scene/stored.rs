//! A file as stored, and what it holds.

use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::{Cancel, Object};

use crate::convert::Polygons;
use crate::summary::Summary;
use crate::{Appearance, Format, MorphPlayback, ReadError, gltf, obj, off, ply, stl, threemf, usdz};

/// A complete file as stored.
#[derive(Debug)]
pub struct Scene {
    pub(super) format: Format,
    pub(super) bytes: Arc<Vec<u8>>,
    pub(super) stored: Stored,
}

#[derive(Debug)]
pub(crate) enum Stored {
    Gltf(gltf::Stored),
    Obj(obj::Stored),
    Ply(ply::Stored),
    Stl(stl::Stored),
    Off(off::Stored),
    Threemf(threemf::Stored),
    Usdz(usdz::Stored),
}

impl Scene {
    /// The format that was read.
    pub fn format(&self) -> Format {
        self.format
    }

    /// Notes for a person on how the file was read (a node left out, an image missing), in sentences.
    pub fn notes(&self) -> &[String] {
        match &self.stored {
            Stored::Gltf(stored) => stored.notes(),
            Stored::Obj(stored) => stored.notes(),
            Stored::Ply(stored) => stored.notes(),
            Stored::Stl(stored) => stored.notes(),
            Stored::Off(stored) => stored.notes(),
            Stored::Threemf(stored) => stored.notes(),
            Stored::Usdz(stored) => stored.notes(),
        }
    }

    /// The file's contents, counted.
    pub fn summary(&self) -> Summary {
        match &self.stored {
            Stored::Gltf(stored) => stored.summary(),
            Stored::Obj(stored) => stored.summary(),
            Stored::Ply(stored) => stored.summary(),
            Stored::Stl(stored) => stored.summary(),
            Stored::Off(stored) => stored.summary(),
            Stored::Threemf(stored) => stored.summary(),
            Stored::Usdz(stored) => stored.summary(),
        }
    }

    /// The file's objects: the triangles that one node or group shows in one material. Empty for PLY, STL and OFF,
    /// which have none.
    pub fn objects(&self) -> Vec<Object> {
        match &self.stored {
            Stored::Gltf(stored) => stored.objects(),
            Stored::Obj(stored) => stored.objects(),
            Stored::Threemf(stored) => stored.objects(),
            Stored::Usdz(stored) => stored.objects(),
            Stored::Ply(_) | Stored::Stl(_) | Stored::Off(_) => Vec::new(),
        }
    }

    /// The names of the file's morph targets, each once. Only glTF has targets; one without a name is called `target
    /// 0`, `target 1`, ... by its number.
    pub fn morph_targets(&self) -> Vec<String> {
        match &self.stored {
            Stored::Gltf(stored) => stored.morph_targets(),
            _ => Vec::new(),
        }
    }

    /// The displacement of each of the file's `vertex_count` drawn vertices, in world space, when the morph targets
    /// called `target` are applied fully; `None` if there is none. `file` is used in messages only.
    ///
    /// # Errors
    /// A target that can't be read, or soon after `cancel` is raised.
    pub fn morph_target(
        &self,
        file: &str,
        target: &str,
        vertex_count: usize,
        cancel: &Cancel,
    ) -> Result<Option<Vec<DVec3>>, ReadError> {
        match &self.stored {
            Stored::Gltf(stored) => stored.morph_target(file, target, vertex_count, cancel),
            _ => Ok(None),
        }
    }

    /// The shapes of the file's drawn vertices during its last animation of morph targets, which only a glTF can have.
    /// `file` is used in messages only.
    ///
    /// # Errors
    /// An animation or a target that can't be read, or soon after `cancel` is raised.
    pub fn morph_playback(&self, file: &str, cancel: &Cancel) -> Result<Option<MorphPlayback>, ReadError> {
        match &self.stored {
            Stored::Gltf(stored) => stored.morph_playback(file, cancel),
            _ => Ok(None),
        }
    }

    /// The appearance of the scene at rest. Each call decodes it from the stored bytes.
    pub fn appearance(&self) -> Appearance {
        match &self.stored {
            Stored::Gltf(stored) => stored.appearance(),
            Stored::Obj(stored) => stored.appearance(),
            Stored::Ply(stored) => stored.appearance(),
            Stored::Stl(stored) => stored.appearance(),
            Stored::Off(stored) => stored.appearance(),
            Stored::Threemf(stored) => stored.appearance(),
            Stored::Usdz(stored) => stored.appearance(),
        }
    }

    /// The same, with each material of a glTF and the names of an OBJ as the file has them, so that
    /// [`UnsavedShape`](crate::UnsavedShape) writes all of it to a new file of the same kind.
    pub fn appearance_with_originals(&self) -> Appearance {
        match &self.stored {
            Stored::Gltf(stored) => stored.appearance_with_originals(),
            Stored::Obj(stored) => stored.appearance_with_names(),
            _ => self.appearance(),
        }
    }

    /// Returns true if a save in this format patches the file, and does not convert it.
    pub fn is_of_kind(&self, format: Format) -> bool {
        let is_gltf = |format| matches!(format, Format::Glb | Format::Gltf);
        self.format() == format || (is_gltf(self.format()) && is_gltf(format))
    }

    /// The file in its own format.
    pub(crate) fn stored(&self) -> &Stored {
        &self.stored
    }

    /// `value` rounded to the precision of the file's format for a coordinate of the given axis. glTF stores
    /// coordinates in a node's space, where no such number exists, so `value` is returned unchanged.
    pub(crate) fn nearest_stored(&self, axis: usize, value: f64) -> f64 {
        match &self.stored {
            Stored::Ply(stored) => stored.nearest(axis, value),
            Stored::Stl(stored) => stored.nearest(value),
            Stored::Gltf(_) | Stored::Obj(_) | Stored::Off(_) | Stored::Threemf(_) | Stored::Usdz(_) => value,
        }
    }

    /// The file's own polygons over drawn vertices, if any of them is not a triangle.
    pub fn polygons(&self) -> Option<Polygons> {
        match &self.stored {
            Stored::Gltf(_) | Stored::Stl(_) | Stored::Threemf(_) => None,
            Stored::Usdz(stored) => stored.polygons(),
            Stored::Obj(stored) => stored.polygons(),
            Stored::Ply(stored) => stored.polygons(),
            Stored::Off(stored) => stored.polygons(),
        }
    }
}
