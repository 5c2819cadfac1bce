//! Materials and their maps, on a sphere.

use glam::Vec3;
use pliant_render::{
    AlphaMode, Encoding, Lighting, Map, Material, MaterialGroup, Renderer, Shading, Style, Surface, SurfaceData,
    TextureData,
};

use crate::Shot;
use crate::rig::{Shape, renderer};

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
    Surface::new(renderer.gpu(), &data).unwrap()
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
