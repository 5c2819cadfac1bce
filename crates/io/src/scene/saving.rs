//! Saves a moved shape: in its own format only the moved vertices' numbers change, in another one it is a new file.

use pliant_mesh::{Cancel, Progress};

use crate::convert::{NewMesh, Parting};
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::save::{OutputFile, Placement, Save, Saved};
use crate::scene::stored::{Scene, Stored};
use crate::scene::writing::write_new;
use crate::{Appearance, Format, SaveError};

impl Scene {
    /// The file that `save` requests. If nothing moved and the format is the same, these are the bytes that were read.
    ///
    /// # Errors
    /// An edit that the format can't hold; [`SaveError::Cancelled`] soon after `cancel` is raised.
    pub fn save(&self, save: &Save<'_>, progress: &Progress, cancel: &Cancel) -> Result<Saved, SaveError> {
        let saved = self.save_parted(save, Parting::ByName, &Course::new(progress, cancel))?;
        progress.set(1.0);
        Ok(saved)
    }

    pub(super) fn save_parted(
        &self,
        save: &Save<'_>,
        parting: Parting,
        course: &Course<'_>,
    ) -> Result<Saved, SaveError> {
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

    /// The shape with `appearance` as a new file of another format.
    pub(super) fn converted(
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
}

/// A save with the neighbours that its file needs.
pub(super) fn with_neighbours(mut saved: Saved, (files, warnings): (Vec<OutputFile>, Vec<String>)) -> Saved {
    saved.files.extend(files);
    saved.warnings.extend(warnings);
    saved
}
