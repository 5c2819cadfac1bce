//! The thin plate as a material: deflections known by formula, and the effect of stiffness.

use crate::rig::Scene;
use glam::{DAffine3, DMat4, DVec3, DVec4};
use pliant_deform::Role;
use pliant_mesh::{Drawn, shapes};

/// The assumed clamp of a plate that is held over rows of vertices.
///
/// A row's vertex sees the slope only through half of its cell, so two rows clamp midway between them: against that
/// plate the error is of second order. For a person the clamp is the selected innermost row, which gives an error of
/// first order.
#[derive(Clone, Copy, Debug)]
enum Clamp {
    Innermost,
    Between,
}

impl Clamp {
    /// The distance from the innermost row, in rows.
    fn offset(self) -> f64 {
        match self {
            Self::Innermost => 0.0,
            Self::Between => 0.5,
        }
    }

    /// Returns true if the errors on meshes of twice the resolution fall at the expected rate.
    fn falls(self, errors: [f64; 3]) -> bool {
        let (most, least) = match self {
            Self::Innermost => (0.65, 0.35),
            Self::Between => (0.32, 0.15),
        };
        errors
            .windows(2)
            .all(|pair| pair[1] < most * pair[0] && pair[1] > least * pair[0])
    }
}

/// The largest error of a strip, clamped over slabs at both ends, of which one is lifted by 1, against the beam's
/// cubic 3 s² − 2 s³.
fn strip_error(cells: usize, clamp: Clamp) -> f64 {
    let step = 1.0 / cells as f64;
    // A slab of two rows clamps position and slope.
    let (from, to) = (1.5 * step, 1.0 - 1.5 * step);
    let scene = Scene::new(shapes::grid(cells, cells))
        .with(Role::Fixed, |p| p.x < from)
        .with(Role::Handle(0), |p| p.x > to);
    let displacements = scene.moved(&[DAffine3::from_translation(DVec3::Z)]);
    let (from, to) = ((1.0 - clamp.offset()) * step, 1.0 - (1.0 - clamp.offset()) * step);
    let mut worst = 0.0_f64;
    for (displacement, p) in displacements.iter().zip(scene.positions()) {
        // The held part is no solution.
        if p.x < 0.5 * step || p.x > 1.0 - 0.5 * step {
            continue;
        }
        let s = ((p.x - from) / (to - from)).clamp(0.0, 1.0);
        worst = worst.max((displacement.z - s * s * (3.0 - 2.0 * s)).abs());
        assert!(displacement.x.abs() < 1e-9 && displacement.y.abs() < 1e-9);
    }
    worst
}

#[test]
fn a_lifted_strip_converges_to_the_beam() {
    for clamp in [Clamp::Innermost, Clamp::Between] {
        let errors = [10, 20, 40].map(|cells| strip_error(cells, clamp));
        assert!(errors[0] < 0.1 && clamp.falls(errors), "{clamp:?} {errors:?}");
    }
}

/// The largest error of a ring plate of radii 1 and 3, clamped over two rows at both rims, its inner rim lifted by 1,
/// against w = a + b r² + c ln r + d r² ln r with w and w' given at both ends of the free part.
fn ring_error(cells: usize, clamp: Clamp) -> f64 {
    let step = 2.0 / cells as f64;
    let around = 3 * cells;
    let sheet = shapes::grid(around, cells);
    let positions = sheet.positions.iter().map(|p| {
        // The seam's two sides are welded if they coincide to the last bit.
        let turn = (p.x * around as f64).round() as usize % around;
        let (sin, cos) = (std::f64::consts::TAU * turn as f64 / around as f64).sin_cos();
        let radius = 1.0 + 2.0 * p.y;
        DVec3::new(radius * cos, radius * sin, 0.0)
    });
    let positions = positions.collect();
    let scene = Scene::new(Drawn { positions, ..sheet })
        .with(Role::Fixed, |p| p.length() > 3.0 - 1.5 * step)
        .with(Role::Handle(0), |p| p.length() < 1.0 + 1.5 * step);
    let displacements = scene.moved(&[DAffine3::from_translation(DVec3::Z)]);
    let (inner, outer) = (1.0 + (1.0 - clamp.offset()) * step, 3.0 - (1.0 - clamp.offset()) * step);
    let row = |r: f64| DVec4::new(1.0, r * r, r.ln(), r * r * r.ln());
    let slope = |r: f64| DVec4::new(0.0, 2.0 * r, 1.0 / r, 2.0 * r * r.ln() + r);
    let rows = DMat4::from_cols(row(inner), row(outer), slope(inner), slope(outer)).transpose();
    let coefficients = rows.inverse() * DVec4::new(1.0, 0.0, 0.0, 0.0);
    let mut worst = 0.0_f64;
    for (displacement, p) in displacements.iter().zip(scene.positions()) {
        if p.length() < 1.0 + 0.5 * step || p.length() > 3.0 - 0.5 * step {
            continue;
        }
        let exact = coefficients.dot(row(p.length().clamp(inner, outer)));
        worst = worst.max((displacement.z - exact).abs());
    }
    worst
}

#[test]
fn a_clamped_ring_plate_converges_to_the_analytic_deflection() {
    for clamp in [Clamp::Innermost, Clamp::Between] {
        let errors = [12, 24, 48].map(|cells| ring_error(cells, clamp));
        assert!(
            errors[0] < 0.12 && errors[2] < 0.03 && clamp.falls(errors),
            "{clamp:?} {errors:?}"
        );
    }
}

#[test]
fn the_surface_is_smooth_where_it_meets_what_is_held() {
    // Thin plates join with equal slope: the first of 32 steps up is far below a 32nd.
    let scene = Scene::new(shapes::grid(40, 40))
        .with(Role::Fixed, |p| p.x < 0.11)
        .with(Role::Handle(0), |p| p.x > 0.89);
    let displacements = scene.moved(&[DAffine3::from_translation(DVec3::Z)]);
    let first_row = scene
        .positions()
        .iter()
        .zip(&displacements)
        .filter(|(p, _)| p.x > 0.12 && p.x < 0.13);
    for (_, displacement) in first_row {
        assert!(
            displacement.z > 0.0 && displacement.z < 0.25 / 32.0,
            "{}",
            displacement.z
        );
    }
}

/// A strip of length 1, clamped at its ends, one of which is moved and turned; a band of it has another stiffness.
/// Returns x and the height along the middle.
fn strip_with_band(cells: usize, stiffness: f64, target: DAffine3) -> Vec<(f64, f64)> {
    let mut scene = Scene::new(shapes::grid(cells, 6))
        .with(Role::Fixed, |p| p.x < CLAMPS.start)
        .with(Role::Handle(0), |p| p.x > CLAMPS.end);
    for (own, p) in scene.stiffness.iter_mut().zip(&scene.model.surface.positions) {
        if BAND.contains(&p.x) {
            *own = stiffness;
        }
    }
    let displacements = scene.moved(&[target]);
    let mut row: Vec<(f64, f64)> = scene
        .positions()
        .iter()
        .zip(&displacements)
        .filter(|(p, _)| (p.y - 0.5).abs() < 1e-6)
        .map(|(p, d)| (p.x, d.z))
        .collect();
    row.sort_by(|a, b| a.0.total_cmp(&b.0));
    row
}

/// The range between the clamps, and that of the band: no vertex in the tests is at an end.
const CLAMPS: std::ops::Range<f64> = 0.113..0.887;
const BAND: std::ops::Range<f64> = 0.253..0.447;

/// Halfway between the last vertex below `x` and the first above.
fn between_vertices(x: f64, cells: usize) -> f64 {
    ((x * cells as f64).floor() + 0.5) / cells as f64
}

/// The bending of the band, its rim included: Σ |second difference| over every vertex whose neighbours reach it.
fn bend_of_band(row: &[(f64, f64)]) -> f64 {
    let reaches = |w: &[(f64, f64)]| w.iter().any(|(x, _)| BAND.contains(x));
    let windows = row.windows(3).filter(|w| reaches(w));
    windows.map(|w| (w[0].1 - 2.0 * w[1].1 + w[2].1).abs()).sum()
}

#[test]
fn a_stiffer_band_bends_less_with_its_rim() {
    let lifted = DAffine3::from_translation(DVec3::Z);
    let hinge = DVec3::new(0.9, 0.5, 0.0);
    let turned =
        DAffine3::from_translation(hinge) * DAffine3::from_rotation_y(-0.7) * DAffine3::from_translation(-hinge);
    for target in [lifted, turned] {
        let bends =
            [0.01, 0.1, 1.0, 10.0, 100.0].map(|stiffness| bend_of_band(&strip_with_band(50, stiffness, target)));
        for pair in bends.windows(2) {
            assert!(pair[1] < pair[0], "{bends:?}");
        }
        // The remaining bending of the stiffest band is in the soft half of the rim's cells.
        assert!(bends[4] < 0.5 * bends[2] && bends[2] < 0.5 * bends[0], "{bends:?}");
    }
}

/// The deflection of a beam between clamps `from` and `to`, lifted by 1, with EI from `stiffness`: EI w'' = a + b x, by
/// sums over `steps` pieces.
fn beam(from: f64, to: f64, stiffness: impl Fn(f64) -> f64, steps: usize) -> impl Fn(f64) -> f64 {
    let h = (to - from) / steps as f64;
    let middle = move |i: usize| from + (i as f64 + 0.5) * h;
    // w'(to) = 0 and w(to) = 1: two equations for a and b.
    let moment = |power: i32, arm: bool| -> f64 {
        let term = |i: usize| middle(i).powi(power) * if arm { to - middle(i) } else { 1.0 } / stiffness(middle(i)) * h;
        (0..steps).map(term).sum()
    };
    let [m00, m01, m10, m11] = [moment(0, false), moment(1, false), moment(0, true), moment(1, true)];
    let determinant = m00 * m11 - m01 * m10;
    let (a, b) = (-m01 / determinant, m00 / determinant);
    let (mut slope, mut height) = (0.0, 0.0);
    let mut heights = vec![0.0];
    for i in 0..steps {
        let curvature = (a + b * middle(i)) / stiffness(middle(i));
        height += h * (slope + 0.5 * h * curvature);
        slope += h * curvature;
        heights.push(height);
    }
    move |x: f64| heights[(((x - from) / h).round().max(0.0) as usize).min(steps)]
}

#[test]
fn a_band_bends_as_a_beam_of_its_stiffness() {
    for stiffness in [0.02, 1.0, 50.0] {
        let error = |cells: usize| {
            let row = strip_with_band(cells, stiffness, DAffine3::from_translation(DVec3::Z));
            // A vertex' cell has the vertex' stiffness, and reaches half way to the next.
            let [from, to] = [CLAMPS.start, CLAMPS.end].map(|x| between_vertices(x, cells));
            let band = between_vertices(BAND.start, cells)..between_vertices(BAND.end, cells);
            let at = beam(from, to, |x| if band.contains(&x) { stiffness } else { 1.0 }, 20_000);
            row.iter().map(|&(x, z)| (z - at(x)).abs()).fold(0.0, f64::max)
        };
        let errors = [50, 100, 200].map(error);
        assert!(
            errors[2] < 0.02 && errors[2] < 0.7 * errors[0],
            "{stiffness}: {errors:?}"
        );
    }
}

/// A bump of height 1 on the unit square, zero with its slope outside a disc, and its second derivatives xx, xy, yy.
fn bump(p: DVec3) -> (f64, [f64; 3]) {
    let (x, y) = ((p.x - 0.45) / 0.4, (p.y - 0.5) / 0.4);
    let t = 1.0 - x * x - y * y;
    if t <= 0.0 {
        return (0.0, [0.0; 3]);
    }
    let second = |a: f64, b: f64, same: f64| (48.0 * a * b * t * t - 8.0 * same * t.powi(3)) / 0.16;
    (t.powi(4), [second(x, x, 1.0), second(x, y, 0.0), second(y, y, 1.0)])
}

#[test]
fn where_stiffness_varies_the_energy_is_that_of_the_hessian() {
    let stiffness = |p: DVec3| if p.x > 0.42 { 5.0 } else { 0.5 };
    let energy = |cells: usize| {
        let mut scene = Scene::new(shapes::grid(cells, cells))
            .with(Role::Fixed, |p| p.x < 0.02)
            .with(Role::Handle(0), |p| p.x > 0.98);
        for (own, p) in scene.stiffness.iter_mut().zip(&scene.model.surface.positions) {
            *own = stiffness(*p);
        }
        let heights: Vec<DVec3> = scene.positions().iter().map(|p| DVec3::Z * bump(*p).0).collect();
        // The handle rests, and the stiff part with it.
        scene.bind().energy_of(&heights).unwrap()
    };
    // The energy of a bump that reaches into both halves is ½ ∫ s₀ (Δf)² + (s − s₀) |∇²f|².
    let fine = 800;
    let exact: f64 = (0..fine * fine)
        .map(|i| {
            let p = DVec3::new((i % fine) as f64 + 0.5, (i / fine) as f64 + 0.5, 0.0) / fine as f64;
            let [xx, xy, yy] = bump(p).1;
            let hessian = xx * xx + 2.0 * xy * xy + yy * yy;
            0.5 * (0.5 * (xx + yy).powi(2) + (stiffness(p) - 0.5) * hessian) / (fine * fine) as f64
        })
        .sum();
    let errors = [20, 40, 80].map(|cells| (energy(cells) / exact - 1.0).abs());
    assert!(errors[2] < 0.02 && errors[2] < 0.5 * errors[0], "{errors:?}");
}

#[test]
fn stiffness_everywhere_changes_nothing() {
    let mut scene = Scene::new(shapes::torus(20, 12)).with_ends(true);
    let targets: Vec<DAffine3> = (0..scene.handle_count)
        .map(|_| crate::rig::turned(DVec3::ZERO, 0.5, DVec3::Y))
        .collect();
    let plain = scene.moved(&targets);
    scene.stiffness.fill(300.0);
    assert!(crate::rig::apart(&plain, &scene.moved(&targets)) < 1e-6);
}

#[test]
fn extreme_strokes_of_stiffness_still_bind() {
    for (name, drawn) in shapes::classes() {
        let mut scene = Scene::new(drawn).with_ends(true);
        for (vertex, stiffness) in scene.stiffness.iter_mut().enumerate() {
            *stiffness = if vertex % 4 < 2 { 1000.0 } else { 0.001 };
        }
        let targets = vec![DAffine3::from_translation(DVec3::ONE); scene.handle_count];
        assert!(
            scene
                .moved(&targets)
                .iter()
                .all(|displacement| displacement.is_finite()),
            "{name}"
        );
    }
}
