//! A guess of the axis that points up in a file, because most formats do not tell it.
//!
//! An object stands upright if its centre lies well above its base (Fu et al. 2008, *Upright orientation of man-made
//! objects*: static stability).

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use pliant_mesh::{Model, bounding_box};

use super::UpAxis;

/// The share of the height, from the lowest vertex on, whose vertices are the base.
const BASE: f64 = 0.03;

/// The most vertices, give or take a factor of two, that are looked at: a base of a few hundred is enough.
const SAMPLE: usize = 100_000;

/// The directions in which the base must reach beyond the centre.
const DIRECTIONS: usize = 32;

/// A shape stands if its base reaches beyond the centre by this share of its size in every direction.
const STANDS: f64 = 0.02;

/// Z is up only if the shape stands this many times as broadly on it as on Y.
const CLEARLY: f64 = 4.0;

/// The up axis of a shape: Y, as in glTF, unless it stands clearly better with Z up. A shape that is thinnest along Z is
/// left alone: a mask or a relief faces Z, and lies well on its back.
pub fn up_axis_of(model: &Model) -> UpAxis {
    let every = 1 + model.surface.positions.len() / SAMPLE;
    let shown = model.vertices_without_specks().step_by(every);
    let sample: Vec<DVec3> = shown.map(|vertex| model.surface.positions[vertex.index()]).collect();
    stands_on(&sample)
}

fn stands_on(sample: &[DVec3]) -> UpAxis {
    let margin = |axis: UpAxis| margin(sample, axis);
    let upon_z = margin(UpAxis::Z);
    let extents = bounding_box(sample).map_or(DVec3::ZERO, |bounds| bounds.max - bounds.min);
    if extents.z > extents.x.min(extents.y) && upon_z > STANDS && upon_z > CLEARLY * margin(UpAxis::Y) {
        UpAxis::Z
    } else {
        UpAxis::Y
    }
}

/// The shortest reach of the base beyond the mean of the vertices, over all level directions, as a share of the size of
/// the shape; negative if the shape would topple, and −∞ if there is no shape.
fn margin(positions: &[DVec3], up: UpAxis) -> f64 {
    let up = up.vector();
    let level = |p: DVec3| {
        if up == DVec3::Y {
            DVec2::new(p.z, p.x)
        } else {
            DVec2::new(p.x, p.y)
        }
    };
    let Some(bounds) = bounding_box(positions).filter(|bounds| bounds.diagonal() > 0.0) else {
        return f64::NEG_INFINITY;
    };
    let sum: DVec3 = positions.iter().map(|p| *p - bounds.min).sum();
    let centre = level(bounds.min + sum / positions.len() as f64);
    let ground = bounds.min.dot(up) + BASE * (bounds.max - bounds.min).dot(up);
    let mut reach = [f64::NEG_INFINITY; DIRECTIONS];
    let directions: [DVec2; DIRECTIONS] =
        std::array::from_fn(|number| DVec2::from_angle(TAU * number as f64 / DIRECTIONS as f64));
    for position in positions.iter().filter(|p| p.dot(up) <= ground) {
        let offset = level(*position) - centre;
        for (reach, direction) in reach.iter_mut().zip(directions) {
            *reach = reach.max(offset.dot(direction));
        }
    }
    reach.into_iter().fold(f64::INFINITY, f64::min) / bounds.diagonal()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table of four legs under a plate, with `up` as its vertical axis.
    fn table(up: UpAxis) -> Vec<DVec3> {
        let stand = |x: f64, height: f64, z: f64| match up {
            UpAxis::Y => DVec3::new(x, height, z),
            UpAxis::Z => DVec3::new(x, -z, height),
        };
        let mut positions = Vec::new();
        for step in 0..=10 {
            let share = f64::from(step) / 10.0;
            positions
                .extend([(-1.0, -0.6), (1.0, -0.6), (-1.0, 0.6), (1.0, 0.6)].map(|(x, z)| stand(x, 2.0 * share, z)));
            // A plate that overhangs the legs on one side, so that the table does not stand on its edge.
            positions.extend((0..=10).map(|row| stand(2.4 * share - 1.2, 2.0, 0.16 * f64::from(row) - 0.8)));
        }
        positions
    }

    #[test]
    fn a_table_stands_on_its_legs() {
        assert_eq!(stands_on(&table(UpAxis::Y)), UpAxis::Y);
        assert_eq!(stands_on(&table(UpAxis::Z)), UpAxis::Z);
    }

    #[test]
    fn what_stands_on_both_axes_or_on_none_keeps_the_axis_of_gltf() {
        let cube: Vec<DVec3> = (0..8)
            .map(|corner| {
                DVec3::new(
                    f64::from(corner & 1),
                    f64::from(corner >> 1 & 1),
                    f64::from(corner >> 2),
                )
            })
            .collect();
        let line = [DVec3::ZERO, DVec3::X];
        let relief: Vec<DVec3> = cube.iter().map(|p| *p * DVec3::new(1.0, 1.0, 0.2)).collect();
        for shape in [&cube[..], &relief, &line, &[], &[DVec3::ONE]] {
            assert_eq!(stands_on(shape), UpAxis::Y);
        }
    }
}
