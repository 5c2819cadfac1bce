//! The lines between regions: around each handle, and between the free region and the fixed part.

use pliant_deform::Role;
use pliant_mesh::{ContourLine, Surface, contours};

use crate::document::HandleId;

/// The region that a line on the surface bounds.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum Rim {
    /// A handle's region.
    Handle(HandleId),
    /// The fixed part, at the border of the free region.
    Held,
}

const FREE: u16 = 0;
const HELD: u16 = 1;
const FIRST_HANDLE: u16 = 2;

/// The region that a line of this label bounds, given the handles in the roles' order; `None` for one that no longer
/// exists.
pub(crate) fn bounded(label: u16, handles: &[HandleId]) -> Option<Rim> {
    match label.checked_sub(FIRST_HANDLE) {
        None => Some(Rim::Held),
        Some(index) => handles.get(usize::from(index)).copied().map(Rim::Handle),
    }
}

/// The lines between roles; between a handle and another region the line is the handle's.
pub(crate) fn rims(surface: &Surface, roles: &[Role]) -> Vec<ContourLine> {
    let label = |role: &Role| match *role {
        Role::Free => FREE,
        Role::Fixed => HELD,
        Role::Handle(index) => FIRST_HANDLE.saturating_add(index),
    };
    let labels: Vec<u16> = roles.iter().map(label).collect();
    contours(surface, &labels)
}
