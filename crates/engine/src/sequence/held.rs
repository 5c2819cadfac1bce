//! Handles that footprints hold in the frames of a sequence.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;
use pliant_editor::Footprints;
use pliant_mesh::{Drawn, SurfaceVertex};

use super::source::Source;
use crate::EngineError;
use crate::loading::Loaded;
use crate::watch::Watch;

/// A handle, by its number, and its footprints.
pub(super) struct Held {
    pub handle: usize,
    pub footprints: Footprints,
}

/// The shapes of handles with footprints in the frames by which others are held. They are read when a frame needs them:
/// those of all frames would not fit into memory.
pub(super) struct HeldShapes<'a> {
    source: &'a Source,
    mesh: (&'a Loaded, &'a Drawn),
    /// The vertices of each such handle.
    vertices: Vec<&'a [SurfaceVertex]>,
    /// The frames that were read last.
    kept: Mutex<VecDeque<(usize, Shapes)>>,
}

/// The positions of the vertices of each handle with footprints, in one frame.
pub(super) type Shapes = Arc<Vec<Vec<DVec3>>>;

impl<'a> HeldShapes<'a> {
    /// The shapes of these handles in the frames of a sequence on `mesh`.
    pub fn of(
        held: &[Held],
        handles: &'a [Vec<SurfaceVertex>],
        source: &'a Source,
        mesh: (&'a Loaded, &'a Drawn),
    ) -> Self {
        Self {
            source,
            mesh,
            vertices: held.iter().map(|own| &*handles[own.handle]).collect(),
            kept: Mutex::default(),
        }
    }

    /// The shapes where the surface is at `positions`.
    pub fn at(&self, positions: &[DVec3]) -> Shapes {
        let shape = |vertices: &&[SurfaceVertex]| vertices.iter().map(|vertex| positions[vertex.index()]).collect();
        Arc::new(self.vertices.iter().map(shape).collect())
    }

    /// The shapes in a frame.
    ///
    /// # Errors
    /// A frame that can't be read.
    pub fn in_frame(&self, frame: usize, watch: &Watch) -> Result<Shapes, EngineError> {
        let kept = || self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let known = kept()
            .iter()
            .find(|(own, _)| *own == frame)
            .map(|(_, shapes)| Arc::clone(shapes));
        if let Some(shapes) = known {
            return Ok(shapes);
        }
        // Two threads may read the same frame: neither waits for the other.
        let shapes = self.at(&self.source.positions(frame, self.mesh, watch)?);
        let mut kept = kept();
        // The middle of a footprint and its nearer end, for each frame that is solved beside others.
        while kept.len() >= 2 * rayon::current_num_threads().max(1) {
            kept.pop_front();
        }
        kept.push_back((frame, Arc::clone(&shapes)));
        Ok(shapes)
    }
}
