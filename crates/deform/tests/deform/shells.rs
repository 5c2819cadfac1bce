//! The laws of discrete shells.

use crate::rig::{Scene, apart, eliminated, settle, turned};
use glam::{DAffine3, DMat3, DVec3};
use pliant_deform::{Method, OptionValue, Role, Shells};
use pliant_mesh::{Cancel, Drawn, face_area, shapes};

/// With `stretching`, `bending` and `volume`.
fn shells(stiffnesses: [f64; 3]) -> Method {
    let names = ["stretching", "bending", "volume"];
    let values = names.into_iter().zip(stiffnesses.map(OptionValue::Number));
    let tolerance = ("tolerance", OptionValue::Number(1e-11));
    Method::from_name("shells")
        .unwrap()
        .with(values.chain([tolerance]))
        .unwrap()
}

/// A bar along x with one end fixed and the other as the handle.
fn bar(stiffnesses: [f64; 3]) -> Scene {
    let mut scene = Scene::new(shapes::bar(24, 4, 4));
    scene.method = shells(stiffnesses);
    let bounds = scene.model.bounds().unwrap();
    let share = move |p: DVec3| (p.x - bounds.min.x) / bounds.extent().x;
    scene
        .with(Role::Fixed, |p| share(p) < 0.1)
        .with(Role::Handle(0), |p| share(p) > 0.9)
}

/// The target of the bar's handle when the bar bends along an arc of this angle.
fn arc(scene: &Scene, angle: f64) -> DAffine3 {
    let bounds = scene.model.bounds().unwrap();
    let (from, to) = (
        bounds.min.x + 0.1 * bounds.extent().x,
        bounds.max.x - 0.1 * bounds.extent().x,
    );
    let middle = bounds.centre();
    let radius = (to - from) / angle;
    let end = DVec3::new(
        from + radius * angle.sin(),
        middle.y,
        middle.z + radius * (1.0 - angle.cos()),
    );
    DAffine3::from_translation(end)
        * DAffine3::from_rotation_y(-angle)
        * DAffine3::from_translation(-DVec3::new(to, middle.y, middle.z))
}

fn volume(scene: &Scene, displacements: &[DVec3]) -> f64 {
    let at = |v: pliant_mesh::SurfaceVertex| scene.positions()[v.index()] + displacements[v.index()];
    let six = scene.model.surface.triangles.iter().map(|corners| {
        let [a, b, c] = corners.map(at);
        a.dot(b.cross(c))
    });
    six.sum::<f64>() / 6.0
}

#[test]
fn at_rest_the_energy_is_zero_to_the_bit() {
    for (name, drawn) in shapes::classes() {
        let mut scene = Scene::new(drawn).with_ends(true);
        scene.method = shells([1.0, 1e-3, 1.0]);
        let zeros = vec![DVec3::ZERO; scene.roles.len()];
        assert_eq!(scene.bind().energy_of(&zeros), Some(0.0), "{name}");
    }
}

#[test]
fn the_energy_never_rises() {
    for stiffnesses in [[1.0, 1e-6, 0.0], [1.0, 1e-4, 0.0], [1.0, 1e-2, 1000.0]] {
        let scene = bar(stiffnesses);
        let bound = &mut scene.bind();
        for target in [arc(&scene, 2.0), DAffine3::from_rotation_x(2.3), arc(&scene, -1.0)] {
            let (_, energies) = settle(bound, &[target]);
            assert!(energies.is_sorted_by(|a, b| a >= b), "{stiffnesses:?}: {energies:?}");
        }
    }
}

/// The strip's cross-lines are the creases, so that a rolled strip of the same lengths exists.
#[test]
fn a_strip_rolled_to_a_cylinder_keeps_the_lengths_of_its_edges() {
    let cells = 24;
    let mut scene = Scene::new(shapes::moved(
        &shapes::grid(cells, cells / 4),
        DAffine3::from_scale(DVec3::new(4.0, 1.0, 1.0)),
    ));
    scene.method = shells([1000.0, 1e-4, 0.0]);
    let length = 4.0 / cells as f64;
    let scene = scene
        .with(Role::Fixed, |p| p.x < 1.5 * length)
        .with(Role::Handle(0), |p| p.x > 4.0 - 1.5 * length);
    // Each of the creases between turns by the same angle.
    let creases = cells - 1;
    let angle = 4.5 / creases as f64;
    let mut end = DVec3::X * length;
    for crease in 1..creases {
        let turned = angle * crease as f64;
        end += DVec3::new(turned.cos(), 0.0, turned.sin()) * length;
    }
    let target = DAffine3::from_translation(end)
        * DAffine3::from_rotation_y(-4.5)
        * DAffine3::from_translation(DVec3::X * (length - 4.0));
    let (displacements, _) = settle(&mut scene.bind(), &[target]);
    let at = |v: usize| scene.positions()[v] + displacements[v];
    for [a, b] in scene.model.topology.edges().map(|edge| edge.map(|v| v.index())) {
        let ratio = at(a).distance(at(b)) / scene.positions()[a].distance(scene.positions()[b]);
        assert!((ratio - 1.0).abs() < 1e-3, "{a} {b}: {ratio}");
    }
}

#[test]
fn the_volume_of_a_bar_is_kept_at_135_degrees() {
    let kept = [0.0, 1000.0].map(|stiffness| {
        let scene = bar([1.0, 1e-4, stiffness]);
        let target = arc(&scene, 135_f64.to_radians());
        let (displacements, _) = settle(&mut scene.bind(), &[target]);
        volume(&scene, &displacements) / volume(&scene, &vec![DVec3::ZERO; scene.roles.len()])
    });
    assert!((kept[0] - 1.0).abs() > 0.01 && (kept[1] - 1.0).abs() < 0.01, "{kept:?}");
}

/// With lengths alone a compressed triangle gives way within its plane.
#[test]
fn triangles_at_the_inside_of_a_bend_keep_an_area() {
    let tube = || {
        Scene::new(shapes::tube(32, 24, 3.0))
            .with(Role::Fixed, |p| p.z < 0.3)
            .with(Role::Handle(0), |p| p.z > 2.7)
    };
    let bent_tube = |angle| turned(DVec3::Z * 1.5, angle, DVec3::X * 0.5);
    let bar = bar([1.0, 1e-4, 0.0]);
    let bent_bar = arc(&bar, 2.3);
    for (mut scene, target) in [(tube(), bent_tube(1.5)), (tube(), bent_tube(2.3)), (bar, bent_bar)] {
        scene.method = Method::from_name("shells").unwrap();
        let (displacements, energies) = settle(&mut scene.bind(), &[target]);
        assert!(energies.len() < 40, "{}", energies.len());
        for face in &scene.model.surface.triangles {
            let now = face_area(face.map(|v| scene.positions()[v.index()] + displacements[v.index()]));
            let ratio = now / face_area(face.map(|v| scene.positions()[v.index()]));
            assert!(ratio > 0.1, "{ratio:e}");
        }
    }
}

#[test]
fn an_open_surface_has_no_volume_and_says_so() {
    let mut scene = Scene::new(shapes::tube(10, 12, 4.0)).with_ends(true);
    scene.method = shells([1.0, 1e-4, 1000.0]);
    let bound = scene.bind();
    assert!(
        bound.warnings().iter().any(|warning| warning.contains("closed")),
        "{:?}",
        bound.warnings()
    );
    scene.method = shells([1.0, 1e-4, 0.0]);
    assert!(scene.bind().warnings().is_empty());
}

#[test]
fn what_resists_bending_more_bends_less_sharply() {
    let sharpest = [1e-6, 1e-4, 1e-2].map(|bending| {
        let scene = bar([1.0, bending, 0.0]);
        let (displacements, _) = settle(&mut scene.bind(), &[arc(&scene, 2.4)]);
        let at = |v: usize| scene.positions()[v] + displacements[v];
        // These are the bar's edges at the inner side, where it creases.
        let lengths = scene.model.topology.edges().map(|edge| edge.map(|v| v.index()));
        let ratios = lengths.map(|[a, b]| at(a).distance(at(b)) / scene.positions()[a].distance(scene.positions()[b]));
        ratios.fold(0.0, |most: f64, ratio| most.max((ratio - 1.0).abs()))
    });
    assert!(sharpest.is_sorted_by(|a, b| a < b), "{sharpest:?}");
}

#[test]
fn soft_handles_are_followed_the_closer_the_heavier_they_are() {
    let missed = |weight: Option<f64>| {
        let mut scene = bar([1.0, 1e-3, 0.0]);
        scene.soft = vec![weight];
        let target = turned(DVec3::ZERO, 0.3, DVec3::Y * 0.5);
        let (displacements, _) = settle(&mut scene.bind(), &[target]);
        let own = (0..scene.roles.len()).filter(|&v| scene.roles[v] == Role::Handle(0));
        own.map(|v| displacements[v].distance(target.transform_point3(scene.positions()[v]) - scene.positions()[v]))
            .fold(0.0, f64::max)
    };
    let all = [Some(1e-3), Some(0.1), Some(10.0), Some(1e6), None].map(missed);
    assert!(
        all.is_sorted_by(|a, b| a > b) && all[4] < 1e-12 && all[3] < 1e-4,
        "{all:?}"
    );
}

/// A closed surface shrinks around a handle that shrinks; one that keeps its volume swells elsewhere.
#[test]
fn what_one_end_loses_in_volume_the_rest_takes_up() {
    let mut scene = Scene::new(shapes::icosphere(3));
    scene.method = shells([1.0, 1e-4, 1e4]);
    let scene = scene
        .with(Role::Fixed, |p| p.z < -0.8)
        .with(Role::Handle(0), |p| p.z > 0.8);
    let (displacements, _) = settle(&mut scene.bind(), &[DAffine3::from_translation(DVec3::NEG_Z * 0.4)]);
    let widest = |displacements: &[DVec3]| {
        let places = scene.positions().iter().zip(displacements);
        places.map(|(p, d)| (*p + *d).truncate().length()).fold(0.0, f64::max)
    };
    assert!(widest(&displacements) > 1.05);
}

/// E by its definition, from the triangles, with angles by arccosine: residuals of all edges.
fn residuals(scene: &Scene, [stretching, bending, stiff_volume]: [f64; 3], displacements: &[DVec3]) -> Vec<f64> {
    let (positions, faces) = (scene.positions(), &scene.model.surface.triangles);
    let rest = |v: usize| positions[v];
    let moved = |v: usize| positions[v] + displacements[v];
    let normal =
        |face: &[usize; 3], at: &dyn Fn(usize) -> DVec3| (at(face[1]) - at(face[0])).cross(at(face[2]) - at(face[0]));
    let faces: Vec<[usize; 3]> = faces
        .iter()
        .map(|corners| corners.map(|corner| corner.index()))
        .collect();
    let mut all = Vec::new();
    for [a, b] in scene.model.topology.edges().map(|edge| edge.map(|v| v.index())) {
        let around: Vec<&[usize; 3]> = faces
            .iter()
            .filter(|face| face.contains(&a) && face.contains(&b))
            .collect();
        let area = around
            .iter()
            .map(|face| 0.5 * normal(face, &rest).length())
            .sum::<f64>()
            / 3.0;
        let stiffness = 0.5 * (scene.stiffness[a] + scene.stiffness[b]);
        let length = rest(a).distance(rest(b));
        all.push((stretching * stiffness * area).sqrt() * (moved(a).distance(moved(b)) / length - 1.0));
        if let [one, other] = around[..] {
            let angle = |at: &dyn Fn(usize) -> DVec3| {
                let [n, m] = [one, other].map(|face| normal(face, at).normalize());
                let apex = other.iter().copied().find(|&v| v != a && v != b).unwrap();
                let angle = n.dot(m).clamp(-1.0, 1.0).acos();
                // Convex if the other triangle's apex is below the first one's plane.
                if n.dot(at(apex) - at(a)) < 0.0 { angle } else { -angle }
            };
            let scale = (bending * stiffness / area).sqrt() * scene.size() * length;
            all.push(scale * (angle(&moved) - angle(&rest)));
        }
    }
    let enclosed = |at: &dyn Fn(usize) -> DVec3| {
        faces
            .iter()
            .map(|face| at(face[0]).dot(at(face[1]).cross(at(face[2]))))
            .sum::<f64>()
            / 6.0
    };
    for face in &faces {
        let [now, before] = [normal(face, &moved), normal(face, &rest)].map(|normal| 0.5 * normal.length());
        let stiffness = face.iter().map(|&v| scene.stiffness[v]).sum::<f64>() / 3.0;
        // Compressed, x² − 1 − 2 log x over 2 instead of (x − 1)².
        let x = now / before;
        let grown = match x < 1.0 {
            true => -(0.5 * (x * x - 1.0 - 2.0 * x.ln())).max(0.0).sqrt(),
            false => x - 1.0,
        };
        all.push((0.25 * stretching * stiffness * before).sqrt() * grown);
    }
    let area: f64 = faces.iter().map(|face| 0.5 * normal(face, &rest).length()).sum();
    all.push((stiff_volume * area).sqrt() * (enclosed(&moved) / enclosed(&rest) - 1.0));
    all
}

#[test]
fn a_dense_gauss_newton_finds_the_same_shape_and_energy() {
    let stiffnesses = [1.0, 1e-3, 5.0];
    let mut scene = Scene::new(shapes::bar(6, 2, 2));
    scene.method = shells(stiffnesses);
    for (vertex, stiffness) in scene.stiffness.iter_mut().enumerate() {
        *stiffness = 1.0 + (vertex % 3) as f64;
    }
    let bounds = scene.model.bounds().unwrap();
    let share = move |p: DVec3| (p.x - bounds.min.x) / bounds.extent().x;
    let scene = scene
        .with(Role::Fixed, |p| share(p) < 0.1)
        .with(Role::Handle(0), |p| share(p) > 0.9);
    let target = arc(&scene, 0.8);
    let bound = &mut scene.bind();
    let (displacements, _) = settle(bound, &[target]);
    let energy = |displacements: &[DVec3]| {
        let all = residuals(&scene, stiffnesses, displacements);
        0.5 * all.iter().map(|r| r * r).sum::<f64>()
    };
    // The start is not the method's: everything except the handle is at rest.
    let mut dense: Vec<DVec3> = scene
        .positions()
        .iter()
        .zip(&scene.roles)
        .map(|(p, role)| match role {
            Role::Handle(_) => target.transform_point3(*p) - *p,
            _ => DVec3::ZERO,
        })
        .collect();
    let free: Vec<usize> = (0..dense.len()).filter(|&v| scene.roles[v] == Role::Free).collect();
    for _ in 0..60 {
        let here = residuals(&scene, stiffnesses, &dense);
        let step = 1e-6;
        let columns: Vec<Vec<f64>> = (0..3 * free.len())
            .map(|k| {
                let beside = |length: f64| {
                    let mut moved = dense.clone();
                    moved[free[k / 3]][k % 3] += length;
                    residuals(&scene, stiffnesses, &moved)
                };
                let (up, down) = (beside(step), beside(-step));
                up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * step)).collect()
            })
            .collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let matrix: Vec<Vec<f64>> = columns
            .iter()
            .enumerate()
            .map(|(k, a)| {
                columns
                    .iter()
                    .enumerate()
                    .map(|(l, b)| dot(a, b) + if k == l { 1e-12 } else { 0.0 })
                    .collect()
            })
            .collect();
        let right = columns.iter().map(|column| DVec3::X * dot(column, &here)).collect();
        let solution = eliminated(matrix, right);
        let before = energy(&dense);
        let lower = (0..20).find_map(|halvings| {
            let mut moved = dense.clone();
            for (k, value) in solution.iter().enumerate() {
                moved[free[k / 3]][k % 3] -= 0.5_f64.powi(halvings) * value.x;
            }
            (energy(&moved) < before).then_some(moved)
        });
        match lower {
            Some(moved) => dense = moved,
            None => break,
        }
    }
    let difference = apart(&dense, &displacements) / scene.diagonal();
    assert!(difference < 1e-4, "{difference:e}");
    // The method's unit of energy is that of the edges' area, the same for any displacements.
    let mut other = displacements.clone();
    other[free[0]] += DVec3::new(0.03, -0.02, 0.05);
    let [own, others] = [&displacements, &other].map(|d| energy(d) / bound.energy_of(d).unwrap());
    assert!((own / others - 1.0).abs() < 1e-6, "{own} {others}");
}

#[test]
fn a_drag_through_more_than_half_a_turn_comes_back_to_rest() {
    let scene = bar([1.0, 1e-4, 0.0]);
    let bound = &mut scene.bind();
    for turn in [1.0, 2.0, 3.0, 4.0, 3.0, 2.0, 1.0, 0.1] {
        settle(bound, &[DAffine3::from_mat3(DMat3::from_rotation_x(turn))]);
    }
    let (displacements, _) = settle(bound, &[DAffine3::IDENTITY]);
    assert!(displacements.iter().all(|d| *d == DVec3::ZERO));
}

/// Drawn shapes of all kinds with possible targets end in few steps.
#[test]
fn plain_bends_take_few_steps() {
    let tube: Drawn = shapes::tube(16, 30, 8.0);
    let mut scene = Scene::new(tube)
        .with(Role::Fixed, |p| p.z < 0.5)
        .with(Role::Handle(0), |p| p.z > 7.5);
    scene.method = Method::from_name("shells").unwrap();
    let (_, energies) = settle(&mut scene.bind(), &[turned(DVec3::Z * 7.5, 1.4, DVec3::X)]);
    assert!(energies.len() < 40, "{}", energies.len());
}

/// A tube whose upper end is the handle, bent with a coarse level above so many solved vertices.
fn led_tube(led_above: usize) -> Scene {
    let tube: Drawn = shapes::tube(24, 60, 8.0);
    let mut scene = Scene::new(tube)
        .with(Role::Fixed, |p| p.z < 0.5)
        .with(Role::Handle(0), |p| p.z > 7.5);
    let mut shells = Shells::default();
    shells.led_above = led_above;
    scene.method = shells.into();
    scene
}

/// Newton steps settle the shape of a surface that a coarse level leads: it ends at the minimum to which Newton steps
/// alone go, after few more steps.
#[test]
fn a_led_surface_settles_at_the_same_minimum() {
    let targets = [turned(DVec3::Z * 7.5, 1.2, DVec3::X)];
    let (alone, of_newton) = settle(&mut led_tube(usize::MAX).bind(), &targets);
    let (led, of_led) = settle(&mut led_tube(0).bind(), &targets);
    assert!(of_led.len() < 60, "{} and {}", of_newton.len(), of_led.len());
    let [lowest, own] = [&of_newton, &of_led].map(|energies| energies[energies.len() - 1]);
    assert!((own / lowest - 1.0).abs() < 1e-5, "{own} and {lowest}");
    let apart = apart(&alone, &led);
    assert!(apart < 1e-2, "{apart:e}");
}

/// A raised flag ends the steps that settle a shape, and a lowered one lets them go on.
#[test]
fn a_cancelled_step_keeps_the_shape() {
    let mut bound = led_tube(0).bind();
    bound.set_targets(&[turned(DVec3::Z * 7.5, 1.2, DVec3::X)]).unwrap();
    let mut displacements = vec![DVec3::ZERO; bound.vertex_count()];
    let cancel = Cancel::new();
    cancel.cancel();
    bound.set_cancel(&cancel);
    let mut last = bound.step(&mut displacements).unwrap();
    for _ in 0..60 {
        last = bound.step(&mut displacements).unwrap();
    }
    assert!(!last.finished);
    let kept = displacements.clone();
    bound.step(&mut displacements).unwrap();
    assert_eq!(displacements, kept);
    bound.set_cancel(&Cancel::new());
    let lower = bound.step(&mut displacements).unwrap();
    assert!(lower.energy < last.energy, "{} and {}", lower.energy, last.energy);
}

/// From paper to rubber: paper keeps its lengths, rubber its angles.
#[test]
fn paper_keeps_lengths_and_rubber_bends_evenly() {
    let bent = Shells::PAPER_TO_RUBBER.map(|bending| {
        let scene = bar([1.0, bending, 0.0]);
        let (displacements, _) = settle(&mut scene.bind(), &[arc(&scene, 2.0)]);
        let at = |v: usize| scene.positions()[v] + displacements[v];
        let edges = scene.model.topology.edges().map(|edge| edge.map(|v| v.index()));
        let strains: Vec<f64> = edges
            .map(|[a, b]| (at(a).distance(at(b)) / scene.positions()[a].distance(scene.positions()[b]) - 1.0).powi(2))
            .collect();
        let turn = |face: &[pliant_mesh::SurfaceVertex; 3], at: &dyn Fn(usize) -> DVec3| {
            let [a, b, c] = face.map(|v| at(v.index()));
            (b - a).cross(c - a).normalize()
        };
        let faces = &scene.model.surface.triangles;
        let mut sharpest = 0.0_f64;
        for [a, b] in scene.model.topology.edges() {
            let around: Vec<_> = faces
                .iter()
                .filter(|face| face.contains(&a) && face.contains(&b))
                .collect();
            if let [one, other] = around[..] {
                let angle = |at: &dyn Fn(usize) -> DVec3| turn(one, at).angle_between(turn(other, at));
                sharpest = sharpest.max((angle(&at) - angle(&|v| scene.positions()[v])).abs());
            }
        }
        (strains.iter().sum::<f64>() / strains.len() as f64, sharpest)
    });
    let [paper, rubber] = bent;
    assert!(paper.0 < 0.5 * rubber.0 && rubber.1 < 0.5 * paper.1, "{bent:?}");
}
