//! Actions on a painted region as a whole: grow, shrink, invert, fill, smooth its border, mirror it, give it another
//! role.
//!
//! Each is a pure function from the region's vertices to the vertices that change; other handles' vertices never do.

use pliant_mesh::{Model, SurfaceVertex};
use rayon::prelude::*;

use super::mirror::mirror;
use super::mirror_request::Purpose;
use super::painting::{members_of, name_of, repaint};
use super::state::Workspace;
use crate::document::{HandleId, Paint};

/// An action on the selected region: that of the tool, or of the selected handle.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum RegionAction {
    /// Adds the vertices around it.
    Grow,
    /// Removes the vertices at its border.
    Shrink,
    /// Inverts it.
    Invert,
    /// Fixes everything outside it, or frees it if the region is the fixed part.
    EverythingBut,
    /// Straightens its border.
    SmoothBorder,
    /// Adds all of every part of the surface that it touches.
    FillParts,
    /// Adds its mirror image across the plane through the model's middle, across axis 0, 1, 2 for x, y, z.
    Mirror(usize),
    /// Removes its paint.
    Clear,
    /// Makes it free to bend.
    ToFree,
    /// Fixes it.
    ToFixed,
    /// Makes it a separate handle.
    ToHandle,
}

impl RegionAction {
    /// Its name in the history, for the region of a role.
    fn name(self, role: Paint) -> &'static str {
        match self {
            Self::Grow => "Grow",
            Self::Shrink => "Shrink",
            Self::Invert => "Invert",
            Self::EverythingBut if role == Paint::Fixed => "Free all but",
            Self::EverythingBut => "Fix all but",
            Self::SmoothBorder => "Smooth border of",
            Self::FillParts => "Fill parts of",
            Self::Mirror(_) => "Mirror",
            Self::Clear => "Clear",
            Self::ToFree => "Make region of",
            Self::ToFixed => "Make fixed",
            Self::ToHandle => "Make handle of",
        }
    }
}

/// Changes the region of a role as a whole.
pub(crate) fn act_on_region(workspace: &mut Workspace, role: Paint, action: RegionAction) {
    let Some(model) = workspace.model().cloned() else {
        return;
    };
    let is_member = members_of(workspace, role);
    if !is_member.contains(&true) {
        workspace.refuse("Nothing is painted: paint a region first.");
        return;
    }
    let what = name_of(workspace, role);
    let removed = |vertex: usize| match role {
        // Otherwise vertices in a reach would be free again.
        Paint::Free if workspace.document.paint[vertex] == Paint::Bare => Paint::Fixed,
        _ => Paint::Bare,
    };
    let mut changes: Vec<(usize, Paint)> = Vec::new();
    let target = match action {
        RegionAction::Grow => {
            changes.extend(grown(&model, &is_member).into_iter().map(|vertex| (vertex, role)));
            role
        }
        RegionAction::Shrink => {
            changes.extend(
                rim(&model, &is_member)
                    .into_iter()
                    .map(|vertex| (vertex, removed(vertex))),
            );
            role
        }
        RegionAction::SmoothBorder => {
            for (vertex, joins) in smoothed(&model, &is_member) {
                changes.push((vertex, if joins { role } else { removed(vertex) }));
            }
            role
        }
        RegionAction::Invert => {
            for (vertex, &is_member) in is_member.iter().enumerate() {
                changes.push((vertex, if is_member { removed(vertex) } else { role }));
            }
            role
        }
        RegionAction::EverythingBut => {
            let other = if role == Paint::Fixed {
                Paint::Free
            } else {
                Paint::Fixed
            };
            changes.extend(
                (0..is_member.len())
                    .filter(|&vertex| !is_member[vertex])
                    .map(|vertex| (vertex, other)),
            );
            role
        }
        RegionAction::FillParts => {
            changes.extend(filled(&model, &is_member).map(|vertex| (vertex, role)));
            role
        }
        RegionAction::Mirror(axis) => return mirror(workspace, Purpose::Region(role), axis),
        RegionAction::Clear | RegionAction::ToFree | RegionAction::ToFixed | RegionAction::ToHandle => {
            let target = match action {
                RegionAction::Clear => Paint::Bare,
                RegionAction::ToFree => Paint::Free,
                RegionAction::ToFixed => Paint::Fixed,
                _ => Paint::Handle(HandleId(workspace.document.next_handle)),
            };
            changes.extend(
                (0..is_member.len())
                    .filter(|&vertex| is_member[vertex])
                    .map(|vertex| (vertex, target)),
            );
            target
        }
    };
    repaint(
        workspace,
        format!("{} {what}", action.name(role)),
        role,
        target,
        changes,
    );
}

/// Vertices beside members, ascending.
fn grown(model: &Model, is_member: &[bool]) -> Vec<usize> {
    border(model, is_member.len(), |vertex| !is_member[vertex])
}

/// Members beside other vertices, ascending.
fn rim(model: &Model, is_member: &[bool]) -> Vec<usize> {
    border(model, is_member.len(), |vertex| is_member[vertex])
}

/// Vertices inside that have a neighbour outside. Only the neighbours of the smaller of the two sets are checked.
fn border(model: &Model, count: usize, is_inside: impl Fn(usize) -> bool) -> Vec<usize> {
    let neighbours = |vertex: usize| model.topology.neighbours(SurfaceVertex(vertex as u32)).iter();
    let inside = (0..count).filter(|&vertex| is_inside(vertex));
    if 2 * inside.clone().count() <= count {
        return inside
            .filter(|&vertex| neighbours(vertex).any(|neighbour| !is_inside(neighbour.index())))
            .collect();
    }
    let mut is_beside = vec![false; count];
    for vertex in (0..count).filter(|&vertex| !is_inside(vertex)) {
        for neighbour in neighbours(vertex) {
            is_beside[neighbour.index()] = true;
        }
    }
    inside.filter(|&vertex| is_beside[vertex]).collect()
}

/// Vertices that differ from most of their neighbours, and whether they join the region.
fn smoothed(model: &Model, is_member: &[bool]) -> Vec<(usize, bool)> {
    (0..is_member.len())
        .into_par_iter()
        .with_min_len(1 << 12)
        .filter_map(|vertex| {
            let neighbours = model.topology.neighbours(SurfaceVertex(vertex as u32));
            let members = neighbours.iter().filter(|v| is_member[v.index()]).count();
            let joins = 2 * members > neighbours.len();
            let leaves = 2 * members < neighbours.len();
            ((joins && !is_member[vertex]) || (leaves && is_member[vertex])).then_some((vertex, joins))
        })
        .collect()
}

/// Every vertex of the parts with a member.
fn filled<'a>(model: &'a Model, is_member: &'a [bool]) -> impl Iterator<Item = usize> + 'a {
    let part = |vertex: usize| model.topology.component(SurfaceVertex(vertex as u32)) as usize;
    let mut has_member = vec![false; model.topology.components().len()];
    for vertex in (0..is_member.len()).filter(|&vertex| is_member[vertex]) {
        has_member[part(vertex)] = true;
    }
    (0..is_member.len()).filter(move |&vertex| has_member[part(vertex)])
}

#[cfg(test)]
mod tests {
    use pliant_mesh::{Cancel, Progress, WeldOptions, shapes};

    use super::*;

    #[test]
    fn a_border_is_found_from_either_side() -> Result<(), Box<dyn std::error::Error>> {
        let options = WeldOptions::default();
        let model = Model::weld(shapes::uv_sphere(24, 24), &options, &Progress::new(), &Cancel::new())?;
        let count = model.surface.positions.len();
        for members in [0, count / 5, count / 2, 4 * count / 5, count] {
            let is_inside = |vertex: usize| vertex * 7 % count < members;
            let is_outside_beside = |vertex: usize| {
                let neighbours = model.topology.neighbours(SurfaceVertex(vertex as u32));
                neighbours.iter().any(|neighbour| !is_inside(neighbour.index()))
            };
            let plain = (0..count).filter(|&vertex| is_inside(vertex) && is_outside_beside(vertex));
            assert_eq!(border(&model, count, is_inside), plain.collect::<Vec<_>>(), "{members}");
        }
        Ok(())
    }
}
