//! Laws on every scan: translations, handle bases, units, distance from the origin, stiffness.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use glam::{DAffine3, DMat3, DVec3};
use pliant_deform::{Bound, Method, Ordering, Problem, RigidMotion, Role};
use pliant_mesh::{Cancel, Model, Progress, Surface};
use pliant_tests::largest_distance;
use pliant_tests::trials::scans;

/// A problem on a scan: its two ends along the longest axis are handles, and a band around its middle may be fixed.
struct Setting<'a> {
    model: &'a Model,
    surface: Surface,
    roles: Vec<Role>,
    stiffness: Vec<f64>,
    ordering: &'a Ordering,
}

impl<'a> Setting<'a> {
    fn new(model: &'a Model, ordering: &'a Ordering, middle: Role) -> Self {
        let bounds = model.bounds().unwrap();
        let axis = (0..3)
            .max_by(|a, b| bounds.extent()[*a].total_cmp(&bounds.extent()[*b]))
            .unwrap();
        let along = |p: &DVec3| (p[axis] - bounds.min[axis]) / bounds.extent()[axis];
        let role = |p: &DVec3| match along(p) {
            s if s < 0.1 => Role::Handle(0),
            s if s > 0.9 => Role::Handle(1),
            s if (s - 0.5).abs() < 0.03 => middle,
            _ => Role::Free,
        };
        Self {
            model,
            surface: model.surface.clone(),
            roles: model.surface.positions.iter().map(role).collect(),
            stiffness: vec![1.0; model.surface.positions.len()],
            ordering,
        }
    }

    fn bind(&self) -> Bound {
        let (mesh, method) = ((&self.surface, &self.model.topology), Method::default());
        let problem = Problem::new(mesh, &self.roles, &self.stiffness, &method);
        problem.bind(self.ordering, &Progress::new(), &Cancel::new()).unwrap()
    }
}

fn step(bound: &mut Bound, targets: &[DAffine3]) -> Vec<DVec3> {
    let mut displacements = vec![DVec3::NAN; bound.vertex_count()];
    bound.set_targets(targets).unwrap();
    bound.step(&mut displacements).unwrap();
    displacements
}

fn solved(bound: &mut Bound, targets: &[DAffine3]) -> Vec<DVec3> {
    let mut displacements = vec![DVec3::NAN; bound.vertex_count()];
    bound.set_targets(targets).unwrap();
    bound.step_by_back_substitution(&mut displacements).unwrap();
    displacements
}

fn turned(about: DVec3, angle_rad: f64, shift: DVec3) -> DAffine3 {
    DAffine3::from_translation(about + shift)
        * DAffine3::from_axis_angle(DVec3::new(0.6, 0.48, 0.64), angle_rad)
        * DAffine3::from_translation(-about)
}

#[test]
fn translations_and_bases_agree_with_solves_on_every_scan() {
    for subject in scans() {
        let (name, model) = (&subject.name, &subject.model);
        let ordering = Ordering::of(&model.topology, 2, &Progress::new(), &Cancel::new()).unwrap();
        let size = model.bounds().unwrap().diagonal();
        let centre = model.bounds().unwrap().centre();
        let mut free = Setting::new(model, &ordering, Role::Free).bind();
        let shift = DVec3::new(0.7, -3.0, 0.2) * size;
        let all = [DAffine3::from_translation(shift); 2];
        for moved in [step(&mut free, &all), solved(&mut free, &all)] {
            let worst = moved.iter().map(|d| d.distance(shift)).fold(0.0, f64::max);
            assert!(worst < 1e-9 * shift.length(), "{name}: a translation is {worst:e} off");
        }
        // In f64 each basis is the solve of a single column: their sum is the solve of the whole.
        let targets = [
            turned(centre, 0.9, DVec3::X * 0.2 * size),
            turned(centre, -0.5, DVec3::Y * 0.1 * size),
        ];
        let whole = solved(&mut free, &targets);
        let largest = whole.iter().map(|d| d.length()).fold(0.0, f64::max);
        let mut sum = vec![DVec3::ZERO; whole.len()];
        for handle in 0..2 {
            for column in 0..4 {
                let mut alone = [DAffine3::IDENTITY; 2];
                let change = targets[handle].matrix3 - DMat3::IDENTITY;
                // A column of the linear part acts about the centre, so its part of the shift is small.
                let part = if column < 3 {
                    let mut columns = [DVec3::ZERO; 3];
                    columns[column] = change.col(column);
                    DMat3::from_cols(columns[0], columns[1], columns[2])
                } else {
                    DMat3::ZERO
                };
                alone[handle] = DAffine3 {
                    matrix3: DMat3::IDENTITY + part,
                    translation: if column < 3 {
                        -(part * centre)
                    } else {
                        targets[handle].transform_point3(centre) - centre
                    },
                };
                for (sum, d) in sum.iter_mut().zip(solved(&mut free, &alone)) {
                    *sum += d;
                }
            }
        }
        // Points that no triangle uses move rigidly with their surroundings, which is not linear.
        let solved_count = model.topology.bare_points().start;
        let (sum, whole) = (&sum[..solved_count], &whole[..solved_count]);
        let apart = largest_distance(sum, whole);
        assert!(apart < 1e-9 * largest, "{name}: columns are {:e} off", apart / largest);
        // Stored bases have the precision of f32.
        let apart = largest_distance(&step(&mut free, &targets)[..solved_count], whole);
        assert!(apart < 1e-6 * largest, "{name}: bases are {:e} off", apart / largest);
    }
}

#[test]
fn units_and_place_do_not_matter_on_any_scan() {
    for subject in scans() {
        let (name, model) = (&subject.name, &subject.model);
        let ordering = Ordering::of(&model.topology, 2, &Progress::new(), &Cancel::new()).unwrap();
        let (size, centre) = (model.bounds().unwrap().diagonal(), model.bounds().unwrap().centre());
        let mut setting = Setting::new(model, &ordering, Role::Fixed);
        let targets = [
            turned(centre, 0.9, DVec3::X * 0.2 * size),
            turned(centre, -0.5, DVec3::Y * 0.1 * size),
        ];
        let here = step(&mut setting.bind(), &targets);
        // The scale is millimetres and kilometres, and the place a hundred diagonals from the origin.
        for (scale, offset) in [
            (1e-3, DVec3::ZERO),
            (1e6, DVec3::ZERO),
            (1.0, DVec3::new(60.0, -70.0, 40.0) * size),
        ] {
            let place = DAffine3::from_translation(offset) * DAffine3::from_scale(DVec3::splat(scale));
            setting.surface.positions = model
                .surface
                .positions
                .iter()
                .map(|p| place.transform_point3(*p))
                .collect();
            let there = step(
                &mut setting.bind(),
                &targets.map(|target| place * target * place.inverse()),
            );
            let back: Vec<DVec3> = there.iter().map(|d| *d / scale).collect();
            let apart = largest_distance(&here, &back) / size;
            assert!(apart < 1e-6, "{name} {scale} {offset}: {apart:e} of the diagonal");
        }
    }
}

#[test]
fn a_stiffer_band_bends_less_on_every_scan() {
    for subject in scans() {
        let (name, model) = (&subject.name, &subject.model);
        let ordering = Ordering::of(&model.topology, 2, &Progress::new(), &Cancel::new()).unwrap();
        let mut setting = Setting::new(model, &ordering, Role::Free);
        let bounds = model.bounds().unwrap();
        let axis = (0..3)
            .max_by(|a, b| bounds.extent()[*a].total_cmp(&bounds.extent()[*b]))
            .unwrap();
        let from_middle = |p: &DVec3| ((p[axis] - bounds.min[axis]) / bounds.extent()[axis] - 0.5).abs();
        let from_middle: Vec<f64> = model.surface.positions.iter().map(from_middle).collect();
        // This holds only well inside the band: at its border, next to softer material, the contrast itself bends the
        // surface.
        let inside: Vec<usize> = (0..from_middle.len()).filter(|&v| from_middle[v] < 0.1).collect();
        let rest: Vec<DVec3> = inside.iter().map(|&v| model.surface.positions[v]).collect();
        let mut targets = [DAffine3::IDENTITY; 2];
        targets[1] = DAffine3::from_translation(DVec3::AXES[(axis + 1) % 3] * 0.3 * bounds.diagonal());
        // At an even stiffness the energy is the Laplacian's and otherwise the Hessian's, which differ on a coarse
        // scan: a tenth is too near to 1 to be compared with it.
        let bends = [0.01, 1.0, 10.0, 100.0].map(|stiffness| {
            for (own, from_middle) in setting.stiffness.iter_mut().zip(&from_middle) {
                *own = if *from_middle < 0.15 { stiffness } else { 1.0 };
            }
            let d = step(&mut setting.bind(), &targets);
            let moved: Vec<DVec3> = inside.iter().map(|&v| d[v]).collect();
            // A turn of the whole band is no bend.
            let fit = RigidMotion::fit(&rest, &moved).unwrap();
            let apart = rest
                .iter()
                .zip(&moved)
                .map(|(p, d)| (fit.displace(*p) - *d).length_squared());
            apart.sum::<f64>()
        });
        assert!(bends.windows(2).all(|pair| pair[1] < pair[0]), "{name}: {bends:?}");
    }
}
