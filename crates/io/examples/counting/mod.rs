//! An allocator that counts, and the processor's time, for examples that measure reading.
#![allow(dead_code, reason = "each example asks for some of it")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::ptr::null_mut;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// The system's allocator, which notes the largest allocation and the bytes held.
pub struct Counting;

/// The largest allocation since it was last set to 0.
pub static LARGEST: AtomicUsize = AtomicUsize::new(0);
/// The sum of all allocations.
pub static ALLOCATED: AtomicUsize = AtomicUsize::new(0);
/// The bytes held.
pub static HELD: AtomicUsize = AtomicUsize::new(0);
/// The most bytes held at once since it was last set.
pub static PEAK: AtomicUsize = AtomicUsize::new(0);
/// The limit of held bytes; an allocation beyond it fails, as on a machine without more memory.
pub static LIMIT: AtomicUsize = AtomicUsize::new(usize::MAX);

/// Counts an allocation; `false` if it is beyond the limit.
fn admit(bytes: usize) -> bool {
    let held = HELD.load(Ordering::Relaxed).saturating_add(bytes);
    let limit = LIMIT.load(Ordering::Relaxed);
    if held > limit {
        tell(bytes, limit);
        return false;
    }
    LARGEST.fetch_max(bytes, Ordering::Relaxed);
    ALLOCATED.fetch_add(bytes, Ordering::Relaxed);
    let held = HELD.fetch_add(bytes, Ordering::Relaxed) + bytes;
    PEAK.fetch_max(held, Ordering::Relaxed);
    true
}

/// Reports the first caller that asked for too much. The report itself takes memory, so the limit is off meanwhile.
#[cold]
fn tell(bytes: usize, limit: usize) {
    static TOLD: AtomicBool = AtomicBool::new(false);
    if !TOLD.swap(true, Ordering::Relaxed) {
        LIMIT.store(usize::MAX, Ordering::Relaxed);
        let backtrace = std::backtrace::Backtrace::force_capture();
        #[expect(clippy::print_stderr, reason = "whoever set the limit wants to know who exceeded it")]
        {
            eprintln!("{bytes} bytes are beyond the limit of {limit}:\n{backtrace}");
        }
        LIMIT.store(limit, Ordering::Relaxed);
    }
}

#[expect(
    unsafe_code,
    reason = "each call is handed to the system's allocator with the very arguments that came in"
)]
// SAFETY: as `System`, to which everything is handed on; counting does not touch the memory, a null pointer says that
// an allocation failed and leaves an old one unchanged, and `tell` calls itself at most once.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if !admit(layout.size()) {
            return null_mut();
        }
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if !admit(layout.size()) {
            return null_mut();
        }
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        if !admit(size) {
            HELD.fetch_add(layout.size(), Ordering::Relaxed);
            return null_mut();
        }
        unsafe { System.realloc(at, layout, size) }
    }
}

/// The processor time of a process and all of its threads. Linux counts it in hundredths of a second.
pub fn cpu_ms(process: &str) -> Option<u64> {
    let text = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The name in brackets may contain anything.
    let fields: Vec<&str> = text.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |place: usize| fields.get(place)?.parse::<u64>().ok();
    Some((ticks(11)? + ticks(12)?) * 10)
}
