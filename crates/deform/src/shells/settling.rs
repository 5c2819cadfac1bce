//! The matrix of the Newton steps that settle a shape after its coarse level.

use super::system::{Pattern, System};
use crate::Budget;

/// The matrix of the Newton steps. It is analysed at its first use: a drag does not use it.
#[derive(Debug)]
pub(super) enum Settling {
    /// The pattern, the ends of its supernodes and the memory that it may take.
    NotAnalysed(Pattern, Vec<u32>, Budget),
    Analysed(Box<System>),
    /// The matrix would take too much memory.
    TooLarge,
}

impl Settling {
    /// The matrix; `None` if it is too large.
    pub fn system(&mut self) -> Option<&mut System> {
        if let Self::NotAnalysed(pattern, ends, budget) = self {
            let system = System::of(pattern, ends, *budget);
            *self = system.map_or(Self::TooLarge, |(system, _)| Self::Analysed(Box::new(system)));
        }
        match self {
            Self::Analysed(system) => Some(system),
            _ => None,
        }
    }

    /// The next step is the first one after a jump of the handles.
    pub fn undamp(&mut self) {
        if let Self::Analysed(system) = self {
            system.undamp();
        }
    }

    /// The count of numbers that the factor stores.
    pub fn stored(&self) -> usize {
        match self {
            Self::Analysed(system) => system.stored(),
            _ => 0,
        }
    }
}
