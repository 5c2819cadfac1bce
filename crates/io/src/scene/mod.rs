//! A file as stored, in any format, and the only place that distinguishes formats.
//!
//! Each format is one module with the same interface: `read(&Source) -> Result<(Stored, Drawn), ReadError>`;
//! `Stored::{notes, summary, appearance, write}`, where `write(&Moved, &Course)` returns the file with only the moved
//! vertices' numbers changed, and warnings (it is called only if something moved); and `write_new(&NewMesh, &Course)`,
//! which converts a mesh of any other format.

mod check;
mod differences;
pub(crate) mod pose;
mod rename;
pub(crate) mod unsaved;

use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::{Cancel, Drawn, Object, Progress};

use crate::convert::faces::{lost, lost_where};
use crate::convert::{NewMesh, Parting, Polygons};
use crate::gltf::unread::MaterialsKept;
use crate::save::bits::bit_equal;
use crate::save::colours::of_file as colours_of_file;
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::save::{MorphAnimation, MorphTarget, OutputFile, Placement, Save, Saved};
use crate::source::{Resolver, Source};
use crate::summary::Summary;
use crate::{Appearance, Bytes, Format, ReadError, SaveError, gltf, obj, off, ply, stl, threemf, usdz};

/// The result of [`read`].
#[derive(Debug)]
pub struct SceneAndDrawn {
    /// The file as stored.
    pub scene: Scene,
    /// The geometry that it shows.
    pub drawn: Drawn,
}

/// A complete file as stored.
#[derive(Debug)]
pub struct Scene {
    format: Format,
    bytes: Arc<Vec<u8>>,
    stored: Stored,
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

/// Reads a file of the given format. `name` is used in messages only; `resolver` reads the neighbours.
pub fn read(
    bytes: Vec<u8>,
    format: Format,
    name: &str,
    resolver: &dyn Resolver,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<SceneAndDrawn, ReadError> {
    cancel.check()?;
    let bytes = Arc::new(bytes);
    let source = Source {
        bytes: &bytes,
        name,
        resolver,
        progress,
        cancel,
    };
    let (stored, drawn) = match format {
        Format::Glb | Format::Gltf => {
            let (stored, drawn) = gltf::read(&source, format)?;
            (Stored::Gltf(stored), drawn)
        }
        Format::Obj => {
            let (stored, drawn) = obj::read(&source)?;
            (Stored::Obj(stored), drawn)
        }
        Format::Ply => {
            let (stored, drawn) = ply::read(&source)?;
            (Stored::Ply(stored), drawn)
        }
        Format::Stl => {
            let (stored, drawn) = stl::read(&source)?;
            (Stored::Stl(stored), drawn)
        }
        Format::Off => {
            let (stored, drawn) = off::read(&source)?;
            (Stored::Off(stored), drawn)
        }
        Format::Threemf => {
            let (stored, drawn) = threemf::read(&source)?;
            (Stored::Threemf(stored), drawn)
        }
        Format::Usdz => {
            let (stored, drawn) = usdz::read(&source)?;
            (Stored::Usdz(stored), drawn)
        }
    };
    cancel.check()?;
    progress.set(1.0);
    Ok(SceneAndDrawn {
        scene: Scene { format, bytes, stored },
        drawn,
    })
}

/// Resolves a saved file's own neighbours.
impl Resolver for Saved {
    fn read(&self, uri: &str) -> Result<Bytes, String> {
        let file = self.files.iter().find(|file| file.name == uri);
        file.map_or_else(
            || Err("it was not written".to_owned()),
            |file| Ok(file.bytes.clone().into()),
        )
    }
}

/// A save with the neighbours that its file needs.
fn with_neighbours(mut saved: Saved, (files, warnings): (Vec<OutputFile>, Vec<String>)) -> Saved {
    saved.files.extend(files);
    saved.warnings.extend(warnings);
    saved
}

/// A shape at rest that was saved as glTF and read back, so that targets can be added.
struct AtRest {
    written: SceneAndDrawn,
    rest: Saved,
}

impl Saved {
    /// A later save of this one's file, with the warnings and the order of triangles of both.
    fn before(self, mut later: Self) -> Self {
        later.warnings.splice(0..0, self.warnings);
        later.triangles = self.triangles;
        later
    }
}

/// Refuses morph targets in a format that has none.
fn check_holds_targets(format: Format) -> Result<(), SaveError> {
    match format {
        Format::Glb | Format::Gltf => Ok(()),
        _ => Err(SaveError::CannotHold {
            what: "a morph target".to_owned(),
            format,
            remedy: "save as .glb".to_owned(),
        }),
    }
}

/// A mesh as a new file.
pub(crate) fn write_new(mesh: &NewMesh<'_>, format: Format, course: &Course<'_>) -> Result<Saved, SaveError> {
    match format {
        Format::Glb => gltf::write::write_new(mesh, course),
        Format::Gltf => gltf::write::write_new_gltf(mesh, course),
        Format::Obj => obj::write_new(mesh, course),
        Format::Ply => ply::write_new(mesh, course),
        Format::Stl => stl::write_new(mesh, course),
        Format::Off => off::write_new(mesh, course),
        Format::Threemf => threemf::write_new(mesh, course),
        Format::Usdz => usdz::write_new(mesh, course),
    }
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

    /// The file that `save` requests. If nothing moved and the format is the same, these are the bytes that were read.
    ///
    /// # Errors
    /// An edit that the format can't hold; [`SaveError::Cancelled`] soon after `cancel` is raised.
    pub fn save(&self, save: &Save<'_>, progress: &Progress, cancel: &Cancel) -> Result<Saved, SaveError> {
        let saved = self.save_parted(save, Parting::ByName, &Course::new(progress, cancel))?;
        progress.set(1.0);
        Ok(saved)
    }

    fn save_parted(&self, save: &Save<'_>, parting: Parting, course: &Course<'_>) -> Result<Saved, SaveError> {
        course.reach(0, 1)?;
        let moved = Moved::of(save.drawn, save.positions, save.turned, save.format)?;
        let own = |(bytes, warnings)| Saved::alone(save.name, bytes, warnings);
        match (&self.stored, save.format) {
            (Stored::Gltf(stored), Format::Glb | Format::Gltf) => stored.save(save, &moved, course),
            (Stored::Obj(stored), Format::Obj) if save.placement == Placement::OtherFolder => {
                let unchanged = moved.is_nothing().then(|| (self.bytes.to_vec(), Vec::new()));
                let saved = own(unchanged.map_or_else(|| stored.write(&moved, course), Ok)?);
                Ok(with_neighbours(saved, stored.neighbours()))
            }
            (Stored::Ply(stored), Format::Ply) if save.placement == Placement::OtherFolder => {
                let unchanged = moved.is_nothing().then(|| (self.bytes.to_vec(), Vec::new()));
                let saved = own(unchanged.map_or_else(|| stored.write(&moved, course), Ok)?);
                Ok(with_neighbours(saved, stored.neighbours()))
            }
            (_, format) if format == self.format && moved.is_nothing() => Ok(own((self.bytes.to_vec(), Vec::new()))),
            (Stored::Obj(stored), Format::Obj) => stored.write(&moved, course).map(own),
            (Stored::Ply(stored), Format::Ply) => stored.write(&moved, course).map(own),
            (Stored::Stl(stored), Format::Stl) => stored.write(&moved, course).map(own),
            (Stored::Off(stored), Format::Off) => stored.write(&moved, course).map(own),
            (Stored::Threemf(stored), Format::Threemf) => stored.write(&moved, course).map(own),
            (Stored::Usdz(stored), Format::Usdz) => stored.write(&moved, course).map(own),
            (_, format) => self.converted(&moved, self.appearance(), save, (format, parting), course),
        }
    }

    /// Returns true if a save in this format patches the file, and does not convert it.
    pub fn is_of_kind(&self, format: Format) -> bool {
        let is_gltf = |format| matches!(format, Format::Glb | Format::Gltf);
        self.format() == format || (is_gltf(self.format()) && is_gltf(format))
    }

    /// Returns true if a save in this format can have other colours of vertices: not STL, and not the file's own 3MF
    /// or USDZ, whose colours other data of the file may name, too.
    pub fn takes_colours(&self, format: Format) -> bool {
        let shares = matches!(format, Format::Threemf | Format::Usdz) && self.is_of_kind(format);
        format != Format::Stl && !shares
    }

    /// The file with other vertex colours: linear, from 0 to 65535, one for each drawn vertex. In the file's own format
    /// ([`Self::is_of_kind`]) only colours are added or replaced: `COLOR_0` in 16 bits in glTF, beside textures, sRGB
    /// bytes elsewhere. The shape then stays as in the file, so `save.positions` must be those at rest, and nothing may
    /// be turned.
    ///
    /// # Errors
    /// A wrong number of colours; a format without colours of vertices; [`SaveError::Cancelled`] soon after `cancel` is
    /// raised.
    pub fn save_with_colours(
        &self,
        save: &Save<'_>,
        colours: &[[u16; 4]],
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Saved, SaveError> {
        let saved = self.coloured(save, colours, &Course::new(progress, cancel))?;
        progress.set(1.0);
        Ok(saved)
    }

    fn coloured(&self, save: &Save<'_>, colours: &[[u16; 4]], course: &Course<'_>) -> Result<Saved, SaveError> {
        course.reach(0, 1)?;
        let moved = Moved::of(save.drawn, save.positions, save.turned, save.format)?;
        let moves_patched = self.is_of_kind(save.format) && !moved.is_nothing();
        if colours.len() != save.drawn.positions.len() || moves_patched {
            return Err(SaveError::OtherScene {
                given: colours.len(),
                wanted: save.drawn.positions.len(),
            });
        }
        let of_file = || colours_of_file(save.drawn, colours);
        let (bytes, neighbours) = match (&self.stored, save.format) {
            (Stored::Gltf(stored), Format::Glb | Format::Gltf) => {
                return stored.save_with_colours(save, colours, course);
            }
            (_, Format::Stl) => return Err(SaveError::without_colours()),
            (Stored::Threemf(_), Format::Threemf) | (Stored::Usdz(_), Format::Usdz) => {
                return Err(SaveError::without_new_colours(save.format));
            }
            (Stored::Obj(stored), Format::Obj) => (stored.write_coloured(&of_file()), stored.neighbours()),
            (Stored::Ply(stored), Format::Ply) => (stored.write_coloured(&of_file())?, stored.neighbours()),
            (Stored::Off(stored), Format::Off) => (stored.write_coloured(&of_file()), (Vec::new(), Vec::new())),
            (_, format) => {
                let appearance = Appearance {
                    colours: Some(colours.to_vec()),
                    ..self.appearance()
                };
                return self.converted(&moved, appearance, save, (format, Parting::ByName), course);
            }
        };
        let saved = Saved::alone(save.name, bytes, Vec::new());
        Ok(match save.placement {
            Placement::OtherFolder => with_neighbours(saved, neighbours),
            Placement::SameFile | Placement::SameFolder => saved,
        })
    }

    /// The shape with `appearance` as a new file of another format.
    fn converted(
        &self,
        moved: &Moved<'_>,
        appearance: Appearance,
        save: &Save<'_>,
        (format, parting): (Format, Parting),
        course: &Course<'_>,
    ) -> Result<Saved, SaveError> {
        let has_normals = appearance.normals.is_some() && !moved.moves_nothing();
        let (of_looks, course) = course.split(if has_normals { 0.4 } else { 0.0 });
        let mesh = NewMesh::of(moved, appearance, save.name, self.polygons(), parting, &of_looks)?;
        let mut saved = write_new(&mesh, format, &course)?;
        saved.warnings.extend(self.motion_lost(format));
        saved.warnings.extend(self.unread_lost(format));
        if let Stored::Obj(stored) = &self.stored {
            saved.warnings.extend(stored.materials_lost(&format.to_string()));
        }
        Ok(saved)
    }

    /// The file with the edit as a morph target: the shape stays, and the displacements to `save.positions` are added
    /// to each edited mesh. Only glTF has morph targets, so a file of another format is converted to glTF first, with
    /// its vertices at rest.
    ///
    /// # Errors
    /// Same as [`Self::save`].
    pub fn save_as_morph(
        &self,
        save: &Save<'_>,
        target: &MorphTarget<'_>,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Saved, SaveError> {
        let saved = self.with_morph(save, target, &Course::new(progress, cancel))?;
        progress.set(1.0);
        Ok(saved)
    }

    /// The file with an animation of morph targets: the shape stays at rest. Like [`Self::save_as_morph`] in
    /// everything else. `save.positions` must be those at rest. Without a target the file stays as it is.
    ///
    /// # Errors
    /// Same as [`Self::save`].
    pub fn save_as_animation(
        &self,
        save: &Save<'_>,
        animation: &MorphAnimation<'_>,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Saved, SaveError> {
        let saved = self.with_animation(save, animation, &Course::new(progress, cancel))?;
        progress.set(1.0);
        Ok(saved)
    }

    fn with_animation(
        &self,
        save: &Save<'_>,
        animation: &MorphAnimation<'_>,
        course: &Course<'_>,
    ) -> Result<Saved, SaveError> {
        course.reach(0, 1)?;
        check_holds_targets(save.format)?;
        let moved = Moved::of(save.drawn, save.positions, save.turned, save.format)?;
        let wanted = save.drawn.positions.len();
        let wrong = animation.targets.iter().find(|target| target.len() != wanted);
        if let (Some(given), _) | (None, Some(given)) =
            (wrong.map(Vec::len), (!moved.moves_nothing()).then_some(wanted))
        {
            return Err(SaveError::OtherScene { given, wanted });
        }
        if let Stored::Gltf(stored) = &self.stored
            && !moved.turns_any()
        {
            return stored.save_as_animation(save, &moved, animation, course);
        }
        let (of_rest, course) = course.split(0.3);
        let AtRest { written, rest } = self.at_rest(save, &of_rest)?;
        let in_gltf = Save {
            drawn: &written.drawn,
            positions: &written.drawn.positions,
            turned: &[],
            placement: Placement::OtherFolder,
            ..*save
        };
        let saved = written.scene.with_animation(&in_gltf, animation, &course)?;
        Ok(rest.before(saved))
    }

    fn with_morph(&self, save: &Save<'_>, target: &MorphTarget<'_>, course: &Course<'_>) -> Result<Saved, SaveError> {
        course.reach(0, 1)?;
        check_holds_targets(save.format)?;
        let moved = Moved::of(save.drawn, save.positions, save.turned, save.format)?;
        if let Stored::Gltf(stored) = &self.stored
            && !moved.turns_any()
        {
            return stored.save_as_morph(save, &moved, target, course);
        }
        let (of_rest, course) = course.split(0.6);
        let AtRest { written, rest } = self.at_rest(save, &of_rest)?;
        // The written positions were rounded to f32, so the displacements are applied to those.
        let ways = save.drawn.positions.iter().zip(save.positions);
        let positions: Vec<DVec3> = (written.drawn.positions.iter().zip(ways))
            .map(|(&written, (&rest, &new))| {
                if bit_equal(rest, new) {
                    written
                } else {
                    written + (new - rest)
                }
            })
            .collect();
        let in_gltf = Save {
            drawn: &written.drawn,
            positions: &positions,
            turned: &[],
            placement: Placement::OtherFolder,
            ..*save
        };
        let saved = written.scene.with_morph(&in_gltf, target, &course)?;
        Ok(rest.before(saved))
    }

    /// The shape at rest as a glTF whose vertices are the drawn ones, read back.
    fn at_rest(&self, save: &Save<'_>, course: &Course<'_>) -> Result<AtRest, SaveError> {
        // With `Parting::Joined` the written vertices are the drawn ones. A GLB contains all of its neighbours.
        let at_rest = Save {
            positions: &save.drawn.positions,
            format: match self.stored {
                Stored::Gltf(_) => Format::Glb,
                _ => save.format,
            },
            ..*save
        };
        let (of_rest, of_reading) = course.split(0.7);
        let rest = self.save_parted(&at_rest, Parting::Joined, &of_rest)?;
        let fault = |what: String| SaveError::CannotHold {
            what,
            format: save.format,
            remedy: "this is a fault of the program: report it with the file".to_owned(),
        };
        let file = rest.files[0].bytes.clone();
        let written = read(
            file,
            at_rest.format,
            save.name,
            &rest,
            &of_reading.progress,
            course.cancel,
        );
        let written = written.map_err(|error| match error {
            ReadError::Cancelled(cancelled) => SaveError::Cancelled(cancelled),
            error => fault(error.to_string()),
        })?;
        if written.drawn.positions.len() != save.positions.len() {
            return Err(fault("a shape whose vertices are not all saved".to_owned()));
        }
        Ok(AtRest { written, rest })
    }

    /// Sentences about the data of this file that a new file of the format can't have when vertices and triangles
    /// differ from the file's: skins, animations, morph targets, data that only this file's format names. The file is
    /// made with [`Self::appearance_with_originals`]; `has_own_names` says whether an OBJ keeps its libraries.
    pub fn lost_in_new_shape(&self, format: Format, has_own_names: bool) -> Vec<String> {
        let summary = self.summary();
        let motion = [
            ("skins", summary.skins > 0),
            ("animations", summary.animations > 0),
            ("morph targets", summary.morph_targets > 0),
        ];
        let motion: Vec<&str> = motion.iter().filter(|(_, has)| *has).map(|(name, _)| *name).collect();
        let motion = (!motion.is_empty()).then(|| {
            let list = motion.join(" and ");
            format!("A new shape can't keep the file's {list}, which belong to its old vertices.")
        });
        let unread = match &self.stored {
            Stored::Gltf(stored) => {
                let kept = match format {
                    Format::Glb | Format::Gltf => MaterialsKept::AsWritten,
                    _ => MaterialsKept::AsDrawn,
                };
                let list = stored.unread(kept);
                let own = self.format.extension();
                let sentence = || {
                    format!(
                        "The new shape leaves out {}: keep the .{own} for them.",
                        list.join(", ")
                    )
                };
                (!list.is_empty()).then(sentence)
            }
            _ => self.unread_lost(format),
        };
        let materials = match &self.stored {
            Stored::Obj(stored) if !has_own_names => stored.materials_lost(&format.to_string()),
            _ => None,
        };
        let smoothing = match &self.stored {
            Stored::Obj(stored) => stored.smoothing_lost(),
            _ => None,
        };
        [motion, unread, materials, smoothing].into_iter().flatten().collect()
    }

    /// A warning about parts of the file that other formats do not get.
    fn unread_lost(&self, format: Format) -> Option<String> {
        let unread = match &self.stored {
            Stored::Ply(stored) => stored.unread(),
            Stored::Stl(stored) => stored.unread(),
            Stored::Off(stored) => stored.unread(),
            Stored::Gltf(_) | Stored::Obj(_) | Stored::Threemf(_) | Stored::Usdz(_) => Vec::new(),
        };
        let own = self.format.extension();
        (!unread.is_empty()).then(|| {
            format!(
                "{format} output leaves out {}: keep the .{own} for them.",
                unread.join(", ")
            )
        })
    }

    /// A warning about skins, animations and morph targets, which only glTF holds.
    fn motion_lost(&self, format: Format) -> Option<String> {
        let summary = self.summary();
        let motion = [
            ("skins", lost_where(summary.skins > 0)),
            ("animations", lost_where(summary.animations > 0)),
            ("morph targets", lost_where(summary.morph_targets > 0)),
        ];
        lost(&format.to_string(), &motion)
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
