//! Moving, turning and scaling a handle or control points, by the gizmo or by G, R and S: begin, preview, commit or
//! abort.
//!
//! A drag of the gizmo ends when its button goes up; a transform begun by a key follows the pointer without a button
//! and ends with a click or Enter. Both understand x, y, z (with Shift: every axis except that one), typed numbers, and
//! Escape.

use glam::{DVec2, DVec3};

use super::constraint::{Constraint, rotation};
use super::context::Context;
use super::gesture::{Gesture, Next};
use super::moved_controls::MovedControls;
use super::overlay::Lit;
use super::surface_snap::{Landing, SurfaceSnap};
use super::transform_measure::{Measure, TransformKind};
use crate::document::{Handle, HandleId, HandleTransform, Transaction, accumulated};
use crate::input::{Button, Key, Modifiers, Pointer};
use crate::jobs::Activity;
use crate::view::{ControlShape, Cursor, GizmoAxes, GizmoPart, Readout, View};
use crate::workspace::{Workspace, aim_free_handles, count_turn, held_because, members, put_handles};

/// A held button must move the pointer this far before a handle follows.
const THRESHOLD_PX: f64 = 3.0;

/// The condition for its end.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Ending {
    /// A click or Enter.
    Click,
    /// The release of the button.
    Release(Button),
}

/// An active transform.
#[derive(Debug)]
pub(crate) struct TransformDrag {
    transaction: Transaction,
    subject: Subject,
    measure: Measure,
    ending: Ending,
    /// True if the pointer has moved far enough.
    is_armed: bool,
}

/// The moved object.
#[derive(Debug)]
enum Subject {
    Handle {
        id: HandleId,
        /// The position of its pivot on the rest shape.
        pivot: DVec3,
        /// Other handles that move with it, in their state at the beginning.
        companions: Vec<Handle>,
        /// Puts it onto the surface, if it is a whole part.
        snap: Option<SurfaceSnap>,
    },
    Controls(MovedControls),
}

impl TransformDrag {
    /// Begins with the selected control points, or else with the selected handle; `None` if none is selected, or it is
    /// locked. It ends with a click.
    pub(crate) fn begin(
        context: &mut Context<'_>,
        kind: TransformKind,
        constraint: Constraint,
        start_px: DVec2,
    ) -> Option<Self> {
        let (orientation, camera) = (context.settings.orientation, context.view.camera());
        let workspace = &mut *context.workspace;
        if let Some(controls) = MovedControls::of_selected(workspace, context.settings.chain) {
            let axes = GizmoAxes::of(&HandleTransform::IDENTITY, orientation, camera);
            let start = (HandleTransform::IDENTITY, controls.centre());
            return Some(Self {
                transaction: workspace.begin(format!("{} {}", kind.verb(), controls.designation())),
                measure: Measure::begin(kind, constraint, start, axes.basis, start_px),
                subject: Subject::Controls(controls),
                ending: Ending::Click,
                is_armed: true,
            });
        }
        let handle = workspace.selected()?.clone();
        if let Some(why) = held_because(workspace, handle.id) {
            workspace.refuse(why);
            return None;
        }
        let companions = workspace.selection.companions().iter();
        let companions = companions
            .filter(|&&id| id != handle.id && handle.twin.is_none_or(|twin| twin.handle != id))
            .filter_map(|&id| workspace.document.handle(id).cloned())
            .collect();
        let axes = GizmoAxes::of(&handle.transform, orientation, camera);
        let start = (handle.transform, handle.centre());
        Some(Self {
            transaction: workspace.begin(format!("{} {}", kind.verb(), handle.name)),
            measure: Measure::begin(kind, constraint, start, axes.basis, start_px).above_ground(height_above_ground(
                workspace,
                camera.up.vector(),
                handle.id,
            )),
            subject: Subject::Handle {
                id: handle.id,
                pivot: handle.pivot,
                companions,
                snap: SurfaceSnap::of(workspace, &handle, camera.up.vector()),
            },
            ending: Ending::Click,
            is_armed: true,
        })
    }

    /// The same, held by a button: it ends when that goes up.
    pub(super) fn held(mut self, button: Button, part: Option<GizmoPart>) -> Self {
        self.ending = Ending::Release(button);
        self.measure.part = part;
        self.is_armed = false;
        self
    }

    fn commit(&self, workspace: &mut Workspace) -> Next {
        workspace.commit(&self.transaction);
        Next::End
    }

    /// Constrains the transform to other axes; to none, if it already has these.
    fn constrain(&mut self, view: &View, wanted: Constraint) {
        let measure = &mut self.measure;
        measure.constraint = if measure.constraint == wanted {
            Constraint::Free
        } else {
            wanted
        };
        measure.restart(view);
    }

    /// Continues as another transform, from the pointer's place.
    fn become_kind(&mut self, view: &View, kind: TransformKind) {
        let measure = &mut self.measure;
        if kind != measure.kind {
            measure.kind = kind;
            measure.constraint = Constraint::Free;
            measure.start_px = measure.last_px;
            measure.restart(view);
            let designation = match &self.subject {
                Subject::Handle { id, .. } => {
                    let handle = self.transaction.before().handle(*id);
                    handle.map_or_else(String::new, |handle| handle.name.clone())
                }
                Subject::Controls(controls) => controls.designation(),
            };
            self.transaction.rename(format!("{} {designation}", kind.verb()));
        }
    }

    /// The motion onto the surface under the pointer, if Ctrl asks for it and there is one.
    fn landing(&self, workspace: &Workspace, view: &View) -> Option<Landing> {
        match &self.subject {
            Subject::Handle { snap: Some(snap), .. } if self.measure.snaps_freely() => {
                snap.landing(workspace, view, self.measure.last_px)
            }
            _ => None,
        }
    }

    /// Moves the object by the present transform.
    fn preview(&self, workspace: &mut Workspace, view: &View) {
        if !self.is_armed {
            return;
        }
        match &self.subject {
            Subject::Handle {
                id, pivot, companions, ..
            } => self.preview_handle(workspace, view, *id, *pivot, companions),
            Subject::Controls(controls) => {
                let measure = &self.measure;
                let is_done = match measure.kind {
                    TransformKind::Move => false,
                    TransformKind::Turn => controls.twist(workspace, measure.turn_axis(view), measure.angle_rad()),
                    TransformKind::Scale => controls.scale(workspace, measure.scale(view)),
                };
                if is_done {
                    return;
                }
                controls.put(workspace, |point| {
                    let arm = point - measure.centre;
                    match measure.kind {
                        TransformKind::Move => measure.translation(view),
                        TransformKind::Turn => rotation(measure.turn_axis(view), measure.angle_rad()) * arm - arm,
                        TransformKind::Scale => measure.scale(view) * arm - arm,
                    }
                });
                if measure.kind == TransformKind::Move {
                    controls.free_depth(workspace, view.camera());
                }
            }
        }
    }

    /// Moves the handle, and those that move with it, by the present transform.
    fn preview_handle(
        &self,
        workspace: &mut Workspace,
        view: &View,
        handle: HandleId,
        pivot: DVec3,
        companions: &[Handle],
    ) {
        let (measure, start) = (&self.measure, self.measure.start);
        let before = workspace.document.handle(handle).map(|handle| handle.transform);
        let together = |own: HandleTransform, of_other: &dyn Fn(&Handle) -> HandleTransform| {
            let others = companions.iter().map(|other| (other.id, of_other(other)));
            std::iter::once((handle, own)).chain(others).collect::<Vec<_>>()
        };
        match measure.kind {
            TransformKind::Move => {
                let onto = self.landing(workspace, view);
                let Landing { turn, way } = onto.unwrap_or_else(|| Landing::without_turn(measure.translation(view)));
                let of_other = |other: &Handle| {
                    let arm = other.centre() - measure.centre;
                    let own = other.transform.turned_by(turn, other.pivot);
                    own.moved_by(turn * arm - arm + way)
                };
                put_handles(
                    workspace,
                    &together(start.turned_by(turn, pivot).moved_by(way), &of_other),
                );
            }
            TransformKind::Turn => {
                let (axis, angle_rad) = (measure.turn_axis(view), measure.angle_rad());
                let turn = rotation(axis, angle_rad);
                let of_other = |other: &Handle| {
                    let arm = other.centre() - measure.centre;
                    other.transform.turned_by(turn, other.pivot).moved_by(turn * arm - arm)
                };
                put_handles(workspace, &together(start.turned_by(turn, pivot), &of_other));
                if let (HandleTransform::Trs { rotation, .. }, Some(before)) =
                    (start, self.transaction.before().handle(handle))
                {
                    let counted = accumulated(before.turn_deg, rotation, axis, angle_rad);
                    count_turn(workspace, handle, counted);
                }
            }
            TransformKind::Scale => {
                let (factors, own) = (measure.scale(view), measure.own_rotation());
                let of_other = |other: &Handle| {
                    let arm = other.centre() - measure.centre;
                    let way = own * (factors * (own.inverse() * arm)) - arm;
                    other.transform.scaled_by(factors, other.pivot).moved_by(way)
                };
                put_handles(workspace, &together(start.scaled_by(factors, pivot), &of_other));
            }
        }
        if workspace.document.handle(handle).map(|handle| handle.transform) != before {
            let moved = std::iter::once(handle).chain(companions.iter().map(|other| other.id));
            aim_free_handles(workspace, view.camera(), moved);
        }
    }
}

/// The visible height of a handle's lowest vertex above the file's lowest point, which is the ground.
fn height_above_ground(workspace: &Workspace, up: DVec3, id: HandleId) -> Option<f64> {
    let ground = workspace.model()?.bounds()?.min.dot(up);
    let own = members(&workspace.document, id)
        .into_iter()
        .map(|vertex| workspace.position(vertex).dot(up));
    let height = own.fold(f64::INFINITY, f64::min) - ground;
    height.is_finite().then_some(height)
}

impl Gesture for TransformDrag {
    fn activity(&self) -> Activity {
        Activity::Dragging
    }

    fn cursor(&self) -> Cursor {
        Cursor::Move
    }

    fn lit(&self) -> Lit {
        Lit::Gizmo(self.measure.part)
    }

    fn status(&self, workspace: &Workspace, view: &View) -> Option<String> {
        let end = match self.ending {
            Ending::Click => "click or Enter to keep it",
            Ending::Release(_) => "release to keep it",
        };
        let doing = self.measure.kind.doing();
        if self.landing(workspace, view).is_some() {
            return Some(format!("{doing} onto the surface: {end}, Esc to cancel"));
        }
        let may_land = matches!(&self.subject, Subject::Handle { snap: Some(_), .. });
        let snap = match self.measure.kind {
            TransformKind::Move if may_land => "Ctrl puts it onto the surface, ",
            _ => "",
        };
        Some(format!(
            "{doing}{} by {}: {snap}x, y or z chooses an axis, digits set the amount, {end}, Esc to cancel",
            self.measure.constraint.label(),
            self.measure.label(view),
        ))
    }

    fn readout(&self, workspace: &Workspace, view: &View) -> Option<Readout> {
        let at = match &self.subject {
            Subject::Handle { id, .. } => workspace.document.handle(*id)?.centre(),
            Subject::Controls(controls) => controls.centre_now(workspace)?,
        };
        self.is_armed.then(|| Readout {
            at,
            text: match self.landing(workspace, view) {
                Some(_) => "onto the surface".to_owned(),
                None => self.measure.label(view),
            },
        })
    }

    fn shapes(&self, view: &View) -> Vec<ControlShape> {
        if self.is_armed {
            self.measure.arc(view)
        } else {
            Vec::new()
        }
    }

    fn holds_camera(&self) -> bool {
        true
    }

    fn moved(&mut self, context: &mut Context<'_>, pointer: Pointer) -> Next {
        self.is_armed |= pointer.position_px.distance(self.measure.start_px) >= THRESHOLD_PX;
        self.measure.move_to(context.view, pointer);
        self.preview(context.workspace, context.view);
        Next::Stay
    }

    fn pressed(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        match (self.ending, button) {
            (_, Button::Secondary) => {
                self.abort(context);
                Next::End
            }
            (Ending::Click, Button::Primary) => {
                self.moved(context, pointer);
                self.commit(context.workspace)
            }
            _ => Next::Stay,
        }
    }

    fn released(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        if self.ending != Ending::Release(button) {
            return Next::Stay;
        }
        self.moved(context, pointer);
        self.commit(context.workspace)
    }

    fn key(&mut self, context: &mut Context<'_>, key: Key, modifiers: Modifiers) -> Option<Next> {
        match key {
            Key::Escape => {
                self.abort(context);
                return Some(Next::End);
            }
            Key::Enter => return Some(self.commit(context.workspace)),
            Key::Character(letter @ 'x'..='z') if !modifiers.ctrl && !modifiers.alt => {
                let axis = usize::from(letter as u8 - b'x');
                let wanted = if modifiers.shift {
                    Constraint::Plane(axis)
                } else {
                    Constraint::Axis(axis)
                };
                self.constrain(context.view, wanted);
            }
            Key::Character(letter @ ('g' | 'r' | 's'))
                if modifiers == Modifiers::NONE && self.ending == Ending::Click =>
            {
                let kind = match letter {
                    'g' => TransformKind::Move,
                    'r' => TransformKind::Turn,
                    _ => TransformKind::Scale,
                };
                self.become_kind(context.view, kind);
            }
            _ if self.measure.number.take(key) => self.is_armed = true,
            // Other commands (undo above all) would act on a document that is about to change.
            _ => return Some(Next::Stay),
        }
        self.preview(context.workspace, context.view);
        Some(Next::Stay)
    }

    fn abort(&mut self, context: &mut Context<'_>) {
        context.workspace.abort(&self.transaction);
    }
}
