//! The plane of `pliant cut`, as arguments.

use std::str::FromStr;

use clap::ValueEnum;
use glam::DVec3;
use pliant_engine::stitching::{Keep, Plane};
use pliant_io::quoted;

/// A plane: its normal and its level.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct PlaneArgument(pub Plane);

impl FromStr for PlaneArgument {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text
            .split(',')
            .map(|number| {
                number
                    .trim()
                    .parse()
                    .map_err(|_| format!("`{}` is no number", quoted(number)))
            })
            .collect::<Result<_, String>>()?;
        let [x, y, z, level] = numbers[..] else {
            return Err("a plane has four numbers: NX,NY,NZ,D".to_owned());
        };
        let plane = Plane::of(DVec3::new(x, y, z), level);
        plane
            .map(Self)
            .ok_or_else(|| "the normal NX,NY,NZ has no direction, or a number is not finite".to_owned())
    }
}

/// The side of a plane to keep.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum KeepArgument {
    Positive,
    Negative,
    Both,
}

impl From<KeepArgument> for Keep {
    fn from(keep: KeepArgument) -> Self {
        match keep {
            KeepArgument::Positive => Self::Positive,
            KeepArgument::Negative => Self::Negative,
            KeepArgument::Both => Self::Both,
        }
    }
}
