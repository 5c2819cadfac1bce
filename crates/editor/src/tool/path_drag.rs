//! A drag of the path of a sequence's body at one frame: it moves the whole body level with the ground.

use glam::{DVec2, DVec3};

use super::context::Context;
use super::gesture::{Gesture, Next};
use super::overlay::Lit;
use crate::document::Transaction;
use crate::input::{Button, Pointer};
use crate::view::{Cursor, View};
use crate::workspace::{BEND_PATH, Workspace, put_path};

/// The plane of the drag is the ground, unless the view's rays make less than this sine with it.
const LEAST_SINE: f64 = 0.08;

/// The path follows the pointer at one frame.
#[derive(Debug)]
pub(crate) struct PathDrag {
    frame: usize,
    step: Transaction,
    /// The pointer's place on the plane of the drag at its beginning, in the world.
    from: DVec3,
    /// The plane's normal.
    normal: DVec3,
    /// The way of the body at the frame at the beginning.
    shift: DVec3,
}

impl PathDrag {
    /// The drag at a frame, which becomes one at which the path is moved; `None` if the path is not known.
    pub(super) fn begin(context: &mut Context<'_>, pointer: Pointer, frame: usize) -> Option<Self> {
        let (view, workspace) = (&*context.view, &mut *context.workspace);
        let up = workspace.path_up(view.camera().up);
        let way = workspace.body_way();
        let place = way.bent(frame)?;
        let shift = place - *way.own()?.get(frame)?;
        let anchor = way.on_ground(place, up);
        let ray = view.world_ray(pointer.position_px);
        let normal = match ray.direction.dot(up).abs() >= LEAST_SINE {
            true => up,
            false => (ray.direction - up * ray.direction.dot(up)).normalize_or(up),
        };
        let from = on_plane(view, pointer.position_px, anchor, normal)?;
        let step = workspace.begin(BEND_PATH);
        let drag = Self {
            frame,
            step,
            from,
            normal,
            shift,
        };
        drag.put(context, shift);
        Some(drag)
    }

    fn put(&self, context: &mut Context<'_>, shift: DVec3) {
        let up = context.view.camera().up;
        put_path(context.workspace, self.frame, shift, up);
    }

    /// The way of the body with the pointer at a point of the viewport; `None` beside the plane of the drag.
    fn shift_at(&self, context: &Context<'_>, px: DVec2) -> Option<DVec3> {
        let up = context.workspace.path_up(context.view.camera().up);
        let way = on_plane(context.view, px, self.from, self.normal)? - self.from;
        Some(self.shift + way - up * way.dot(up))
    }
}

/// The point on a plane under a point of the viewport, in the world.
fn on_plane(view: &View, px: DVec2, anchor: DVec3, normal: DVec3) -> Option<DVec3> {
    let ray = view.world_ray(px);
    let share = (anchor - ray.origin).dot(normal) / ray.direction.dot(normal);
    (share.is_finite() && share > 0.0).then(|| ray.origin + ray.direction * share)
}

impl Gesture for PathDrag {
    fn cursor(&self) -> Cursor {
        Cursor::Grabbing
    }

    fn lit(&self) -> Lit {
        Lit::Gizmo(None)
    }

    fn status(&self, workspace: &Workspace, _: &View) -> Option<String> {
        let shifts = workspace.document.animation().path()?.shifts();
        let (_, shift) = shifts.into_iter().find(|(frame, _)| *frame == self.frame)?;
        let (frame, length) = (self.frame, shift.length());
        Some(format!(
            "Bending the path at frame {frame}: {length:.4} from the body's own way, Esc to cancel"
        ))
    }

    fn holds_camera(&self) -> bool {
        true
    }

    fn moved(&mut self, context: &mut Context<'_>, pointer: Pointer) -> Next {
        if let Some(shift) = self.shift_at(context, pointer.position_px) {
            self.put(context, shift);
        }
        Next::Stay
    }

    fn released(&mut self, context: &mut Context<'_>, pointer: Pointer, button: Button) -> Next {
        if button != Button::Primary {
            return Next::Stay;
        }
        self.moved(context, pointer);
        context.workspace.commit(&self.step);
        Next::End
    }

    fn abort(&mut self, context: &mut Context<'_>) {
        context.workspace.abort(&self.step);
    }
}
