//! The animation of a sequence: its keys are at frames, of which one is shown.

use std::sync::Arc;

use super::animation::Animation;

impl Animation {
    /// The same keys for the frames of a sequence, of which one is shown.
    pub(crate) fn of_sequence(&self, count: usize) -> Self {
        let mut animation = Self {
            frames: Some(count.max(1)),
            ..self.clone()
        };
        animation.tidy_spans();
        animation.at_frame(self.frame_at(self.time).round() as usize)
    }

    /// The number of frames of the sequence that is edited; `None` for an edit of one shape.
    pub fn frames(&self) -> Option<usize> {
        self.frames
    }

    /// The shown frame of a sequence, from 0.
    pub fn frame(&self) -> usize {
        self.frame_at(self.time).round() as usize
    }

    /// The same animation at another frame, or at the last one if there are fewer.
    pub(crate) fn at_frame(&self, frame: usize) -> Self {
        let last = self.frames.map_or(frame, |count| count - 1);
        Self {
            time: frame.min(last) as f64 / self.fps,
            ..self.clone()
        }
    }

    /// The same animation with other frames a second. Keys keep their times, and those of a sequence their frames.
    pub(crate) fn with_fps(&self, fps: f64) -> Self {
        let mut animation = Self { fps, ..self.clone() };
        if self.frames.is_some() {
            let moved = |time: f64| self.frame_at(time).round() / fps;
            animation.time = moved(self.time);
            for key in Arc::make_mut(&mut animation.keys) {
                key.time = moved(key.time);
            }
        }
        animation
    }
}
