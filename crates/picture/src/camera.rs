//! The eye of a picture.

use glam::{DVec2, DVec3};
use pliant_editor::{Camera, NamedView, Projection};
use pliant_mesh::{Model, bounding_box};

use crate::options::{LookOptions, ProjectionName, StillOptions, View};

/// The factor by which the eye is farther away than for the rest shape alone, so that the whole bent shape is visible,
/// too.
const ROOM_FOR_THE_EDIT: f64 = 1.2;

/// The eye of the first picture: it sees all of the rest shape, for any edit, so that pictures before and after can be
/// compared. Specks far away are left out.
pub fn camera(options: &StillOptions, model: &Model, size_px: DVec2) -> Camera {
    let seen = model
        .vertices_without_specks()
        .map(|v| model.surface.positions[v.index()]);
    let seen: Vec<DVec3> = seen.collect();
    let diagonal = bounding_box(&seen).map_or(0.0, |bounds| bounds.diagonal());
    let mut camera = looking(options.look, model, diagonal);
    camera.projection = match options.projection {
        ProjectionName::Perspective => Projection::Perspective,
        ProjectionName::Orthographic => Projection::Orthographic,
    };
    camera.frame(&seen, size_px);
    camera.distance *= ROOM_FOR_THE_EDIT;
    camera
}

/// A camera that looks from this side at a model, whose rest shape has this diagonal.
pub fn looking(look: LookOptions, model: &Model, diagonal: f64) -> Camera {
    let mut camera = Camera {
        up: look.up.axis_of(model),
        scale: diagonal,
        ..Camera::default()
    };
    camera.look_from(match look.view {
        View::Front => NamedView::Front,
        View::Back => NamedView::Back,
        View::Left => NamedView::Left,
        View::Right => NamedView::Right,
        View::Top => NamedView::Top,
        View::Bottom => NamedView::Bottom,
        View::ThreeQuarter => NamedView::ThreeQuarter,
    });
    camera
}
