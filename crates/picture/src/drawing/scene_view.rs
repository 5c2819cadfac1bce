//! The editor's view, converted for the renderer: point of view, style and overlays.

use glam::{DMat4, DVec2, DVec3};
use pliant_editor::{Camera, Clay, Look, SceneView, Shading};
use pliant_render::{
    Borders, Faces, Matcap, Outlines, Overlay, OverlayLine, OverlayTriangle, Shadows, Style, View, Wireframe,
};

use super::field::Field;

/// Factor of the alpha of the gizmo and the brush ring where a surface hides them.
const HIDDEN_SHARE: f32 = 0.35;
/// Colour of the brush ring, sRGB.
const RING_COLOUR: [u8; 4] = [255, 255, 255, 220];
/// Width of the brush ring in points.
const RING_WIDTH_POINTS: f32 = 2.0;

/// The share of the regions' colours that is left while the surface is dragged.
const FADED_SHARE: f32 = 0.3;

/// The width in points of a cage's or lattice's edges.
const CONTROL_WIDTH_POINTS: f32 = 1.1;

/// Widths in points of the gizmo's lines, and of those under the pointer.
const GIZMO_WIDTH_POINTS: f32 = 2.5;
const GIZMO_HIGHLIGHTED_POINTS: f32 = 4.0;

/// The camera's view, relative to `centre`. Rounded to f32 only after the subtraction in f64.
pub fn view(camera: &Camera, viewport_px: DVec2, centre: DVec3) -> View {
    let view_from_world = camera.view_from_world() * DMat4::from_translation(centre);
    View::new(camera.clip_from_view(viewport_px).as_mat4(), view_from_world.as_mat4())
}

/// The field that a shading shows as colours, if any.
pub fn field(shading: Shading) -> Option<Field> {
    match shading {
        Shading::Stiffness => Some(Field::Stiffness),
        Shading::Weights => Some(Field::Weight),
        Shading::Stretch => Some(Field::Stretch),
        Shading::Area => Some(Field::Area),
        Shading::Curvature => Some(Field::Curvature),
        Shading::Clay | Shading::Material | Shading::Zebra | Shading::Normals => None,
    }
}

/// The renderer's style for a look.
pub fn style(look: &Look, pixels_per_point: f32) -> Style {
    let (shading, region_share) = match look.shading {
        Shading::Clay => (pliant_render::Shading::Matcap(matcap(look.clay)), 1.0),
        // The file's colours stay visible under painted stiffness, too.
        Shading::Material => (pliant_render::Shading::Material, 0.8),
        Shading::Zebra => (pliant_render::Shading::Zebra, 0.0),
        Shading::Normals => (pliant_render::Shading::Normals, 0.0),
        Shading::Stiffness | Shading::Weights | Shading::Stretch | Shading::Area | Shading::Curvature => {
            (pliant_render::Shading::Painted, 1.0)
        }
    };
    Style {
        shading,
        region_share: if look.regions || field(look.shading).is_some() {
            region_share
        } else {
            0.0
        },
        faces: if look.flat { Faces::Flat } else { Faces::Smooth },
        wireframe: if look.wireframe { Wireframe::On } else { Wireframe::Off },
        borders: if look.borders { Borders::On } else { Borders::Off },
        outlines: match look.outlines {
            true => Outlines::On,
            false => Outlines::Off,
        },
        shadows: if look.shadow { Shadows::On } else { Shadows::Off },
        pixels_per_point,
        ..Style::default()
    }
}

/// The same while the surface is dragged: the regions' colours fade, and numbers that are shown as colours stay.
pub fn faded_style(look: &Look, pixels_per_point: f32) -> Style {
    let style = style(look, pixels_per_point);
    let share = if field(look.shading).is_some() {
        1.0
    } else {
        FADED_SHARE
    };
    Style {
        region_share: share * style.region_share,
        ..style
    }
}

fn matcap(clay: Clay) -> Matcap {
    match clay {
        Clay::Clay => Matcap::Clay,
        Clay::Plaster => Matcap::Plaster,
        Clay::Wax => Matcap::Wax,
        Clay::Bronze => Matcap::Bronze,
        Clay::Porcelain => Matcap::Porcelain,
        Clay::Graphite => Matcap::Graphite,
    }
}

/// The overlays of a view, relative to `centre`: the method's cage or lattice, the joint of a limb or the arc of a
/// turn, the brush ring, then the gizmo. `pixels_per_point` scales widths.
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
            width_px: RING_WIDTH_POINTS * pixels_per_point,
        }));
    let mut gizmo = Overlay {
        hidden_share: HIDDEN_SHARE,
        ..Overlay::default()
    };
    for shape in view.gizmo {
        let width_px = if shape.highlighted {
            GIZMO_HIGHLIGHTED_POINTS
        } else {
            GIZMO_WIDTH_POINTS
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
    let control_shapes = || view.controls.iter().chain(view.shapes);
    // Lines of one overlay are drawn over its triangles, so the edges have overlays of their own, before the points.
    let edges = control_shapes().map(|shape| {
        let edge = |ends: &[DVec3; 2]| OverlayLine {
            ends: ends.map(relative),
            colours: [shape.colour; 2],
            width_px: CONTROL_WIDTH_POINTS * pixels_per_point,
        };
        Overlay {
            hidden_share: shape.hidden_share,
            lines: shape.lines.iter().map(edge).collect(),
            ..Overlay::default()
        }
    });
    let points = control_shapes().map(|shape| {
        let point = |corners: &[DVec3; 3]| OverlayTriangle {
            corners: corners.map(relative),
            colours: [shape.colour; 3],
        };
        Overlay {
            hidden_share: shape.hidden_share,
            triangles: shape.triangles.iter().map(point).collect(),
            ..Overlay::default()
        }
    });
    edges.chain(points).chain([ring, gizmo]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_look_without_regions_may_have_outlines_and_a_drag_fades_regions_but_no_numbers() {
        let shown = style(&Look::default(), 1.0);
        assert!(shown.region_share > 0.0 && shown.outlines == Outlines::On);
        let faded = faded_style(&Look::default(), 1.0);
        assert!(faded.region_share > 0.0 && faded.region_share < 0.5 * shown.region_share);
        let off = Look {
            regions: false,
            ..Look::default()
        };
        assert_eq!(
            (style(&off, 1.0).region_share, style(&off, 1.0).outlines),
            (0.0, Outlines::On)
        );
        let numbers = Look {
            shading: Shading::Stretch,
            ..Look::default()
        };
        assert_eq!(
            faded_style(&numbers, 1.0).region_share,
            style(&numbers, 1.0).region_share
        );
    }
}
