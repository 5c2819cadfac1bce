//! The lines that are drawn between regions: around each handle, and where the free region meets what is held.

use pliant_deform::Role;
use pliant_mesh::{ContourLine, Surface, contours};

use crate::document::HandleId;
use crate::editor::Editor;

/// What a line on the surface bounds.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum Rim {
    /// A handle's region.
    Handle(HandleId),
    /// What is held still, where the free region begins.
    Held,
}

const FREE: u16 = 0;
const HELD: u16 = 1;
const FIRST_HANDLE: u16 = 2;

/// The lines between roles; where a handle meets anything else the line is the handle's.
pub(crate) fn rims(surface: &Surface, roles: &[Role]) -> Vec<ContourLine> {
    let label = |role: &Role| match *role {
        Role::Free => FREE,
        Role::Fixed => HELD,
        Role::Handle(index) => FIRST_HANDLE.saturating_add(index),
    };
    let labels: Vec<u16> = roles.iter().map(label).collect();
    contours(surface, &labels)
}

impl Editor {
    /// The lines between the regions as they were last measured, each with what it bounds; those of hidden handles are
    /// left out. To be fetched again when [`SceneView::rims_revision`](crate::SceneView::rims_revision) has grown.
    pub fn rims(&self) -> impl Iterator<Item = (&ContourLine, Rim)> {
        let region = &self.engine.region;
        let of_label = |label: u16| match label.checked_sub(FIRST_HANDLE) {
            None => Some(Rim::Held),
            Some(index) => {
                let id = *region.handles.get(usize::from(index))?;
                let is_seen = self.document.handle(id).is_some_and(|handle| handle.visible);
                is_seen.then_some(Rim::Handle(id))
            }
        };
        let lines = region.rims.iter().filter(|line| self.is_triangle_shown(line.triangle));
        lines.filter_map(move |line| Some((line, of_label(line.label)?)))
    }
}
