//! Requests for cache lines before they are needed.
//!
//! Processors prefetch by themselves only data that are read in rising order. The backward substitution reads the
//! factor in falling order and spent half of its time waiting; the values of a ring's vertices are read in random
//! order. A hint cannot fault, even for an invalid address.

/// The machine's prefetch instruction, if it has one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Prefetch {
    #[cfg(target_arch = "x86_64")]
    sse: Option<pulp::core_arch::x86::Sse>,
}

impl Prefetch {
    /// The machine's prefetch.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            #[cfg(target_arch = "x86_64")]
            sse: pulp::core_arch::x86::Sse::try_new(),
        }
    }

    /// Prefetches the data `distance` items after `item`, for a loop in rising order.
    #[inline(always)]
    pub fn above<T>(self, item: &T, distance: usize) {
        self.fetch(std::ptr::from_ref(item).wrapping_add(distance));
    }

    /// Prefetches the data `distance` items before `item`, for a loop in falling order.
    #[inline(always)]
    pub fn below<T>(self, item: &T, distance: usize) {
        self.fetch(std::ptr::from_ref(item).wrapping_sub(distance));
    }

    /// Prefetches an item of at most one cache line; both lines if it is on two.
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
