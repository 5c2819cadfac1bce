//! Golden pictures: a small picture for every shading and overlay, compared with the checked one. They are bound to
//! Mesa's software device, whose pictures are equal on every machine bit for bit; on other devices the tests are
//! skipped.
//!
//! `PLIANT_KEEP_PICTURES=1 cargo test -p pliant-render --test golden` replaces the pictures; check them before
//! committing.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may fail by panicking")]

mod rig;

use std::path::Path;
use std::sync::Arc;

use glam::Vec3;
use pliant_render::{
    AlphaMode, Background, Borders, EdgePoint, Encoding, Faces, Frame, Grid, Lighting, Map, Matcap, Material,
    MaterialGroup, Outlines, Overlay, OverlayLine, OverlayTriangle, Renderer, Samples, Shading, Style, Surface,
    SurfaceData, SurfaceLine, TextureData, View, Wireframe, border, region,
};
use rig::{SIZE_PX, Shape, golden, oblique_view, renderer};

/// What a picture shows in addition to its surface; most use the default style and view.
struct Shot<'a> {
    view: View,
    style: Style,
    grid: Option<&'a Grid>,
    overlays: &'a [Overlay],
}

impl Default for Shot<'_> {
    fn default() -> Self {
        Self {
            view: oblique_view(),
            style: Style::default(),
            grid: None,
            overlays: &[],
        }
    }
}

impl Shot<'_> {
    fn of(shading: Shading) -> Self {
        Self {
            style: Style {
                shading,
                ..Style::default()
            },
            ..Self::default()
        }
    }

    /// Draws the picture and compares it with the golden one.
    fn compare(&self, renderer: &mut Renderer, name: &str, surface: &Surface) {
        let frame = Frame {
            view: &self.view,
            style: &self.style,
            surfaces: &[surface],
            grid: self.grid,
            overlays: self.overlays,
        };
        let image = renderer.draw_to_image(SIZE_PX, Samples::Four, &frame).unwrap();
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
        golden::compare(renderer, &folder, name, &image);
    }
}

/// The ring, a third of it in a region colour.
fn painted_ring(renderer: &Renderer) -> Surface {
    let ring = Shape::open_ring(48, 20);
    let regions: Vec<[u8; 4]> = ring
        .positions
        .iter()
        .map(|p| match p {
            [x, ..] if *x > 0.55 => region::HANDLE,
            [x, ..] if *x > -0.35 => region::FREE,
            _ => region::FIXED,
        })
        .collect();
    let data = SurfaceData {
        regions: Some(&regions),
        ..ring.data()
    };
    Surface::new(renderer, &data).unwrap()
}

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
    surface.show(renderer, Some(Arc::new(shown))).unwrap();
    let mut shot = Shot::default();
    shot.style.wireframe = Wireframe::On;
    shot.style.borders = Borders::On;
    shot.compare(renderer, "hidden", &surface);
    let all = Shot::default();
    surface.show(renderer, None).unwrap();
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
    surface.update_lines(renderer, &lines).unwrap();
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
    assert!(surface.update_lines(renderer, &[missing]).is_err());
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
    let surface = Surface::new(&headless.renderer, &data).unwrap();
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

/// A UV sphere of one material.
fn ball(renderer: &Renderer, material: Material, textures: &[TextureData<'_>]) -> Surface {
    let mut sphere = Shape::default();
    let (around, across) = (48_u32, 24_u32);
    let mut uvs = Vec::new();
    for k in 0..=across {
        for i in 0..=around {
            let (u, v) = (i as f32 / around as f32, k as f32 / across as f32);
            let (turn, tip) = (std::f32::consts::TAU * u, std::f32::consts::PI * v);
            let p = Vec3::new(turn.sin() * tip.sin(), tip.cos(), turn.cos() * tip.sin());
            sphere.positions.push(p.to_array());
            sphere.normals.push(p.to_array());
            uvs.push([4.0 * u, 2.0 * v]);
        }
    }
    for k in 0..across {
        for i in 0..around {
            let at = |i: u32, k: u32| k * (around + 1) + i;
            sphere.triangles.push([at(i, k), at(i, k + 1), at(i + 1, k + 1)]);
            sphere.triangles.push([at(i, k), at(i + 1, k + 1), at(i + 1, k)]);
        }
    }
    let data = SurfaceData {
        uvs: Some(&uvs),
        groups: &[MaterialGroup {
            triangles: 0..2 * around * across,
            material: 0,
        }],
        materials: &[material],
        textures,
        ..sphere.data()
    };
    Surface::new(renderer, &data).unwrap()
}

fn image_of(side: u32, pixel: impl Fn(f32, f32) -> [u8; 4]) -> Vec<u8> {
    let at = |t: u32| (t as f32 + 0.5) / side as f32;
    (0..side * side)
        .flat_map(|n| pixel(at(n % side), at(n / side)))
        .collect()
}

#[test]
fn materials() {
    let Some(mut headless) = renderer() else { return };
    let red = Material {
        base_colour: [0.6, 0.07, 0.05, 1.0],
        roughness: 0.35,
        ..Material::default()
    };
    let gold = [1.0, 0.71, 0.29, 1.0];
    let cases = [
        ("plastic", red),
        ("matt", Material { roughness: 1.0, ..red }),
        (
            "gold",
            Material {
                base_colour: gold,
                metallic: 1.0,
                roughness: 0.25,
                ..red
            },
        ),
        (
            "rough-gold",
            Material {
                base_colour: gold,
                metallic: 1.0,
                roughness: 0.7,
                ..red
            },
        ),
        (
            "mirror",
            Material {
                base_colour: [0.95, 0.95, 0.95, 1.0],
                metallic: 1.0,
                roughness: 0.0,
                ..red
            },
        ),
        (
            "glass",
            Material {
                base_colour: [0.6, 0.8, 0.9, 0.35],
                roughness: 0.05,
                alpha: AlphaMode::Blend,
                ..red
            },
        ),
        (
            "emissive",
            Material {
                base_colour: [0.02, 0.02, 0.02, 1.0],
                emissive: [0.2, 1.6, 0.5],
                ..red
            },
        ),
        (
            "unlit",
            Material {
                lighting: Lighting::Unlit,
                ..red
            },
        ),
    ];
    let style = Style {
        shading: Shading::Material,
        ..Style::default()
    };
    for (name, material) in cases {
        let surface = ball(&headless.renderer, material, &[]);
        let name = format!("material-{name}");
        Shot {
            style,
            ..Shot::default()
        }
        .compare(&mut headless.renderer, &name, &surface);
    }
}

#[test]
fn maps() {
    let Some(mut headless) = renderer() else { return };
    let side = 64;
    // Round studs: normals lean outwards from the centre of each tile.
    let studs = image_of(side, |u, v| {
        let (x, y) = (2.0 * u - 1.0, 1.0 - 2.0 * v);
        let radius = (x * x + y * y).sqrt();
        let lean = if radius < 0.75 { radius / 0.75 * 0.8 } else { 0.0 };
        let n = Vec3::new(x / radius.max(1e-4) * lean, y / radius.max(1e-4) * lean, 1.0).normalize();
        let byte = |t: f32| (127.5 * (t + 1.0)).round() as u8;
        [byte(n.x), byte(n.y), byte(n.z), 255]
    });
    let is_chequered = |u: f32, v: f32| (u < 0.5) == (v < 0.5);
    let chequer = image_of(side, |u, v| {
        if is_chequered(u, v) {
            [230, 190, 60, 255]
        } else {
            [40, 70, 150, 255]
        }
    });
    let rough = image_of(side, |u, v| {
        if is_chequered(u, v) {
            [255, 60, 255, 255]
        } else {
            [255, 220, 0, 255]
        }
    });
    let shade = image_of(side, |u, _| [(255.0 * u) as u8, 0, 0, 255]);
    let lamps = image_of(side, |u, v| {
        let is_lamp = (u - 0.5).abs() < 0.12 && (v - 0.5).abs() < 0.3;
        if is_lamp { [255, 120, 30, 255] } else { [0, 0, 0, 255] }
    });
    let holes = image_of(side, |u, v| {
        let alpha = if (u - 0.5).hypot(v - 0.5) < 0.3 { 0 } else { 255 };
        [150, 160, 90, alpha]
    });
    let colour = |rgba| TextureData {
        width: side,
        height: side,
        rgba,
        encoding: Encoding::Srgb,
    };
    let numbers = |rgba| TextureData {
        width: side,
        height: side,
        rgba,
        encoding: Encoding::Linear,
    };
    let grey = Material {
        base_colour: [0.5, 0.5, 0.5, 1.0],
        roughness: 0.5,
        ..Material::default()
    };
    let first = Some(Map::of(0));
    let tilted = Map {
        transform: [[1.4, 0.9, 0.2], [-0.9, 1.4, 0.1]],
        ..Map::of(0)
    };
    let cases = [
        (
            "base-colour",
            Material {
                base_colour: [1.0; 4],
                base_colour_map: first,
                ..grey
            },
            colour(&chequer),
        ),
        (
            "normal",
            Material {
                normal_map: first,
                ..grey
            },
            numbers(&studs),
        ),
        (
            "normal-tilted",
            Material {
                normal_map: Some(tilted),
                ..grey
            },
            numbers(&studs),
        ),
        (
            "roughness",
            Material {
                metallic: 1.0,
                roughness: 1.0,
                metallic_roughness_map: first,
                ..grey
            },
            numbers(&rough),
        ),
        (
            "occlusion",
            Material {
                occlusion_map: first,
                ..grey
            },
            numbers(&shade),
        ),
        (
            "emission",
            Material {
                emissive: [1.5; 3],
                emissive_map: first,
                ..grey
            },
            colour(&lamps),
        ),
        (
            "mask",
            Material {
                base_colour: [1.0; 4],
                base_colour_map: first,
                alpha: AlphaMode::Mask { cutoff: 0.5 },
                ..grey
            },
            colour(&holes),
        ),
    ];
    let style = Style {
        shading: Shading::Material,
        ..Style::default()
    };
    for (name, material, texture) in cases {
        let surface = ball(&headless.renderer, material, &[texture]);
        let name = format!("map-{name}");
        Shot {
            style,
            ..Shot::default()
        }
        .compare(&mut headless.renderer, &name, &surface);
    }
}
