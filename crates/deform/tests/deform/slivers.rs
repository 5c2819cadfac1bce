//! Slivers: a linear method turns no triangle over where the same shape on good triangles has none.

use glam::{DAffine3, DVec3};
use pliant_deform::{Bilaplacian, Detail, Frames, LaplacianEditing, Method, Poisson, Role};
use pliant_mesh::{Distortion, Drawn, DrawnVertex, shapes};

use crate::rig::{Scene, settle};

const LENGTH: f64 = 10.0;

/// A tube with a vertex close to the longest edge of every third triangle, `share` of its height away from it.
fn capped(share: f64) -> Drawn {
    let mut drawn = shapes::tube(16, 20, LENGTH);
    let triangles = std::mem::take(&mut drawn.triangles);
    for (number, triangle) in triangles.into_iter().enumerate() {
        let at = triangle.map(|v| drawn.positions[v.index()]);
        let length = |i: usize| at[(i + 1) % 3].distance(at[(i + 2) % 3]);
        let apex = (0..3).max_by(|&i, &j| length(i).total_cmp(&length(j))).unwrap();
        if number % 3 != 0 {
            drawn.triangles.push(triangle);
            continue;
        }
        let [c, a, b] = [0, 1, 2].map(|k| triangle[(apex + k) % 3]);
        let [at_c, at_a, at_b] = [0, 1, 2].map(|k| at[(apex + k) % 3]);
        let middle = at_a.lerp(at_b, 0.5);
        let new = DrawnVertex(drawn.positions.len() as u32);
        drawn.positions.push(middle.lerp(at_c, share));
        drawn.triangles.extend([[c, a, new], [c, new, b], [new, a, b]]);
    }
    Drawn::once(drawn.positions, drawn.triangles)
}

/// A tube whose rings come in pairs `gap` apart, of which one is turned by half a cell.
fn paired(gap: f64) -> Drawn {
    let (around, along) = (16, 40);
    let mut drawn = shapes::tube(around, along, LENGTH);
    let half_cell = DAffine3::from_rotation_z(std::f64::consts::PI / around as f64);
    for (number, p) in drawn.positions.iter_mut().enumerate() {
        let ring = number / around;
        if ring % 2 == 1 {
            *p = half_cell.transform_point3(*p);
            p.z = LENGTH * (ring - 1) as f64 / along as f64 + gap;
        }
    }
    drawn
}

/// The linear methods that stand on a Laplacian.
fn linear() -> Vec<(&'static str, Method)> {
    let detailed = |detail| {
        let mut options = Bilaplacian::default();
        options.detail = detail;
        Method::from(options)
    };
    vec![
        ("plate", Bilaplacian::default().into()),
        ("normals", detailed(Detail::NormalDisplacements)),
        ("transfer", detailed(Detail::DeformationTransfer)),
        ("poisson", Poisson::default().into()),
        ("frames", Frames::default().into()),
        ("laplacian", LaplacianEditing::default().into()),
    ]
}

/// The effect of bending a tube's end by 90°.
fn distorted(drawn: Drawn, method: Method) -> Distortion {
    let mut scene = Scene::new(drawn)
        .with(Role::Fixed, |p| p.z < 0.1 * LENGTH)
        .with(Role::Handle(0), |p| p.z > 0.9 * LENGTH);
    scene.method = method;
    let middle = DVec3::Z * (0.5 * LENGTH);
    let bend = DAffine3::from_translation(middle)
        * DAffine3::from_rotation_x(std::f64::consts::FRAC_PI_2)
        * DAffine3::from_translation(-middle);
    let (displacements, _) = settle(&mut scene.bind(), &[bend]);
    let places = scene.positions().iter().zip(&displacements).map(|(p, d)| *p + *d);
    Distortion::of(&scene.model.surface, &scene.model.topology, &places.collect::<Vec<_>>())
}

#[test]
fn slivers_flip_no_face() {
    let caps = [0.1, 0.01, 0.001].map(|share| (format!("caps {share}"), capped(share)));
    let pairs = [0.02].map(|gap| (format!("pairs {gap}"), paired(gap)));
    for (mesh, drawn) in caps.into_iter().chain(pairs) {
        for (name, method) in linear() {
            let bent = distorted(drawn.clone(), method);
            assert_eq!(bent.flipped_faces, 0, "{mesh} {name}: {bent:?}");
        }
    }
}
