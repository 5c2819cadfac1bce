//! The samples that ship in `assets/`, generated from our own shapes: `cargo xtask assets`.
//!
//! Bit-for-bit deterministic on every machine, for any number of threads: see [`vector`].

pub mod bar;
pub mod cactus;
pub mod creature;
pub mod cylinder;
pub mod expressions;
pub mod face;
pub mod glb;
pub mod limb;
pub mod mesh;
pub mod noise;
pub mod plane;
pub mod relax;
pub mod solid;
pub mod surface_nets;
pub mod vector;

use mesh::{Mesh, in_parallel};
use solid::Solid;
use vector::Vec3;

/// A sample that ships.
pub struct Sample {
    /// File name without extension.
    pub name: &'static str,
    /// Makes the mesh at the committed size.
    pub make: fn() -> Result<Mesh, String>,
}

/// Every sample that ships. The first one opens by default.
pub const SAMPLES: [Sample; 6] = [
    Sample {
        name: "creature",
        make: || creature_of(60_000),
    },
    Sample {
        name: "plane",
        make: || Ok(plane::plane()),
    },
    Sample {
        name: "cylinder",
        make: || Ok(cylinder::cylinder()),
    },
    Sample {
        name: "bar",
        make: || Ok(bar::bar()),
    },
    Sample {
        name: "cactus",
        make: || mesh_of(&cactus::Cactus::new(), 16_000),
    },
    Sample {
        name: "face",
        make: face,
    },
];

/// The face with its expressions: fine in front, at the wrinkles, and coarse behind.
fn face() -> Result<Mesh, String> {
    let mut mesh = mesh_of(&face::Magnified, 24_000)?;
    mesh.positions = mesh.positions.into_iter().map(face::inverted).collect();
    let displacements = |expression: &expressions::Expression| {
        let own = mesh.positions.iter().map(|p| (expression.displacement)(*p));
        (expression.name, own.collect())
    };
    mesh.targets = expressions::EXPRESSIONS.iter().map(displacements).collect();
    Ok(mesh)
}

/// The creature with about `triangles` triangles; more triangles give finer skin.
///
/// # Errors
/// Those of [`mesh_of`].
pub fn creature_of(triangles: usize) -> Result<Mesh, String> {
    mesh_of(&creature::Creature::new(), triangles)
}

/// Amplitude of the scanner noise, as a fraction of the edge length.
const GRAIN: f64 = 0.03;

/// The surface of `solid` with about `triangles` triangles: closed, manifold, oriented outwards.
///
/// # Errors
/// The fault of the surface on the last of several grids, if none gives a manifold.
pub fn mesh_of(solid: &dyn Solid, triangles: usize) -> Result<Mesh, String> {
    let (low, high) = solid.bounds();
    // The count grows with the inverse square of the cell size; two coarse trials give the factor.
    let mut size = (high - low).length() / 60.0;
    for _ in 0..2 {
        let trial = surface_nets::extract(solid, size, 0.0).triangles.len().max(1);
        let goal = triangles.min(20_000);
        size *= (trial as f64 / goal as f64).sqrt();
    }
    size *= (triangles.min(20_000) as f64 / triangles as f64).sqrt();
    let mut fault = String::new();
    for attempt in 0..8 {
        let mut mesh = surface_nets::extract(solid, size, f64::from(attempt) * 0.137);
        mesh.keep_largest_part();
        if let Err(sentence) = mesh.check_closed() {
            fault = sentence;
            continue;
        }
        relax::relax(&mut mesh, solid, size, 6)?;
        mesh.check_closed()?;
        let normals: Vec<Vec3> = in_parallel(mesh.positions.len(), |i| {
            relax::slope(solid, mesh.positions[i], size).normalized()
        });
        mesh.colours = in_parallel(mesh.positions.len(), |i| solid.colour(mesh.positions[i], normals[i]));
        for (i, normal) in normals.iter().enumerate() {
            let grain = solid.scanner_noise(i, mesh.positions[i]) * GRAIN * size;
            mesh.positions[i] += *normal * grain;
        }
        return Ok(mesh);
    }
    Err(fault)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]
    use super::*;

    #[test]
    fn the_committed_samples_are_what_the_generator_makes() {
        for sample in SAMPLES {
            let path = crate::root::root().join("assets").join(format!("{}.glb", sample.name));
            let committed = std::fs::read(&path).expect("the sample is committed");
            let made = glb::write(&(sample.make)().unwrap(), sample.name);
            assert!(made == committed, "{}: run `cargo xtask assets`", path.display());
            assert!(committed.len() < 2_000_000, "{}", path.display());
        }
    }

    #[test]
    fn closed_samples_are_closed_at_several_sizes() {
        for shape in [&creature::Creature::new() as &dyn Solid, &cactus::Cactus::new()] {
            for triangles in [6_000, 17_000] {
                let mesh = mesh_of(shape, triangles).unwrap();
                assert_eq!(mesh.check_closed(), Ok(()));
                let share = mesh.triangles.len() as f64 / triangles as f64;
                assert!(
                    (0.85..1.15).contains(&share),
                    "{} for {triangles}",
                    mesh.triangles.len()
                );
            }
        }
        assert_eq!(bar::bar().check_closed(), Ok(()));
        assert_eq!(cylinder::cylinder().check_closed(), Ok(()));
    }

    #[test]
    fn the_face_faces_outwards_is_finer_in_front_and_moves_in_front_alone() {
        let mesh = face().unwrap();
        assert_eq!(mesh.check_closed(), Ok(()));
        let mean_area = |is_in: &dyn Fn(Vec3) -> bool| {
            let corners = mesh.triangles.iter().map(|t| t.map(|i| mesh.positions[i as usize]));
            let areas = corners.filter(|[a, _, _]| is_in(*a));
            let areas: Vec<f64> = areas.map(|[a, b, c]| (b - a).cross(c - a).length()).collect();
            areas.iter().sum::<f64>() / areas.len() as f64
        };
        assert!(mean_area(&|p| p.z < -0.2) > 4.0 * mean_area(&|p| p.z > 0.2));
        for (name, displacements) in &mesh.targets {
            let moved = displacements.iter().zip(&mesh.positions);
            let (behind, before): (Vec<_>, Vec<_>) = moved.partition(|(_, p)| p.z < 0.0);
            assert!(behind.iter().all(|(d, _)| d.length() == 0.0), "{name}");
            assert!(before.iter().any(|(d, _)| d.length() > 0.04), "{name}");
        }
    }

    #[test]
    fn triangles_are_well_shaped() {
        let mesh = mesh_of(&creature::Creature::new(), 17_000).unwrap();
        // Twice the inner radius over the outer: 1 for an equilateral triangle, 0 for a sliver.
        let mut quality: Vec<f64> = mesh
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
                let (u, v, w) = ((b - a).length(), (c - b).length(), (a - c).length());
                (v + w - u) * (w + u - v) * (u + v - w) / (u * v * w)
            })
            .collect();
        quality.sort_by(f64::total_cmp);
        assert!(
            quality[quality.len() / 2] > 0.9,
            "median {}",
            quality[quality.len() / 2]
        );
        assert!(
            quality[quality.len() / 100] > 0.4,
            "hundredth {}",
            quality[quality.len() / 100]
        );
    }
}
