//! The times that the strip shows, and their places.

use std::ops::RangeInclusive;

use eframe::egui::{Context, Id, Rangef};
use pliant_editor::Animation;

/// The shortest stretch of time that the strip shows, in seconds.
const SHORTEST: f64 = 0.05;

/// The stretch that it shows at least, unless a person has chosen another.
const AT_LEAST: f64 = 2.0;

/// The stretch of time between the left and the right border.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct TimeScale {
    pub x: Rangef,
    /// In seconds.
    pub from: f64,
    pub to: f64,
}

impl TimeScale {
    /// The stretch that a person has chosen, or else all keys or frames with some room.
    pub fn of(context: &Context, animation: &Animation, x: Rangef) -> Self {
        let chosen: Option<(f64, f64)> = context.data(|data| data.get_temp(id()));
        let last = match animation.frames() {
            Some(_) => animation.duration().max(SHORTEST),
            None => animation.duration().max(animation.time()).max(AT_LEAST),
        };
        // The playhead at 0 does not touch the names.
        let (from, to) = chosen.unwrap_or((-0.03 * last, 1.08 * last));
        Self { x, from, to }
    }

    /// The place of a time.
    pub fn x_of(&self, time: f64) -> f32 {
        let share = (time - self.from) / (self.to - self.from);
        self.x.min + (share * f64::from(self.x.span())) as f32
    }

    /// The time at a place.
    pub fn time_of(&self, x: f32) -> f64 {
        let share = f64::from(x - self.x.min) / f64::from(self.x.span().max(1.0));
        self.from + share * (self.to - self.from)
    }

    /// The length of a way along the strip, in seconds.
    pub fn seconds_of(&self, way: f32) -> f64 {
        f64::from(way) / f64::from(self.x.span().max(1.0)) * (self.to - self.from)
    }

    /// Shows a longer (above 1) or shorter stretch around a time.
    pub fn zoom(&self, context: &Context, time: f64, factor: f64) {
        let shown = (self.to - self.from) * factor;
        if (SHORTEST..=Animation::LATEST).contains(&shown) {
            keep(
                context,
                (time + (self.from - time) * factor)..=(time + (self.to - time) * factor),
            );
        }
    }

    /// Shows a later stretch.
    pub fn pan(&self, context: &Context, seconds: f64) {
        let seconds = seconds.max(-0.1 * (self.to - self.from) - self.from);
        keep(context, (self.from + seconds)..=(self.to + seconds));
    }

    /// Shows all keys.
    pub fn fit(context: &Context) {
        context.data_mut(|data| data.remove::<(f64, f64)>(id()));
    }

    /// The distance of marks for a rate of frames, in frames: marks with numbers have room for them.
    pub fn frames_a_mark(&self, fps: f64) -> f64 {
        const ROOM: f64 = 56.0;
        let frames = self.seconds_of(1.0) * ROOM * fps;
        let mut step = 1.0;
        for factor in [2.0, 2.5, 2.0].into_iter().cycle() {
            if step >= frames {
                break;
            }
            step *= factor;
        }
        step.round()
    }
}

fn keep(context: &Context, stretch: RangeInclusive<f64>) {
    context.data_mut(|data| data.insert_temp(id(), (*stretch.start(), *stretch.end())));
}

fn id() -> Id {
    Id::unique("stretch of the timeline")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_times_are_inverse_and_marks_have_room() {
        for seconds in [0.1, 1.0, 2.0, 30.0, 4000.0] {
            let scale = TimeScale {
                x: Rangef::new(120.0, 900.0),
                from: -0.1,
                to: seconds,
            };
            for x in [120.0, 333.0, 900.0] {
                assert!((scale.x_of(scale.time_of(x)) - x).abs() < 1e-2);
            }
            let frames = scale.frames_a_mark(24.0);
            let apart = scale.x_of(frames / 24.0) - scale.x_of(0.0);
            assert!(
                frames >= 1.0 && frames.fract() == 0.0 && apart >= 55.0,
                "{seconds}: {frames} {apart}"
            );
        }
    }
}
