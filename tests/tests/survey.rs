//! The survey's scenes against another implementation: weights from dot and cross products, a triplet matrix, faer's own
//! ordering and Cholesky factor.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::Path;

use faer::Side;
use faer::linalg::solvers::Solve;
use faer::prelude::Mat;
use faer::sparse::{SparseColMat, Triplet};
use glam::{DMat4, DVec3};
use pliant_tests::{Folder, datum, largest_distance, open};
use serde_json::Value;

/// Vertices and triangles of a triangle OFF file.
fn read_off(path: &Path) -> (Vec<DVec3>, Vec<[usize; 3]>) {
    let text = fs::read_to_string(path).unwrap();
    let mut words = text.split_whitespace();
    assert_eq!(words.next(), Some("OFF"));
    let numbers: Vec<f64> = words.map(|word| word.parse().unwrap()).collect();
    let (vertex_count, face_count) = (numbers[0] as usize, numbers[1] as usize);
    let (positions, faces) = numbers[3..].split_at(3 * vertex_count);
    let positions = positions.chunks(3).map(DVec3::from_slice).collect();
    let faces = faces
        .chunks(4)
        .take(face_count)
        .map(|f| [f[1] as usize, f[2] as usize, f[3] as usize]);
    (positions, faces.collect())
}

/// Rows of the cotangent Laplacian and the mixed Voronoi areas.
fn operators(positions: &[DVec3], faces: &[[usize; 3]]) -> (Vec<Vec<(usize, f64)>>, Vec<f64>) {
    let mut rows = vec![Vec::new(); positions.len()];
    let mut areas = vec![0.0; positions.len()];
    for face in faces {
        let cotangents: [f64; 3] = std::array::from_fn(|i| {
            let [at, to, other] = [0, 1, 2].map(|k| positions[face[(i + k) % 3]]);
            (to - at).dot(other - at) / (to - at).cross(other - at).length()
        });
        let [a, b, c] = face.map(|v| positions[v]);
        let area = 0.5 * (b - a).cross(c - a).length();
        for i in 0..3 {
            let (one, other) = (face[(i + 1) % 3], face[(i + 2) % 3]);
            let weight = 0.5 * cotangents[i];
            rows[one].extend([(other, weight), (one, -weight)]);
            rows[other].extend([(one, weight), (other, -weight)]);
            areas[face[i]] += if cotangents.iter().all(|cotangent| *cotangent >= 0.0) {
                let square = |k: usize| positions[face[i]].distance_squared(positions[face[(i + k) % 3]]);
                (square(1) * cotangents[(i + 2) % 3] + square(2) * cotangents[(i + 1) % 3]) / 8.0
            } else if cotangents[i] < 0.0 {
                area / 2.0
            } else {
                area / 4.0
            };
        }
    }
    (rows, areas)
}

/// New positions by L M⁻¹ L d = 0.
fn solve(positions: &[DVec3], faces: &[[usize; 3]], edit: &Value) -> Vec<DVec3> {
    let vertices = |value: &Value| -> Vec<usize> {
        value["vertices"]
            .as_array()
            .unwrap()
            .iter()
            .map(|v| v.as_u64().unwrap() as usize)
            .collect()
    };
    let handle = &edit["handles"][0];
    let matrix: Vec<f64> = handle["transform"]["matrix"]
        .as_array()
        .unwrap()
        .iter()
        .map(|x| x.as_f64().unwrap())
        .collect();
    let matrix = DMat4::from_cols_slice(&matrix);
    let mut held = vec![None; positions.len()];
    for vertex in vertices(&edit["fixed"]) {
        held[vertex] = Some(DVec3::ZERO);
    }
    for vertex in vertices(&handle["select"]) {
        held[vertex] = Some(matrix.transform_point3(positions[vertex]) - positions[vertex]);
    }
    let mut column_of = vec![None; positions.len()];
    let free: Vec<usize> = (0..positions.len()).filter(|&v| held[v].is_none()).collect();
    for (column, &vertex) in free.iter().enumerate() {
        column_of[vertex] = Some(column);
    }
    let (rows, areas) = operators(positions, faces);
    let (mut triplets, mut right) = (Vec::new(), Mat::<f64>::zeros(free.len(), 3));
    for (row, area) in rows.iter().zip(&areas) {
        for &(i, a) in row {
            let Some(column) = column_of[i] else { continue };
            for &(j, b) in row {
                match (column_of[j], held[j]) {
                    (Some(other), _) => triplets.push(Triplet::new(column, other, a * b / area)),
                    (None, Some(d)) => (0..3).for_each(|k| right[(column, k)] -= a * b / area * d[k]),
                    (None, None) => unreachable!(),
                }
            }
        }
    }
    let system = SparseColMat::<usize, f64>::try_new_from_triplets(free.len(), free.len(), &triplets).unwrap();
    let factor = system.sp_cholesky(Side::Lower).unwrap();
    let mut solution = factor.solve(&right);
    let left = &right - &system * &solution;
    solution += factor.solve(&left);
    (0..positions.len())
        .map(|vertex| {
            let of = |column: usize| DVec3::from_array([0, 1, 2].map(|k| solution[(column, k)]));
            positions[vertex] + held[vertex].or(column_of[vertex].map(of)).unwrap()
        })
        .collect()
}

#[test]
fn the_scenes_come_out_as_another_implementation_has_them() {
    let folder = Folder::new();
    for scene in ["plane", "cylinder", "bar", "cactus"] {
        let Some(mesh) = datum(&format!("survey/{scene}.off")) else {
            continue;
        };
        let edit: Value = serde_json::from_str(&fs::read_to_string(mesh.with_extension("edit.json")).unwrap()).unwrap();
        let (positions, faces) = read_off(&mesh);
        let expected = solve(&positions, &faces, &edit);
        let out = folder.at("out.off");
        folder.apply(&mesh, &edit, &out, &[]).done();
        let (bent, _) = read_off(&out);
        let diagonal = open(&mesh).model.bounds().unwrap().diagonal();
        let apart = largest_distance(&bent, &expected) / diagonal;
        // A thousandth is asked for; what separates the two is rounding and the digits of the file.
        assert!(apart < 1e-5, "{scene}: {apart:e} of the diagonal");
        assert!(largest_distance(&bent, &positions) > 0.1 * diagonal, "{scene} was bent");
    }
}
