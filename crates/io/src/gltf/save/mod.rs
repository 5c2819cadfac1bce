//! Saving a glTF: moved vertices become changes, the changes become a patch, and the patch is delivered as files.

mod accessors;
mod changes;
mod colours;
mod copy_on_write;
mod deliver;
mod elsewhere;
mod morph;
mod overlap;
mod pack;
mod patch;
mod target_turns;
mod turned;
mod turned_targets;
mod turned_triangles;
mod unpack;
mod unpack_copies;

use super::Stored;
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::save::{MorphAnimation, MorphDeltas, MorphTarget, Save, Saved};
use crate::{Format, SaveError};
use patch::Patched;

impl Stored {
    /// The file as GLB or `.gltf`, with the moved vertices' numbers replaced.
    pub fn save(&self, save: &Save<'_>, moved: &Moved<'_>, course: &Course<'_>) -> Result<Saved, SaveError> {
        let Self {
            document,
            meshes,
            pieces,
            ..
        } = self;
        let patched = if moved.is_nothing() {
            Patched::unchanged(document)
        } else {
            let changes = changes::changes(document, meshes, pieces, moved, save.deltas, &course.part(0.0, 0.8))?;
            let turned = turned_triangles::turned(pieces, moved);
            let course = course.part(0.8, 0.9);
            accessors::with_changes(document, meshes, pieces, (&changes, &turned), save.format, &course)?
        };
        course.reach(9, 10)?;
        self.deliver(patched, save)
    }

    /// The file as GLB or `.gltf`, with its shape unchanged and the displacements as one more morph target.
    pub fn save_as_morph(
        &self,
        save: &Save<'_>,
        moved: &Moved<'_>,
        target: &MorphTarget<'_>,
        course: &Course<'_>,
    ) -> Result<Saved, SaveError> {
        let Self {
            document,
            meshes,
            pieces,
            ..
        } = self;
        let mut patched = Patched::unchanged(document);
        if moved.is_nothing() {
            patched
                .warnings
                .push("Nothing moved, so no morph target was added.".to_owned());
        } else {
            let changes = changes::changes(
                document,
                meshes,
                pieces,
                moved,
                // The shape stays, and so do they.
                MorphDeltas::Stay,
                &course.part(0.0, 0.8),
            )?;
            let course = course.part(0.8, 0.9);
            patched = morph::with_target(document, meshes, pieces, &changes, target, save.format, &course)?;
        }
        course.reach(9, 10)?;
        self.deliver(patched, save)
    }

    /// The file as GLB or `.gltf`, with its shape unchanged and an animation of new morph targets.
    pub fn save_as_animation(
        &self,
        save: &Save<'_>,
        moved: &Moved<'_>,
        animation: &MorphAnimation<'_>,
        course: &Course<'_>,
    ) -> Result<Saved, SaveError> {
        let Self {
            document,
            meshes,
            pieces,
            ..
        } = self;
        let of_patch = course.part(0.0, 0.9);
        let patched = match animation.targets {
            [] => Patched::unchanged(document),
            _ => morph::with_animation(document, meshes, pieces, moved, animation, save.format, &of_patch)?,
        };
        course.reach(9, 10)?;
        self.deliver(patched, save)
    }

    /// The file as GLB or `.gltf` with other colours, one for each drawn vertex, and its shape unchanged.
    pub fn save_with_colours(
        &self,
        save: &Save<'_>,
        colours: &[[u16; 4]],
        course: &Course<'_>,
    ) -> Result<Saved, SaveError> {
        let Self {
            document,
            meshes,
            pieces,
            ..
        } = self;
        let old = self
            .appearance()
            .colours
            .unwrap_or_else(|| vec![[u16::MAX; 4]; colours.len()]);
        let patched = colours::with_colours(document, meshes, pieces, (&old, colours), save.format, course)?;
        self.deliver(patched, save)
    }

    fn deliver(&self, patched: Patched<'_>, save: &Save<'_>) -> Result<Saved, SaveError> {
        let document = &self.document;
        match (self.format, save.format) {
            (Format::Glb, Format::Gltf) => deliver::unpacked(document, patched, save),
            // A GLB with the name .gltf goes through `in_its_kind`, which keeps its container.
            (Format::Gltf, Format::Glb) if document.container.is_none() => pack::packed(document, patched, save),
            _ => deliver::in_its_kind(document, patched, save),
        }
    }
}
