//! Solving with a supernodal factor, several right-hand sides at once.
//!
//! The limit is memory: each solve reads the factor twice. So the right-hand sides stand side by side (`[f64; K]` a
//! row), each entry of the factor is used for all of them while it is in a register, and its columns are read in the
//! order in which they lie. Sequential: faer's own parallel solve was 3 to 40 times slower than its sequential one on
//! such factors; independent right-hand sides run beside each other instead.

use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;

/// Solves L Lᵀ x = b in place.
///
/// `values` are the factor's, `x` has one row a column of the factor.
pub(crate) fn solve_in_place<const K: usize>(
    symbolic: &SymbolicSupernodalCholesky<u32>,
    values: &[f64],
    x: &mut [[f64; K]],
) {
    let widest = symbolic.nnz_per_super().iter().copied().max().unwrap_or(0) as usize;
    let mut below = vec![[0.0; K]; widest];
    for s in 0..symbolic.n_supernodes() {
        forward(&Supernode::of(symbolic, values, s), x, &mut below);
    }
    for s in (0..symbolic.n_supernodes()).rev() {
        backward(&Supernode::of(symbolic, values, s), x, &mut below);
    }
}

/// Columns with one pattern: a dense triangle on `rows`' own columns and a dense block below it.
struct Supernode<'a> {
    start: usize,
    width: usize,
    /// The rows below the triangle.
    pattern: &'a [u32],
    /// Column-major, `width + pattern.len()` high.
    values: &'a [f64],
}

impl<'a> Supernode<'a> {
    fn of(symbolic: &'a SymbolicSupernodalCholesky<u32>, values: &'a [f64], s: usize) -> Self {
        let start = symbolic.supernode_begin()[s] as usize;
        let end = symbolic.supernode_end()[s] as usize;
        let first = symbolic.col_ptr_for_row_idx()[s] as usize;
        let count = symbolic.nnz_per_super()[s] as usize;
        Self {
            start,
            width: end - start,
            pattern: &symbolic.row_idx()[first..first + count],
            values: &values[symbolic.col_ptr_for_val()[s] as usize..symbolic.col_ptr_for_val()[s + 1] as usize],
        }
    }

    fn column(&self, j: usize) -> &'a [f64] {
        let height = self.width + self.pattern.len();
        &self.values[j * height..(j + 1) * height]
    }
}

/// x ← L⁻¹ x for the supernode's columns, their effect subtracted from the rows below.
fn forward<const K: usize>(node: &Supernode, x: &mut [[f64; K]], below: &mut [[f64; K]]) {
    let below = &mut below[..node.pattern.len()];
    below.fill([0.0; K]);
    let own = &mut x[node.start..node.start + node.width];
    for j in 0..node.width {
        let column = &node.column(j)[j..];
        let value = own[j].map(|value| value / column[0]);
        own[j] = value;
        let (inside, outside) = column[1..].split_at(node.width - j - 1);
        for (row, &entry) in own[j + 1..].iter_mut().zip(inside) {
            for k in 0..K {
                row[k] -= entry * value[k];
            }
        }
        for (row, &entry) in below.iter_mut().zip(outside) {
            for k in 0..K {
                row[k] += entry * value[k];
            }
        }
    }
    for (&row, sum) in node.pattern.iter().zip(below.iter()) {
        let target = &mut x[row as usize];
        for k in 0..K {
            target[k] -= sum[k];
        }
    }
}

/// x ← L⁻ᵀ x for the supernode's columns, given the rows below.
fn backward<const K: usize>(node: &Supernode, x: &mut [[f64; K]], below: &mut [[f64; K]]) {
    let below = &mut below[..node.pattern.len()];
    for (&row, value) in node.pattern.iter().zip(below.iter_mut()) {
        *value = x[row as usize];
    }
    let own = &mut x[node.start..node.start + node.width];
    for j in (0..node.width).rev() {
        let column = &node.column(j)[j..];
        let (inside, outside) = column[1..].split_at(node.width - j - 1);
        let mut value = own[j];
        let mut sums = [[0.0; K]; 2];
        let pairs = outside.chunks_exact(2).zip(below.chunks_exact(2));
        for (entries, rows) in pairs {
            for k in 0..K {
                sums[0][k] += entries[0] * rows[0][k];
                sums[1][k] += entries[1] * rows[1][k];
            }
        }
        if outside.len() % 2 == 1
            && let (Some(entry), Some(row)) = (outside.last(), below.last())
        {
            for k in 0..K {
                sums[0][k] += entry * row[k];
            }
        }
        for (row, &entry) in own[j + 1..].iter().zip(inside) {
            for k in 0..K {
                sums[1][k] += entry * row[k];
            }
        }
        for k in 0..K {
            value[k] = (value[k] - (sums[0][k] + sums[1][k])) / column[0];
        }
        own[j] = value;
    }
}
