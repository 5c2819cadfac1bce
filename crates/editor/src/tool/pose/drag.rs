//! A drag of the pose brush, from the press to the release of the limb.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_mesh::{Joint, SurfaceVertex};

use super::motion::{Motion, Pose, Way};
use super::reach::Reaching;
use crate::document::{
    Document, Handle, HandleId, HandleTransform, Paint, PivotPlace, Reach, Transaction, accumulated, link_twins,
};
use crate::input::{Button, Modifiers, Pointer};
use crate::jobs::{Activity, JobKind};
use crate::tool::context::Context;
use crate::tool::gesture::{Gesture, Next};
use crate::tool::halves::{Half, Halves, NO_TWIN, State, is_twin};
use crate::tool::limb::{Limb, NewLimb, hover, limb_under};
use crate::tool::overlay::Lit;
use crate::view::{ControlShape, Cursor, Pick, Readout, View};
use crate::workspace::{Workspace, count_turn, held_because, members, put_handle, tidy_handles};

/// The pointer must move this far before the limb follows.
const THRESHOLD_PX: f64 = 3.0;

/// The message if there is no limb.
const NO_JOINT: &str =
    "No joint was found here: point at a limb that is narrower than the body, or paint a handle (1).";

/// A press on a limb.
#[derive(Debug)]
pub(crate) struct PoseDrag {
    pick: Pick,
    start_px: DVec2,
    last: Pointer,
    /// True if the limb bends at all its joints.
    is_whole: bool,
    phase: Phase,
}

#[derive(Debug)]
enum Phase {
    /// The search for the joint is still running; the pointer's events wait.
    Looking,
    /// The limb follows the pointer.
    Posing(Box<Posing>),
    /// The limb bends at all its joints.
    Reaching(Box<Reaching>),
}

/// A limb that has become a handle.
#[derive(Debug)]
struct Posing {
    transaction: Transaction,
    handle: HandleId,
    name: String,
    /// The handle's pivot on the rest shape.
    pivot: DVec3,
    motion: Motion,
    is_armed: bool,
}

impl PoseDrag {
    /// Begins at a point of the surface; `None`, with a sentence, if there is no limb or it is locked.
    pub(crate) fn begin(context: &mut Context<'_>, pointer: Pointer, pick: Pick) -> Option<Self> {
        let mut drag = Self {
            pick,
            start_px: pointer.position_px,
            last: pointer,
            is_whole: context.settings.whole_limb && pointer.modifiers == Modifiers::NONE,
            phase: Phase::Looking,
        };
        hover(
            context.workspace,
            context.view,
            Some(pointer.position_px),
            context.settings.whole_limb,
        );
        (drag.take_limb(context.workspace) == Next::Stay).then_some(drag)
    }

    /// Grabs the limb, if it is known.
    fn take_limb(&mut self, workspace: &mut Workspace) -> Next {
        let limb = limb_under(workspace, &self.pick, self.is_whole);
        // The shown joint may be that of the place where the pointer was before.
        if workspace.jobs.is_busy(JobKind::Joint) {
            return Next::Stay;
        }
        if self.is_whole
            && let Some((transaction, handles)) = take_chain(workspace, &limb, self.pick.vertex)
        {
            return self.reach(workspace, transaction, &handles);
        }
        let posing = match limb {
            Limb::Unknown => return Next::Stay,
            Limb::None => {
                workspace.refuse(NO_JOINT);
                return Next::End;
            }
            Limb::Posed(id) => take_again(workspace, id),
            Limb::Untouched(limb) => match (limb.freed(workspace), limb.parent) {
                (None, Some(parent)) => take_again(workspace, parent),
                (freed, _) => make_handle(workspace, &limb, &freed.unwrap_or_default()),
            },
        };
        let Some((transaction, handle, axis)) = posing else {
            return Next::End;
        };
        workspace.controls.put([]);
        workspace.selection.put_alone(Some(handle.id));
        workspace.selection.wants_new_handle = false;
        let centre = handle.centre();
        let limb = members(&workspace.document, handle.id);
        let arms = || limb.iter().map(|&vertex| workspace.position(vertex) - centre);
        let radii: f64 = arms().map(|arm| arm.reject_from(axis).length()).sum();
        let motion = Motion {
            pose: Pose::of(self.last.modifiers),
            centre,
            axis,
            grip: self.pick.point,
            reach: arms().map(DVec3::length).fold(0.0, f64::max),
            girth: radii / limb.len().max(1) as f64,
            start: (handle.transform, handle.turn_deg),
        };
        self.phase = Phase::Posing(Box::new(Posing {
            transaction,
            handle: handle.id,
            name: handle.name,
            pivot: handle.pivot,
            motion,
            is_armed: false,
        }));
        Next::Stay
    }

    /// Grabs a limb by handles, from the body on, of which the last one has the grabbed point.
    fn reach(&mut self, workspace: &mut Workspace, transaction: Transaction, handles: &[HandleId]) -> Next {
        workspace.controls.put([]);
        workspace.selection.put_alone(handles.last().copied());
        workspace.selection.wants_new_handle = false;
        match Reaching::begin(workspace, transaction, handles, self.pick.point) {
            Some(reaching) => {
                self.phase = Phase::Reaching(Box::new(reaching));
                Next::Stay
            }
            None => Next::End,
        }
    }
}

impl PoseDrag {
    /// The open step.
    fn transaction(&self) -> Option<&Transaction> {
        match &self.phase {
            Phase::Looking => None,
            Phase::Posing(posing) => Some(&posing.transaction),
            Phase::Reaching(reaching) => Some(&reaching.transaction),
        }
    }
}

impl Posing {
    /// Moves the limb to the pointer; other modifiers continue from its present place.
    fn follow(&mut self, context: &mut Context<'_>, last_px: DVec2, pointer: Pointer) {
        let pose = Pose::of(pointer.modifiers);
        if pose != self.motion.pose {
            let way = self.motion.way(context.view, last_px);
            let held = self.motion.held(context.view, last_px);
            if let Some(handle) = context.workspace.document.handle(self.handle) {
                let way = if self.is_armed { way } else { Way::Scale(1.0) };
                self.motion = self.motion.go_on(pose, way, held, (handle.transform, handle.turn_deg));
            }
        }
        if !self.is_armed {
            return;
        }
        let way = self.motion.way(context.view, pointer.position_px);
        put_handle(context.workspace, self.handle, self.motion.transform(way, self.pivot));
        if let (Way::Turn(axis, angle_rad), (HandleTransform::Trs { rotation, .. }, turn_deg)) =
            (way, self.motion.start)
        {
            let counted = accumulated(turn_deg, rotation, axis, angle_rad);
            count_turn(context.workspace, self.handle, counted);
        }
        self.transaction.rename(format!("{} {}", pose.verb(), self.name));
    }
}

impl Gesture for PoseDrag {
    fn activity(&self) -> Activity {
        match self.phase {
            Phase::Looking => Activity::Still,
            Phase::Posing(_) | Phase::Reaching(_) => Activity::Dragging,
        }
    }

    fn cursor(&self) -> Cursor {
        Cursor::Grabbing
    }

    fn lit(&self) -> Lit {
        match self.phase {
            Phase::Looking => Lit::Ring,
            Phase::Posing(_) | Phase::Reaching(_) => Lit::Pivot,
        }
    }

    fn status(&self, _: &Workspace, view: &View) -> Option<String> {
        Some(match &self.phase {
            Phase::Looking => "Finding the joint: Esc to cancel".to_owned(),
            Phase::Reaching(_) => "Bending the limb at all its joints: release to keep it, Esc to cancel".to_owned(),
            Phase::Posing(posing) => {
                let doing = match posing.motion.pose {
                    Pose::Turn => "Turning",
                    Pose::Twist => "Twisting",
                    Pose::Scale => "Scaling",
                };
                let way = posing.motion.way(view, self.last.position_px).label();
                format!("{doing} the limb by {way}: Ctrl twists it, Shift scales it, release to keep it, Esc to cancel")
            }
        })
    }

    fn readout(&self, _: &Workspace, view: &View) -> Option<Readout> {
        match &self.phase {
            Phase::Posing(posing) if posing.is_armed => Some(Readout {
                at: posing.motion.centre,
                text: posing.motion.way(view, self.last.position_px).label(),
            }),
            _ => None,
        }
    }

    fn shapes(&self, view: &View) -> Vec<ControlShape> {
        match &self.phase {
            Phase::Posing(posing) if posing.is_armed => posing.motion.arc(view, self.last.position_px),
            Phase::Reaching(reaching) => reaching.shapes(),
            _ => Vec::new(),
        }
    }

    fn holds_camera(&self) -> bool {
        true
    }

    fn is_looking(&self) -> bool {
        matches!(self.phase, Phase::Looking)
    }

    fn moved(&mut self, context: &mut Context<'_>, pointer: Pointer) -> Next {
        let last_px = std::mem::replace(&mut self.last, pointer).position_px;
        let is_armed = pointer.position_px.distance(self.start_px) >= THRESHOLD_PX;
        match &mut self.phase {
            Phase::Looking => {}
            Phase::Posing(posing) => {
                posing.is_armed |= is_armed;
                posing.follow(context, last_px, pointer);
            }
            Phase::Reaching(reaching) => {
                reaching.is_armed |= is_armed;
                reaching.follow(context.workspace, context.view, pointer.position_px);
            }
        }
        Next::Stay
    }

    fn released(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        if button != Button::Primary || self.is_looking() {
            return Next::Stay;
        }
        // The held modifiers no longer matter: the pointer's last movement counts.
        let modifiers = self.last.modifiers;
        self.moved(context, Pointer { modifiers, ..pointer });
        if let Some(transaction) = self.transaction() {
            context.workspace.commit(transaction);
        }
        Next::End
    }

    fn found_joint(&mut self, context: &mut Context<'_>) -> Next {
        match self.phase {
            Phase::Looking => self.take_limb(context.workspace),
            Phase::Posing(_) | Phase::Reaching(_) => Next::Stay,
        }
    }

    fn abort(&mut self, context: &mut Context<'_>) {
        if let Some(transaction) = self.transaction() {
            context.workspace.abort(transaction);
        }
    }
}

/// The beginning of a drag: the open step, the handle, and the limb's direction from its joint.
type Taken = (Transaction, Handle, DVec3);

/// Grabs a limb's handle; `None`, with a sentence, if it is locked.
fn take_again(workspace: &mut Workspace, id: HandleId) -> Option<Taken> {
    if let Some(why) = held_because(workspace, id) {
        workspace.refuse(why);
        return None;
    }
    let handle = workspace.document.handle(id)?.clone();
    let members = members(&workspace.document, id);
    let sum: DVec3 = members.iter().map(|&vertex| workspace.position(vertex)).sum();
    let axis = (sum / members.len().max(1) as f64 - handle.centre()).normalize_or(DVec3::Y);
    Some((workspace.begin(format!("Pose {}", handle.name)), handle, axis))
}

/// Makes a limb a handle that reaches back across its joint's falloff, between its parent, of which vertices are
/// `freed`, and its children; `None`, with a sentence, if all of it is locked or hidden.
fn make_handle(workspace: &mut Workspace, limb: &NewLimb, freed: &[SurfaceVertex]) -> Option<Taken> {
    let joint = &*limb.joint;
    if limb.own.is_empty() {
        workspace.refuse("This limb is locked: unlock it in the list of objects to pose it.");
        return None;
    }
    let mut transaction = workspace.begin_stroke("Pose");
    workspace.document.keep_shape();
    let id = add_limb(workspace, &transaction, limb, freed);
    let handle = workspace.document.handle(id)?.clone();
    transaction.rename(format!("Make {}", handle.name));
    Some((transaction, handle, joint.axis))
}

/// Grabs all parts of a limb as far as the one with the grabbed vertex, from the body on; they are made handles if the
/// limb is untouched. `None` if it has only one part, or if only some of its parts are handles.
fn take_chain(workspace: &mut Workspace, limb: &Limb, grabbed: SurfaceVertex) -> Option<(Transaction, Vec<HandleId>)> {
    match limb {
        Limb::Posed(id) => {
            let document = &workspace.document;
            let parent = |id: &HandleId| document.handle(*id).and_then(|handle| handle.parent);
            let mut handles: Vec<HandleId> = std::iter::successors(Some(*id), parent).collect();
            handles.reverse();
            (handles.len() > 1).then(|| (workspace.begin("Pose a limb"), handles))
        }
        Limb::Untouched(limb) if limb.parent.is_none() && limb.children.is_empty() && !limb.own.is_empty() => {
            let inner = workspace.computed().inner_joints().to_vec();
            (!inner.is_empty()).then(|| make_chain(workspace, limb, &inner, grabbed))
        }
        _ => None,
    }
}

/// Makes the parts of a limb between its joints handles, each the child of the one before it.
fn make_chain(
    workspace: &mut Workspace,
    root: &NewLimb,
    inner: &[Arc<Joint>],
    grabbed: SurfaceVertex,
) -> (Transaction, Vec<HandleId>) {
    let transaction = workspace.begin_stroke("Pose a limb");
    workspace.document.keep_shape();
    let first = add_limb(workspace, &transaction, root, &[]);
    let (mut last, mut held) = (first, vec![first]);
    for joint in inner {
        let limb = NewLimb::within(workspace, last, joint);
        let Some(freed) = limb.freed(workspace).filter(|_| !limb.own.is_empty()) else {
            continue;
        };
        last = add_limb(workspace, &transaction, &limb, &freed);
        if joint.limb.binary_search(&grabbed).is_ok() {
            held.push(last);
        }
    }
    (transaction, held)
}

/// Makes a limb a handle within a step.
fn add_limb(workspace: &mut Workspace, step: &Transaction, limb: &NewLimb, freed: &[SurfaceVertex]) -> HandleId {
    let joint = &*limb.joint;
    let document = &mut workspace.document;
    let id = document.add_handle();
    document.change_handle(id, |handle| {
        handle.reach = Reach::Length(limb.joint.width());
        handle.parent = limb.parent;
    });
    paint_limb(document, id, &limb.own, freed);
    for child in &limb.children {
        document.change_handle(*child, |child| child.parent = Some(id));
    }
    tidy_handles(workspace, step.before());
    workspace.document.change_handle(id, |handle| {
        let on_rest = handle.affine().inverse().transform_point3(joint.centre);
        handle.pivot_place = PivotPlace::Picked;
        handle.move_pivot(on_rest);
    });
    make_posed_twin(workspace, id, limb, freed);
    id
}

/// Paints a limb's own vertices as a handle, and frees those that bend at its joint.
fn paint_limb(document: &mut Document, id: HandleId, own: &[SurfaceVertex], freed: &[SurfaceVertex]) {
    let own = own.iter().map(|vertex| (*vertex, Paint::Handle(id)));
    document.paint_vertices(own);
    document.paint_vertices(freed.iter().map(|vertex| (*vertex, Paint::Bare)));
}

/// With symmetry, gives a limb that has become a handle its twin on the other side, unless it is on both sides of the
/// plane. Twins of its parent and children are the twin's.
fn make_posed_twin(workspace: &mut Workspace, id: HandleId, limb: &NewLimb, freed: &[SurfaceVertex]) {
    let (Some(sides), Some(model)) = (workspace.both_sides().cloned(), workspace.model().cloned()) else {
        return;
    };
    let mut halves = Halves::of_nothing(Arc::clone(&sides), model, false);
    halves.give(&limb.own);
    if halves.state() == State::One {
        return;
    }
    let around = halves.around(&limb.own).into_iter();
    let twins = around.filter(|(_, half)| *half == Half::Twin);
    let mut own: Vec<SurfaceVertex> = twins.map(|(vertex, _)| vertex).collect();
    if !is_twin(own.len(), limb.own.len()) {
        workspace.refuse(NO_TWIN);
        return;
    }
    let twin_of = |workspace: &Workspace, id: HandleId| Some(workspace.document.handle(id)?.twin?.handle);
    let parent = limb.parent.map(|parent| twin_of(workspace, parent).unwrap_or(parent));
    let children: Vec<HandleId> = limb
        .children
        .iter()
        .filter_map(|child| twin_of(workspace, *child))
        .collect();
    let is_open = |vertex: &SurfaceVertex, may_be_own: bool| {
        let may_change = match workspace.document.paint()[vertex.index()] {
            Paint::Handle(other) if other == id => may_be_own,
            Paint::Handle(other) => Some(other) == parent,
            _ => true,
        };
        may_change && workspace.vertex_access.may_be_painted(vertex.index())
    };
    own.retain(|vertex| is_open(vertex, true));
    let freed = sides.opposite(freed.to_vec()).filter(|vertex| is_open(vertex, false));
    let freed: Vec<SurfaceVertex> = freed.collect();
    if own.is_empty() {
        return;
    }
    let document = &mut workspace.document;
    let twin = document.add_handle();
    paint_limb(document, twin, &own, &freed);
    link_twins(document, id, twin, sides.plane);
    document.change_handle(twin, |handle| handle.parent = parent);
    for child in children {
        document.change_handle(child, |child| child.parent = Some(twin));
    }
}
