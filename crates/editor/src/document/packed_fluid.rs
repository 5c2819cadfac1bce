//! A fluid as history keeps it: in a half of its memory or less, without loss.
//!
//! A stretch of play is one step of the history, and changes every number of the fluid. Its numbers are rounded when it
//! ends ([`rounded_dye`], [`round_velocities`]): dye to 16 bits, as vertex colours are saved, and velocities to as many
//! below the fastest one. So a packed fluid is the same to the bit when it is unpacked; a field whose numbers are finer,
//! out of a project or under a brush that pushed, is kept as it is.

use std::sync::Arc;

use super::fluid::{Dye, Fluid};

/// The largest number of 16 bits.
const MOST: f32 = 65535.0;

/// The largest packed component of a velocity.
const FASTEST: f32 = 32767.0;

/// A fluid, packed.
#[derive(Clone, Debug)]
pub(crate) struct PackedFluid {
    dye: Option<PackedDye>,
    velocity: Option<PackedVelocity>,
    /// It changes seldom and is shared.
    kept: Option<Arc<Vec<Dye>>>,
}

#[derive(Clone, Debug)]
enum PackedDye {
    /// The dyed vertices and their dyes, and the number of all vertices.
    Some(Vec<(u32, [u16; 4])>, usize),
    /// The dye of each vertex.
    Every(Vec<[u16; 4]>),
    AsItIs(Arc<Vec<Dye>>),
}

#[derive(Clone, Debug)]
enum PackedVelocity {
    /// The velocity of each triangle in units of the second number.
    Every(Vec<[i16; 3]>, f32),
    AsItIs(Arc<Vec<[f32; 3]>>),
}

impl PackedFluid {
    pub fn of(fluid: &Fluid) -> Self {
        Self {
            dye: fluid.dye.as_ref().map(packed_dye),
            velocity: fluid.velocity.as_ref().map(packed_velocity),
            kept: fluid.kept.clone(),
        }
    }

    /// The same fluid again.
    pub fn unpacked(&self) -> Fluid {
        let dye = |packed: &PackedDye| match packed {
            PackedDye::Some(dyed, count) => {
                let mut dyes = vec![[0.0; 4]; *count];
                dyed.iter()
                    .for_each(|(vertex, dye)| dyes[*vertex as usize] = wide(*dye));
                Arc::new(dyes)
            }
            PackedDye::Every(dyes) => Arc::new(dyes.iter().map(|dye| wide(*dye)).collect()),
            PackedDye::AsItIs(dyes) => Arc::clone(dyes),
        };
        let velocity = |packed: &PackedVelocity| match packed {
            PackedVelocity::Every(all, unit) => {
                let fast = |velocity: &[i16; 3]| velocity.map(|component| f32::from(component) * unit);
                Arc::new(all.iter().map(fast).collect())
            }
            PackedVelocity::AsItIs(all) => Arc::clone(all),
        };
        Fluid {
            dye: self.dye.as_ref().map(dye),
            velocity: self.velocity.as_ref().map(velocity),
            kept: self.kept.clone(),
        }
    }

    /// The memory of its fields. Each holder of a shared field counts its share of it.
    pub fn bytes(&self) -> usize {
        fn share<T>(field: &Arc<Vec<T>>) -> usize {
            size_of_val(field.as_slice()) / Arc::strong_count(field)
        }
        let dye = self.dye.as_ref().map_or(0, |dye| match dye {
            PackedDye::Some(dyed, _) => size_of_val(dyed.as_slice()),
            PackedDye::Every(dyes) => size_of_val(dyes.as_slice()),
            PackedDye::AsItIs(dyes) => share(dyes),
        });
        let velocity = self.velocity.as_ref().map_or(0, |velocity| match velocity {
            PackedVelocity::Every(all, _) => size_of_val(all.as_slice()),
            PackedVelocity::AsItIs(all) => share(all),
        });
        dye + velocity + self.kept.as_ref().map_or(0, share)
    }
}

/// A dye, rounded so that it can be packed.
pub(crate) fn rounded_dye(dye: Dye) -> Dye {
    wide(narrow(dye))
}

/// Rounds velocities so that they can be packed.
pub(crate) fn round_velocities(velocities: &mut [[f32; 3]]) {
    let unit = unit_of(velocities);
    if unit > 0.0 {
        for component in velocities.as_flattened_mut() {
            *component = (*component / unit).round() * unit;
        }
    }
}

fn narrow(dye: Dye) -> [u16; 4] {
    dye.map(|value| (value.clamp(0.0, 1.0) * MOST).round() as u16)
}

fn wide(dye: [u16; 4]) -> Dye {
    dye.map(|value| f32::from(value) / MOST)
}

fn packed_dye(dyes: &Arc<Vec<Dye>>) -> PackedDye {
    if dyes.iter().any(|dye| rounded_dye(*dye) != *dye) {
        return PackedDye::AsItIs(Arc::clone(dyes));
    }
    let dyed = dyes.iter().enumerate().filter(|(_, dye)| **dye != [0.0; 4]);
    let packed = dyed.clone().map(|(vertex, dye)| (vertex as u32, narrow(*dye)));
    match dyed.clone().count() * size_of::<(u32, [u16; 4])>() < dyes.len() * size_of::<[u16; 4]>() {
        true => PackedDye::Some(packed.collect(), dyes.len()),
        false => PackedDye::Every(dyes.iter().map(|dye| narrow(*dye)).collect()),
    }
}

/// The power of two that is the unit of these velocities when they are packed; 0 if they are all 0, or not numbers.
fn unit_of(velocities: &[[f32; 3]]) -> f32 {
    let fastest = velocities
        .as_flattened()
        .iter()
        .fold(0.0f32, |fastest, component| fastest.max(component.abs()));
    match fastest.is_normal() {
        true => (fastest / FASTEST).log2().ceil().exp2(),
        false => 0.0,
    }
}

fn packed_velocity(velocities: &Arc<Vec<[f32; 3]>>) -> PackedVelocity {
    let unit = unit_of(velocities);
    let is_whole = |component: &f32| {
        let whole = component / unit;
        whole.abs() <= FASTEST && whole.round() * unit == *component
    };
    if !velocities.as_flattened().iter().all(is_whole) {
        return PackedVelocity::AsItIs(Arc::clone(velocities));
    }
    let packed = velocities
        .iter()
        .map(|velocity| velocity.map(|component| (component / unit) as i16));
    PackedVelocity::Every(packed.collect(), unit)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use super::*;

    /// A fluid as it is at the end of a stretch: every `nth` of 3,000 vertices is dyed.
    fn played(nth: usize) -> Fluid {
        let number = |i: usize| ((i * 7919) % 10007) as f32 / 10007.0;
        let dye = |v: usize| match v % nth {
            0 => rounded_dye([0, 1, 2, 3].map(|k| number(5 * v + k))),
            _ => [0.0; 4],
        };
        let mut velocity: Vec<[f32; 3]> = (0..6000)
            .map(|t| [0, 1, 2].map(|k| 3.7 * (number(3 * t + k) - 0.5)))
            .collect();
        round_velocities(&mut velocity);
        Fluid {
            dye: Some(Arc::new((0..3000).map(dye).collect())),
            velocity: Some(Arc::new(velocity)),
            kept: None,
        }
    }

    #[test]
    fn a_played_fluid_takes_half_its_memory_or_less_and_comes_back_to_the_bit() {
        for nth in [1, 2, 10] {
            let fluid = played(nth);
            let packed = PackedFluid::of(&fluid);
            assert_eq!(packed.unpacked(), fluid);
            let whole = 3000 * size_of::<Dye>() + 6000 * size_of::<[f32; 3]>();
            assert!(2 * packed.bytes() <= whole, "{} of {whole}", packed.bytes());
            if nth == 10 {
                assert!(3 * packed.bytes() < whole, "{} of {whole}", packed.bytes());
            }
        }
    }

    #[test]
    fn rounding_moves_a_fluid_by_less_than_a_saved_colour_and_changes_it_once() {
        for scale in [1e-20f32, 1.0, 3e15] {
            let given: Vec<[f32; 3]> = (0..999).map(|t| [scale * (t as f32).sin(), scale, 0.0]).collect();
            let mut rounded = given.clone();
            round_velocities(&mut rounded);
            for (a, b) in given.as_flattened().iter().zip(rounded.as_flattened()) {
                assert!((a - b).abs() <= scale / 32767.0);
            }
            let once = rounded.clone();
            round_velocities(&mut rounded);
            assert_eq!(once, rounded);
        }
        for value in [0.0, 1e-6, 0.3, 0.77777, 1.0] {
            let rounded = rounded_dye([value; 4]);
            assert!((rounded[0] - value).abs() <= 0.51 / 65535.0);
            assert_eq!(rounded_dye(rounded), rounded);
        }
    }

    #[test]
    fn finer_numbers_are_kept_as_they_are() {
        let mut fluid = played(1);
        let velocity = Arc::make_mut(fluid.velocity.as_mut().unwrap());
        velocity[7] = [1e-7, 0.0, 0.0];
        Arc::make_mut(fluid.dye.as_mut().unwrap())[3] = [0.123_456_78; 4];
        assert_eq!(PackedFluid::of(&fluid).unpacked(), fluid);
        let still = Fluid {
            velocity: Some(Arc::new(vec![[0.0; 3]; 4])),
            ..Fluid::default()
        };
        assert_eq!(PackedFluid::of(&still).unpacked(), still);
    }
}
