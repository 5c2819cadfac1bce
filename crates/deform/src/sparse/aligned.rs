//! Numbers that start on a cache line: kernels treat the first few apart according to where they lie, and that must
//! not differ from run to run.

/// Numbers of a cache line.
pub(crate) const LINE: usize = 8;

/// A vector of numbers that starts on a cache line.
#[derive(Default, Debug)]
pub(crate) struct Aligned {
    numbers: Vec<f64>,
    first: usize,
    len: usize,
}

impl Aligned {
    /// `len` zeros from the system, which are only touched where they are written; `None` where there is no room.
    pub fn zeros(len: usize) -> Option<Self> {
        Vec::<f64>::new().try_reserve_exact(len + LINE).ok()?;
        let mut aligned = Self {
            numbers: vec![0.0; len + LINE],
            ..Self::default()
        };
        aligned.align(len);
        Some(aligned)
    }

    /// How many numbers it has room for without asking the system.
    pub fn room(&self) -> usize {
        self.numbers.capacity().saturating_sub(LINE)
    }

    /// Nothing yet, with room for `len` numbers.
    pub fn with_room(len: usize) -> Self {
        Self {
            numbers: Vec::with_capacity(len + LINE),
            ..Self::default()
        }
    }

    /// Makes it `len` zeros.
    pub fn clear(&mut self, len: usize) {
        self.numbers.clear();
        self.numbers.resize(len + LINE, 0.0);
        self.align(len);
    }

    fn align(&mut self, len: usize) {
        self.first = self.numbers.as_ptr().align_offset(64).min(LINE);
        self.len = len;
    }

    pub fn get(&self) -> &[f64] {
        &self.numbers[self.first..self.first + self.len]
    }

    pub fn get_mut(&mut self) -> &mut [f64] {
        &mut self.numbers[self.first..self.first + self.len]
    }
}
