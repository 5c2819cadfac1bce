//! Stiffer along long axes: the bi-Laplacian of the surface stretched along its principal axes.

use glam::{DAffine3, DQuat, DVec3};
use pliant_deform::{Bilaplacian, BilaplacianOrder, Method, Role};
use pliant_mesh::{Drawn, shapes};

use crate::rig::{Scene, apart};

fn method(order: BilaplacianOrder, anisotropy: f64) -> Method {
    let mut options = Bilaplacian::default();
    options.order = order;
    options.anisotropy = anisotropy;
    Method::from(options)
}

/// A sheet 4 long in x and `width` wide, turned away from the axes, its rim held and a patch inside lifted by 1;
/// heights and the positions within the sheet.
fn sheet(width: f64, turn: DQuat, order: BilaplacianOrder, anisotropy: f64) -> (Vec<DVec3>, Vec<f64>) {
    let flat = shapes::grid(40, 20);
    let positions = flat
        .positions
        .iter()
        .map(|p| turn * DVec3::new(4.0 * p.x, width * p.y, 0.0));
    let positions = positions.collect();
    let unit = |p: DVec3| {
        let p = turn.inverse() * p;
        DVec3::new(p.x / 4.0, p.y / width, 0.0)
    };
    let rim = |p: DVec3| {
        (p.x / 0.08)
            .min(p.y / 0.16)
            .min((1.0 - p.x) / 0.08)
            .min((1.0 - p.y) / 0.16)
    };
    let mut scene = Scene::new(Drawn { positions, ..flat })
        .with(Role::Fixed, |p| rim(unit(p)) < 1.0)
        .with(Role::Handle(0), |p| {
            (unit(p) - DVec3::new(0.5, 0.5, 0.0)).abs().max_element() < 0.051
        });
    scene.method = method(order, anisotropy);
    let up = turn * DVec3::Z;
    let displacements = scene.moved(&[DAffine3::from_translation(up)]);
    let mut rows: Vec<(DVec3, f64)> = scene
        .positions()
        .iter()
        .zip(&displacements)
        .map(|(p, d)| (unit(*p), d.dot(up)))
        .collect();
    rows.sort_by(|a, b| {
        (a.0.y * 1e3)
            .round()
            .total_cmp(&(b.0.y * 1e3).round())
            .then(a.0.x.total_cmp(&b.0.x))
    });
    rows.into_iter().unzip()
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn it_is_the_bilaplacian_of_the_stretched_sheet() {
    // The moving part of this sheet varies in x and y as 4 · 0.84 to 1 · 0.68.
    let turn = DQuat::from_axis_angle(DVec3::new(0.48, 0.6, 0.64), 0.7);
    for order in BilaplacianOrder::ALL {
        let isotropic = sheet(1.0, turn, order, 0.0).1;
        let whole = sheet(1.0, turn, order, 1.0).1;
        assert!(largest_difference(&isotropic, &whole) > 0.02, "{order:?}");
        let differences: Vec<f64> = (0..40)
            .map(|step| 3.0 + 0.1 * f64::from(step))
            .map(|width| largest_difference(&whole, &sheet(width, turn, order, 0.0).1))
            .collect();
        let (best, _) = differences
            .iter()
            .enumerate()
            .min_by(|a, b| a.1.total_cmp(b.1))
            .unwrap();
        let width = 3.0 + 0.1 * best as f64;
        assert!(differences[best] < 0.01, "{order:?} {width} {}", differences[best]);
        assert!(width > 4.2 && width < 5.6, "{order:?}: {width}");
    }
}

#[test]
fn the_longer_way_bends_less_the_more_anisotropic() {
    let bends = [0.0, 0.25, 0.5, 0.75, 1.0].map(|anisotropy| {
        let (places, heights) = sheet(1.0, DQuat::IDENTITY, BilaplacianOrder::ThinPlate, anisotropy);
        let row: Vec<f64> = places
            .iter()
            .zip(&heights)
            .filter(|(p, _)| (p.y - 0.5).abs() < 1e-6)
            .map(|(_, z)| *z)
            .collect();
        assert_eq!(row.len(), 41);
        row.windows(3)
            .map(|w| (w[0] - 2.0 * w[1] + w[2]).abs())
            .fold(0.0, f64::max)
    });
    assert!(bends.windows(2).all(|pair| pair[1] < 0.97 * pair[0]), "{bends:?}");
}

#[test]
fn what_varies_alike_in_all_directions_is_not_stretched_to_the_last_bit() {
    for anisotropy in [0.3, 1.0] {
        for order in BilaplacianOrder::ALL {
            // Caps at both ends of every axis: the part between varies alike along all of them.
            let mut scene = Scene::new(shapes::icosphere(3))
                .with(Role::Fixed, |p| p.min_element() < -0.9)
                .with(Role::Handle(0), |p| p.max_element() > 0.9);
            let target = [crate::rig::turned(DVec3::ZERO, 0.7, DVec3::X)];
            scene.method = method(order, 0.0);
            let plain = scene.moved(&target);
            scene.method = method(order, anisotropy);
            assert_eq!(plain, scene.moved(&target), "{order:?} {anisotropy}");
        }
    }
}

/// The deviation from an even twist of a long bar whose upper end is turned: the largest error of a cross-section's
/// turn, as a share of the whole.
fn unevenness(anisotropy: f64) -> f64 {
    const ANGLE_RAD: f64 = 0.3;
    let mut scene = Scene::new(shapes::bar(4, 4, 32))
        .with(Role::Fixed, |p| p.z < 1.5)
        .with(Role::Handle(0), |p| p.z > 30.5);
    scene.method = method(BilaplacianOrder::ThinPlate, anisotropy);
    let centre = DVec3::new(2.0, 2.0, 0.0);
    let twist =
        DAffine3::from_translation(centre) * DAffine3::from_rotation_z(ANGLE_RAD) * DAffine3::from_translation(-centre);
    let displacements = scene.moved(&[twist]);
    let mut sums = [[0.0_f64; 2]; 33];
    for (p, d) in scene.positions().iter().zip(&displacements) {
        let (before, after) = (
            p.truncate() - centre.truncate(),
            (*p + *d).truncate() - centre.truncate(),
        );
        let [sine, cosine] = &mut sums[p.z.round() as usize];
        *sine += before.perp_dot(after);
        *cosine += before.dot(after);
    }
    let errors = sums.iter().enumerate().skip(1).take(31).map(|(z, [sine, cosine])| {
        let even = (z as f64 - 1.0) / 30.0;
        (sine.atan2(*cosine) / ANGLE_RAD - even).abs()
    });
    errors.fold(0.0, f64::max)
}

#[test]
fn a_twisted_bar_is_twisted_the_more_evenly_the_more_anisotropic() {
    let unevenness = [0.0, 0.25, 0.5, 0.75, 1.0].map(unevenness);
    assert!(
        unevenness.windows(2).all(|pair| pair[1] < 0.95 * pair[0]),
        "{unevenness:?}"
    );
    assert!(unevenness[0] > 0.3 && unevenness[4] < 0.2, "{unevenness:?}");
}

#[test]
fn place_and_unit_do_not_matter() {
    let mut scene = Scene::new(shapes::tube(16, 24, 6.0)).with_ends(true);
    scene.method = method(BilaplacianOrder::ThinPlate, 0.8);
    let targets = vec![DAffine3::from_translation(DVec3::X); scene.handle_count];
    let here = scene.moved(&targets);
    let place = DAffine3::from_translation(DVec3::new(3e5, -2e5, 1e5));
    for position in &mut scene.model.surface.positions {
        *position = place.transform_point3(*position * 64.0);
    }
    let targets = vec![DAffine3::from_translation(DVec3::X * 64.0); scene.handle_count];
    let there: Vec<DVec3> = scene.moved(&targets).iter().map(|d| *d / 64.0).collect();
    assert!(apart(&here, &there) < 1e-6, "{}", apart(&here, &there));
}
