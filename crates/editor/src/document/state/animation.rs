//! The keys of the edit over time.

use super::Document;
use crate::document::animation::Animation;

impl Document {
    /// The edit over time.
    pub fn animation(&self) -> &Animation {
        &self.content.animation
    }

    /// Replaces the edit over time. Nothing moves.
    pub(crate) fn set_animation(&mut self, animation: Animation) {
        self.content.animation = animation;
    }

    pub(in crate::document) fn swap_animation(&mut self, animation: &mut Animation) {
        std::mem::swap(animation, &mut self.content.animation);
    }
}
