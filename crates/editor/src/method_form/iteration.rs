//! When a method that iterates ends: options that all such methods share.

use super::{MethodOption, OptionKind};
use crate::edit_error::EditError;
use crate::edit_node::Members;

pub(super) const TOLERANCE: MethodOption = MethodOption {
    name: "tolerance",
    says: "iteration ends where a step lowers the energy by less than this share of it, 1e-12 to 0.1; default 1e-7",
    takes: OptionKind::Number {
        range: [1e-12, 0.1],
        default: 1e-7,
        unit: "of the energy",
    },
};

pub(super) const MAX_ITERATIONS: MethodOption = MethodOption {
    name: "max_iterations",
    says: "iteration ends after so many steps a frame, 1 to 100000; default 1000",
    takes: OptionKind::Whole {
        range: [1, 100_000],
        default: 1000,
    },
};

pub(super) fn read(members: &Members<'_>, tolerance: &mut f64, max_iterations: &mut u32) -> Result<(), EditError> {
    if let Some(node) = members.get("tolerance") {
        *tolerance = match node.number()? {
            number if (1e-12..=0.1).contains(&number) => number,
            _ => return Err(node.out_of_range("a number from 1e-12 to 0.1")),
        };
    }
    if let Some(node) = members.get("max_iterations") {
        *max_iterations = match node.whole()? {
            number @ 1..=100_000 => number as u32,
            _ => return Err(node.out_of_range("a whole number from 1 to 100000")),
        };
    }
    Ok(())
}
