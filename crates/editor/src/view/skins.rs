//! The ghosts of other moments around the shown one: a person's choice, not part of the document.

use crate::document::Animation;

/// The vertices of all ghosts together. Each takes about 130 bytes, of shapes and of buffers on the device (measured on a
/// surface of 43,000 vertices); its picture, which has the view's size, comes on top.
const MOST_VERTICES: usize = 4_000_000;

/// The ghosts before and after the shown moment of an animation.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub struct Skins {
    /// True if they are shown.
    pub shown: bool,
    /// The number of them before the moment, at most [`Skins::MOST`].
    pub before: u8,
    /// The number of them after it, at most [`Skins::MOST`].
    pub after: u8,
    /// The frames from one to the next, at least 1.
    pub spacing: u16,
    /// The colours of those before and after, sRGB.
    pub colours: [[u8; 3]; 2],
}

impl Default for Skins {
    fn default() -> Self {
        Self {
            shown: false,
            before: 2,
            after: 2,
            spacing: 4,
            colours: [[88, 150, 255], [255, 132, 84]],
        }
    }
}

impl Skins {
    /// The largest number of ghosts on one side.
    pub const MOST: u8 = 8;

    /// Returns true if every number is in its range.
    pub(crate) fn are_usable(&self) -> bool {
        self.before <= Self::MOST && self.after <= Self::MOST && self.spacing > 0
    }

    /// The moments of the ghosts in seconds, each with its place: -1 is the nearest before the shown moment, 1 the
    /// nearest after it. None lies outside the keys, and there are at most [`Skins::most_on`] the mesh.
    pub(crate) fn moments(&self, animation: &Animation, vertices: usize) -> Vec<(i8, f64)> {
        if !self.shown {
            return Vec::new();
        }
        let frame = animation.frame_at(animation.time());
        let spacing = f64::from(self.spacing);
        let range = 0.0..=animation.duration();
        // Rounding loses neither the first nor the last frame.
        let is_within =
            |time: f64| range.contains(&time) || range.contains(&(time - 1e-9)) || range.contains(&(time + 1e-9));
        let moments = self.places().into_iter();
        let moments = moments.map(|place| (place, (frame + f64::from(place) * spacing) / animation.fps()));
        let mut moments: Vec<(i8, f64)> = moments
            .filter(|(_, time)| is_within(*time))
            .take(Self::most_on(vertices))
            .collect();
        moments.sort_by_key(|(place, _)| *place);
        moments
    }

    /// The places of all ghosts, the nearest ones first.
    fn places(&self) -> Vec<i8> {
        let [before, after] = [self.before, self.after].map(|count| count.min(Self::MOST) as i8);
        let mut places: Vec<i8> = (-before..=after).filter(|place| *place != 0).collect();
        places.sort_by_key(|place| (place.unsigned_abs(), *place));
        places
    }

    /// The number of ghosts that a mesh of so many vertices may have, at least one: each has its own shape, and its own
    /// buffers on the device, so their number bounds the memory.
    pub fn most_on(vertices: usize) -> usize {
        (MOST_VERTICES / vertices.max(1)).max(1)
    }
}
