//! Matcaps: a sphere in each of the editor's clays, shaded on the processor from a few lights and stored as a small
//! texture that the shader looks up by normal.
//!
//! It is a texture, because then any number of lights costs one look-up per pixel, which matters on software devices.
//! It is computed, not painted, because a dozen numbers are easy to read and change. Diffuse and specular light are
//! stored separately so that a region's colour can replace the clay's under the same, evened-out light: regions must be
//! recognisable by their colour on every clay.

use glam::{Vec3, Vec4};

use crate::uniforms::MatcapUniform;

/// A clay with its lighting.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Matcap {
    /// Warm grey modelling clay: only the shape.
    #[default]
    Clay,
    /// White plaster in soft daylight: the finest gradations.
    Plaster,
    /// Red wax with soft highlights, as sculptors use it.
    Wax,
    /// Dark bronze: highlights that run along every ridge.
    Bronze,
    /// Glazed porcelain: sharp highlights that show every dent.
    Porcelain,
    /// Graphite lit from the side: relief.
    Graphite,
}

impl Matcap {
    /// Every matcap.
    pub const ALL: [Self; 6] = [
        Self::Clay,
        Self::Plaster,
        Self::Wax,
        Self::Bronze,
        Self::Porcelain,
        Self::Graphite,
    ];
}

/// A directional light in view space (x right, y up, z towards the eye).
#[derive(Debug, Clone, Copy)]
struct Light {
    direction: Vec3,
    colour: Vec3,
    /// Wrap lighting, 0 to 1: how far the light reaches beyond the terminator, so how large and soft it is.
    wrap: f32,
    /// Exponent of the falloff.
    power: i32,
}

/// The numbers from which a matcap is computed.
#[derive(Debug, Clone, Copy)]
struct MatcapParameters {
    colour: Vec3,
    inside: Vec3,
    lights: [Light; 2],
    /// Light from above and from below.
    sky: Vec3,
    ground: Vec3,
    /// A light from behind that only grazing surfaces catch.
    rim: Light,
    /// The share by which the silhouette darkens before the rim light is added, so that overlapping forms separate.
    contour: f32,
    /// Exponent and strength of each light's highlight.
    specular: [(i32, f32); 2],
    /// Reflected light that grows towards the silhouette.
    sheen: f32,
}

const KEY: Vec3 = Vec3::new(-0.503, 0.647, 0.573);
const FILL: Vec3 = Vec3::new(0.874, -0.175, 0.453);
const RIM: Vec3 = Vec3::new(0.391, 0.521, -0.759);

const fn light(direction: Vec3, colour: [f32; 3], wrap: f32, power: i32) -> Light {
    Light {
        direction,
        colour: Vec3::from_array(colour),
        wrap,
        power,
    }
}

const CLAY: MatcapParameters = MatcapParameters {
    colour: Vec3::new(0.470, 0.418, 0.366),
    inside: Vec3::new(0.215, 0.160, 0.140),
    lights: [
        light(KEY, [1.30, 1.22, 1.12], 0.35, 2),
        light(FILL, [0.110, 0.128, 0.165], 0.30, 1),
    ],
    sky: Vec3::new(0.150, 0.163, 0.185),
    ground: Vec3::new(0.058, 0.050, 0.044),
    rim: light(RIM, [1.05, 1.15, 1.30], 0.45, 1),
    contour: 0.42,
    specular: [(32, 0.075), (32, 0.0)],
    sheen: 0.0,
};

fn parameters(matcap: Matcap) -> MatcapParameters {
    match matcap {
        Matcap::Clay => CLAY,
        Matcap::Plaster => MatcapParameters {
            colour: Vec3::new(0.56, 0.548, 0.530),
            inside: Vec3::new(0.30, 0.27, 0.26),
            lights: [
                light(Vec3::new(-0.58, 0.62, 0.53), [1.02, 0.99, 0.94], 0.40, 2),
                light(FILL, [0.12, 0.14, 0.18], 0.5, 1),
            ],
            sky: Vec3::new(0.155, 0.172, 0.205),
            ground: Vec3::new(0.075, 0.066, 0.058),
            rim: light(RIM, [0.30, 0.33, 0.38], 0.45, 1),
            contour: 0.30,
            specular: [(8, 0.02), (8, 0.0)],
            ..CLAY
        },
        Matcap::Wax => MatcapParameters {
            colour: Vec3::new(0.315, 0.058, 0.040),
            inside: Vec3::new(0.16, 0.045, 0.035),
            lights: [
                light(KEY, [1.42, 1.22, 1.12], 0.50, 2),
                light(FILL, [0.26, 0.17, 0.17], 0.5, 1),
            ],
            sky: Vec3::new(0.19, 0.17, 0.19),
            ground: Vec3::new(0.14, 0.060, 0.050),
            rim: light(RIM, [1.6, 1.1, 1.0], 0.55, 1),
            contour: 0.34,
            specular: [(48, 0.26), (24, 0.06)],
            sheen: 0.045,
        },
        Matcap::Bronze => MatcapParameters {
            colour: Vec3::new(0.225, 0.130, 0.066),
            inside: Vec3::new(0.075, 0.050, 0.038),
            lights: [
                light(KEY, [1.15, 1.05, 0.92], 0.15, 2),
                light(FILL, [0.16, 0.18, 0.22], 0.25, 1),
            ],
            sky: Vec3::new(0.15, 0.16, 0.18),
            ground: Vec3::new(0.085, 0.055, 0.035),
            rim: light(RIM, [1.3, 1.25, 1.15], 0.4, 1),
            contour: 0.50,
            specular: [(18, 0.30), (14, 0.14)],
            sheen: 0.10,
        },
        Matcap::Porcelain => MatcapParameters {
            colour: Vec3::new(0.50, 0.515, 0.535),
            inside: Vec3::new(0.24, 0.24, 0.26),
            lights: [
                light(KEY, [0.92, 0.90, 0.87], 0.35, 2),
                light(FILL, [0.14, 0.16, 0.20], 0.35, 1),
            ],
            sky: Vec3::new(0.20, 0.215, 0.24),
            ground: Vec3::new(0.075, 0.072, 0.070),
            rim: light(RIM, [0.45, 0.50, 0.58], 0.45, 1),
            contour: 0.40,
            specular: [(260, 0.80), (160, 0.34)],
            sheen: 0.14,
        },
        Matcap::Graphite => MatcapParameters {
            colour: Vec3::new(0.235, 0.238, 0.246),
            inside: Vec3::new(0.10, 0.085, 0.082),
            lights: [
                light(Vec3::new(-0.91, 0.34, 0.24), [1.75, 1.70, 1.62], 0.10, 1),
                light(Vec3::new(0.94, 0.05, 0.34), [0.26, 0.32, 0.42], 0.10, 1),
            ],
            sky: Vec3::new(0.085, 0.092, 0.105),
            ground: Vec3::new(0.045, 0.042, 0.040),
            rim: light(RIM, [0.8, 0.9, 1.05], 0.35, 1),
            contour: 0.35,
            specular: [(22, 0.10), (22, 0.05)],
            sheen: 0.03,
        },
    }
}

/// Width and height of each half of the texture.
pub(crate) const SIDE_PX: u32 = 128;

/// A matcap's texture, `2·SIDE_PX` by `SIDE_PX` sRGB pixels: half its diffuse light, then its specular light.
pub(crate) fn texture(matcap: Matcap) -> Vec<u8> {
    let parameters = parameters(matcap);
    let mut rgba = Vec::with_capacity(8 * (SIDE_PX * SIDE_PX) as usize);
    for row in 0..SIDE_PX {
        for column in 0..2 * SIDE_PX {
            let at = |pixel: u32| ((pixel % SIDE_PX) as f32 + 0.5) / SIDE_PX as f32 - 0.5;
            // As the shader samples it: the sphere fills 0.98 of its half, and its silhouette is extended beyond.
            let (x, y) = (at(column) / 0.49, -at(row) / 0.49);
            let radius = (x * x + y * y).sqrt().max(1.0);
            let (x, y) = (x / radius, y / radius);
            let normal = Vec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt());
            let (diffuse, specular) = shade(&parameters, normal);
            let shown = if column < SIDE_PX { 0.5 * diffuse } else { specular };
            rgba.extend(shown.to_array().map(srgb_byte));
            rgba.push(255);
        }
    }
    rgba
}

/// A clay's own colours, and the factors by which its light is multiplied on region colours.
pub(crate) fn uniform(matcap: Matcap) -> MatcapUniform {
    let parameters = parameters(matcap);
    MatcapUniform {
        colour: parameters.colour.extend(1.0).to_array(),
        inside: parameters.inside.extend(1.0).to_array(),
        on_regions: on_regions(&parameters).to_array(),
    }
}

/// Upper limit of highlights on a region's colour.
const SPECULAR_ON_REGIONS: f32 = 0.15;

/// The factors that bring the light of `parameters` to that of plain clay, which region colours are designed for: per
/// channel the ratio of the mean diffuse light over a sphere, and in w a factor that limits the specular light to
/// [`SPECULAR_ON_REGIONS`].
fn on_regions(parameters: &MatcapParameters) -> Vec4 {
    let diffuse = mean_diffuse(&CLAY) / mean_diffuse(parameters);
    let strongest = parameters
        .specular
        .iter()
        .fold(parameters.sheen, |most, (_, strength)| most.max(*strength));
    diffuse.extend((SPECULAR_ON_REGIONS / strongest).min(1.0))
}

/// Mean diffuse light over the visible half of a sphere.
fn mean_diffuse(parameters: &MatcapParameters) -> Vec3 {
    let lights: Vec<Vec3> = sphere().map(|n| shade(parameters, n).0).collect();
    lights.iter().sum::<Vec3>() / lights.len() as f32
}

/// Normals of a sphere, evenly distributed over its image.
fn sphere() -> impl Iterator<Item = Vec3> {
    const STEPS: i32 = 24;
    let at = |step: i32| (step as f32 + 0.5) / STEPS as f32;
    let pixels = (-STEPS..STEPS).flat_map(move |row| (-STEPS..STEPS).map(move |column| (at(column), at(row))));
    let inside = pixels.filter(|(x, y)| x * x + y * y < 1.0);
    inside.map(|(x, y)| Vec3::new(x, y, (1.0 - x * x - y * y).sqrt()))
}

/// Diffuse and specular light at the point of a sphere with unit normal `n`, seen from +z.
fn shade(parameters: &MatcapParameters, n: Vec3) -> (Vec3, Vec3) {
    let falloff = |light: &Light| {
        let wrapped = ((n.dot(light.direction) + light.wrap) / (1.0 + light.wrap)).max(0.0);
        wrapped.powi(light.power)
    };
    let grazing = 1.0 - n.z.max(0.0);
    let mut diffuse = parameters.ground.lerp(parameters.sky, 0.5 + 0.5 * n.y);
    let mut specular = Vec3::ZERO;
    for (light, (exponent, strength)) in parameters.lights.iter().zip(parameters.specular) {
        let falloff = falloff(light);
        diffuse += falloff * light.colour;
        // The half vector of [Bli77].
        let n_dot_h = n.dot((light.direction + Vec3::Z).normalize()).max(0.0);
        let brightest = light.colour.max_element().max(0.2);
        specular += n_dot_h.powi(exponent) * falloff.min(1.0) * strength * light.colour / brightest;
    }
    let rim = grazing.powi(3) * (n.dot(parameters.rim.direction) + parameters.rim.wrap).max(0.0);
    diffuse += rim * parameters.rim.colour;
    diffuse *= 1.0 - parameters.contour * grazing * grazing;
    specular += parameters.sheen * grazing.powi(4) * (0.6 + 0.4 * n.y) * Vec3::ONE;
    (diffuse, specular)
}

/// Linear light encoded as an sRGB byte, clamped.
fn srgb_byte(linear: f32) -> u8 {
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

    /// Blue, gold, red and grey (linear) as the shader shows them on a sphere of each clay: as saturated as on plain
    /// clay (grey stays grey), and with enough contrast to show the form.
    #[test]
    fn region_colours_are_equally_saturated_on_every_clay_and_show_the_form() {
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
                let parameters = parameters(matcap);
                let even = on_regions(&parameters);
                let pixels: Vec<Vec3> = sphere()
                    .map(|n| {
                        let (diffuse, specular) = shade(&parameters, n);
                        shown(colour * diffuse * even.truncate() + specular * even.w)
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
    fn every_clay_is_lit_from_above_without_clipping() {
        for matcap in Matcap::ALL {
            let parameters = parameters(matcap);
            let mean = |y: f32| {
                let xs = (-8..=8).map(|x| x as f32 * 0.08);
                let lights = xs.map(|x| shade(&parameters, Vec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt())).0);
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
