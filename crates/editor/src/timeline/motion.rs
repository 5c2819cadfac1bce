//! All handles over time.

use glam::DAffine3;

use super::track::Track;

/// The handles' motions of an edit with keys.
#[derive(Clone, PartialEq, Debug)]
pub struct Timeline {
    /// A track for each handle; those without keys have none.
    tracks: Vec<Track>,
    /// The time of the last key, in seconds.
    duration: f64,
}

impl Timeline {
    pub(crate) fn new(tracks: Vec<Track>, duration: f64) -> Self {
        Self { tracks, duration }
    }

    /// The time of the last key, in seconds.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Returns true if the handle at this place of the list has a key.
    pub(crate) fn is_keyed(&self, place: usize) -> bool {
        self.tracks.get(place).is_some_and(|track| track.at(0.0).is_some())
    }

    /// The handles' maps at a time in seconds. `own` are the maps of handles without keys.
    pub(crate) fn maps_at(&self, time: f64, own: Vec<DAffine3>) -> Vec<DAffine3> {
        let tracks = self.tracks.iter();
        tracks
            .zip(own)
            .map(|(track, own)| track.at(time).map_or(own, |transform| transform.affine()))
            .collect()
    }
}
