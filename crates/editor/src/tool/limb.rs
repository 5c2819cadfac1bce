//! The limb under the pointer, and the search for its joint.
//!
//! A limb has several joints, and each posed part of it is a handle: below a posed joint there may be another, whose
//! part becomes a child of the posed one, and above it another, whose part becomes its parent.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::Role;
use pliant_mesh::{Cancelled, DistanceSearch, Joint, Shape, SurfaceVertex};

use crate::document::{Document, Handle, HandleId, Paint};
use crate::jobs::JobKind;
use crate::region::{FoundLimb, limb_chain, limb_joint};
use crate::view::{Pick, View};
use crate::workspace::{Workspace, members, tint_limb};

/// The most joints above a posed one that are looked at.
const MOST_ABOVE: i32 = 3;

/// The limb under the pose brush at a point of the surface.
#[derive(Clone, Debug)]
pub(crate) enum Limb {
    /// A limb that already has a handle.
    Posed(HandleId),
    /// A limb without one.
    Untouched(NewLimb),
    /// The search for its joint is running.
    Unknown,
    /// There is no joint.
    None,
}

/// A limb that can become a handle.
#[derive(Clone, Debug)]
pub(crate) struct NewLimb {
    pub(crate) joint: Arc<Joint>,
    /// The vertices that become the handle's.
    pub(crate) own: Vec<SurfaceVertex>,
    /// The handle with which it rides along.
    pub(crate) parent: Option<HandleId>,
    /// The handles that ride along with it.
    pub(crate) children: Vec<HandleId>,
}

impl NewLimb {
    /// The part of a handle beyond a joint on it, which becomes its child.
    pub(crate) fn within(workspace: &Workspace, parent: HandleId, joint: &Arc<Joint>) -> Self {
        let paint = workspace.document.paint();
        let is_parents = |vertex: &SurfaceVertex| paint[vertex.index()] == Paint::Handle(parent);
        Self {
            own: open(workspace, joint.far_side.iter().copied().filter(is_parents)),
            joint: Arc::clone(joint),
            parent: Some(parent),
            children: Vec::new(),
        }
    }

    /// The vertices of its parent that become free to bend at the joint; `None` if the parent would keep no vertex.
    pub(crate) fn freed(&self, workspace: &Workspace) -> Option<Vec<SurfaceVertex>> {
        let (Some(parent), Some(model)) = (self.parent, workspace.model()) else {
            return Some(Vec::new());
        };
        let (document, surface) = (&workspace.document, &model.surface);
        let seeds: Vec<(SurfaceVertex, f64)> = self.own.iter().map(|&vertex| (vertex, 0.0)).collect();
        let position = |vertex: SurfaceVertex| workspace.position(vertex);
        let is_parents = |vertex: &SurfaceVertex| document.paint()[vertex.index()] == Paint::Handle(parent);
        let mut search = DistanceSearch::default();
        let near = search.within(
            &surface.triangles,
            &model.topology,
            position,
            &seeds,
            self.joint.width(),
        );
        let near = near.iter().map(|(vertex, _)| *vertex).filter(is_parents);
        let freed = open(workspace, near.filter(|vertex| self.own.binary_search(vertex).is_err()));
        let lost = freed.len() + self.own.iter().filter(|vertex| is_parents(vertex)).count();
        (lost < members(document, parent).len()).then_some(freed)
    }
}

/// Requests the joint of the limb under the pointer, or all its joints, if it is not known yet.
pub(crate) fn hover(workspace: &mut Workspace, view: &View, pointer_px: Option<glam::DVec2>, is_chain: bool) {
    if !workspace.jobs.is_picking_current() {
        return;
    }
    let pick = pointer_px.and_then(|px| workspace.pick(view, px));
    let Some(pick) = pick else {
        return workspace.jobs.forget_joint();
    };
    let shown = workspace.computed().joint();
    if shown.is_some_and(|joint| joint.limb.binary_search(&pick.vertex).is_err()) {
        workspace.jobs.want_joint(None);
    }
    let Some(up) = workspace.jobs.asks_for_joint(pick.triangle, is_chain) else {
        return;
    };
    let Some(model) = workspace.model().cloned() else {
        return;
    };
    let displacements = Arc::clone(workspace.document.from_file());
    let contacts = workspace.computed().contacts.clone();
    let document = &workspace.document;
    let posed = match handle_at(document, &pick) {
        None => document.handles().iter().map(Handle::centre).collect(),
        Some(_) => Vec::new(),
    };
    workspace.jobs.look_for_joint(
        pick.triangle,
        is_chain,
        Box::new(move |_, cancel| {
            let rest = model.surface.positions.iter().zip(&**displacements);
            let positions: Vec<_> = rest.map(|(&rest, &moved)| rest + moved).collect();
            let shape = Shape {
                triangles: &model.surface.triangles,
                topology: &model.topology,
                positions: &positions,
            };
            let at = (pick.triangle, pick.point);
            match is_chain {
                true => Ok(limb_chain(&model, &shape, &contacts, at, up, cancel)?),
                false => {
                    let joint_at = |up| limb_joint(&model, &shape, &contacts, at, up, cancel);
                    let joint = above_posed(joint_at, up, &pick, &posed)?.map(Arc::new);
                    let inner = Vec::new();
                    Ok(joint.map(|joint| FoundLimb { joint, inner }))
                }
            }
        }),
    );
}

/// The joint `up`, or, if that is not chosen and is a posed one on whose body's side the pointer is, the next one above
/// it: pointing at an upper arm beside a bent elbow means the shoulder. `posed` has the places of the posed joints.
fn above_posed(
    joint_at: impl Fn(i32) -> Result<Option<Joint>, Cancelled>,
    up: i32,
    pick: &Pick,
    posed: &[DVec3],
) -> Result<Option<Joint>, Cancelled> {
    let is_posed = |joint: &Joint| posed.iter().any(|place| is_at(*place, joint));
    let is_passed = |joint: &Joint| is_posed(joint) && joint.far_side.binary_search(&pick.vertex).is_err();
    let guess = joint_at(up)?;
    let Some(first) = guess
        .as_ref()
        .filter(|joint| up == 0 && is_passed(joint))
        .map(|joint| joint.up)
    else {
        return Ok(guess);
    };
    for above in first + 1..=first + MOST_ABOVE {
        match joint_at(above)? {
            Some(joint) if joint.up < above => break,
            Some(joint) if !is_posed(&joint) => return Ok(Some(joint)),
            Some(_) => {}
            None => break,
        }
    }
    Ok(guess)
}

/// Tints the limb that a press of the pose brush at `pointer_px` would turn; `None` tints none.
pub(crate) fn tint(workspace: &mut Workspace, view: &View, pointer_px: Option<glam::DVec2>, is_whole: bool) {
    let pick = pointer_px.and_then(|px| workspace.pick(view, px));
    // The limb is looked through once for each joint, not at each move of the pointer.
    let tinted = workspace.colours().turning();
    let is_known = tinted.map(Arc::as_ptr) == workspace.computed().joint().map(Arc::as_ptr);
    if let (Some(pick), Some(tinted), true) = (&pick, tinted, is_known)
        && tinted.limb.binary_search(&pick.vertex).is_ok()
    {
        return;
    }
    let joint = match pick.map(|pick| limb_under(workspace, &pick, is_whole)) {
        Some(Limb::Untouched(limb)) => Some(limb.joint),
        _ => None,
    };
    tint_limb(workspace, joint.as_ref());
}

/// The limb at a point of the surface, by the joint that was found last: the handle of that joint, or the part of the
/// surface that can become one. If whole limbs are posed, a part of one stays a part, wherever joints are found on the
/// bent surface.
pub(crate) fn limb_under(workspace: &Workspace, pick: &Pick, is_whole: bool) -> Limb {
    let on = handle_at(&workspace.document, pick);
    if let Some(id) = on.filter(|id| is_whole && is_in_chain(&workspace.document, *id)) {
        return Limb::Posed(id);
    }
    let joint = workspace.computed().joint();
    let Some(joint) = joint.filter(|joint| joint.limb.binary_search(&pick.vertex).is_ok()) else {
        return match on {
            _ if workspace.jobs.is_busy(JobKind::Joint) => Limb::Unknown,
            Some(id) => Limb::Posed(id),
            None => Limb::None,
        };
    };
    let beyond = handles_beyond(&workspace.document, joint);
    // The first of equal ones.
    let most = beyond.iter().rev().max_by_key(|(_, inside)| inside.count);
    let present = on.or(most.map(|(id, _)| *id));
    let Some(present) = present else {
        return Limb::Untouched(untouched(workspace, joint));
    };
    let new = match workspace.document.handle(present) {
        Some(handle) if !turns_about(handle, joint) => Some(further_limb(workspace, joint, on, &beyond)),
        _ => None,
    };
    match new.filter(|new| !new.own.is_empty()) {
        Some(new) => Limb::Untouched(new),
        None => Limb::Posed(present),
    }
}

/// Returns true if a handle is another one's parent or child.
fn is_in_chain(document: &Document, id: HandleId) -> bool {
    let is_its = |handle: &Handle| handle.parent == Some(id) || (handle.id == id && handle.parent.is_some());
    document.handles().iter().any(is_its)
}

/// Returns true if a handle's pivot is at a joint.
fn turns_about(handle: &Handle, joint: &Joint) -> bool {
    is_at(handle.centre(), joint)
}

/// Returns true if a place is at a joint.
fn is_at(place: DVec3, joint: &Joint) -> bool {
    place.distance(joint.centre) <= joint.falloff.max(joint.radius)
}

/// A limb beyond whose joint there is no handle.
fn untouched(workspace: &Workspace, joint: &Arc<Joint>) -> NewLimb {
    NewLimb {
        own: open(workspace, joint.far_side.iter().copied()),
        joint: Arc::clone(joint),
        parent: None,
        children: Vec::new(),
    }
}

/// The limb beyond another joint of a posed limb; it has no vertex of its own if the joint's surroundings belong to
/// others. `on` is the handle under the pointer, of which it takes its part.
fn further_limb(
    workspace: &Workspace,
    joint: &Arc<Joint>,
    on: Option<HandleId>,
    beyond: &BTreeMap<HandleId, Inside>,
) -> NewLimb {
    let document = &workspace.document;
    let roles = &workspace.computed().region.roles;
    let below = beyond.iter().filter(|(id, inside)| Some(**id) != on && inside.is_most);
    let below: Vec<HandleId> = below.map(|(id, _)| *id).collect();
    let parent_of = |id: &HandleId| document.handle(*id).and_then(|handle| handle.parent);
    let is_root = |id: &&HandleId| parent_of(id).is_none_or(|parent| !below.contains(&parent));
    let children: Vec<HandleId> = below.iter().filter(is_root).copied().collect();
    let becomes_own = |vertex: &SurfaceVertex| match document.paint()[vertex.index()] {
        Paint::Handle(id) => Some(id) == on,
        // The bends of the children stay free.
        _ => children.is_empty() || roles.get(vertex.index()) != Some(&Role::Free),
    };
    let own = open(workspace, joint.far_side.iter().copied().filter(becomes_own));
    NewLimb {
        parent: on.or_else(|| children.iter().find_map(parent_of)),
        joint: Arc::clone(joint),
        own,
        children,
    }
}

/// The vertices that may be painted.
fn open(workspace: &Workspace, vertices: impl Iterator<Item = SurfaceVertex>) -> Vec<SurfaceVertex> {
    let access = &workspace.vertex_access;
    vertices
        .filter(|vertex| access.may_be_painted(vertex.index()))
        .collect()
}

/// The handle at a point of the surface, except pins.
fn handle_at(document: &Document, pick: &Pick) -> Option<HandleId> {
    match document.paint()[pick.vertex.index()] {
        Paint::Handle(id) => document
            .handle(id)
            .filter(|handle| !handle.is_pin)
            .map(|handle| handle.id),
        _ => None,
    }
}

/// The part of a handle that is beyond a joint.
struct Inside {
    /// The number of its vertices on the far side.
    count: usize,
    /// True if these are most of its vertices.
    is_most: bool,
}

/// The handles with vertices on the far side of a joint, except pins.
fn handles_beyond(document: &Document, joint: &Joint) -> BTreeMap<HandleId, Inside> {
    let mut counts: BTreeMap<HandleId, usize> = BTreeMap::new();
    for vertex in &joint.far_side {
        if let Paint::Handle(id) = document.paint()[vertex.index()]
            && document.handle(id).is_some_and(|handle| !handle.is_pin)
        {
            *counts.entry(id).or_default() += 1;
        }
    }
    let mut all: BTreeMap<HandleId, usize> = counts.keys().map(|id| (*id, 0)).collect();
    for paint in document.paint() {
        if let Paint::Handle(id) = paint
            && let Some(number) = all.get_mut(id)
        {
            *number += 1;
        }
    }
    let with_share = |(id, count): (HandleId, usize)| {
        let is_most = 2 * count > all.get(&id).copied().unwrap_or_default();
        (id, Inside { count, is_most })
    };
    counts.into_iter().map(with_share).collect()
}
