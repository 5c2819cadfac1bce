//! Shadings, modes, lines and marks.

use std::sync::Arc;

use glam::Vec3;
use pliant_render::{
    Background, Borders, EdgePoint, Faces, Grid, Matcap, Outlines, Overlay, OverlayLine, OverlayTriangle, Shading,
    Shadows, Style, Surface, SurfaceData, SurfaceLine, View, Wireframe, border,
};

use crate::rig::{Shape, renderer};
use crate::{Shot, painted_ring};

#[test]
fn clays() {
    let Some(mut headless) = renderer() else { return };
    let surface = painted_ring(&headless.renderer);
    for matcap in Matcap::ALL {
        let name = format!("{matcap:?}").to_lowercase();
        Shot::of(Shading::Matcap(matcap)).compare(&mut headless.renderer, &name, &surface);
    }
}

#[test]
fn modes() {
    let Some(mut headless) = renderer() else { return };
    let surface = painted_ring(&headless.renderer);
    type Change = fn(&mut Style);
    let modes: [(&str, Change); 8] = [
        ("regions", |style| style.region_share = 1.0),
        ("painted", |style| {
            style.shading = Shading::Painted;
            style.region_share = 1.0;
        }),
        ("zebra", |style| style.shading = Shading::Zebra),
        ("normals", |style| style.shading = Shading::Normals),
        ("flat", |style| style.faces = Faces::Flat),
        ("wireframe", |style| style.wireframe = Wireframe::On),
        ("borders", |style| style.borders = Borders::On),
        ("transparent", |style| style.background = Background::Transparent),
    ];
    for (name, change) in modes {
        let mut shot = Shot::default();
        change(&mut shot.style);
        shot.compare(&mut headless.renderer, name, &surface);
    }
}

/// Part of the ring is hidden: neither its triangles nor its edges nor its borders are drawn.
#[test]
fn hidden() {
    let Some(mut headless) = renderer() else { return };
    let renderer = &mut headless.renderer;
    let mut surface = painted_ring(renderer);
    let ring = Shape::open_ring(48, 20);
    let is_shown = |triangle: &[u32; 3]| ring.positions[triangle[0] as usize][1] < 0.3;
    let shown: Vec<bool> = ring.triangles.iter().map(is_shown).collect();
    surface.show(renderer.gpu(), Some(Arc::new(shown))).unwrap();
    let mut shot = Shot::default();
    shot.style.wireframe = Wireframe::On;
    shot.style.borders = Borders::On;
    shot.compare(renderer, "hidden", &surface);
    let all = Shot::default();
    surface.show(renderer.gpu(), None).unwrap();
    all.compare(renderer, "clay", &surface);
}

#[test]
fn outlines() {
    let Some(mut headless) = renderer() else { return };
    let renderer = &mut headless.renderer;
    let mut surface = painted_ring(renderer);
    // Around the tube between two of its rows, through the midpoints of edges.
    let (across, row) = (20, 6);
    let between = |k: u32, to: u32| EdgePoint {
        vertices: [row * across + k % across, (row + 1) * across + to % across],
        share: 0.5,
    };
    let lines = |colour, width_points| {
        (0..across).flat_map(move |k| {
            let [diagonal, side] = [between(k, k + 1), between(k + 1, k + 1)];
            [[between(k, k), diagonal], [diagonal, side]].map(|ends| SurfaceLine {
                ends,
                colour,
                width_points,
            })
        })
    };
    let lines: Vec<SurfaceLine> = lines([24, 25, 28, 255], 6.0)
        .chain(lines([232, 184, 48, 255], 3.4))
        .collect();
    surface.update_lines(renderer.gpu(), &lines).unwrap();
    let mut shot = Shot::default();
    shot.style.outlines = Outlines::On;
    shot.compare(renderer, "outlines", &surface);
    let missing = SurfaceLine {
        ends: [EdgePoint {
            vertices: [0, u32::MAX],
            share: 0.5,
        }; 2],
        ..lines[0]
    };
    assert!(surface.update_lines(renderer.gpu(), &[missing]).is_err());
}

#[test]
fn orthographic() {
    let Some(mut headless) = renderer() else { return };
    let surface = painted_ring(&headless.renderer);
    let view_from_world = View::look_at(Vec3::new(1.6, 2.0, 3.6), Vec3::ZERO, Vec3::Y);
    let view = View::orthographic(1.45, 1.5, -5.0, 15.0, view_from_world);
    let style = Style {
        wireframe: Wireframe::On,
        borders: Borders::On,
        ..Style::default()
    };
    Shot {
        view,
        style,
        ..Shot::default()
    }
    .compare(&mut headless.renderer, "orthographic", &surface);
}

#[test]
fn ground() {
    let Some(mut headless) = renderer() else { return };
    let surface = painted_ring(&headless.renderer);
    let grid = Grid {
        middle: [0.0, -1.25, 0.0],
        along: [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        step: 0.2,
        reach: 7.0,
        fine_share: 0.8,
        axes: [0.0, 2.0],
        colour: [168, 176, 190, 110],
        axis_colours: [[190, 84, 90, 200], [84, 126, 196, 200]],
    };
    Shot {
        grid: Some(&grid),
        ..Shot::default()
    }
    .compare(&mut headless.renderer, "ground", &surface);
}

/// The ring stands on the ground: its shadow is dark where it touches it.
#[test]
fn shadow() {
    let Some(mut headless) = renderer() else { return };
    let renderer = &mut headless.renderer;
    let mut surface = painted_ring(renderer);
    let ground = Grid {
        middle: [0.0, -1.25, 0.0],
        along: [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]],
        step: 0.2,
        reach: 7.0,
        fine_share: 0.8,
        axes: [0.0, 2.0],
        colour: [168, 176, 190, 110],
        axis_colours: [[84, 126, 196, 200], [190, 84, 90, 200]],
    };
    renderer.update_shadow(&mut surface, &ground).unwrap();
    let view_from_world = View::look_at(Vec3::new(1.6, 3.0, 5.0), Vec3::new(0.0, -0.5, 0.0), Vec3::Y);
    let view = View::perspective(0.62, 1.5, 0.01, view_from_world);
    let background = Background::Gradient {
        top: [200; 3],
        bottom: [180; 3],
    };
    let style = Style {
        shadows: Shadows::On,
        background,
        ..Style::default()
    };
    let shot = Shot {
        view,
        style,
        ..Shot::default()
    };
    shot.compare(renderer, "shadow", &surface);
}

#[test]
fn marks() {
    let Some(mut headless) = renderer() else { return };
    let surface = painted_ring(&headless.renderer);
    let line = |end: [f32; 3], colour| OverlayLine {
        ends: [[0.0; 3], end],
        colours: [colour; 2],
        width_px: 3.0,
    };
    let marks = Overlay {
        triangles: vec![OverlayTriangle {
            corners: [[0.2, 0.2, 0.0], [0.6, 0.2, 0.0], [0.2, 0.6, 0.0]],
            colours: [[255, 220, 80, 160]; 3],
        }],
        lines: vec![
            line([1.2, 0.0, 0.0], [226, 62, 72, 255]),
            line([0.0, 1.2, 0.0], [106, 176, 48, 255]),
            line([0.0, 0.0, 1.2], [58, 122, 228, 255]),
        ],
        hidden_share: 0.35,
    };
    Shot {
        overlays: &[marks],
        ..Shot::default()
    }
    .compare(&mut headless.renderer, "marks", &surface);
}

#[test]
fn irregular_edges_are_marked() {
    let Some(mut headless) = renderer() else { return };
    // Two crossing squares: four triangles share the common edge.
    let mut cross = Shape::default();
    for axis in [Vec3::X, Vec3::Z] {
        let first = cross.positions.len() as u32;
        let corners = [
            -axis - Vec3::Y,
            -Vec3::Y,
            axis - Vec3::Y,
            -axis + Vec3::Y,
            Vec3::Y,
            axis + Vec3::Y,
        ];
        cross.positions.extend(corners.map(|corner| corner.to_array()));
        let normal = axis.cross(Vec3::Y).to_array();
        cross.normals.extend([normal; 6]);
        let square = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]];
        cross
            .triangles
            .extend(square.map(|triangle| triangle.map(|corner| first + corner)));
    }
    let welded: Vec<u32> = (0..12).map(|v| if v == 7 || v == 10 { v - 6 } else { v }).collect();
    let data = SurfaceData {
        welded: Some(&welded),
        ..cross.data()
    };
    let surface = Surface::new(headless.renderer.gpu(), &data).unwrap();
    let style = Style {
        borders: Borders::On,
        ..Style::default()
    };
    assert_eq!(border::OPEN[3], 255);
    Shot {
        style,
        ..Shot::default()
    }
    .compare(&mut headless.renderer, "odd-edges", &surface);
}
