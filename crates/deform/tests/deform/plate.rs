//! The thin plate as a material: deflections known by formula, and what stiffness does.

use crate::rig::Scene;
use glam::{DAffine3, DMat4, DVec3, DVec4};
use pliant_deform::Role;
use pliant_mesh::{Drawn, shapes};

/// Where a plate that is held over rows of vertices is taken to be clamped.
///
/// A row's vertex sees the slope through half of its cell only, so two rows clamp midway between them: against that plate
/// the error is of second order. A person takes what was selected, the innermost row: of first order.
#[derive(Clone, Copy, Debug)]
enum Clamp {
    Innermost,
    Between,
}

impl Clamp {
    /// From the innermost row, in rows.
    fn offset(self) -> f64 {
        match self {
            Self::Innermost => 0.0,
            Self::Between => 0.5,
        }
    }

    /// Whether the errors on meshes twice as fine each fall as they should.
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
        // What is held is no solution.
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
/// against w = a + b r² + c ln r + d r² ln r with w and w' given at both ends of what is free.
fn ring_error(cells: usize, clamp: Clamp) -> f64 {
    let step = 2.0 / cells as f64;
    let around = 3 * cells;
    let sheet = shapes::grid(around, cells);
    let positions = sheet.positions.iter().map(|p| {
        // The seam's two sides are welded where they fall on each other to the last bit.
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

/// How much a band around the middle of a lifted strip bends: Σ |second difference| over it.
fn bend_of_middle(stiffness: f64) -> f64 {
    let mut scene = Scene::new(shapes::grid(30, 10))
        .with(Role::Fixed, |p| p.x < 0.11)
        .with(Role::Handle(0), |p| p.x > 0.89);
    let band = |p: DVec3| p.x > 0.25 && p.x < 0.45;
    for (own, &p) in scene.stiffness.iter_mut().zip(&scene.model.surface.positions) {
        if band(p) {
            *own = stiffness;
        }
    }
    let displacements = scene.moved(&[DAffine3::from_translation(DVec3::Z)]);
    let mut row: Vec<(f64, f64)> = scene
        .positions()
        .iter()
        .zip(&displacements)
        .filter(|(p, _)| (p.y - 0.5).abs() < 0.01 && band(**p))
        .map(|(p, d)| (p.x, d.z))
        .collect();
    row.sort_by(|a, b| a.0.total_cmp(&b.0));
    row.windows(3).map(|w| (w[0].1 - 2.0 * w[1].1 + w[2].1).abs()).sum()
}

#[test]
fn a_stiffer_band_bends_less() {
    let bends = [0.01, 0.1, 1.0, 10.0, 100.0].map(bend_of_middle);
    for pair in bends.windows(2) {
        assert!(pair[1] < 0.8 * pair[0], "{bends:?}");
    }
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
