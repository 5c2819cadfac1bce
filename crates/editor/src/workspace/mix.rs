//! Another sequence that leads handles of the open one: the places in the shown frame are asked for, and the frame is shown
//! when they were read.

use glam::DVec3;

use super::state::Workspace;
use crate::document::{Aspect, HandleMix};
use crate::timeline::places_of_handles;

/// The sequence that leads handles, or none.
pub(crate) fn set_mix(workspace: &mut Workspace, mix: Option<HandleMix>) {
    workspace.step("Mix", |workspace| {
        let animation = workspace.document.animation().with_mix(mix);
        workspace.document.set_animation(animation);
        workspace.frames.mix.try_again();
        workspace.pose_frame();
    });
}

impl Workspace {
    /// The other sequence and the frame of it that must be read next; `None` if there is none.
    pub(crate) fn mix_to_read(&self) -> Option<(&str, usize)> {
        let frame = self.frames.wanted.or(self.frames.skins.asked_of_mix())?;
        let mix = self.document.animation().mix()?;
        self.awaits_mix(frame).then_some((&*mix.sequence, frame))
    }

    /// Returns true if the places of led handles in a frame must be read first.
    pub(super) fn awaits_mix(&self, frame: usize) -> bool {
        let animation = self.document.animation();
        let paint = self.document.versions().of(Aspect::Paint);
        let is_sequence = animation.frames().is_some();
        is_sequence
            && animation
                .mix()
                .is_some_and(|mix| self.frames.mix.awaits(frame, paint, mix))
    }

    /// Takes a frame of another sequence: the displacements of the surface from the file's, or the reason why there are
    /// none.
    pub(crate) fn take_mix_frame(&mut self, sequence: &str, frame: usize, shape: Result<&[DVec3], String>) {
        let document = &self.document;
        let Some(mix) = document.animation().mix().filter(|mix| mix.sequence == sequence) else {
            return;
        };
        match (shape, self.model()) {
            (Ok(shape), Some(model)) if shape.len() == document.rest().len() => {
                let places = places_of_handles(document.paint(), &model.surface.positions, shape);
                let of = (document.versions().of(Aspect::Paint), &**mix);
                self.frames.mix.take(frame, places, of);
            }
            (Ok(_), _) => {}
            (Err(sentence), _) => {
                self.frames.mix.fail();
                self.pause_keys();
                self.refuse(sentence);
            }
        }
    }
}
