//! Clays: how a sphere of each looks in its studio, computed from a handful of lamps and kept as a small texture (a
//! "matcap") that is looked up by normal.
//!
//! A texture rather than lamps in the shader: any number of lamps costs one look-up a pixel, which software devices
//! feel. Computed rather than painted: a clay is a dozen numbers that can be read and changed here. Light and gloss are
//! kept apart, so that a region's colour can take the clay's place under the same light, evened out: each region is told
//! by its colour on every clay.

use glam::{Vec3, Vec4};

use crate::uniforms::ClayUniform;

/// A clay under its studio's light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Matcap {
    /// Warm grey modelling clay: shape and nothing else.
    #[default]
    Clay,
    /// White plaster in soft daylight: the finest shades.
    Plaster,
    /// Red wax with a soft gloss, as sculptors take it.
    Wax,
    /// Dark bronze: highlights that run along every ridge.
    Bronze,
    /// Glazed porcelain: sharp lamps that show every dent.
    Porcelain,
    /// Graphite lit from the side: relief.
    Graphite,
}

impl Matcap {
    /// Every clay.
    pub const ALL: [Self; 6] = [
        Self::Clay,
        Self::Plaster,
        Self::Wax,
        Self::Bronze,
        Self::Porcelain,
        Self::Graphite,
    ];
}

/// A lamp fixed to the eye, in view space (x right, y up, z towards the eye).
#[derive(Debug, Clone, Copy)]
struct Lamp {
    direction: Vec3,
    colour: Vec3,
    /// How far its light reaches around the corner, 0 to 1: how large and soft it is.
    wrap: f32,
    /// What the reach falls off by.
    power: i32,
}

/// What a clay's look follows from.
#[derive(Debug, Clone, Copy)]
struct Studio {
    colour: Vec3,
    inside: Vec3,
    lamps: [Lamp; 2],
    /// Light from above and from below.
    sky: Vec3,
    ground: Vec3,
    /// Light that only grazing parts catch, from behind.
    rim: Lamp,
    /// How much the contour darkens before the rim lights it: forms separate where they overlap.
    contour: f32,
    /// Exponent and strength of each lamp's highlight.
    gloss: [(i32, f32); 2],
    /// Mirrored light that grows towards the contour.
    sheen: f32,
}

const KEY: Vec3 = Vec3::new(-0.503, 0.647, 0.573);
const FILL: Vec3 = Vec3::new(0.874, -0.175, 0.453);
const RIM: Vec3 = Vec3::new(0.391, 0.521, -0.759);

const fn lamp(direction: Vec3, colour: [f32; 3], wrap: f32, power: i32) -> Lamp {
    Lamp {
        direction,
        colour: Vec3::from_array(colour),
        wrap,
        power,
    }
}

const CLAY: Studio = Studio {
    colour: Vec3::new(0.470, 0.418, 0.366),
    inside: Vec3::new(0.215, 0.160, 0.140),
    lamps: [
        lamp(KEY, [1.30, 1.22, 1.12], 0.35, 2),
        lamp(FILL, [0.110, 0.128, 0.165], 0.30, 1),
    ],
    sky: Vec3::new(0.150, 0.163, 0.185),
    ground: Vec3::new(0.058, 0.050, 0.044),
    rim: lamp(RIM, [1.05, 1.15, 1.30], 0.45, 1),
    contour: 0.42,
    gloss: [(32, 0.075), (32, 0.0)],
    sheen: 0.0,
};

fn studio(matcap: Matcap) -> Studio {
    match matcap {
        Matcap::Clay => CLAY,
        Matcap::Plaster => Studio {
            colour: Vec3::new(0.56, 0.548, 0.530),
            inside: Vec3::new(0.30, 0.27, 0.26),
            lamps: [
                lamp(Vec3::new(-0.58, 0.62, 0.53), [1.02, 0.99, 0.94], 0.40, 2),
                lamp(FILL, [0.12, 0.14, 0.18], 0.5, 1),
            ],
            sky: Vec3::new(0.155, 0.172, 0.205),
            ground: Vec3::new(0.075, 0.066, 0.058),
            rim: lamp(RIM, [0.30, 0.33, 0.38], 0.45, 1),
            contour: 0.30,
            gloss: [(8, 0.02), (8, 0.0)],
            ..CLAY
        },
        Matcap::Wax => Studio {
            colour: Vec3::new(0.315, 0.058, 0.040),
            inside: Vec3::new(0.16, 0.045, 0.035),
            lamps: [
                lamp(KEY, [1.42, 1.22, 1.12], 0.50, 2),
                lamp(FILL, [0.26, 0.17, 0.17], 0.5, 1),
            ],
            sky: Vec3::new(0.19, 0.17, 0.19),
            ground: Vec3::new(0.14, 0.060, 0.050),
            rim: lamp(RIM, [1.6, 1.1, 1.0], 0.55, 1),
            contour: 0.34,
            gloss: [(48, 0.26), (24, 0.06)],
            sheen: 0.045,
        },
        Matcap::Bronze => Studio {
            colour: Vec3::new(0.225, 0.130, 0.066),
            inside: Vec3::new(0.075, 0.050, 0.038),
            lamps: [
                lamp(KEY, [1.15, 1.05, 0.92], 0.15, 2),
                lamp(FILL, [0.16, 0.18, 0.22], 0.25, 1),
            ],
            sky: Vec3::new(0.15, 0.16, 0.18),
            ground: Vec3::new(0.085, 0.055, 0.035),
            rim: lamp(RIM, [1.3, 1.25, 1.15], 0.4, 1),
            contour: 0.50,
            gloss: [(18, 0.30), (14, 0.14)],
            sheen: 0.10,
        },
        Matcap::Porcelain => Studio {
            colour: Vec3::new(0.50, 0.515, 0.535),
            inside: Vec3::new(0.24, 0.24, 0.26),
            lamps: [
                lamp(KEY, [0.92, 0.90, 0.87], 0.35, 2),
                lamp(FILL, [0.14, 0.16, 0.20], 0.35, 1),
            ],
            sky: Vec3::new(0.20, 0.215, 0.24),
            ground: Vec3::new(0.075, 0.072, 0.070),
            rim: lamp(RIM, [0.45, 0.50, 0.58], 0.45, 1),
            contour: 0.40,
            gloss: [(260, 0.80), (160, 0.34)],
            sheen: 0.14,
        },
        Matcap::Graphite => Studio {
            colour: Vec3::new(0.235, 0.238, 0.246),
            inside: Vec3::new(0.10, 0.085, 0.082),
            lamps: [
                lamp(Vec3::new(-0.91, 0.34, 0.24), [1.75, 1.70, 1.62], 0.10, 1),
                lamp(Vec3::new(0.94, 0.05, 0.34), [0.26, 0.32, 0.42], 0.10, 1),
            ],
            sky: Vec3::new(0.085, 0.092, 0.105),
            ground: Vec3::new(0.045, 0.042, 0.040),
            rim: lamp(RIM, [0.8, 0.9, 1.05], 0.35, 1),
            contour: 0.35,
            gloss: [(22, 0.10), (22, 0.05)],
            sheen: 0.03,
        },
    }
}

/// Width and height of each half of the texture.
pub(crate) const SIDE_PX: u32 = 128;

/// The texture of a clay, `2·SIDE_PX` by `SIDE_PX` sRGB pixels: its light, halved, and its gloss.
pub(crate) fn texture(matcap: Matcap) -> Vec<u8> {
    let studio = studio(matcap);
    let mut rgba = Vec::with_capacity(8 * (SIDE_PX * SIDE_PX) as usize);
    for row in 0..SIDE_PX {
        for column in 0..2 * SIDE_PX {
            let at = |pixel: u32| ((pixel % SIDE_PX) as f32 + 0.5) / SIDE_PX as f32 - 0.5;
            // As the shader looks it up: the sphere fills 0.98 of the half, and beyond it its contour goes on.
            let (x, y) = (at(column) / 0.49, -at(row) / 0.49);
            let radius = (x * x + y * y).sqrt().max(1.0);
            let (x, y) = (x / radius, y / radius);
            let normal = Vec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt());
            let (light, gloss) = lit(&studio, normal);
            let shown = if column < SIDE_PX { 0.5 * light } else { gloss };
            rgba.extend(shown.to_array().map(encoded));
            rgba.push(255);
        }
    }
    rgba
}

/// A clay's own colours, and what its light does to those of regions.
pub(crate) fn uniform(matcap: Matcap) -> ClayUniform {
    let studio = studio(matcap);
    ClayUniform {
        colour: studio.colour.extend(1.0).to_array(),
        inside: studio.inside.extend(1.0).to_array(),
        on_regions: on_regions(&studio).to_array(),
    }
}

/// The strongest highlight on a region's colour.
const GLOSS_ON_REGIONS: f32 = 0.15;

/// What brings a studio's light to that of the plain clay, for which the regions' colours are made: its mean over a
/// sphere in each channel, and in w its gloss to no more than [`GLOSS_ON_REGIONS`].
fn on_regions(studio: &Studio) -> Vec4 {
    let light = mean_light(&CLAY) / mean_light(studio);
    let strongest = studio
        .gloss
        .iter()
        .fold(studio.sheen, |most, (_, strength)| most.max(*strength));
    light.extend((GLOSS_ON_REGIONS / strongest).min(1.0))
}

/// The mean light over a sphere as it is seen.
fn mean_light(studio: &Studio) -> Vec3 {
    let lights: Vec<Vec3> = sphere().map(|n| lit(studio, n).0).collect();
    lights.iter().sum::<Vec3>() / lights.len() as f32
}

/// Normals of a sphere, evenly spread over its picture.
fn sphere() -> impl Iterator<Item = Vec3> {
    const STEPS: i32 = 24;
    let at = |step: i32| (step as f32 + 0.5) / STEPS as f32;
    let pixels = (-STEPS..STEPS).flat_map(move |row| (-STEPS..STEPS).map(move |column| (at(column), at(row))));
    let inside = pixels.filter(|(x, y)| x * x + y * y < 1.0);
    inside.map(|(x, y)| Vec3::new(x, y, (1.0 - x * x - y * y).sqrt()))
}

/// Light and gloss of a sphere's point of unit normal `n`, seen from +z.
fn lit(studio: &Studio, n: Vec3) -> (Vec3, Vec3) {
    let reach = |lamp: &Lamp| {
        let reach = ((n.dot(lamp.direction) + lamp.wrap) / (1.0 + lamp.wrap)).max(0.0);
        reach.powi(lamp.power)
    };
    let grazing = 1.0 - n.z.max(0.0);
    let mut light = studio.ground.lerp(studio.sky, 0.5 + 0.5 * n.y);
    let mut gloss = Vec3::ZERO;
    for (lamp, (exponent, strength)) in studio.lamps.iter().zip(studio.gloss) {
        let reach = reach(lamp);
        light += reach * lamp.colour;
        // Blinn 1977.
        let half_way = n.dot((lamp.direction + Vec3::Z).normalize()).max(0.0);
        gloss += half_way.powi(exponent) * reach.min(1.0) * strength * lamp.colour / lamp.colour.max_element().max(0.2);
    }
    let rim = grazing.powi(3) * (n.dot(studio.rim.direction) + studio.rim.wrap).max(0.0);
    light += rim * studio.rim.colour;
    light *= 1.0 - studio.contour * grazing * grazing;
    gloss += studio.sheen * grazing.powi(4) * (0.6 + 0.4 * n.y) * Vec3::ONE;
    (light, gloss)
}

/// The sRGB byte of linear light, clipped.
fn encoded(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    };
    (255.0 * encoded).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blue, gold, red and grey, linear, as they come out of the shader on a sphere of each clay: as deep as on the plain
    /// one (grey stays grey), and with the form to be seen.
    #[test]
    fn a_regions_colour_is_as_deep_on_every_clay_and_shows_the_form() {
        let colours = [
            [0.12, 0.31, 0.73],
            [0.81, 0.48, 0.09],
            [0.62, 0.06, 0.04],
            [0.16, 0.16, 0.17],
        ];
        // `rolled_off` in shaders/lib/tone.wgsl.
        let shown = |light: Vec3| {
            let over = (light - 0.5).max(Vec3::ZERO) / 0.5;
            light.min(Vec3::splat(0.5)) + 0.5 * over / (1.0 + over)
        };
        let depth = |colour: Vec3| 1.0 - colour.min_element() / colour.max_element();
        for colour in colours.map(Vec3::from) {
            let on = |matcap: Matcap| {
                let studio = studio(matcap);
                let even = on_regions(&studio);
                let pixels: Vec<Vec3> = sphere()
                    .map(|n| {
                        let (light, gloss) = lit(&studio, n);
                        shown(colour * light * even.truncate() + gloss * even.w)
                    })
                    .collect();
                let mean = pixels.iter().sum::<Vec3>() / pixels.len() as f32;
                let mut bright: Vec<f32> = pixels.iter().map(|pixel| pixel.element_sum()).collect();
                bright.sort_by(f32::total_cmp);
                (depth(mean), bright[bright.len() * 9 / 10] / bright[bright.len() / 10])
            };
            let (plain_depth, _) = on(Matcap::Clay);
            for matcap in Matcap::ALL {
                let (its_depth, form) = on(matcap);
                assert!(
                    (its_depth - plain_depth).abs() < 0.04,
                    "{matcap:?}: {colour} is {its_depth} deep, not {plain_depth}"
                );
                assert!(form > 3.0, "{matcap:?}: {colour} spans {form}");
            }
        }
    }

    #[test]
    fn every_clay_is_lit_from_above_and_never_clips_its_light() {
        for matcap in Matcap::ALL {
            let studio = studio(matcap);
            let mean = |y: f32| {
                let xs = (-8..=8).map(|x| x as f32 * 0.08);
                let lights = xs.map(|x| lit(&studio, Vec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt())).0);
                lights.map(|light| light.element_sum()).sum::<f32>()
            };
            assert!(mean(0.6) > 1.2 * mean(-0.6), "{matcap:?}");
            let texture = texture(matcap);
            let light = texture.chunks_exact(4 * SIDE_PX as usize).step_by(2).flatten();
            let clipped = light
                .copied()
                .enumerate()
                .filter(|(at, byte)| at % 4 < 3 && *byte == 255);
            assert_eq!(clipped.count(), 0, "{matcap:?}");
        }
    }
}
