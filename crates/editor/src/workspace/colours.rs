//! The colours of regions and handles on the surface, and the lines between them.

use pliant_deform::Role;
use pliant_mesh::{ContourLine, SurfaceVertex};

use super::dirty_colours::DirtyColours;
use super::state::Workspace;
use crate::document::{HandleId, Paint, Repainted, Version};
use crate::jobs::{Revision, Rim, bounded};

/// The colour of a stiffness, sRGB with alpha: blue where it gives way (0.001), grey at 1, red where it is firm (1000).
pub fn stiffness_colour(stiffness: f64) -> [u8; 4] {
    const SOFT: [f64; 3] = [58.0, 118.0, 214.0];
    const PLAIN: [f64; 3] = [196.0, 196.0, 192.0];
    const FIRM: [f64; 3] = [206.0, 66.0, 44.0];
    let decades = stiffness.max(f64::MIN_POSITIVE).log10() / 3.0;
    // What is near 1 is told apart, too.
    let share = decades.abs().min(1.0).sqrt();
    let end = if decades < 0.0 { SOFT } else { FIRM };
    let [r, g, b] = std::array::from_fn(|i| (PLAIN[i] + (end[i] - PLAIN[i]) * share).round() as u8);
    [r, g, b, 255]
}

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

    /// The vertices whose colour may have changed since a revision; `None`: all of them.
    pub(crate) fn since(&self, regions_revision: u64) -> Option<&[SurfaceVertex]> {
        self.dirty.since(regions_revision)
    }

    /// Everything is another.
    pub(super) fn change_all(&mut self) {
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

/// What tells the colour of a vertex, sRGB with alpha.
pub(crate) fn region_colour(workspace: &Workspace) -> impl Fn(SurfaceVertex) -> [u8; 4] {
    const FREE: [u8; 4] = [96, 150, 222, 255];
    // The clay or the material as it is: a share of any grey would wash it out.
    const STILL: [u8; 4] = [0; 4];
    const FIXED: [u8; 4] = [112, 112, 116, 255];
    let document = &workspace.document;
    let handles = document.handles();
    let largest = handles.iter().map(|handle| usize::from(handle.id.0) + 1).max();
    let mut of_handle = vec![STILL; largest.unwrap_or(0)];
    for handle in handles.iter().filter(|handle| handle.visible) {
        of_handle[usize::from(handle.id.0)] = handle.colour;
    }
    let by = workspace.colours.by();
    move |vertex| {
        if by == ColouredBy::Stiffness {
            return stiffness_colour(document.stiffness().map_or(1.0, |field| field[vertex.index()]));
        }
        match document.paint[vertex.index()] {
            Paint::Fixed => FIXED,
            Paint::Free => FREE,
            Paint::Handle(HandleId(id)) => of_handle.get(usize::from(id)).copied().unwrap_or(STILL),
            Paint::Bare => match workspace.computed().region.roles.get(vertex.index()) {
                Some(Role::Free) => FREE,
                _ => STILL,
            },
        }
    }
}

/// The lines between the regions as they were last measured, each with what it bounds; those of hidden handles and on
/// hidden triangles are left out.
pub(crate) fn rims(workspace: &Workspace) -> impl Iterator<Item = (&ContourLine, Rim)> {
    let region = &workspace.computed().region;
    let is_seen = |rim: &Rim| match rim {
        Rim::Held => true,
        Rim::Handle(id) => workspace.document.handle(*id).is_some_and(|handle| handle.visible),
    };
    let lines = region.rims.iter();
    let shown = lines.filter(|line| workspace.vertex_access.shows_triangle(line.triangle));
    shown.filter_map(move |line| Some((line, bounded(line.label, &region.handles).filter(is_seen)?)))
}
