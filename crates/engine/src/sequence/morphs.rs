//! The frames of a file's own animation of morph targets.

use std::path::Path;

use glam::DVec3;
use pliant_io::{MorphPlayback, PointCacheFormat, quoted};
use pliant_mesh::Model;

use super::frame_times::FrameTimes;
use crate::EngineError;
use crate::loading::Loaded;
use crate::path_text::shown;
use crate::watch::Watch;

/// The frames of an animation of morph targets, from its time 0 to its last key.
#[derive(Debug)]
pub(super) struct Morphs {
    playback: MorphPlayback,
    frames: FrameTimes,
    /// The first drawn vertex of each surface vertex.
    drawn_of_surface: Vec<usize>,
}

impl Morphs {
    /// The frames of a file's last animation of morph targets, at `fps` frames a second or, without it, such that every key
    /// of the animation is one.
    ///
    /// # Errors
    /// The file has none, or it can't be read; a rate that gives too many frames.
    pub fn of(file: &Loaded, fps: Option<f64>, watch: &Watch) -> Result<Self, EngineError> {
        let found = file.scene.morph_playback(&file.path.to_string_lossy(), &watch.cancel)?;
        let playback = found.ok_or_else(|| {
            let remedy = match file.scene.summary().animations {
                0 => "give a file that has one, a folder of frames, or a .pc2 or .mdd cache",
                _ => {
                    "its animations move joints or nodes, which `pliant apply` keeps while it edits the stored pose; to edit \
                     their frames, bake them to morph targets, numbered files or a .pc2 or .mdd cache"
                }
            };
            EngineError::Unsupported(format!(
                "{} has no animation of morph targets: {remedy}",
                shown(&file.path)
            ))
        })?;
        Ok(Self {
            frames: match fps {
                Some(fps) => FrameTimes::steady(playback.duration(), fps)?,
                None => FrameTimes::of_keys(playback.key_times())?,
            },
            drawn_of_surface: first_drawn(&file.model),
            playback,
        })
    }

    /// A sentence about the choice, if the file has several such animations, and about uneven keys.
    pub fn choice(&self) -> Option<String> {
        let (name, others) = (quoted(self.playback.name()), self.playback.others());
        let choice = (others > 0).then(|| {
            let count = others + 1;
            format!("the file has {count} animations of morph targets: the last one, {name}, is edited")
        });
        let uneven = (self.frames.uneven > 0).then(|| {
            let (count, fps) = (self.frames.uneven, self.frames.fps);
            format!("the animation has {count} keys at uneven times, which are frames beside those at {fps} a second")
        });
        match (choice, uneven) {
            (Some(choice), Some(uneven)) => Some(format!("{choice}; {uneven}")),
            (choice, uneven) => choice.or(uneven),
        }
    }

    /// The times of the frames, in seconds.
    pub fn times(&self) -> &[f64] {
        &self.frames.times
    }

    /// Returns true if each key's shape holds until the next.
    pub fn holds(&self) -> bool {
        self.playback.holds()
    }

    /// The frames a second, without those at uneven keys.
    pub fn fps(&self) -> f64 {
        self.frames.fps
    }

    /// Refuses a point cache of uneven frames.
    ///
    /// # Errors
    /// The frames' times are uneven.
    pub fn check_steady(&self, output: &Path) -> Result<(), EngineError> {
        match self.frames.uneven > 0 && PointCacheFormat::of_name(&output.to_string_lossy()).is_some() {
            true => Err(EngineError::Unsupported(format!(
                "the animation has keys at uneven times, but {} has one rate: give a rate with --fps, or a .glb",
                shown(output)
            ))),
            false => Ok(()),
        }
    }

    /// The number of frames.
    pub fn count(&self) -> usize {
        self.frames.times.len()
    }

    /// The displacements of `count` drawn vertices since rest in a frame.
    pub fn displacements(&self, frame: usize, count: usize) -> Vec<DVec3> {
        let mut displacements = vec![DVec3::ZERO; count];
        self.playback.displace(self.frames.times[frame], &mut displacements);
        displacements
    }

    /// The surface in a frame with these displacements of the drawn vertices, where a welded vertex goes with the first
    /// of its drawn ones.
    ///
    /// # Errors
    /// A vertex without a finite position.
    pub fn positions(&self, file: &Loaded, displacements: &[DVec3]) -> Result<Vec<DVec3>, EngineError> {
        let rest = &file.model.surface.positions;
        let moved = rest.iter().zip(&self.drawn_of_surface);
        let moved: Vec<DVec3> = moved.map(|(rest, drawn)| *rest + displacements[*drawn]).collect();
        match moved.iter().all(|position| position.is_finite()) {
            true => Ok(moved),
            false => Err(EngineError::Unsupported(format!(
                "{}: its animation moves a vertex beyond all numbers: repair its morph targets",
                shown(&file.path)
            ))),
        }
    }
}

fn first_drawn(model: &Model) -> Vec<usize> {
    let mut first = vec![None; model.surface.positions.len()];
    for (drawn, vertex) in model.drawn.surface_vertices().enumerate() {
        if let Some(vertex) = vertex {
            first[vertex.index()].get_or_insert(drawn);
        }
    }
    first.into_iter().map(Option::unwrap_or_default).collect()
}
