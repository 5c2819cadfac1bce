//! Laplacian editing against a second implementation, dense and written from [SCL+04], with the weights of [BS08]:
//! cotangents over areas, and squares weighted by area.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

use glam::{DAffine3, DMat3, DVec2, DVec3};
use pliant_deform::{Method, Role};
use pliant_mesh::{Drawn, DrawnVertex, shapes};

use crate::rig::{Scene, eliminated};

/// The rows of the differential coordinates: each vertex' neighbours with their cotangent weights, divided by a third
/// of the area around.
fn rows(scene: &Scene) -> Vec<Vec<(usize, f64)>> {
    let p = scene.positions();
    let mut weights = vec![BTreeMap::<usize, f64>::new(); p.len()];
    let mut areas = vec![0.0; p.len()];
    for corners in &scene.model.surface.triangles {
        let corners = corners.map(|corner| corner.index());
        for k in 0..3 {
            let [i, j, opposite] = [0, 1, 2].map(|next| corners[(k + next) % 3]);
            let (a, b) = (p[i] - p[opposite], p[j] - p[opposite]);
            let double_area = a.cross(b).length();
            let half_cotangent = 0.5 * a.dot(b) / double_area;
            *weights[i].entry(j).or_default() += half_cotangent;
            *weights[j].entry(i).or_default() += half_cotangent;
            areas[i] += double_area / 6.0;
        }
    }
    let divided = |(row, area): (BTreeMap<usize, f64>, f64)| row.into_iter().map(|(j, w)| (j, w / area)).collect();
    weights.into_iter().zip(areas).map(divided).collect()
}

/// A third of the area around each vertex: the weight of a squared row.
fn areas(scene: &Scene) -> Vec<f64> {
    let mut areas = vec![0.0; scene.positions().len()];
    for corners in &scene.model.surface.triangles {
        let [a, b, c] = corners.map(|corner| scene.positions()[corner.index()]);
        for corner in corners {
            areas[corner.index()] += (b - a).cross(c - a).length() / 6.0;
        }
    }
    areas
}

/// The normal matrix of the fit of T = (s, h, t) to the ring of `i`, T v = s v + h × v + t, and the ring (equation 5).
fn fit(p: &[DVec3], i: usize, row: &[(usize, f64)]) -> (Vec<Vec<f64>>, Vec<usize>) {
    let ring: Vec<usize> = std::iter::once(i).chain(row.iter().map(|&(j, _)| j)).collect();
    let mut normal = vec![vec![0.0; 7]; 7];
    for &j in &ring {
        for equation in equations(p[j] - p[i]) {
            for (a, row) in normal.iter_mut().enumerate() {
                for (b, own) in row.iter_mut().enumerate() {
                    *own += equation[a] * equation[b];
                }
            }
        }
    }
    (normal, ring)
}

/// The rows of A in A (s, h, t) = v' for one vertex v.
fn equations(v: DVec3) -> [[f64; 7]; 3] {
    [
        [v.x, 0.0, v.z, -v.y, 1.0, 0.0, 0.0],
        [v.y, -v.z, 0.0, v.x, 0.0, 1.0, 0.0],
        [v.z, v.y, -v.x, 0.0, 0.0, 0.0, 1.0],
    ]
}

/// For each vertex of the ring the matrix that maps its new position to its part of T δ.
fn transforms(p: &[DVec3], i: usize, row: &[(usize, f64)], delta: DVec3) -> Vec<(usize, DMat3)> {
    let (normal, ring) = fit(p, i, row);
    // T δ has no translation, since δ is a direction: its rows, as factors of (s, h, t).
    let mut effect = equations(delta);
    for row in &mut effect {
        row[4..].fill(0.0);
    }
    let right = (0..7)
        .map(|k| DVec3::new(effect[0][k], effect[1][k], effect[2][k]))
        .collect();
    let solved = eliminated(normal, right);
    let part = |&j: &usize| {
        let columns = equations(p[j] - p[i]);
        let column = |of: [f64; 7]| solved.iter().zip(of).map(|(&own, a)| own * a).sum::<DVec3>();
        let [x, y, z] = columns.map(column);
        (j, DMat3::from_cols(x, y, z))
    };
    ring.iter().map(part).collect()
}

/// Minimises Σ area |Σ_j G_ij v'_j − g_i|² over the free vertices, with the others at their positions in `shape`.
fn minimised(
    shape: &mut [DVec3],
    free: &[Option<usize>],
    blocks: &[Vec<(usize, DMat3)>],
    aims: &[DVec3],
    areas: &[f64],
) {
    let size = 3 * free.iter().flatten().count();
    let mut matrix = vec![vec![0.0; size]; size];
    let mut right = vec![DVec3::ZERO; size];
    for ((block, &aim), &area) in blocks.iter().zip(aims).zip(areas) {
        let known: DVec3 = block
            .iter()
            .filter(|(j, _)| free[*j].is_none())
            .map(|&(j, g)| g * shape[j])
            .sum();
        let unknown: Vec<(usize, DMat3)> = block.iter().filter_map(|&(j, g)| Some((free[j]?, g))).collect();
        for &(a, ga) in &unknown {
            let force = ga.transpose() * (aim - known) * area;
            for row in 0..3 {
                right[3 * a + row].x += force[row];
            }
            for &(b, gb) in &unknown {
                let product = ga.transpose() * gb * area;
                for row in 0..3 {
                    for column in 0..3 {
                        matrix[3 * a + row][3 * b + column] += product.col(column)[row];
                    }
                }
            }
        }
    }
    let solved = eliminated(matrix, right);
    for (own, place) in shape.iter_mut().zip(free) {
        if let Some(place) = place {
            *own = DVec3::from_array([0, 1, 2].map(|k| solved[3 * place + k].x));
        }
    }
}

/// The vertices' positions when the single handle moves to `target`.
fn edited(scene: &Scene, target: DAffine3) -> Vec<DVec3> {
    let (p, rows, areas) = (scene.positions(), rows(scene), areas(scene));
    let mut count = 0;
    let mut number = |role: &Role| {
        (*role == Role::Free).then(|| {
            count += 1;
            count - 1
        })
    };
    let free: Vec<Option<usize>> = scene.roles.iter().map(&mut number).collect();
    let placed = |(&v, role): (&DVec3, &Role)| match role {
        Role::Handle(_) => target.transform_point3(v),
        Role::Fixed | Role::Free => v,
    };
    let mut shape: Vec<DVec3> = p.iter().zip(&scene.roles).map(placed).collect();
    let differential =
        |shape: &[DVec3], i: usize| -> DVec3 { rows[i].iter().map(|&(j, w)| (shape[i] - shape[j]) * w).sum() };
    let deltas: Vec<DVec3> = (0..p.len()).map(|i| differential(p, i)).collect();
    let plain = |i: usize| -> Vec<(usize, DMat3)> {
        let own: f64 = rows[i].iter().map(|&(_, w)| w).sum();
        let others = rows[i].iter().map(|&(j, w)| (j, DMat3::IDENTITY * -w));
        std::iter::once((i, DMat3::IDENTITY * own)).chain(others).collect()
    };
    let implicit = |i: usize| -> Vec<(usize, DMat3)> {
        let turned = transforms(p, i, &rows[i], deltas[i]);
        let less = plain(i).into_iter().zip(turned);
        less.map(|((j, g), (_, turned))| (j, g - turned)).collect()
    };
    // Equation 4, with T of the unknown positions, and then with each length as at rest (section 3.3).
    let blocks: Vec<_> = (0..p.len()).map(implicit).collect();
    minimised(&mut shape, &free, &blocks, &vec![DVec3::ZERO; p.len()], &areas);
    let aims: Vec<DVec3> = (0..p.len())
        .map(|i| differential(&shape, i).normalize_or_zero() * deltas[i].length())
        .collect();
    let blocks: Vec<_> = (0..p.len()).map(plain).collect();
    minimised(&mut shape, &free, &blocks, &aims, &areas);
    shape
}

/// The surface of unit cells.
fn surface_of(cells: &BTreeSet<[i32; 3]>) -> Drawn {
    let mut numbers = BTreeMap::new();
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for &cell in cells {
        for axis in 0..3 {
            for side in 0..2 {
                let mut beside = cell;
                beside[axis] += 2 * side - 1;
                if cells.contains(&beside) {
                    continue;
                }
                let mut corner = |u: i32, v: i32| {
                    let mut at = cell;
                    at[axis] += side;
                    at[(axis + 1) % 3] += u;
                    at[(axis + 2) % 3] += v;
                    *numbers.entry(at).or_insert_with(|| {
                        positions.push(DVec3::from_array(at.map(f64::from)));
                        DrawnVertex(positions.len() as u32 - 1)
                    })
                };
                let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                triangles.extend(match side {
                    0 => [[a, c, b], [a, d, c]],
                    _ => [[a, b, c], [a, c, d]],
                });
            }
        }
    }
    Drawn {
        positions,
        triangles,
        ..shapes::grid(1, 1)
    }
}

/// A trunk with an arm on either side.
fn cactus() -> Drawn {
    let trunk = (0..2).flat_map(|x| (0..2).flat_map(move |y| (0..10).map(move |z| [x, y, z])));
    let arms = [
        [2, 0, 4],
        [3, 0, 4],
        [3, 0, 5],
        [3, 0, 6],
        [-1, 1, 6],
        [-2, 1, 6],
        [-2, 1, 7],
    ];
    surface_of(&trunk.chain(arms).collect())
}

/// The root mean square distance between the method's shape and the second implementation's, as a share of the
/// diagonal.
fn apart(mut scene: Scene, target: DAffine3) -> f64 {
    scene.method = Method::from_name("laplacian").unwrap();
    let expected = edited(&scene, target);
    let moved = scene.moved(&[target]);
    let squares = scene.positions().iter().zip(&moved).zip(&expected);
    let sum: f64 = squares
        .map(|((&p, &d), &expected)| (p + d).distance_squared(expected))
        .sum();
    (sum / expected.len() as f64).sqrt() / scene.diagonal()
}

/// A scene held below `low` and moved above `high` along z.
fn held(drawn: Drawn, low: f64, high: f64) -> Scene {
    Scene::new(drawn)
        .with(Role::Fixed, |p| p.z < low)
        .with(Role::Handle(0), |p| p.z > high)
}

#[test]
fn scenes_like_the_surveys_are_as_by_a_second_implementation() {
    let plane = Scene::new(shapes::grid(12, 12))
        .with(Role::Fixed, |p| p.truncate().distance(DVec2::splat(0.5)) > 0.45)
        .with(Role::Handle(0), |p| p.truncate().distance(DVec2::splat(0.5)) < 0.15);
    let lifted = DAffine3::from_translation(DVec3::new(-0.16, 0.0, 0.28));
    let arc = DAffine3::from_translation(DVec3::new(0.0, -5.0, 8.66))
        * DAffine3::from_rotation_x(PI * 120.0 / 180.0)
        * DAffine3::from_translation(DVec3::Z * -10.0);
    let twist = DAffine3::from_translation(DVec3::new(1.5, 1.5, 0.0))
        * DAffine3::from_rotation_z(PI * 0.75)
        * DAffine3::from_translation(DVec3::new(-1.5, -1.5, 0.0));
    let bent = DAffine3::from_translation(DVec3::new(1.0, -2.5, 7.0))
        * DAffine3::from_rotation_x(PI * 70.0 / 180.0)
        * DAffine3::from_translation(DVec3::new(-1.0, -1.0, -9.0));
    let found = [
        ("plane", apart(plane, lifted), 0.04),
        (
            "cylinder",
            apart(held(shapes::tube(10, 16, 10.0), 0.7, 9.3), arc),
            0.001,
        ),
        ("bar", apart(held(shapes::bar(3, 3, 12), 0.5, 11.5), twist), 0.01),
        ("cactus", apart(held(cactus(), 1.5, 8.5), bent), 0.02),
    ];
    for (name, apart, most) in found {
        assert!(apart < most, "{name}: {apart} of {most}");
    }
}
