//! The laws of all iterative methods.

use crate::rig::{Scene, apart, far, mirrored, settle, turned};
use crate::shared;
use glam::{DAffine3, DVec3};
use pliant_deform::{Arap, ArapEnergy, Method, Primo, Role, Shells};
use pliant_mesh::{Drawn, SurfaceVertex, shapes};

/// An iterative method.
#[derive(Clone, Copy, Debug)]
pub enum Iterative {
    Arap(ArapEnergy),
    /// With a coarse level, for a surface of any size.
    Led(ArapEnergy),
    Primo,
    Shells,
    /// With a coarse level, for a surface of any size.
    LedShells,
}

const ITERATIVE: [Iterative; 8] = [
    Iterative::Arap(ArapEnergy::Spokes),
    Iterative::Arap(ArapEnergy::SpokesAndRims),
    Iterative::Arap(ArapEnergy::Smooth),
    Iterative::Led(ArapEnergy::SpokesAndRims),
    Iterative::Led(ArapEnergy::Smooth),
    Iterative::Primo,
    Iterative::Shells,
    Iterative::LedShells,
];

impl Iterative {
    pub fn ending_at(self, tolerance: f64) -> Method {
        self.ending(tolerance, 2000)
    }

    fn ending(self, tolerance: f64, max_iterations: u32) -> Method {
        match self {
            Self::Arap(energy) | Self::Led(energy) => {
                let mut options = Arap::default();
                options.energy = energy;
                options.tolerance = tolerance;
                options.max_iterations = max_iterations;
                if matches!(self, Self::Led(_)) {
                    options.coarse_above = 0;
                }
                Method::from(options)
            }
            Self::Primo => {
                let mut options = Primo::default();
                options.tolerance = tolerance;
                options.max_iterations = max_iterations;
                Method::from(options)
            }
            Self::Shells | Self::LedShells => {
                let mut options = Shells::default();
                if matches!(self, Self::LedShells) {
                    options.led_above = 0;
                }
                options.tolerance = tolerance;
                options.max_iterations = max_iterations;
                Method::from(options)
            }
        }
    }
}

/// With the tolerance 1e-10.
pub fn scene(drawn: Drawn, method: Iterative) -> Scene {
    let mut scene = Scene::new(drawn);
    scene.method = method.ending_at(1e-10);
    scene
}

#[test]
fn a_mirrored_scene_gives_the_mirrored_shape() {
    let flip = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    for method in ITERATIVE {
        let tube = shapes::moved(
            &shapes::tube(10, 20, 8.0),
            DAffine3::from_rotation_y(std::f64::consts::FRAC_PI_2),
        );
        let ends = |drawn: Drawn, side: f64| {
            scene(drawn, method)
                .with(Role::Fixed, |p| p.x * side < 0.5)
                .with(Role::Handle(0), |p| p.x * side > 7.5)
        };
        let (here, there) = (ends(tube.clone(), 1.0), ends(mirrored(&tube), -1.0));
        let target = turned(DVec3::X * 7.0, 1.2, DVec3::new(-1.0, 1.0, 0.0));
        let (shape, _) = settle(&mut here.bind(), &[target]);
        let (reflection, _) = settle(&mut there.bind(), &[flip * target * flip]);
        let image_of = |p: &DVec3| {
            there
                .positions()
                .iter()
                .position(|q| *q == flip.transform_point3(*p))
                .unwrap()
        };
        let back: Vec<DVec3> = here
            .positions()
            .iter()
            .map(|p| flip.transform_vector3(reflection[image_of(p)]))
            .collect();
        let error = apart(&shape, &back) / here.diagonal();
        assert!(shape.iter().any(|d| d.length() > 1.0));
        assert!(error < 1e-4, "{method:?}: {error:e}");
    }
}

#[test]
fn the_result_is_the_same_bit_for_bit_on_any_number_of_threads() {
    for method in ITERATIVE {
        // This is enough for more than one chunk of either's cells.
        let [around, across] = match method {
            Iterative::Arap(_) | Iterative::Led(_) => [90, 40],
            Iterative::Primo | Iterative::Shells | Iterative::LedShells => [40, 30],
        };
        let mut scene = scene(shapes::torus(around, across), method).with_ends(true);
        scene.method = method.ending_at(1e-4);
        let results = || {
            let bound = &mut scene.bind();
            let targets = [0, 1].map(|k| far(&scene)[k % scene.handle_count]);
            targets.map(|target| settle(bound, &[target]))
        };
        shared::same_on_any_number_of_threads(results, &format!("{method:?}"));
    }
}

#[test]
fn what_is_painted_stiffer_is_bent_less() {
    for method in ITERATIVE {
        let mut last = f64::INFINITY;
        for stiffness in [0.01, 0.1, 1.0, 10.0, 100.0] {
            let mut scene = scene(shapes::tube(12, 24, 8.0), method)
                .with(Role::Fixed, |p| p.z < 0.5)
                .with(Role::Handle(0), |p| p.z > 7.5);
            let inside = |p: DVec3| p.z > 2.5 && p.z < 5.5;
            for (own, &p) in scene.stiffness.iter_mut().zip(&scene.model.surface.positions) {
                *own = if inside(p) { stiffness } else { 1.0 };
            }
            let (d, _) = settle(&mut scene.bind(), &[turned(DVec3::Z * 7.5, 1.0, DVec3::X)]);
            let mut strain = 0.0;
            for (vertex, &p) in scene.positions().iter().enumerate().filter(|(_, p)| inside(**p)) {
                for &other in scene.model.topology.neighbours(SurfaceVertex(vertex as u32)) {
                    let (rest, q) = (scene.positions()[other.index()] - p, d[other.index()] - d[vertex]);
                    if inside(scene.positions()[other.index()]) {
                        strain += ((rest + q).length() / rest.length() - 1.0).powi(2);
                    }
                }
            }
            assert!(strain < last, "{method:?} {stiffness}: {strain} {last}");
            last = strain;
        }
    }
}

#[test]
fn extreme_targets_give_finite_shapes_and_do_not_spoil_the_next() {
    for method in ITERATIVE {
        for (name, drawn) in shapes::classes() {
            let mut scene = scene(drawn, method).with_ends(true);
            scene.method = method.ending_at(match method {
                Iterative::Arap(_) | Iterative::Led(_) => 1e-4,
                Iterative::Primo | Iterative::Shells | Iterative::LedShells => 1e-3,
            });
            let bound = &mut scene.bind();
            for target in shared::extreme(&scene) {
                let (_, energies) = settle(bound, &vec![target; scene.handle_count]);
                assert!(energies.windows(2).all(|pair| pair[1] <= pair[0]), "{name}");
            }
            let beyond = DAffine3::from_translation(DVec3::X * 1e200);
            shared::finite_beyond_all_bounds(bound, beyond, scene.handle_count);
            settle(bound, &far(&scene));
        }
    }
}

#[test]
fn a_rigid_motion_of_all_handles_moves_everything_rigidly() {
    for method in ITERATIVE {
        for (name, drawn) in shapes::classes() {
            let scene = scene(drawn, method).with_ends(false);
            let centre = scene.model.bounds().unwrap().centre();
            let bound = &mut scene.bind();
            // The last ones are small steps of a drag.
            for angle in [0.0, 1.0, 3.0, -2.0, -1.998, -1.9] {
                let motion = turned(centre, angle, DVec3::new(2.0, -1.0, 0.5) * scene.diagonal());
                let (displacements, energies) = settle(bound, &vec![motion; scene.handle_count]);
                let expected: Vec<DVec3> = scene
                    .positions()
                    .iter()
                    .map(|&p| motion.transform_point3(p) - p)
                    .collect();
                let error = apart(&displacements, &expected) / scene.diagonal();
                assert!(error < 1e-6, "{name} {method:?} {angle}: {error:e}");
                // If a coarse level leads ARAP, a global step in single precision comes first.
                let most = if matches!(method, Iterative::Led(_)) { 20 } else { 10 };
                assert!(energies.len() < most, "{name} {method:?} {angle}: {}", energies.len());
            }
        }
    }
}

#[test]
fn a_drag_ends_where_one_solve_does() {
    for method in ITERATIVE {
        let mut scene = scene(shapes::tube(16, 30, 8.0), method)
            .with(Role::Fixed, |p| p.z < 0.5)
            .with(Role::Handle(0), |p| p.z > 7.5);
        scene.method = method.ending_at(1e-9);
        let target = |t: f64| turned(DVec3::Z * 7.5, 1.4 * t, DVec3::X * t);
        let (once, _) = settle(&mut scene.bind(), &[target(1.0)]);
        let bound = &mut scene.bind();
        for frame in 1..20 {
            // Like a hand: a few steps per frame.
            let mut out = vec![DVec3::ZERO; scene.roles.len()];
            for iteration in 1..=3 {
                bound.set_targets(&[target(f64::from(frame) / 20.0)]).unwrap();
                assert_eq!(bound.step(&mut out).unwrap().iteration, iteration);
            }
        }
        let (dragged, _) = settle(bound, &[target(1.0)]);
        let error = apart(&once, &dragged) / scene.diagonal();
        assert!(error < 1e-3, "{method:?}: {error:e}");
    }
}

#[test]
fn a_drag_through_the_body_and_back_ends_no_higher_than_one_solve() {
    for method in [
        Iterative::Arap(ArapEnergy::Spokes),
        Iterative::Arap(ArapEnergy::SpokesAndRims),
        Iterative::Arap(ArapEnergy::Smooth),
        Iterative::Led(ArapEnergy::SpokesAndRims),
        Iterative::Primo,
    ] {
        let mut scene = scene(shapes::tube(12, 24, 8.0), method)
            .with(Role::Fixed, |p| p.z < 0.5)
            .with(Role::Handle(0), |p| p.z > 7.5);
        scene.method = method.ending_at(1e-7);
        // The end sinks through the fixed one, turns over below it, and comes back.
        let at = |depth: f64, turn: f64| {
            DAffine3::from_translation(DVec3::new(0.2, 0.1, -depth)) * turned(DVec3::Z * 7.5, turn, DVec3::ZERO)
        };
        let down = (1..=8).map(|k| at(1.5 * f64::from(k), 0.35 * f64::from(k)));
        let back = (1..=8).map(|k| at(12.0 - 1.4 * f64::from(k), 2.8 - 0.3 * f64::from(k)));
        let path: Vec<DAffine3> = down.chain(back).collect();
        let last = path[path.len() - 1];
        let bound = &mut scene.bind();
        let mut ends = Vec::new();
        for target in path {
            ends.push(settle(bound, &[target]));
        }
        let dragged = ends.pop().and_then(|(_, energies)| energies.last().copied()).unwrap();
        let (_, energies) = settle(&mut scene.bind(), &[last]);
        let once = energies[energies.len() - 1];
        assert!(dragged <= 1.002 * once, "{method:?}: {dragged} {once}");
    }
}

#[test]
fn the_limit_ends_iteration_unconverged() {
    for method in ITERATIVE {
        let mut scene = scene(shapes::tube(16, 30, 8.0), method).with_ends(true);
        scene.method = method.ending(1e-12, 3);
        let bound = &mut scene.bind();
        bound.set_targets(&far(&scene)).unwrap();
        let mut out = vec![DVec3::ZERO; scene.roles.len()];
        let steps: Vec<_> = (0..3).map(|_| bound.step(&mut out).unwrap()).collect();
        assert!(!steps[1].finished && steps[2].finished && !steps[2].converged);
    }
}
