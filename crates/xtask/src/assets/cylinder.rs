//! The cylinder: an upright round rod, closed by a disc at either end.

use super::mesh::Mesh;
use super::solid::{mix, srgb};
use super::vector::{Vec3, v};

/// Segments around the circle: a power of two, so that halving a quarter turn gives the points.
const AROUND: u32 = 64;
/// Rings from the bottom's rim to the top's.
const RINGS: u32 = 96;
/// Rings of a disc without its rim.
const DISC: u32 = 9;
const RADIUS: f64 = 0.12;
const HEIGHT: f64 = 1.2;

/// The rod from y = 0 upwards.
pub fn cylinder() -> Mesh {
    let circle = circle();
    // This is the profile from the bottom's centre over both rims to the top's centre: radius and height of each ring.
    let mut profile = Vec::new();
    profile.extend((1..=DISC).map(|i| (RADIUS * f64::from(i) / f64::from(DISC + 1), 0.0)));
    profile.extend((0..=RINGS).map(|i| (RADIUS, HEIGHT * f64::from(i) / f64::from(RINGS))));
    profile.extend(
        (1..=DISC)
            .rev()
            .map(|i| (RADIUS * f64::from(i) / f64::from(DISC + 1), HEIGHT)),
    );

    let mut mesh = Mesh::default();
    mesh.positions.push(v(0.0, 0.0, 0.0));
    for &(radius, height) in &profile {
        mesh.positions
            .extend(circle.iter().map(|c| *c * radius + v(0.0, height, 0.0)));
    }
    mesh.positions.push(v(0.0, HEIGHT, 0.0));

    let at = |ring: u32, i: u32| 1 + ring * AROUND + i % AROUND;
    let (last, rings) = (mesh.positions.len() as u32 - 1, profile.len() as u32);
    for i in 0..AROUND {
        mesh.triangles.push([0, at(0, i + 1), at(0, i)]);
        for ring in 0..rings - 1 {
            let (a, b, c, d) = (at(ring, i), at(ring, i + 1), at(ring + 1, i), at(ring + 1, i + 1));
            mesh.triangles.extend([[a, b, c], [b, d, c]]);
        }
        mesh.triangles.push([last, at(rings - 1, i), at(rings - 1, i + 1)]);
    }
    mesh.colours = mesh
        .positions
        .iter()
        .map(|p| banded(p.y / HEIGHT, 0x6fa3a8, 0xf2dfb8))
        .collect();
    mesh
}

/// Twelve alternating bands along the length, 0 to 1, which show the distribution of a bend.
pub fn banded(along: f64, one: u32, other: u32) -> Vec3 {
    let band = (along * 12.0 - 0.5).floor() as i32;
    mix(srgb(one), srgb(other), f64::from(band.rem_euclid(2)))
}

/// [`AROUND`] points on the unit circle from z to x, by halving angles: square roots only, so equal on every machine.
fn circle() -> Vec<Vec3> {
    let mut quarter = vec![v(0.0, 0.0, 1.0), v(1.0, 0.0, 0.0)];
    while quarter.len() as u32 - 1 < AROUND / 4 {
        let halved = quarter
            .windows(2)
            .flat_map(|pair| [pair[0], (pair[0] + pair[1]).normalized()])
            .collect::<Vec<_>>();
        let end = quarter[quarter.len() - 1];
        quarter = halved;
        quarter.push(end);
    }
    quarter.pop();
    let turn = |p: Vec3| v(p.z, 0.0, -p.x);
    let mut circle = Vec::new();
    for _ in 0..4 {
        circle.extend_from_slice(&quarter);
        quarter = quarter.into_iter().map(turn).collect();
    }
    circle
}
