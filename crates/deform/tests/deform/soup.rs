//! A soup: every triangle loose, shuffled and jittered. Methods of space bend it without opening cracks.

use glam::{DMat3, DVec3};
use pliant_deform::{Method, OptionValue, Role};
use pliant_mesh::{Drawn, DrawnVertex, SurfaceVertex, shapes};

use crate::rig::{Scene, settle, turned};
use crate::space;

/// Corners move by up to this share of the diagonal.
const JITTER: f64 = 1e-4;

fn random(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

/// The soup of a shape, and for each of its vertices the corners at it.
fn soup(shape: &Drawn) -> (Drawn, Vec<Vec<u32>>) {
    let bounds = pliant_mesh::bounding_box(&shape.positions).unwrap();
    let size = JITTER * bounds.diagonal() / 3_f64.sqrt();
    let mut state = 7;
    let mut order: Vec<usize> = (0..shape.triangles.len()).collect();
    for place in (1..order.len()).rev() {
        order.swap(place, (random(&mut state) * (place + 1) as f64) as usize);
    }
    let mut corners = vec![Vec::new(); shape.positions.len()];
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for triangle in order {
        let first = positions.len() as u32;
        for vertex in shape.triangles[triangle] {
            corners[vertex.index()].push(positions.len() as u32);
            let mut off = || (random(&mut state) - 0.5) * size;
            positions.push(shape.positions[vertex.index()] + DVec3::new(off(), off(), off()));
        }
        triangles.push([first, first + 1, first + 2].map(DrawnVertex));
    }
    (Drawn::once(positions, triangles), corners)
}

/// The largest singular value.
fn stretch(jacobian: DMat3) -> f64 {
    let (mut direction, square) = (DVec3::new(0.6, 0.5, 0.4), jacobian.transpose() * jacobian);
    for _ in 0..60 {
        direction = (square * direction).normalize_or(DVec3::X);
    }
    (jacobian * direction).length()
}

/// Each corner gap after bending, and the rest gap times the map's stretch at its ends.
fn gaps(scene: &Scene, corners: &[Vec<u32>], targets: &[glam::DAffine3]) -> Vec<[f64; 2]> {
    let bound = &mut scene.bind();
    let (displacements, _) = settle(bound, targets);
    let jacobians = bound.jacobians().unwrap();
    let surface = |corner: &u32| scene.model.drawn.surface_vertex(DrawnVertex(*corner)).unwrap();
    let mut gaps = Vec::new();
    for own in corners {
        let own: Vec<SurfaceVertex> = own.iter().map(surface).collect();
        let rest = |v: SurfaceVertex| scene.positions()[v.index()];
        let moved = |v: SurfaceVertex| rest(v) + displacements[v.index()];
        let most = own
            .iter()
            .map(|v| stretch(DMat3::IDENTITY + jacobians[v.index()].as_dmat3()));
        let most = most.fold(1.0, f64::max);
        for (place, &a) in own.iter().enumerate() {
            for &b in &own[..place] {
                gaps.push([moved(a).distance(moved(b)), most * rest(a).distance(rest(b))]);
            }
        }
    }
    gaps
}

#[test]
fn a_jittered_soup_bends_without_a_crack_wider_than_the_map_stretches_the_jitter() {
    let (drawn, corners) = soup(&shapes::icosphere(4));
    // Without a falloff the map ends at the region's border.
    let is_smooth = |method: &Method| method.value("falloff") != Some(OptionValue::Number(0.0));
    for method in space::methods().into_iter().filter(is_smooth) {
        let scene = bent(&drawn, &method);
        // A few corners coincide.
        let loose = scene.model.topology.components().len();
        assert!(loose > 5100, "every triangle is loose: {loose}");
        let targets = [
            turned(DVec3::Z, 0.5, DVec3::X * 0.4),
            turned(DVec3::X, -0.3, DVec3::Y * 0.3),
        ];
        let size = scene.diagonal();
        for [gap, allowed] in gaps(&scene, &corners, &targets) {
            assert!(
                gap < 1.5 * allowed + 0.1 * JITTER * size,
                "{method:?}: {gap:e} {allowed:e}"
            );
        }
    }
}

fn bent(drawn: &Drawn, method: &Method) -> Scene {
    let mut scene = Scene::new(drawn.clone())
        .with(Role::Fixed, |p| p.z < -0.5)
        .with(Role::Handle(0), |p| p.z > 0.7)
        .with(Role::Handle(1), |p| p.x > 0.85);
    scene.method = method.clone();
    scene
}
