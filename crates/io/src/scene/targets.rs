//! Saves edits as morph targets and as animations of them, which leave the shape at rest.

use glam::DVec3;
use pliant_mesh::{Cancel, Progress};

use crate::convert::Parting;
use crate::save::bits::bit_equal;
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::save::{MorphAnimation, MorphTarget, Placement, Save, Saved};
use crate::scene::reading::{SceneAndDrawn, read};
use crate::scene::stored::{Scene, Stored};
use crate::source::Resolver;
use crate::{Bytes, Format, ReadError, SaveError};

impl Scene {
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
