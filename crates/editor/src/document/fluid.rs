//! The fluid on the surface: its dye, its velocity, and the colours that were kept from it.

use std::sync::{Arc, LazyLock};

use glam::DVec3;

/// Dye at a vertex: linear red, green and blue multiplied by the coverage, and the coverage, each from 0 to 1. f32 has
/// more digits than any picture.
pub type Dye = [f32; 4];

/// A fluid between two stretches of its flow. It is shared by clones, and a missing field is zero everywhere.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Fluid {
    /// The dye of each surface vertex.
    pub dye: Option<Arc<Vec<Dye>>>,
    /// The velocity of each surface triangle in world units per second, along the surface on which it last flowed. f32
    /// as dye is.
    pub velocity: Option<Arc<Vec<[f32; 3]>>>,
    /// The dye that was kept as vertex colours, of each surface vertex. It lies under the other and no longer flows.
    pub kept: Option<Arc<Vec<Dye>>>,
}

/// The forces in a flow.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct FlowOptions {
    /// The acceleration of dyed fluid, in world units per second squared.
    pub gravity: DVec3,
    /// Kinematic viscosity, in squared world units per second, from 0.
    pub viscosity: f64,
    /// The strength of vorticity confinement, per second, from 0.
    pub confinement: f64,
}

impl FlowOptions {
    /// Returns true if a flow can have these forces.
    pub(crate) fn are_usable(&self) -> bool {
        let is_usable = |number: f64| number.is_finite() && number >= 0.0;
        self.gravity.is_finite() && is_usable(self.viscosity) && is_usable(self.confinement)
    }
}

impl Fluid {
    /// Returns true if there is dye that flows.
    pub fn has_dye(&self) -> bool {
        self.dye
            .as_ref()
            .is_some_and(|dye| dye.iter().any(|[.., coverage]| *coverage > 0.0))
    }

    /// The colour of a vertex, sRGB with its coverage.
    pub(crate) fn colour(&self, vertex: usize) -> [u8; 4] {
        let at = |field: &Option<Arc<Vec<Dye>>>| field.as_ref().map_or([0.0; 4], |dye| dye[vertex]);
        dye_colour(over(at(&self.dye), at(&self.kept)))
    }

    /// The same with the kept dye that a file lacks whose colours have `saved` already.
    pub(crate) fn without_saved(&self, saved: &[Dye]) -> Self {
        let left = |kept: &Arc<Vec<Dye>>| {
            let left: Vec<Dye> = kept
                .iter()
                .zip(saved)
                .map(|(kept, saved)| without(*kept, *saved))
                .collect();
            left.iter().any(|dye| dye[3] > 0.0).then(|| Arc::new(left))
        };
        Self {
            kept: self.kept.as_ref().and_then(left),
            ..self.clone()
        }
    }

    /// The dye over the kept one, in place of both; the fluid is then clear and rests.
    pub(crate) fn with_dye_kept(&self) -> Self {
        let kept = match (&self.dye, &self.kept) {
            (Some(dye), Some(kept)) => {
                let layered = dye.iter().zip(kept.iter()).map(|(dye, kept)| over(*dye, *kept));
                Some(Arc::new(layered.collect()))
            }
            (dye, kept) => dye.as_ref().or(kept.as_ref()).cloned(),
        };
        Self {
            kept,
            ..Self::default()
        }
    }
}

/// The dye that gives `whole` over `under`: the rest of a dye of which a part is in the file already. Where `under` covers
/// everything, nothing tells how much of the whole lies above it: the answer is the whole, or nothing if they are equal.
pub(crate) fn without(whole: Dye, under: Dye) -> Dye {
    if whole == under {
        return [0.0; 4];
    }
    let seen = 1.0 - under[3];
    if seen <= 0.0 {
        return whole;
    }
    // 1 − whole = (1 − top)(1 − under) for the coverage.
    let clear = ((1.0 - whole[3]) / seen).clamp(0.0, 1.0);
    std::array::from_fn(|k| match k {
        3 => 1.0 - clear,
        _ => (whole[k] - clear * under[k]).max(0.0),
    })
}

/// One dye over another.
pub(crate) fn over(top: Dye, under: Dye) -> Dye {
    std::array::from_fn(|k| top[k] + (1.0 - top[3]) * under[k])
}

/// A dye as a colour, sRGB with its coverage.
pub(crate) fn dye_colour([red, green, blue, coverage]: Dye) -> [u8; 4] {
    if coverage <= 0.0 {
        return [0; 4];
    }
    let [red, green, blue] = [red, green, blue].map(|value| to_srgb(value / coverage));
    [red, green, blue, (255.0 * coverage.min(1.0)).round() as u8]
}

/// A byte of sRGB as linear light, from 0 to 1.
pub(crate) fn from_srgb(byte: u8) -> f64 {
    let value = f64::from(byte) / 255.0;
    if value <= 0.04045 {
        value / 12.92
    } else {
        ((value + 0.055) / 1.055).powf(2.4)
    }
}

/// Linear light as a byte of sRGB. A table, because a flow converts every vertex at each step.
fn to_srgb(value: f32) -> u8 {
    const LAST: usize = 1 << 13;
    static TABLE: LazyLock<Vec<u8>> = LazyLock::new(|| {
        let byte = |place: usize| {
            let linear = place as f64 / LAST as f64;
            let value = if linear <= 0.003_130_8 {
                12.92 * linear
            } else {
                1.055 * linear.powf(1.0 / 2.4) - 0.055
            };
            (255.0 * value).round() as u8
        };
        (0..=LAST).map(byte).collect()
    });
    TABLE[(value.clamp(0.0, 1.0) * LAST as f32).round() as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dye_without_the_one_below_it_gives_the_whole_over_that_one_again() {
        let shares = [0.0f32, 0.25, 0.5, 0.8, 1.0];
        for top in shares {
            for under in shares {
                let [top, under] = [[top * 0.2, top * 0.9, 0.0, top], [under * 0.7, 0.0, under, under]];
                let whole = over(top, under);
                let again = over(without(whole, under), under);
                for (a, b) in again.iter().zip(whole) {
                    assert!(
                        (a - b).abs() < 1e-6,
                        "{top:?} over {under:?}: {again:?} is not {whole:?}"
                    );
                }
            }
        }
        let half = [0.5, 0.0, 0.0, 0.5];
        assert_eq!(without(half, half), [0.0; 4]);
    }

    #[test]
    fn a_colour_that_covers_everything_is_shown_as_it_is() {
        for byte in 0..=u8::MAX {
            let linear = from_srgb(byte) as f32;
            let dye = [linear, 0.0, 1.0, 1.0];
            let [red, green, blue, coverage] = dye_colour(over(dye, [0.3, 0.3, 0.3, 0.5]));
            assert!(red.abs_diff(byte) <= 1, "{byte} became {red}");
            assert_eq!([green, blue, coverage], [0, 255, 255]);
        }
        assert_eq!(dye_colour([0.0; 4]), [0; 4]);
    }
}
