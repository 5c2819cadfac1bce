//! A supernode's triangular solves on fields: the loops that read the factor.
//!
//! Inlined into callers that are compiled for wider vectors than the target's. Four columns are taken at once, so that a
//! field is read and written a fourth as often; sums run over lanes of a fixed number, whatever the vectors' width.

/// Columns that are taken at once.
const COLUMNS: usize = 4;

/// Partial sums of a product of columns.
const LANES: usize = 8;

/// Solves with the supernode's lower triangle (`width` columns of `values`, `height` numbers each) for the head of each
/// field of `height` numbers, and subtracts from its tail what the rows below take.
#[inline(always)]
pub(crate) fn forward(values: &[f64], width: usize, height: usize, fields: &mut [f64]) {
    let mut first = 0;
    while first < width {
        let count = COLUMNS.min(width - first);
        let columns: [&[f64]; COLUMNS] = std::array::from_fn(|c| column(values, height, first + c.min(count - 1)));
        for field in fields.chunks_exact_mut(height) {
            let (head, tail) = field[first..].split_at_mut(count);
            let mut taken = [0.0; COLUMNS];
            for c in 0..count {
                let mut value = head[c];
                for b in 0..c {
                    value -= columns[b][first + c] * taken[b];
                }
                taken[c] = value / columns[c][first + c];
                head[c] = taken[c];
            }
            if count == COLUMNS {
                let [one, two, three, four] = columns.map(|column| &column[first + COLUMNS..]);
                let factors = one.iter().zip(two).zip(three).zip(four);
                for (value, (((one, two), three), four)) in tail.iter_mut().zip(factors) {
                    *value -= (one * taken[0] + two * taken[1]) + (three * taken[2] + four * taken[3]);
                }
            } else {
                for c in 0..count {
                    for (value, factor) in tail.iter_mut().zip(&columns[c][first + count..]) {
                        *value -= factor * taken[c];
                    }
                }
            }
        }
        first += count;
    }
}

/// Solves with the triangle's transpose for the head of each field, given its tail.
#[inline(always)]
pub(crate) fn backward(values: &[f64], width: usize, height: usize, fields: &mut [f64]) {
    let mut end = width;
    while end > 0 {
        let count = match end % COLUMNS {
            0 => COLUMNS,
            rest => rest,
        };
        let first = end - count;
        let columns: [&[f64]; COLUMNS] = std::array::from_fn(|c| column(values, height, first + c.min(count - 1)));
        for field in fields.chunks_exact_mut(height) {
            let (head, tail) = field[first..].split_at_mut(count);
            let sums = if count == COLUMNS {
                products(columns.map(|column| &column[end..]), tail)
            } else {
                columns.map(|column| products([&column[end..]], tail)[0])
            };
            for c in (0..count).rev() {
                let mut value = head[c] - sums[c];
                for b in c + 1..count {
                    value -= columns[c][first + b] * head[b];
                }
                head[c] = value / columns[c][first + c];
            }
        }
        end = first;
    }
}

#[inline(always)]
fn column(values: &[f64], height: usize, j: usize) -> &[f64] {
    &values[j * height..(j + 1) * height]
}

/// The products of some columns with one.
#[inline(always)]
fn products<const C: usize>(columns: [&[f64]; C], other: &[f64]) -> [f64; C] {
    let mut sums = [[0.0; LANES]; C];
    let (lines, rest) = other.as_chunks::<LANES>();
    let chunks = columns.map(|column| column.as_chunks::<LANES>());
    for (i, line) in lines.iter().enumerate() {
        for c in 0..C {
            let own = &chunks[c].0[i];
            for lane in 0..LANES {
                sums[c][lane] += own[lane] * line[lane];
            }
        }
    }
    std::array::from_fn(|c| {
        let tail: f64 = rest.iter().zip(chunks[c].1).map(|(a, b)| a * b).sum();
        let s = &sums[c];
        ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7])) + tail
    })
}
