//! The distance between a primitive's positions and those before rounding: to integers, to the grid of `Draco`, or to
//! single precision.
//!
//! Draco does not hand on its grid. The grid's origin is the least coordinate of each axis and its width the largest
//! extent, cut into 2^bits − 1 steps, so the fewest bits whose grid holds all coordinates are found here.

use ::gltf::json::accessor::ComponentType;
use glam::{DAffine3, DMat3, DVec3, Vec3};
use rayon::prelude::*;

use super::pose::Pose;
use crate::gltf::document::layout::Layout;

/// Draco's largest number of bits.
const MOST_BITS: u32 = 30;

/// The number of coordinates for one task.
const CHUNK: usize = 1 << 14;

/// The coding of positions in the file.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Coding {
    Plain,
    Draco,
}

/// The largest distance in world units between a position and the one before rounding.
pub(super) fn distance(layout: &Layout, coding: Coding, positions: &[[f32; 3]], pose: &Pose) -> f64 {
    let step = match layout.component {
        ComponentType::F32 if coding == Coding::Draco => {
            draco_step(positions).unwrap_or_else(|| step_of_floats(positions))
        }
        ComponentType::F32 => step_of_floats(positions),
        ComponentType::I8 => step_of_integers(layout, f64::from(i8::MAX)),
        ComponentType::U8 => step_of_integers(layout, f64::from(u8::MAX)),
        ComponentType::I16 => step_of_integers(layout, f64::from(i16::MAX)),
        ComponentType::U16 => step_of_integers(layout, f64::from(u16::MAX)),
        ComponentType::U32 => step_of_integers(layout, f64::from(u32::MAX)),
    };
    let transforms = pose.transforms();
    0.5 * step * transforms.iter().map(corner_distance).fold(0.0, f64::max)
}

/// The largest distance by which a transform moves a corner of the cube of side 2 from its centre.
fn corner_distance(transform: &DAffine3) -> f64 {
    let DMat3 { x_axis, y_axis, z_axis } = transform.matrix3;
    let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let of_corner = |(y, z): (f64, f64)| (x_axis + y * y_axis + z * z_axis).length();
    corners.into_iter().map(of_corner).fold(0.0, f64::max)
}

fn step_of_integers(layout: &Layout, most: f64) -> f64 {
    if layout.normalized { 1.0 / most } else { 1.0 }
}

/// The distance between neighbouring numbers at the largest coordinate.
fn step_of_floats(positions: &[[f32; 3]]) -> f64 {
    let larger = |largest: f32, x: &f32| if x.is_finite() { largest.max(x.abs()) } else { largest };
    let chunks = positions.as_flattened().par_chunks(CHUNK);
    let largest = chunks
        .map(|chunk| chunk.iter().fold(0.0, larger))
        .reduce(|| 0.0, f32::max);
    f64::from(largest) * f64::from(f32::EPSILON)
}

/// The step of Draco's grid; `None` if the positions are on no such grid.
fn draco_step(positions: &[[f32; 3]]) -> Option<f64> {
    let all = || positions.iter().map(|p| Vec3::from_array(*p).as_dvec3());
    let (min, max) = all().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| {
        (min.min(p), max.max(p))
    });
    let width = (max - min).max_element();
    if !(width > 0.0 && width.is_finite()) {
        return None;
    }
    // Decoding rounds the sum of origin and steps.
    let slack = 2.0 * step_of_floats(positions);
    (1..=MOST_BITS)
        .map(|bits| width / f64::from((1_u32 << bits) - 1))
        .take_while(|step| 8.0 * slack < *step)
        .find(|&step| {
            all().all(|p| {
                let steps = (p - min) / step;
                ((steps - steps.round()).abs() * step).max_element() <= slack
            })
        })
}

#[cfg(test)]
mod tests {
    use super::super::pose::SkinPose;
    use super::*;

    fn layout(component: ComponentType, normalized: bool) -> Layout {
        Layout {
            component,
            lanes: 3,
            normalized,
            count: 0,
            dense: None,
            sparse: None,
        }
    }

    #[test]
    fn steps_are_those_of_the_type_and_scale_with_the_node() {
        let positions = [[0.0, 1.0, 2.0], [-4.0, 0.5, 0.25]];
        let identity = DAffine3::IDENTITY;
        let of = |component, normalized, world: &DAffine3| {
            distance(
                &layout(component, normalized),
                Coding::Plain,
                &positions,
                &Pose::Node(*world),
            )
        };
        let half_diagonal = 0.5 * 3.0_f64.sqrt();
        assert!((of(ComponentType::U16, false, &identity) - half_diagonal).abs() < 1e-12);
        assert!((of(ComponentType::I16, true, &identity) - half_diagonal / 32767.0).abs() < 1e-12);
        assert!((of(ComponentType::I8, true, &identity) - half_diagonal / 127.0).abs() < 1e-12);
        let stretched = DAffine3::from_scale(DVec3::new(3.0, 0.0, 4.0));
        assert!((of(ComponentType::U8, false, &stretched) - 2.5).abs() < 1e-12);
        let floats = of(ComponentType::F32, false, &identity);
        assert!((floats - half_diagonal * 4.0 * f64::from(f32::EPSILON)).abs() < 1e-12);
        // In a skin the joint with the largest enlargement decides.
        let skin = Pose::Skin(SkinPose::of(vec![DAffine3::IDENTITY, stretched]));
        let by_skin = distance(&layout(ComponentType::U8, false), Coding::Plain, &positions, &skin);
        assert!((by_skin - 2.5).abs() < 1e-12);
    }

    #[test]
    fn a_grid_is_told_by_what_it_holds() {
        for bits in [8, 11, 14, 16] {
            let (origin, width) = (DVec3::new(-3.2, 0.7, 11.0), 5.3_f32);
            let step = f64::from(width) / f64::from((1_u32 << bits) - 1);
            let mut positions: Vec<[f32; 3]> = (0..200_u32)
                .map(|k| {
                    let spread = |by: u32| f64::from(k * by % ((1 << bits) - 1));
                    (origin + step * DVec3::new(spread(7919), spread(104_729), spread(31)))
                        .as_vec3()
                        .to_array()
                })
                .collect();
            positions.push(origin.as_vec3().to_array());
            positions.push((origin + DVec3::X * f64::from(width)).as_vec3().to_array());
            let found = draco_step(&positions);
            assert!(
                found.is_some_and(|found| (found / step - 1.0).abs() < 1e-4),
                "{bits}: {found:?}, {step}"
            );
        }
        let irregular: Vec<[f32; 3]> = (0..100).map(|k| [(k as f32).sqrt(), (k as f32).sin(), 0.1]).collect();
        assert_eq!(draco_step(&irregular), None);
        assert_eq!(draco_step(&[[1.0; 3]; 4]), None);
        assert_eq!(draco_step(&[]), None);
    }
}
