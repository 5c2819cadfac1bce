//! Scalar fields on the surface as colours: deformation from the rest shape, curvature, stiffness.

use glam::DVec3;
use pliant_mesh::{Model, SurfaceVertex, face_area, mean_curvatures};
use rayon::prelude::*;

/// A scalar field on the surface.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum Field {
    /// Edge length over rest length; at each vertex, the ratio of its edges that is farthest from 1.
    Stretch,
    /// Area of the triangles around a vertex over their area at rest.
    Area,
    /// Mean curvature, positive where the surface is convex.
    Curvature,
    /// Stiffness, 1 by default.
    Stiffness,
    /// A handle's weight, from 0 to 1.
    Weight,
}

impl Field {
    /// Returns true if it follows from the shape, unlike the others.
    pub fn is_of_shape(self) -> bool {
        !matches!(self, Self::Stiffness | Self::Weight)
    }
}

/// A colour scale, which a legend shows.
#[derive(Clone, PartialEq, Debug)]
pub struct Scale {
    /// The field and its unit.
    pub title: &'static str,
    spacing: Spacing,
    /// Ticks beside the bar, the lowest first.
    pub ticks: Vec<Tick>,
}

/// A tick beside a legend's bar.
#[derive(Clone, PartialEq, Debug)]
pub struct Tick {
    /// Position from 0 (bottom) to 1 (top).
    pub at: f64,
    /// The number beside the tick.
    pub label: String,
}

/// The distribution of numbers along a scale.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Spacing {
    /// Logarithmic, from 1/most to most.
    Ratio { most: f64 },
    /// Linear, from −most to most.
    Even { most: f64 },
    /// Linear, from 0 to 1.
    Share,
}

impl Scale {
    /// The scale of a field on `model`: the same for all of its shapes, so that pictures can be compared.
    pub fn of(field: Field, model: &Model) -> Self {
        let ratio = |title, most: f64, labels: &[f64]| {
            let spacing = Spacing::Ratio { most };
            let tick = |&value: &f64| Tick {
                at: spacing.share(value),
                label: format!("×{value}"),
            };
            Self {
                title,
                spacing,
                ticks: labels.iter().map(tick).collect(),
            }
        };
        match field {
            Field::Stretch => ratio("edge length / rest", 2.0, &[0.5, 0.71, 1.0, 1.41, 2.0]),
            Field::Area => ratio("area / rest", 2.0, &[0.5, 0.71, 1.0, 1.41, 2.0]),
            Field::Stiffness => ratio("stiffness", 1000.0, &[0.001, 0.03, 1.0, 30.0, 1000.0]),
            Field::Weight => Self {
                title: "handle's weight",
                spacing: Spacing::Share,
                ticks: [0.0, 0.25, 0.5, 0.75, 1.0]
                    .map(|at| Tick { at, label: short(at) })
                    .to_vec(),
            },
            Field::Curvature => {
                let most = usual_curvature(model);
                let spacing = Spacing::Even { most };
                let tick = |share: f64| Tick {
                    at: 0.5 + 0.5 * share,
                    label: short(share * most),
                };
                Self {
                    title: "mean curvature, 1/unit",
                    spacing,
                    ticks: [-1.0, -0.5, 0.0, 0.5, 1.0].map(tick).to_vec(),
                }
            }
        }
    }

    /// The sRGB colour of a number, clamped to the scale; NaN is black.
    pub fn colour(&self, value: f64) -> [u8; 4] {
        if value.is_nan() {
            return [0, 0, 0, 255];
        }
        colour_at(self.spacing.share(value))
    }
}

impl Spacing {
    fn share(self, value: f64) -> f64 {
        let signed = match self {
            Self::Ratio { most } => value.ln() / most.ln(),
            Self::Even { most } => value / most,
            Self::Share => 2.0 * value - 1.0,
        };
        (0.5 + 0.5 * signed).clamp(0.0, 1.0)
    }
}

/// The colour at a position on the scale, 0 to 1: a diverging colour map from blue through grey to red, equally bright
/// at both ends so that neither direction is emphasised, after \[Mor09\].
pub fn colour_at(share: f64) -> [u8; 4] {
    const STOPS: [[f64; 3]; 7] = [
        [40.0, 62.0, 176.0],
        [74.0, 128.0, 224.0],
        [142.0, 186.0, 240.0],
        [214.0, 214.0, 212.0],
        [244.0, 168.0, 128.0],
        [222.0, 92.0, 64.0],
        [158.0, 18.0, 44.0],
    ];
    let at = share.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let below = (at as usize).min(STOPS.len() - 2);
    let between = at - below as f64;
    let mixed = |channel: usize| {
        let mixed = STOPS[below][channel] * (1.0 - between) + STOPS[below + 1][channel] * between;
        mixed.round() as u8
    };
    [mixed(0), mixed(1), mixed(2), 255]
}

/// The colours of the surface vertices in the shape given by `displacements`, or of the `values` of a field that does
/// not follow from the shape.
pub fn colours(
    field: Field,
    scale: &Scale,
    model: &Model,
    displacements: &[DVec3],
    values: Option<&[f64]>,
) -> Vec<[u8; 4]> {
    let vertex_count = model.surface.positions.len();
    let colour = |value: f64| scale.colour(value);
    if !field.is_of_shape() {
        let default = if field == Field::Stiffness { 1.0 } else { 0.0 };
        return match values {
            Some(values) => values.par_iter().map(|&value| colour(value)).collect(),
            None => vec![colour(default); vertex_count],
        };
    }
    let rest = &model.surface.positions;
    let moved: Vec<DVec3> = rest.par_iter().zip(displacements).map(|(&p, &d)| p + d).collect();
    match field {
        Field::Stretch | Field::Stiffness | Field::Weight => (0..vertex_count as u32)
            .into_par_iter()
            .map(|v| colour(stretch(model, &moved, SurfaceVertex(v))))
            .collect(),
        Field::Area => {
            let ratio = |v: u32| {
                let around = |positions: &[DVec3]| {
                    let faces = model.topology.faces(SurfaceVertex(v), &model.surface.triangles);
                    let area = |face: u32| {
                        face_area(model.surface.triangles[face as usize].map(|corner| positions[corner.index()]))
                    };
                    faces.map(area).sum::<f64>()
                };
                let before = around(rest);
                if before > 0.0 { around(&moved) / before } else { 1.0 }
            };
            (0..vertex_count as u32)
                .into_par_iter()
                .map(|v| colour(ratio(v)))
                .collect()
        }
        Field::Curvature => mean_curvatures(&model.surface, &model.topology, &moved)
            .into_par_iter()
            .map(colour)
            .collect(),
    }
}

/// The ratio of lengths of the edges at `v` that is farthest from 1; edges of zero length at rest are skipped.
fn stretch(model: &Model, moved: &[DVec3], v: SurfaceVertex) -> f64 {
    let rest = &model.surface.positions;
    let mut worst = 1.0_f64;
    for &u in model.topology.neighbours(v) {
        let before = rest[v.index()].distance(rest[u.index()]);
        if before > 0.0 {
            let ratio = moved[v.index()].distance(moved[u.index()]) / before;
            if ratio.ln().abs() > worst.ln().abs() {
                worst = ratio;
            }
        }
    }
    worst
}

/// The 95th percentile of the absolute mean curvature at rest, rounded up to 1, 2 or 5 times a power of ten.
fn usual_curvature(model: &Model) -> f64 {
    let mut sizes: Vec<f64> = mean_curvatures(&model.surface, &model.topology, &model.surface.positions)
        .into_iter()
        .map(f64::abs)
        .collect();
    if sizes.is_empty() {
        return 1.0;
    }
    let at = (sizes.len() * 95 / 100).min(sizes.len() - 1);
    let (_, &mut usual, _) = sizes.select_nth_unstable_by(at, f64::total_cmp);
    if !(usual.is_finite() && usual > 0.0) {
        return 1.0;
    }
    let power = 10.0_f64.powf(usual.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0];
    let step = steps.into_iter().find(|step| step * power >= usual).unwrap_or(10.0);
    step * power
}

/// A number in at most a few characters.
fn short(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if (0.01..10_000.0).contains(&size) => format!("{}", (value * 1000.0).round() / 1000.0),
        _ => format!("{value:.0e}"),
    }
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use pliant_mesh::{Cancel, Progress, WeldOptions, shapes};

    /// An icosphere of radius `radius`.
    fn sphere(radius: f64, levels: u32) -> Model {
        let mut drawn = shapes::icosphere(levels);
        drawn.positions.iter_mut().for_each(|position| *position *= radius);
        Model::weld(drawn, &WeldOptions::default(), &Progress::default(), &Cancel::default()).unwrap()
    }

    #[test]
    fn a_sphere_curves_by_one_over_its_radius_everywhere() {
        let model = sphere(4.0, 4);
        for curvature in mean_curvatures(&model.surface, &model.topology, &model.surface.positions) {
            assert!((curvature - 0.25).abs() < 0.01, "{curvature}");
        }
        assert_eq!(usual_curvature(&model), 0.5);
    }

    #[test]
    fn doubling_a_surface_reaches_the_upper_end_of_both_scales() {
        let model = sphere(1.0, 2);
        let grown = model.surface.positions.clone();
        let area = Scale::of(Field::Area, &model);
        let stretch = Scale::of(Field::Stretch, &model);
        let none = vec![DVec3::ZERO; grown.len()];
        let of = |field, scale: &Scale, displacements: &[DVec3]| colours(field, scale, &model, displacements, None);
        assert!(
            of(Field::Stretch, &stretch, &grown)
                .iter()
                .all(|&c| c == colour_at(1.0))
        );
        assert!(of(Field::Area, &area, &grown).iter().all(|&c| c == colour_at(1.0)));
        assert!(of(Field::Area, &area, &none).iter().all(|&c| c == colour_at(0.5)));
        let root: Vec<DVec3> = grown.iter().map(|&p| p * (2.0_f64.sqrt() - 1.0)).collect();
        for colour in of(Field::Stretch, &stretch, &root) {
            assert!(
                colour
                    .iter()
                    .zip(stretch.colour(2.0_f64.sqrt()))
                    .all(|(&a, b)| a.abs_diff(b) <= 1)
            );
        }
    }

    #[test]
    fn nan_is_black_and_values_beyond_the_scale_are_clamped() {
        let scale = Scale::of(Field::Stretch, &sphere(1.0, 2));
        assert_eq!(scale.colour(f64::NAN), [0, 0, 0, 255]);
        assert_eq!((scale.colour(0.0), scale.colour(1e9)), (colour_at(0.0), colour_at(1.0)));
        assert_eq!(scale.ticks.iter().map(|tick| tick.at).fold(-1.0, f64::max), 1.0);
    }
}
