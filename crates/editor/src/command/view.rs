//! Commands on the view.

use glam::{DVec2, DVec3};
use pliant_mesh::DrawnVertex;

use super::entry::{Action, Entry, Scope, alt, always, character, ctrl_numpad, item, numpad, plain, unless, when_open};
use crate::input::Key;
use crate::view::{Camera, CameraStep, NamedView, Orbit, Projection, UpAxis, View};
use crate::workspace::{NOTHING_HERE, Workspace, light_part, members};

/// The angle by which a key turns the view: 15 degrees.
const VIEW_STEP_RAD: f64 = std::f64::consts::PI / 12.0;

/// Frames everything.
pub(super) const FRAME_ALL: Entry<()> = Entry {
    listed: &[item(
        (),
        "Frame all",
        "Shows the whole surface.",
        "zoom fit home",
        &[plain(Key::Home)],
    )],
    scope: Scope::View,
    unavailable: when_open,
    action: Action::Do(|context, ()| frame_all(context.workspace, context.view)),
};

/// Frames the selected handle and its region.
pub(super) const FRAME_SELECTED: Entry<()> = Entry {
    listed: &[item(
        (),
        "Frame selected",
        "Shows the selected handle, or the whole surface if none is selected.",
        "zoom fit focus",
        &[character('.')],
    )],
    scope: Scope::View,
    unavailable: when_open,
    action: Action::Do(|context, ()| frame_selected(context.workspace, context.view)),
};

/// Frames a connected part, by its component's number.
pub(super) const FRAME_PART: Entry<u32> = Entry {
    listed: &[],
    scope: Scope::View,
    unavailable: when_open,
    action: Action::Do(|context, part| frame_part(context.workspace, context.view, part)),
};

/// Frames the connected part under the pointer.
pub(super) const FRAME_PART_HERE: Entry<()> = Entry {
    listed: &[item(
        (),
        "Frame part",
        "Frames the connected part under the pointer.",
        "zoom to component piece focus",
        &[],
    )],
    scope: Scope::View,
    unavailable: when_open,
    action: Action::Do(|context, ()| {
        let part = context
            .pointed_at()
            .map(|pick| pick.vertex)
            .zip(context.workspace.model());
        match part.map(|(vertex, model)| model.topology.component(vertex)) {
            Some(part) => frame_part(context.workspace, context.view, part),
            None => context.workspace.refuse(NOTHING_HERE),
        }
    }),
};

/// Highlights a connected part, by its component's number, or none.
pub(super) const LIGHT_PART: Entry<Option<u32>> = Entry {
    listed: &[],
    scope: Scope::View,
    unavailable: when_open,
    action: Action::Do(|context, part| light_part(context.workspace, part)),
};

/// Frames a vertex, by the file's number.
pub(super) const FRAME_FILE_VERTEX: Entry<u32> = Entry {
    listed: &[],
    scope: Scope::View,
    unavailable: when_open,
    action: Action::Do(|context, vertex| frame_file_vertex(context.workspace, context.view, vertex)),
};

/// Frames a place where the shape passes through itself, by its number.
pub(super) const FRAME_INTERSECTION: Entry<usize> = Entry {
    listed: &[item(
        0,
        "Go to self-intersection",
        "Moves the view to the largest place where the bent surface passes through itself.",
        "self-intersection crossing collision overlap penetrate",
        &[],
    )],
    scope: Scope::View,
    unavailable: |state, place| {
        let found = state.workspace.intersections();
        let is_there = found.is_some_and(|found| *place < found.places.len());
        unless(is_there, "The bent shape has no new self-intersection.")
    },
    action: Action::Do(|context, place| {
        let found = context.workspace.intersections();
        if let Some(place) = found.and_then(|found| found.places.get(place)) {
            context.view.frame(place.segments.as_flattened());
        }
    }),
};

/// Goes back to the last view.
pub(super) const CAMERA_BACK: Entry<()> = Entry {
    listed: &[item(
        (),
        "Previous view",
        "Goes back to the previous view.",
        "camera back",
        &[alt('[')],
    )],
    scope: Scope::View,
    unavailable: |state, ()| {
        let is_any = state.view.history().has(CameraStep::Back);
        unless(is_any, "There is no previous view.")
    },
    action: Action::Do(|context, ()| context.view.step(CameraStep::Back)),
};

/// Goes forth to the view before going back.
pub(super) const CAMERA_FORTH: Entry<()> = Entry {
    listed: &[item(
        (),
        "Next view",
        "Goes forward to the view that you left with Previous view.",
        "camera forth forward",
        &[alt(']')],
    )],
    scope: Scope::View,
    unavailable: |state, ()| {
        let is_any = state.view.history().has(CameraStep::Forth);
        unless(is_any, "There is no next view.")
    },
    action: Action::Do(|context, ()| context.view.step(CameraStep::Forth)),
};

/// The axis that points up on the screen. The model is framed again, because another axis shows another side of it.
pub(super) const SET_UP: Entry<UpAxis> = Entry {
    listed: &[
        item(
            UpAxis::Y,
            "Y is up",
            "Shows the model with its Y axis upwards, as in glTF.",
            "axis turn upright",
            &[],
        ),
        item(
            UpAxis::Z,
            "Z is up",
            "Shows the model with its Z axis upwards, as in scanners and CAD.",
            "axis turn upright",
            &[],
        ),
    ],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, up| {
        context.view.adjust(|camera| camera.up = up);
        frame_all(context.workspace, context.view);
    }),
};

/// Changes between perspective and orthographic.
pub(super) const TOGGLE_PROJECTION: Entry<()> = Entry {
    listed: &[item(
        (),
        "Orthographic",
        "Switches between a perspective and an orthographic view.",
        "perspective projection parallel",
        &[numpad(5)],
    )],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, ()| {
        context.view.adjust(|camera| {
            camera.projection = match camera.projection {
                Projection::Perspective => Projection::Orthographic,
                Projection::Orthographic => Projection::Perspective,
            };
        });
    }),
};

/// The effect of dragging the view.
pub(super) const SET_ORBIT: Entry<Orbit> = Entry {
    listed: &[
        item(
            Orbit::Turntable,
            "Turntable",
            "Makes a drag turn the view about the up axis; the horizon stays level.",
            "orbit",
            &[],
        ),
        item(
            Orbit::Trackball,
            "Trackball",
            "Makes a drag roll the view like a ball.",
            "orbit arcball",
            &[],
        ),
    ],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, orbit| context.view.set_orbit(orbit)),
};

/// Turns the view by steps of 15 degrees, to the right and down.
pub(super) const STEP_VIEW: Entry<[i8; 2]> = Entry {
    listed: &[
        item([1, 0], "Turn left", "Turns the view by 15°.", "", &[numpad(4)]),
        item([-1, 0], "Turn right", "Turns the view by 15°.", "", &[numpad(6)]),
        item([0, 1], "Turn up", "Turns the view by 15°.", "", &[numpad(8)]),
        item([0, -1], "Turn down", "Turns the view by 15°.", "", &[numpad(2)]),
    ],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, steps| {
        let angles_rad = DVec2::from(steps.map(f64::from)) * VIEW_STEP_RAD;
        context.view.travel(|camera| camera.turn(angles_rad));
    }),
};

/// Looks from the opposite side.
pub(super) const TURN_AROUND: Entry<()> = Entry {
    listed: &[item(
        (),
        "Other side",
        "Looks from the other side.",
        "opposite flip view behind",
        &[numpad(9)],
    )],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, ()| context.view.travel(Camera::turn_around)),
};

/// Looks from a named side.
pub(super) const VIEW: Entry<NamedView> = Entry {
    listed: &[
        item(
            NamedView::Front,
            "From front",
            "Looks from the front.",
            "camera",
            &[numpad(1)],
        ),
        item(
            NamedView::Back,
            "From back",
            "Looks from behind.",
            "camera",
            &[ctrl_numpad(1)],
        ),
        item(
            NamedView::Left,
            "From left",
            "Looks from the left.",
            "camera side",
            &[ctrl_numpad(3)],
        ),
        item(
            NamedView::Right,
            "From right",
            "Looks from the right.",
            "camera side",
            &[numpad(3)],
        ),
        item(
            NamedView::Top,
            "From top",
            "Looks from above.",
            "camera above",
            &[numpad(7)],
        ),
        item(
            NamedView::Bottom,
            "From bottom",
            "Looks from below.",
            "camera below",
            &[ctrl_numpad(7)],
        ),
        item(
            NamedView::ThreeQuarter,
            "Three-quarter",
            "Looks from the front, the right and above.",
            "camera perspective",
            &[numpad(0)],
        ),
    ],
    scope: Scope::View,
    unavailable: always,
    action: Action::Do(|context, side| context.view.look_from(side)),
};

/// Shows everything that is not hidden.
pub(crate) fn frame_all(workspace: &Workspace, view: &mut View) {
    if workspace.model().is_some() {
        view.frame_all(&workspace.shown_positions());
    }
}

fn frame_selected(workspace: &Workspace, view: &mut View) {
    let Some(id) = workspace.selection.selected() else {
        return;
    };
    let members = members(&workspace.document, id).into_iter();
    let positions: Vec<DVec3> = members.map(|vertex| workspace.position(vertex)).collect();
    if !positions.is_empty() {
        view.frame(&positions);
    }
}

fn frame_part(workspace: &Workspace, view: &mut View, part: u32) {
    let Some(model) = workspace.model() else { return };
    if (part as usize) < model.topology.components().len() {
        let vertices = model.topology.vertices_of(part);
        let positions: Vec<DVec3> = vertices.map(|vertex| workspace.position(vertex)).collect();
        view.frame(&positions);
    }
}

/// Frames a vertex, by the file's number.
fn frame_file_vertex(workspace: &Workspace, view: &mut View, file_vertex: u32) {
    let Some(model) = workspace.model() else { return };
    let drawn = model.drawn.file_vertices().position(|vertex| vertex.0 == file_vertex);
    let Some(drawn) = drawn.map(|drawn| DrawnVertex(drawn as u32)) else {
        return;
    };
    let moved = model.drawn.surface_vertex(drawn);
    let moved = moved.map_or(DVec3::ZERO, |vertex| workspace.document.from_file()[vertex.index()]);
    let point = model.rest_position(drawn) + moved;
    if point.is_finite() {
        view.approach(point);
    }
}
