//! An allocator that counts, for examples that tell what memory reading takes.
#![allow(dead_code, reason = "each example asks for some of it")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The system's allocator, which notes the largest allocation and how much is held.
pub struct Counting;

/// The largest allocation since it was last set to 0.
pub static LARGEST: AtomicUsize = AtomicUsize::new(0);
/// The sum of all allocations.
pub static ALLOCATED: AtomicUsize = AtomicUsize::new(0);
/// What is held.
pub static HELD: AtomicUsize = AtomicUsize::new(0);
/// The most that was held at once since it was last set.
pub static PEAK: AtomicUsize = AtomicUsize::new(0);

fn count(bytes: usize) {
    LARGEST.fetch_max(bytes, Ordering::Relaxed);
    ALLOCATED.fetch_add(bytes, Ordering::Relaxed);
    let held = HELD.fetch_add(bytes, Ordering::Relaxed) + bytes;
    PEAK.fetch_max(held, Ordering::Relaxed);
}

#[expect(
    unsafe_code,
    reason = "each call is handed to the system's allocator with the very arguments that came in"
)]
// SAFETY: as `System`, to which everything is handed on; counting neither allocates nor touches the memory.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size());
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        count(size);
        unsafe { System.realloc(at, layout, size) }
    }
}
