//! The processor's vectors that the loops run with.
//!
//! Loops are compiled for several vectors and dispatched when they run, usually to the widest that the processor has. A
//! program may ask for narrower ones, to reproduce another machine's results and speed on this one. No loop fuses or
//! reorders operations by the width of vectors, so all of them give the same bits.

use std::sync::atomic::{AtomicU8, Ordering};

use pulp::Arch;

/// A set of vector instructions.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(u8)]
pub enum Vectors {
    /// AVX-512: eight numbers of double precision.
    Avx512 = 1,
    /// AVX2 with fused multiply-add: four.
    Avx2 = 2,
    /// The vectors of every processor of its kind: SSE2 or NEON, two numbers.
    Baseline = 3,
}

/// The chosen [`Vectors`], 0 for the widest.
static CHOSEN: AtomicU8 = AtomicU8::new(0);

impl Vectors {
    /// All vectors, from the widest to the narrowest.
    pub const ALL: [Self; 3] = [Self::Avx512, Self::Avx2, Self::Baseline];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Avx512 => "avx512",
            Self::Avx2 => "avx2",
            Self::Baseline => "baseline",
        }
    }

    /// The vectors of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|vectors| vectors.name() == name)
    }

    /// Returns true if this processor has them.
    pub fn is_available(self) -> bool {
        self.arch().is_some()
    }

    /// Makes all loops of this process that start from now on run with these vectors. Returns whether this processor
    /// has them; if not, nothing changes.
    #[must_use]
    pub fn choose(self) -> bool {
        let available = self.is_available();
        if available {
            CHOSEN.store(self as u8, Ordering::Relaxed);
        }
        available
    }

    #[cfg(target_arch = "x86_64")]
    #[inline]
    fn arch(self) -> Option<Arch> {
        match self {
            #[cfg(feature = "avx512")]
            Self::Avx512 => pulp::x86::V4::try_new().map(Arch::V4),
            #[cfg(not(feature = "avx512"))]
            Self::Avx512 => None,
            Self::Avx2 => pulp::x86::V3::try_new().map(Arch::V3),
            Self::Baseline => Some(Arch::Scalar),
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    #[inline]
    fn arch(self) -> Option<Arch> {
        (self == Self::Baseline).then(Arch::new)
    }
}

/// The dispatcher of loops: the chosen vectors, or else the widest.
#[inline]
pub fn vectors() -> Arch {
    let chosen = CHOSEN.load(Ordering::Relaxed);
    let chosen = Vectors::ALL.into_iter().find(|vectors| *vectors as u8 == chosen);
    chosen.and_then(Vectors::arch).unwrap_or_default()
}
