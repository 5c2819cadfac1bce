//! When the colours on the surface, and the lines between regions, are to be fetched again.

use pliant_mesh::SurfaceVertex;

use super::dirty_colours::DirtyColours;
use crate::document::{HandleId, Repainted, Version};
use crate::jobs::Revision;

/// What the surface's colours tell.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) enum ColouredBy {
    /// What each vertex does.
    #[default]
    Region,
    /// How stiff it was painted.
    Stiffness,
}

/// What the colours of regions and the lines between them are made from, but for paint and stiffness.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) struct Sources {
    /// How handles look.
    pub(super) appearance: Version,
    /// What is shown.
    pub(super) access: Version,
    /// The region that was measured last.
    pub(super) roles: Revision,
    pub(super) by: ColouredBy,
    pub(super) selected: Option<HandleId>,
}

/// The revisions of the regions' colours and of the lines between them.
#[derive(Debug, Default)]
pub(crate) struct Colours {
    /// Grows when a vertex has another colour.
    regions_revision: u64,
    /// Grows when the lines have changed, or what is told apart by them.
    rims_revision: u64,
    dirty: DirtyColours,
    sources: Sources,
    /// The connected part that is lit up, by its component's number.
    lit: Option<u32>,
}

impl Colours {
    pub(crate) fn regions_revision(&self) -> u64 {
        self.regions_revision
    }

    pub(crate) fn rims_revision(&self) -> u64 {
        self.rims_revision
    }

    /// The colour that `by` tells has become what is shown.
    pub(crate) fn by(&self) -> ColouredBy {
        self.sources.by
    }

    /// The connected part that is lit up.
    pub(crate) fn lit(&self) -> Option<u32> {
        self.lit
    }

    /// Lights up another part, or none; `vertices` are those of the one before and of this one.
    pub(super) fn light(&mut self, part: Option<u32>, vertices: &[SurfaceVertex]) {
        self.lit = part;
        self.dirty.add(vertices);
    }

    /// The vertices whose colour may have changed since a revision; `None`: all of them.
    pub(crate) fn since(&self, regions_revision: u64) -> Option<&[SurfaceVertex]> {
        self.dirty.since(regions_revision)
    }

    /// Everything is another, and nothing is lit up.
    pub(super) fn change_all(&mut self) {
        self.lit = None;
        self.regions_revision += 1;
        self.dirty.whole(self.regions_revision);
        self.rims_revision += 1;
    }

    /// Follows what colours and lines are made from.
    pub(super) fn follow(&mut self, sources: Sources, repainted: Repainted) {
        let before = std::mem::replace(&mut self.sources, sources);
        let line_sources = |s: &Sources| (s.appearance, s.access, s.roles, s.selected);
        if line_sources(&before) != line_sources(&sources) {
            self.rims_revision += 1;
        }
        let colour_sources = |s: &Sources| (s.appearance, s.roles, s.by);
        match repainted {
            Repainted::Vertices(vertices) if colour_sources(&before) == colour_sources(&sources) => {
                self.dirty.add(&vertices);
                if self.dirty.is_pending() {
                    self.regions_revision += 1;
                    self.dirty.part(self.regions_revision);
                }
            }
            _ => {
                self.regions_revision += 1;
                self.dirty.whole(self.regions_revision);
            }
        }
    }
}
