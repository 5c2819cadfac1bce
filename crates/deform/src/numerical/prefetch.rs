//! Asking for cache lines before they are needed.
//!
//! Processors fetch ahead of what is read in rising order alone. A solve reads the factor once up and once down, and on
//! the way down, where each block was waited for, half of the time went by; what a ring's vertices have is read
//! wherever they stand. A hint cannot fault, wherever it points.

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

    /// Asks for what lies `distance` items behind `item`, for a walk up.
    #[inline(always)]
    pub fn above<T>(self, item: &T, distance: usize) {
        self.fetch(std::ptr::from_ref(item).wrapping_add(distance));
    }

    /// Asks for what lies `distance` items before `item`, for a walk down.
    #[inline(always)]
    pub fn below<T>(self, item: &T, distance: usize) {
        self.fetch(std::ptr::from_ref(item).wrapping_sub(distance));
    }

    /// Asks for an item of at most a cache line, both lines if it lies across two.
    #[inline(always)]
    pub fn item<T>(self, item: &T) {
        let first = std::ptr::from_ref(item);
        self.fetch(first);
        if !64_usize.is_multiple_of(size_of::<T>()) {
            self.fetch(first.cast::<u8>().wrapping_add(size_of::<T>() - 1));
        }
    }

    #[inline(always)]
    #[cfg_attr(not(target_arch = "x86_64"), allow(unused_variables, clippy::unused_self))]
    fn fetch<T>(self, place: *const T) {
        #[cfg(target_arch = "x86_64")]
        if let Some(sse) = self.sse {
            sse._mm_prefetch::<{ std::arch::x86_64::_MM_HINT_T0 }>(place.cast());
        }
    }
}
