//! The survey's scenes against an independent implementation: weights from dot and cross products, a triplet matrix,
//! and faer's own ordering and Cholesky factor.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

use faer::Side;
use faer::linalg::solvers::Solve;
use faer::prelude::Mat;
use faer::sparse::{SparseColMat, Triplet};
use glam::{DAffine3, DVec3};
use pliant_deform::Role;
use pliant_editor::Beginning;
use pliant_mesh::DrawnVertex;
use pliant_tests::{Folder, assets, datum, extension, largest_distance, open};

/// Each scene's mesh and edit: those that ship with the program, and the survey's own files if they are present.
fn scenes() -> Vec<(PathBuf, PathBuf)> {
    let with_edit = |mesh: PathBuf| (mesh.clone(), mesh.with_extension("edit.json"));
    ["plane", "cylinder", "bar", "cactus"]
        .into_iter()
        .flat_map(|scene| {
            let of_survey = datum(&format!("survey/{scene}.off"));
            std::iter::once(assets().join(format!("{scene}.glb"))).chain(of_survey)
        })
        .map(with_edit)
        .collect()
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

/// New positions by L M⁻¹ L d = 0, with displacements prescribed for the roles that have them.
fn solve(positions: &[DVec3], faces: &[[usize; 3]], roles: &[Role], targets: &[DAffine3]) -> Vec<DVec3> {
    let held: Vec<Option<DVec3>> = roles
        .iter()
        .zip(positions)
        .map(|(role, p)| match role {
            Role::Fixed => Some(DVec3::ZERO),
            Role::Handle(handle) => Some(targets[usize::from(*handle)].transform_point3(*p) - *p),
            Role::Free => None,
        })
        .collect();
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
    for (mesh, edit) in scenes() {
        let model = open(&mesh).model;
        let text = fs::read_to_string(&edit).unwrap();
        let setup = Beginning::parse(&text).unwrap().resolve(&model).unwrap();
        let surface = &model.surface;
        let faces: Vec<[usize; 3]> = surface.triangles.iter().map(|t| t.map(|v| v.index())).collect();
        let solved = solve(&surface.positions, &faces, &setup.roles, &setup.targets(1.0));
        let surface_vertex = |drawn: u32| model.drawn.surface_vertex(DrawnVertex(drawn)).unwrap();
        let drawn = 0..model.drawn.vertex_count() as u32;
        let expected: Vec<DVec3> = drawn.map(|drawn| solved[surface_vertex(drawn).index()]).collect();

        let bent = bent(&folder, &mesh, &edit);
        let diagonal = model.bounds().unwrap().diagonal();
        let apart = largest_distance(&bent, &expected) / diagonal;
        // Only rounding and the file's digits separate the two.
        assert!(apart < 1e-5, "{}: {apart:e} of the diagonal", mesh.display());
        let moved = largest_distance(&bent, &model.rest_positions());
        assert!(moved > 0.1 * diagonal, "{} was bent", mesh.display());
    }
}

/// The positions of each drawn vertex after `pliant apply`.
fn bent(folder: &Folder, mesh: &Path, edit: &Path) -> Vec<DVec3> {
    let edit = serde_json::from_str(&fs::read_to_string(edit).unwrap()).unwrap();
    let out = folder.at(&format!("out.{}", extension(mesh)));
    folder.apply(mesh, &edit, &out, &["--method", "bilaplacian"]).done();
    open(&out).model.rest_positions()
}
