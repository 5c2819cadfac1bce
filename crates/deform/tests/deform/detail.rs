//! The purpose of multiresolution details: bumps on a bent plate.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::rig::{Scene, apart, back_substitute, step};
use glam::{DAffine3, DVec3};
use pliant_deform::{Bound, Method, OptionValue, Role};
use pliant_mesh::{Bvh, Cancel, Drawn, Model, Progress, SurfaceVertex, shapes};

/// Every way of putting details back.
const DETAILS: [&str; 3] = ["normal-displacements", "displacement-volumes", "deformation-transfer"];

fn method(detail: &'static str) -> Method {
    let method = Method::from_name("bilaplacian").unwrap();
    method.with([("detail", OptionValue::Name(detail))]).unwrap()
}

/// The method with the smoothest base.
fn smoothest(detail: &'static str) -> Method {
    with_length(detail, 10.0)
}

/// The method with a base that is faired for this length, in sizes of the bending part.
fn with_length(detail: &'static str, length: f64) -> Method {
    method(detail)
        .with([("base_length", OptionValue::Number(length))])
        .unwrap()
}

/// The places of the bumps on the plate, and their radius.
const CENTRES: [f64; 3] = [0.3, 0.5, 0.7];
const RADIUS: f64 = 0.09;

/// The height of a bumpy plate over the unit square.
fn bumps(p: DVec3, height: f64) -> f64 {
    let of = |x: f64| {
        let share = DVec3::new(p.x - x, p.y - 0.5, 0.0).length() / RADIUS;
        if share < 1.0 {
            height * (0.5 + 0.5 * (PI * share).cos())
        } else {
            0.0
        }
    };
    CENTRES.into_iter().map(of).sum()
}

/// A plate of this many cells with bumps, fixed at the left, its right end the handle, the sides free.
fn plate(cells: usize, height: f64, detail: &'static str) -> Scene {
    let Drawn {
        positions, triangles, ..
    } = shapes::grid(cells, cells);
    let raised = positions.iter().map(|p| *p + DVec3::Z * bumps(*p, height)).collect();
    let mut scene = Scene::new(Drawn::once(raised, triangles))
        .with(Role::Fixed, |p| p.x < 0.08)
        .with(Role::Handle(0), |p| p.x > 0.92);
    scene.method = smoothest(detail);
    scene
}

/// Bends the plate to about an arc of `angle_rad`, upwards if it is positive.
fn arc(angle_rad: f64) -> DAffine3 {
    let radius = 1.0 / angle_rad;
    let end = DVec3::new(radius * angle_rad.sin(), 0.0, radius * (1.0 - angle_rad.cos()));
    DAffine3::from_translation(end) * DAffine3::from_rotation_y(-angle_rad) * DAffine3::from_translation(-DVec3::X)
}

/// A bumpy plate, and the plate and its base under a target.
struct Bent {
    scene: Scene,
    shape: Vec<DVec3>,
    base: Vec<DVec3>,
}

/// The base is bent as the plain bi-Laplacian bends the plate.
fn bent(height: f64, detail: &'static str, target: DAffine3) -> Bent {
    let scene = plate(CELLS, height, detail);
    let moved = |from: &[DVec3], by: &[DVec3]| from.iter().zip(by).map(|(p, d)| *p + *d).collect();
    let mut bound = scene.bind();
    let displacements = step(&mut bound, &[target]);
    let mut base = displacements.clone();
    assert_eq!(bound.base(&mut base), detail != "none");
    Bent {
        shape: moved(scene.positions(), &displacements),
        base: moved(scene.positions(), &base),
        scene,
    }
}

const CELLS: usize = 40;

fn distance(p: DVec3, x: f64) -> f64 {
    DVec3::new(p.x - x, p.y - 0.5, 0.0).length()
}

impl Bent {
    /// The volume between the base and the surface over the bump at `x`.
    fn volume(&self, x: f64) -> f64 {
        let tetrahedron = |p: DVec3, q: DVec3, r: DVec3, s: DVec3| (q - p).dot((r - p).cross(s - p)) / 6.0;
        let mut sum = 0.0;
        for corners in &self.scene.model.surface.triangles {
            let corners = corners.map(SurfaceVertex::index);
            if corners
                .iter()
                .all(|&v| distance(self.scene.positions()[v], x) < 1.5 * RADIUS)
            {
                let ([a, b, c], [p, q, r]) = (corners.map(|v| self.base[v]), corners.map(|v| self.shape[v]));
                sum += tetrahedron(a, b, c, p) + tetrahedron(b, c, p, q) + tetrahedron(c, p, q, r);
            }
        }
        sum
    }

    /// The angle between the bump at `x`, from the middle of its foot to its tip, and the normal of its foot, in
    /// radians.
    fn lean(&self, x: f64) -> f64 {
        let vertices = || (0..self.shape.len()).map(|v| (v, distance(self.scene.positions()[v], x)));
        let tip = vertices().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap().0;
        let foot: Vec<usize> = vertices()
            .filter(|(_, r)| (RADIUS..1.4 * RADIUS).contains(r))
            .map(|(v, _)| v)
            .collect();
        let middle = |points: &[DVec3]| foot.iter().map(|&v| points[v]).sum::<DVec3>() / foot.len() as f64;
        let (rest, now) = (middle(self.scene.positions()), middle(&self.shape));
        let (mut along, mut across) = (DVec3::ZERO, DVec3::ZERO);
        for &v in &foot {
            let arm = self.scene.positions()[v] - rest;
            along += (self.shape[v] - now) * arm.x;
            across += (self.shape[v] - now) * arm.y;
        }
        along.cross(across).angle_between(self.shape[tip] - now)
    }
}

#[test]
fn bumps_turn_with_the_plate_below_them_and_shear_without_details() {
    let lift = DAffine3::from_translation(DVec3::Z * 0.7);
    for target in [arc(FRAC_PI_2), arc(-FRAC_PI_2), lift] {
        let sheared = bent(0.12, "none", target);
        for x in CENTRES {
            assert!(sheared.lean(x) > 0.4, "{x} {}", sheared.lean(x));
            for detail in DETAILS {
                let upright = bent(0.12, detail, target);
                assert!(upright.lean(x) < 0.15, "{detail} {x} {}", upright.lean(x));
            }
        }
    }
}

/// The displacements that take the surface to its base in the last step.
fn base_of(bound: &Bound) -> Vec<DVec3> {
    let mut base = vec![DVec3::ZERO; bound.vertex_count()];
    assert!(bound.base(&mut base));
    base
}

#[test]
fn the_base_is_bent_as_the_plain_thin_plate_bends_the_surface_and_rests_with_the_handles() {
    let target = arc(FRAC_PI_2);
    let plain = plate(CELLS, 0.12, "none").moved(&[target]);
    for detail in DETAILS {
        let mut bound = plate(CELLS, 0.12, detail).bind();
        let at_rest = base_of(&bound);
        assert!(
            at_rest.iter().any(|d| d.z < -0.1),
            "{detail}: the bumps are faired away"
        );
        step(&mut bound, &[target]);
        let expected: Vec<DVec3> = at_rest.iter().zip(&plain).map(|(rest, bent)| *rest + *bent).collect();
        let mut base = step(&mut bound, &[target]);
        assert!(bound.base(&mut base));
        // The plain method's bases are in single precision.
        assert!(apart(&base, &expected) < 1e-6, "{detail} {}", apart(&base, &expected));
        step(&mut bound, &[DAffine3::IDENTITY]);
        assert!(base_of(&bound) == at_rest, "{detail}: not the very base at rest");
    }
}

#[test]
fn a_base_turns_with_its_surface_where_nothing_holds_it() {
    let target = DAffine3::from_translation(DVec3::new(0.2, -0.1, 0.4)) * DAffine3::from_rotation_x(2.5);
    for detail in DETAILS {
        let mut scene = plate(CELLS, 0.12, detail);
        scene
            .roles
            .iter_mut()
            .filter(|role| **role == Role::Fixed)
            .for_each(|role| *role = Role::Free);
        let mut bound = scene.bind();
        let rest = base_of(&bound);
        let mut base = step(&mut bound, &[target]);
        assert!(bound.base(&mut base));
        let expected: Vec<DVec3> = (scene.positions().iter().zip(&rest))
            .map(|(p, d)| target.transform_point3(*p + *d) - *p)
            .collect();
        assert!(apart(&base, &expected) < 1e-6, "{detail} {}", apart(&base, &expected));
    }
}

#[test]
fn a_flat_plate_is_its_own_base_and_bends_as_without_details() {
    let target = arc(FRAC_PI_2);
    let plain = bent(0.0, "none", target);
    for detail in DETAILS {
        let flat = bent(0.0, detail, target);
        assert!(apart(&flat.base, &plain.base) < 1e-7, "{detail}");
        assert!(
            apart(&flat.shape, &plain.shape) < 1e-6,
            "{detail} {}",
            apart(&flat.shape, &plain.shape)
        );
    }
}

#[test]
fn every_base_order_bends_bumps_with_the_plate() {
    for detail in DETAILS {
        for order in 1..=3 {
            let mut scene = plate(CELLS, 0.1, detail);
            scene.method = scene.method.with([("base_order", OptionValue::Whole(order))]).unwrap();
            let mut bound = scene.bind();
            // The plate's rim is flat: so is its base.
            let base = base_of(&bound);
            let mut heights = scene.positions().iter().zip(&base).map(|(p, d)| p.z + d.z);
            let remains = if detail == "deformation-transfer" { 1e-7 } else { 1e-3 };
            assert!(heights.all(|height| height.abs() < remains), "{detail} {order}");
            let target = arc(1.0);
            let shape = step(&mut bound, &[target]);
            let solved = back_substitute(&mut bound, &[target]);
            assert!(
                apart(&shape, &solved) < 1e-6,
                "{detail} {order}: {}",
                apart(&shape, &solved)
            );
        }
    }
}

#[test]
fn bumps_keep_their_volume_on_a_bent_plate_but_with_normal_displacements() {
    for angle in [FRAC_PI_2, -FRAC_PI_2] {
        let change = |detail: &'static str| {
            let (rest, bent) = (bent(0.12, detail, DAffine3::IDENTITY), bent(0.12, detail, arc(angle)));
            CENTRES.map(|x| bent.volume(x) / rest.volume(x) - 1.0)
        };
        let turned = change("normal-displacements");
        assert!(turned.iter().all(|change| change.abs() > 0.06), "{angle} {turned:?}");
        for detail in ["displacement-volumes", "deformation-transfer"] {
            let kept = change(detail);
            assert!(
                kept.iter().all(|change| change.abs() < 0.045),
                "{detail} {angle} {kept:?}"
            );
        }
    }
}

/// The turn of the plate between x = 0.38 and x = 0.62 under a quarter arc, in radians, with its middle this stiff,
/// from the directions of its flat flanks there.
fn turn_of_the_middle(detail: &'static str, stiffness: f64) -> f64 {
    let mut scene = plate(CELLS, 0.12, detail);
    let rest = scene.positions().to_vec();
    for (own, p) in scene.stiffness.iter_mut().zip(&rest) {
        if (0.36..0.64).contains(&p.x) {
            *own = stiffness;
        }
    }
    let moved = scene.moved(&[arc(FRAC_PI_2)]);
    let direction = |x: f64| {
        let flank = |p: &DVec3| (p.x - x).abs() < 0.05 && (p.y - 0.5).abs() > 0.2;
        let own = || rest.iter().zip(&moved).filter(|(p, _)| flank(p));
        let middle = own().map(|(p, _)| p.x).sum::<f64>() / own().count() as f64;
        own().map(|(p, d)| (*p + *d) * (p.x - middle)).sum::<DVec3>()
    };
    direction(0.42).angle_between(direction(0.58))
}

#[test]
fn a_stiff_patch_bends_less_with_every_kind_of_detail() {
    for detail in ["none"].into_iter().chain(DETAILS) {
        let [even, stiff, stiffer] = [1.0, 10.0, 100.0].map(|stiffness| turn_of_the_middle(detail, stiffness));
        assert!(even > 0.15, "{detail} {even}");
        assert!(
            stiff < 0.5 * even && stiffer < 0.5 * stiff,
            "{detail} {even} {stiff} {stiffer}"
        );
    }
}

#[test]
fn transferred_gradients_keep_a_tube_whole_whose_base_shrinks_to_a_line() {
    // In the middle the base is about e^-10 of the tube's width.
    let mut scene = Scene::new(shapes::tube(12, 40, 20.0))
        .with(Role::Fixed, |p| p.z < 1.0)
        .with(Role::Handle(0), |p| p.z > 19.0);
    scene.method = method("deformation-transfer");
    let turn = DAffine3::from_translation(DVec3::X * 4.0) * DAffine3::from_rotation_y(0.5);
    let displacements = scene.moved(&[turn]);
    let stretch = |[a, b]: [SurfaceVertex; 2]| {
        let [a, b] = [a, b].map(SurfaceVertex::index);
        let rest = scene.positions()[b] - scene.positions()[a];
        (rest + displacements[b] - displacements[a]).length() / rest.length()
    };
    let edges = scene
        .model
        .surface
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let (least, most) = edges.map(stretch).fold((f64::MAX, 0.0_f64), |(least, most), stretch| {
        (least.min(stretch), most.max(stretch))
    });
    assert!(
        least > 0.3 && most < 3.0,
        "edges are {least} to {most} as long as before"
    );
}

/// A closed sheet of 4 × 1 with this thickness and number of cells, its lower vertices shifted by `skew` of a cell,
/// fixed at the left, its right end the handle.
fn sheet(cells: [usize; 2], thickness: f64, skew: f64, detail: &'static str) -> Scene {
    let [along, across] = cells;
    let mut drawn = shapes::bar(along, across, 1);
    let scale = DVec3::new(4.0 / along as f64, 1.0 / across as f64, thickness);
    for p in &mut drawn.positions {
        let is_inner = p.x > 1.0 && p.x < along as f64 - 1.0 && p.y > 0.0 && p.y < across as f64;
        if p.z == 0.0 && is_inner {
            p.x += skew;
        }
        *p *= scale;
    }
    let mut scene = Scene::new(drawn)
        .with(Role::Fixed, |p| p.x < 0.4)
        .with(Role::Handle(0), |p| p.x > 3.6);
    scene.method = method(detail);
    scene
}

#[test]
fn the_sides_of_a_thin_sheet_stay_apart() {
    // A quarter turn with the end drawn in, like a hand's motion.
    let bend = DAffine3::from_translation(DVec3::new(2.8, 0.0, 1.2))
        * DAffine3::from_rotation_y(-FRAC_PI_2)
        * DAffine3::from_translation(-DVec3::X * 4.0);
    for (cells, thickness, skew) in [
        ([36, 9], 0.05, 0.0),
        ([36, 9], 0.005, 0.0),
        ([36, 9], 0.02, 0.4),
        ([60, 15], 0.08, 0.3),
    ] {
        for detail in DETAILS {
            let scene = sheet(cells, thickness, skew, detail);
            let displacements = scene.moved(&[bend]);
            let shape: Vec<DVec3> = (scene.positions().iter().zip(&displacements))
                .map(|(p, d)| *p + *d)
                .collect();
            let Model { surface, topology, .. } = &scene.model;
            let crossings = Bvh::build(&shape, &surface.triangles)
                .new_self_intersections(surface, topology, 1, &Progress::new(), &Cancel::new())
                .unwrap();
            assert!(crossings.pairs.is_empty(), "{detail} {thickness}: {crossings:?}");
            let apart = |[a, b]: [usize; 2]| shape[a].distance(shape[b]) / thickness;
            let rest = scene.positions();
            let across = (0..rest.len()).filter(|&v| rest[v].z == 0.0).filter_map(|v| {
                let is_across = |&w: &usize| rest[w].distance(rest[v] + DVec3::Z * thickness) < 1e-9;
                Some([v, (0..rest.len()).find(is_across)?])
            });
            let most = across.map(apart).fold(0.0, f64::max);
            assert!(most < 2.0, "{detail} {thickness}: {most}");
        }
    }
}

/// The volume of the body between two triangles whose points move straight from one to the other: the mean of the six
/// tetrahedra sums that its three sides allow, by cones from the origin.
fn prism(base: [DVec3; 3], top: [DVec3; 3]) -> f64 {
    let cone = |a: DVec3, b: DVec3, c: DVec3| a.dot(b.cross(c)) / 6.0;
    let mut sum = cone(top[0], top[1], top[2]) - cone(base[0], base[1], base[2]);
    for k in 0..3 {
        let (a, b, p, q) = (base[k], base[(k + 1) % 3], top[k], top[(k + 1) % 3]);
        sum += 0.5 * (cone(a, b, q) + cone(a, q, p) + cone(a, b, p) + cone(b, q, p));
    }
    sum
}

/// The sum of the prisms' changes of volume between rest and a target, as a share of the volumes' sum.
fn volume_error(scene: &Scene, target: DAffine3) -> f64 {
    let mut bound = scene.bind();
    let volumes = |bound: &Bound, displacements: &[DVec3]| -> Vec<f64> {
        let mut to_base = displacements.to_vec();
        assert!(bound.base(&mut to_base));
        let at = |by: &[DVec3], v: SurfaceVertex| scene.positions()[v.index()] + by[v.index()];
        let triangles = scene.model.surface.triangles.iter();
        triangles
            .map(|corners| prism(corners.map(|v| at(&to_base, v)), corners.map(|v| at(displacements, v))))
            .collect()
    };
    let rest = volumes(&bound, &vec![DVec3::ZERO; bound.vertex_count()]);
    let bent = step(&mut bound, &[target]);
    let now = volumes(&bound, &bent);
    let changed: f64 = rest.iter().zip(&now).map(|(rest, now)| (now - rest).abs()).sum();
    changed / rest.iter().map(|volume| volume.abs()).sum::<f64>()
}

#[test]
fn displacement_volumes_keep_each_prisms_volume_to_two_percent_on_average() {
    let check = |name: &str, target: DAffine3, scene: &dyn Fn(&'static str) -> Scene| {
        let normals = volume_error(&scene("normal-displacements"), target);
        let volumes = volume_error(&scene("displacement-volumes"), target);
        assert!(volumes < 0.02 && volumes < 0.3 * normals, "{name}: {normals} {volumes}");
    };
    check("a convex plate", arc(FRAC_PI_2), &|detail| plate(CELLS, 0.1, detail));
    check("a concave plate", arc(-FRAC_PI_2), &|detail| plate(CELLS, 0.1, detail));
    check("a tube", bent_limb(), &|detail| limb(detail, 0.05));
    check("a tube over a thin base", bent_limb(), &|detail| limb(detail, 0.07));
}

/// A tube of radius 1 and length 20, its base faired for this length in sizes.
fn limb(detail: &'static str, length: f64) -> Scene {
    let mut scene = Scene::new(shapes::tube(24, 80, 20.0))
        .with(Role::Fixed, |p| p.z < 1.0)
        .with(Role::Handle(0), |p| p.z > 19.0);
    scene.method = with_length(detail, length);
    scene
}

fn bent_limb() -> DAffine3 {
    DAffine3::from_translation(DVec3::new(3.0, 0.0, -1.0)) * DAffine3::from_rotation_y(0.6)
}

#[test]
fn a_limbs_base_keeps_the_share_of_its_radius_that_fairing_for_a_length_leaves() {
    for length in [0.02, 0.04, 0.05, 0.08] {
        let scene = limb("normal-displacements", length);
        let base = base_of(&scene.bind());
        let middle = (0..base.len()).filter(|&v| (scene.positions()[v].z - 10.0).abs() < 1.0);
        // x and y have the wave number 1 around the tube.
        let expected = 1.0 / (1.0 + (length * scene.size()).powi(4));
        for v in middle {
            let p = scene.positions()[v] + base[v];
            let radius = p.x.hypot(p.y);
            assert!((radius - expected).abs() < 0.02, "{length}: {radius} {expected}");
        }
    }
}

/// A point's foot on a surface with interpolated normals, found by trying every triangle.
struct Found {
    corners: [usize; 3],
    weights: DVec3,
    height: f64,
}

/// The unit normals of vertices, by the area vectors around them.
fn normals(points: &[DVec3], triangles: &[[usize; 3]]) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; points.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|v| points[v]);
        corners.iter().for_each(|&v| sums[v] += (b - a).cross(c - a));
    }
    sums.into_iter().map(DVec3::normalize_or_zero).collect()
}

fn mixed(weights: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    a * weights.x + b * weights.y + c * weights.z
}

/// The nearest foot of a point, by fixed-point steps in every triangle: the point is projected on the triangle's plane
/// along the normal of the last projection.
fn found(point: DVec3, points: &[DVec3], normals: &[DVec3], triangles: &[[usize; 3]]) -> Option<Found> {
    let in_triangle = |corners: &[usize; 3]| {
        let places = corners.map(|v| points[v]);
        let [a, b, c] = places;
        let area = (b - a).cross(c - a);
        let (mut weights, mut height) = (DVec3::splat(1.0 / 3.0), 0.0);
        for _ in 0..300 {
            let normal = mixed(weights, corners.map(|v| normals[v])).normalize();
            // Along the normal onto the triangle's plane.
            height = (point - a).dot(area) / normal.dot(area);
            let foot = point - normal * height;
            let of = |p: DVec3, q: DVec3| (p - foot).cross(q - foot).dot(area) / area.length_squared();
            weights = DVec3::new(of(b, c), of(c, a), of(a, b));
            if weights.abs().max_element() > 3.0 {
                return None;
            }
        }
        (weights.min_element() > -1e-6).then_some(Found {
            corners: *corners,
            weights,
            height,
        })
    };
    let all = triangles.iter().filter_map(in_triangle);
    all.min_by(|a, b| a.height.abs().total_cmp(&b.height.abs()))
}

#[test]
fn normal_displacements_keep_the_height_over_the_nearest_point_along_its_normal() {
    let mut scene = plate(16, 0.1, "normal-displacements");
    scene.method = with_length("normal-displacements", 0.05);
    let mut bound = scene.bind();
    let at = |by: &[DVec3]| -> Vec<DVec3> { scene.positions().iter().zip(by).map(|(p, d)| *p + *d).collect() };
    let rest = at(&base_of(&bound));
    let bent = step(&mut bound, &[arc(1.0)]);
    let mut to_base = bent.clone();
    assert!(bound.base(&mut to_base));
    let (surface, base) = (at(&bent), at(&to_base));
    // The method's base ends with the triangles around free vertices.
    let is_near = |corners: &&[SurfaceVertex; 3]| corners.iter().any(|v| scene.roles[v.index()] == Role::Free);
    let triangles = scene.model.surface.triangles.iter().filter(is_near);
    let triangles: Vec<[usize; 3]> = triangles.map(|corners| corners.map(SurfaceVertex::index)).collect();
    let (rest_normals, base_normals) = (normals(&rest, &triangles), normals(&base, &triangles));
    let mut displaced = 0;
    for (v, point) in scene.positions().iter().enumerate() {
        let is_border = scene.model.topology.is_boundary_vertex(SurfaceVertex(v as u32));
        if scene.roles[v] != Role::Free || is_border {
            continue;
        }
        let Found {
            corners,
            weights,
            height,
        } = found(*point, &rest, &rest_normals, &triangles).unwrap();
        let normal = mixed(weights, corners.map(|v| base_normals[v])).normalize();
        let expected = mixed(weights, corners.map(|v| base[v])) + normal * height;
        assert!(surface[v].distance(expected) < 1e-6, "{v}: {} {expected}", surface[v]);
        displaced += usize::from(height.abs() > 0.005);
    }
    assert!(displaced > 20, "{displaced}");
}

#[test]
fn a_collapsed_base_and_folded_details_are_told_with_the_place_and_the_remedy() {
    for detail in ["normal-displacements", "displacement-volumes"] {
        let scene = limb(detail, 1.0);
        let bound = scene.bind();
        let told = bound.warnings().iter().find(|warning| warning.contains("99%"));
        let told = told.map(ToString::to_string).unwrap_or_default();
        assert!(
            told.contains("deformation-transfer") && told.contains("at "),
            "{detail}: {told}"
        );
        assert!(
            !limb(detail, 0.02)
                .bind()
                .warnings()
                .iter()
                .any(|warning| warning.contains("99%"))
        );
    }
    // Bumps as high as a sharp bend's radius.
    let folds = |height: f64| {
        let mut bound = plate(CELLS, height, "normal-displacements").bind();
        step(&mut bound, &[arc(3.0)]);
        let told = bound.warnings().iter().find(|warning| warning.contains("fold over"));
        told.map(ToString::to_string)
    };
    let told = folds(0.35).unwrap_or_default();
    assert!(told.contains("deformation-transfer") && told.contains("at "), "{told}");
    assert_eq!(folds(0.02), None);
}
