//! Asking for cache lines before they are needed.
//!
//! A solve reads the factor once up and once down, and processors fetch ahead of what is read in rising order alone; on
//! the way down, where each block was waited for, half of the time went by. A hint cannot fault, wherever it points.

use crate::sparse::line::Line;

/// Lines between the one that is read and the one that is asked for: some blocks of the usual size.
const DISTANCE: usize = 128;

/// The machine's hint, where there is one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prefetch {
    #[cfg(target_arch = "x86_64")]
    sse: Option<pulp::core_arch::x86::Sse>,
}

impl Prefetch {
    /// What this machine offers.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            #[cfg(target_arch = "x86_64")]
            sse: pulp::core_arch::x86::Sse::try_new(),
        }
    }

    /// Asks for what lies some way behind `line`, for a walk up.
    #[inline(always)]
    pub fn above(self, line: &Line) {
        self.fetch(std::ptr::from_ref(line).wrapping_add(DISTANCE));
    }

    /// Asks for what lies some way before `line`, for a walk down.
    #[inline(always)]
    pub fn below(self, line: &Line) {
        self.fetch(std::ptr::from_ref(line).wrapping_sub(DISTANCE));
    }

    #[inline(always)]
    #[cfg_attr(not(target_arch = "x86_64"), allow(unused_variables, clippy::unused_self))]
    fn fetch(self, line: *const Line) {
        #[cfg(target_arch = "x86_64")]
        if let Some(sse) = self.sse {
            sse._mm_prefetch::<{ std::arch::x86_64::_MM_HINT_T0 }>(line.cast());
        }
    }
}
