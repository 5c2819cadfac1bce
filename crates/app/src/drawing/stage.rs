//! The editor's view in the renderer's terms: the eye, and the marks above the surface.

use glam::{DMat4, DVec2, DVec3};
use pliant_editor::{Camera, SceneView};
use pliant_render::{Overlay, OverlayLine, OverlayTriangle, Shading, Style, View, Wireframe};

/// How much of a mark's alpha is left where the surface hides it.
const HIDDEN_SHARE: f32 = 0.35;
/// The brush ring's colour, sRGB.
const RING_COLOUR: [u8; 4] = [255, 255, 255, 220];
/// The brush ring's width in points.
const RING_WIDTH_PX: f32 = 2.0;

/// The width of the gizmo's lines in points, and of those under the pointer.
const GIZMO_WIDTH_PX: f32 = 2.5;
const GIZMO_HIGHLIGHTED_PX: f32 = 4.0;

/// The camera's eye, seen from `centre`. f32 begins here, after the subtraction in f64.
pub fn view(camera: &Camera, viewport_px: DVec2, centre: DVec3) -> View {
    let view_from_world = camera.view_from_world() * DMat4::from_translation(centre);
    View::new(camera.clip_from_view(viewport_px).as_mat4(), view_from_world.as_mat4())
}

/// The renderer's style for what the editor wants shown.
pub fn style(view: &SceneView<'_>) -> Style {
    let (shading, region_share) = match view.shading {
        pliant_editor::Shading::Clay => (Shading::Clay, 1.0),
        // The file's colours stay to be seen under the paint.
        pliant_editor::Shading::Material => (Shading::Material, 0.45),
    };
    Style {
        shading,
        region_share: if view.regions { region_share } else { 0.0 },
        wireframe: if view.wireframe { Wireframe::On } else { Wireframe::Off },
        ..Style::default()
    }
}

/// The marks of a view, relative to `centre`: the brush's ring, then the gizmo. `pixels_per_point` scales widths.
pub fn overlays(view: &SceneView<'_>, centre: DVec3, pixels_per_point: f32) -> Vec<Overlay> {
    let relative = |position: DVec3| (position - centre).as_vec3().to_array();
    let mut ring = Overlay {
        hidden_share: HIDDEN_SHARE,
        ..Overlay::default()
    };
    let next = view.brush_ring.iter().cycle().skip(1);
    ring.lines
        .extend(view.brush_ring.iter().zip(next).map(|(&from, &to)| OverlayLine {
            ends: [relative(from), relative(to)],
            colours: [RING_COLOUR; 2],
            width_px: RING_WIDTH_PX * pixels_per_point,
        }));
    let mut gizmo = Overlay {
        hidden_share: HIDDEN_SHARE,
        ..Overlay::default()
    };
    for shape in view.gizmo {
        let width_px = if shape.highlighted {
            GIZMO_HIGHLIGHTED_PX
        } else {
            GIZMO_WIDTH_PX
        } * pixels_per_point;
        gizmo.lines.extend(shape.lines.iter().map(|ends| OverlayLine {
            ends: ends.map(relative),
            colours: [shape.colour; 2],
            width_px,
        }));
        gizmo
            .triangles
            .extend(shape.triangles.iter().map(|corners| OverlayTriangle {
                corners: corners.map(relative),
                colours: [shape.colour; 3],
            }));
    }
    vec![ring, gizmo]
}
