//! Revisions of the colours on the surface, and of the lines between regions: a changed revision means a new upload.

use std::sync::Arc;

use pliant_mesh::{Joint, SurfaceVertex};

use super::dirty_colours::DirtyColours;
use crate::document::{HandleId, Repainted, Version};
use crate::revision::Revision;

/// The meaning of the surface's colours.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) enum ColouredBy {
    /// The role of each vertex.
    #[default]
    Region,
    /// The painted stiffness.
    Stiffness,
    /// The dye alone.
    Dye,
}

/// The sources of the regions' colours and of the lines between them, except paint and stiffness.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) struct Sources {
    /// The look of handles.
    pub(super) appearance: Version,
    /// The shown parts.
    pub(super) access: Version,
    /// The last measured region.
    pub(super) roles: Revision,
    pub(super) by: ColouredBy,
    /// The revision of the playing flow's colours.
    pub(super) flow: u64,
    pub(super) selected: Option<HandleId>,
}

/// The revisions of the regions' colours and of the lines between them.
#[derive(Debug, Default)]
pub(crate) struct Colours {
    /// Grows when a vertex changes its colour.
    regions_revision: u64,
    /// Grows when the lines have changed, or the regions that they separate.
    rims_revision: u64,
    dirty: DirtyColours,
    sources: Sources,
    /// The highlighted connected part, by its component's number.
    lit: Option<u32>,
    /// The joint of the limb that a press would turn.
    turning: Option<Arc<Joint>>,
}

impl Colours {
    pub(crate) fn regions_revision(&self) -> u64 {
        self.regions_revision
    }

    pub(crate) fn rims_revision(&self) -> u64 {
        self.rims_revision
    }

    /// The colours of `by` are now shown.
    pub(crate) fn by(&self) -> ColouredBy {
        self.sources.by
    }

    /// The highlighted connected part.
    pub(crate) fn lit(&self) -> Option<u32> {
        self.lit
    }

    /// Highlights another part, or none; `vertices` are those of the last one and of this one.
    pub(super) fn light(&mut self, part: Option<u32>, vertices: &[SurfaceVertex]) {
        self.lit = part;
        self.dirty.add(vertices);
    }

    /// The joint of the limb that a press would turn.
    pub(crate) fn turning(&self) -> Option<&Arc<Joint>> {
        self.turning.as_ref()
    }

    /// Tints another limb, or none.
    pub(super) fn tint_limb(&mut self, joint: Option<Arc<Joint>>) {
        let before = std::mem::replace(&mut self.turning, joint);
        for joint in before.iter().chain(&self.turning) {
            self.dirty.add(&joint.limb);
        }
    }

    /// The vertices whose colour may have changed since a revision; `None` is all of them.
    pub(crate) fn since(&self, regions_revision: u64) -> Option<&[SurfaceVertex]> {
        self.dirty.since(regions_revision)
    }

    /// Everything has changed, and nothing is highlighted.
    pub(super) fn change_all(&mut self) {
        (self.lit, self.turning) = (None, None);
        self.regions_revision += 1;
        self.dirty.whole(self.regions_revision);
        self.rims_revision += 1;
    }

    /// Follows the sources of colours and lines.
    pub(super) fn follow(&mut self, sources: Sources, repainted: Repainted) {
        let before = std::mem::replace(&mut self.sources, sources);
        let line_sources = |s: &Sources| (s.appearance, s.access, s.roles, s.selected);
        if line_sources(&before) != line_sources(&sources) {
            self.rims_revision += 1;
        }
        let colour_sources = |s: &Sources| (s.appearance, s.roles, s.by, s.flow);
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
