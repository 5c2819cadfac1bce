//! Laws of the Laplacian on every class of mesh.

use pliant_deform::Laplacian;
use pliant_mesh::{Model, shapes};

fn operator(model: &Model) -> Laplacian {
    let stiffness: Vec<f64> = (0..model.surface.positions.len())
        .map(|v| if v % 3 == 0 { 50.0 } else { 0.02 })
        .collect();
    Laplacian::of(&model.surface, &model.topology, &stiffness)
}

fn noise(count: usize, seed: usize) -> Vec<[f64; 1]> {
    (0..count)
        .map(|v| [((v * 7919 + seed * 104_729) % 1009) as f64 / 1009.0 - 0.5])
        .collect()
}

#[test]
fn it_is_symmetric_to_the_last_bit() {
    for (name, drawn) in shapes::classes() {
        let laplacian = operator(&shapes::model(drawn));
        for i in 0..laplacian.vertices().len() {
            for (&j, &weight) in laplacian.neighbours(i).iter().zip(laplacian.weights(i)) {
                let back = laplacian.neighbours(j as usize).binary_search(&(i as u32)).unwrap();
                assert_eq!(
                    laplacian.weights(j as usize)[back].to_bits(),
                    weight.to_bits(),
                    "{name}"
                );
            }
        }
    }
}

#[test]
fn constants_are_in_its_kernel_and_it_is_negative_semidefinite() {
    for (name, drawn) in shapes::classes() {
        let laplacian = operator(&shapes::model(drawn));
        let count = laplacian.vertices().len();
        assert!(
            laplacian
                .per_area(&vec![[1e8 / 3.0]; count])
                .iter()
                .all(|row| row[0] == 0.0),
            "{name}"
        );
        for seed in 0..10 {
            let f = noise(count, seed);
            let form: f64 = (0..count).map(|i| f[i][0] * laplacian.row(i, &f)[0]).sum();
            assert!(form < 0.0, "{name}: {form}");
        }
    }
}

#[test]
fn areas_and_weights_are_finite_on_every_class() {
    for (name, drawn) in shapes::classes() {
        let model = shapes::model(drawn);
        let laplacian = operator(&model);
        // A bare point has no area.
        for i in 0..model.topology.bare_points().start {
            assert!(
                laplacian.inverse_areas()[i] > 0.0 && laplacian.inverse_areas()[i].is_finite(),
                "{name}"
            );
            assert!(laplacian.weights(i).iter().all(|weight| weight.is_finite()), "{name}");
        }
    }
}

#[test]
fn triangles_without_area_are_mollified_and_sound_ones_are_not() {
    for (name, drawn) in shapes::classes() {
        let expected = usize::from(name == "broken");
        assert_eq!(operator(&shapes::model(drawn)).mollified_faces(), expected, "{name}");
    }
}

#[test]
fn the_laplacian_of_a_parabola_on_a_sheet_is_its_second_derivative() {
    let model = shapes::model(shapes::grid(20, 20));
    let laplacian = Laplacian::of(
        &model.surface,
        &model.topology,
        &vec![1.0; model.surface.positions.len()],
    );
    let f: Vec<[f64; 1]> = model
        .surface
        .positions
        .iter()
        .map(|p| [p.x * p.x + 3.0 * p.y])
        .collect();
    for (value, p) in laplacian.per_area(&f).iter().zip(&model.surface.positions) {
        if p.x > 0.01 && p.x < 0.99 && p.y > 0.01 && p.y < 0.99 {
            assert!((value[0] - 2.0).abs() < 1e-9);
        }
    }
}
