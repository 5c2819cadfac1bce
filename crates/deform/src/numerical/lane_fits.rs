//! Eight cells' rotations fitted side by side, by Newton's method in lanes.

use glam::{DMat3, DQuat, DVec3};
use pulp::Simd;

use super::lanes::{LANES, Lanes, Mask, Matrices, Vector};
use super::rotation::{OPEN, SMALL_RAD, STATIONARY, STEPS, fit_anew};

/// Eight cells on their way from matrices to rotations.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Fits {
    /// The matrix to add to the symmetric matrix `rest` to make S, column by column.
    pub change: [[Lanes; 3]; 3],
    /// xx, xy, xz, yy, yz, zz.
    pub rest: [Lanes; 6],
    /// The unit quaternions x, y, z, w: first the guess, then the result.
    pub rotation: [Lanes; 4],
    /// R − 1, column by column: near the identity they keep their digits.
    pub turn: [[Lanes; 3]; 3],
    /// ½ ⟨R − 1, S⟩.
    pub inner: Lanes,
}

impl Fits {
    /// Corrects rounded unit quaternions, so that their length is 1 to second order.
    #[inline(always)]
    pub fn normalise<S: Simd>(&mut self, simd: S) {
        for place in 0..LANES / S::F64_LANES {
            let q = Vector::each(simd, &self.rotation, place);
            let square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
            let length = Vector::splat(simd, 1.5) - Vector::splat(simd, 0.5) * square;
            Vector::put_each(
                [q[0] * length, q[1] * length, q[2] * length, q[3] * length],
                &mut self.rotation,
                place,
            );
        }
    }

    /// The rotations that maximise tr(Rᵀ S) of the first `count` cells, from their present ones.
    #[inline(always)]
    pub fn fit<S: Simd>(&mut self, simd: S, count: usize) {
        for place in 0..LANES / S::F64_LANES {
            let s = self.matrices(simd, place);
            let start = Vector::each(simd, &self.rotation, place);
            let (rotation, found) = newton(simd, &s, start);
            Vector::put_each(rotation, &mut self.rotation, place);
            if !found.is_full() {
                let mut flags = Lanes::default();
                Vector::splat(simd, 1.0)
                    .or(found, Vector::splat(simd, 0.0))
                    .put(&mut flags, place);
                let lanes = place * S::F64_LANES..((place + 1) * S::F64_LANES).min(count);
                for lane in lanes.filter(|&lane| flags.0[lane] == 0.0) {
                    self.refit(lane);
                }
            }
        }
    }

    /// Finds turns and products of the rotations.
    #[inline(always)]
    pub fn finish<S: Simd>(&mut self, simd: S) {
        for place in 0..LANES / S::F64_LANES {
            let s = self.matrices(simd, place);
            let b = self.changes(simd, place);
            let rotation = Vector::each(simd, &self.rotation, place);
            let [x, y, z, w] = rotation;
            // ⟨R − 1, S⟩ by the quaternion: 2 w (a · v) + 2 (v · S v − |v|² tr S), with a from B, whose digits S has
            // lost.
            let v = [x, y, z];
            let axial = [b[1][2] - b[2][1], b[2][0] - b[0][2], b[0][1] - b[1][0]];
            let mut inner = w * (axial[0] * x + axial[1] * y + axial[2] * z);
            let trace = s[0][0] + s[1][1] + s[2][2];
            for k in 0..3 {
                let sv = s[0][k] * x + s[1][k] * y + s[2][k] * z;
                inner = inner + v[k] * (sv - v[k] * trace);
            }
            inner.put(&mut self.inner, place);
            for (column, turn) in turns(rotation).into_iter().zip(&mut self.turn) {
                Vector::put_each(column, turn, place);
            }
        }
    }

    #[inline(always)]
    fn changes<S: Simd>(&self, simd: S, place: usize) -> Matrices<S> {
        let [a, b, c] = &self.change;
        [
            Vector::each(simd, a, place),
            Vector::each(simd, b, place),
            Vector::each(simd, c, place),
        ]
    }

    /// S of the cells at `place`, column by column.
    #[inline(always)]
    pub fn matrices<S: Simd>(&self, simd: S, place: usize) -> Matrices<S> {
        let mut s = self.changes(simd, place);
        let [xx, xy, xz, yy, yz, zz] = Vector::each(simd, &self.rest, place);
        let rest = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        for column in 0..3 {
            for row in 0..3 {
                s[column][row] = s[column][row] + rest[column][row];
            }
        }
        s
    }

    /// Fits one lane again, without a guess.
    #[cold]
    fn refit(&mut self, lane: usize) {
        let [xx, xy, xz, yy, yz, zz] = self.rest.map(|value| value.0[lane]);
        let rest = DMat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz]);
        let column = |[x, y, z]: [Lanes; 3]| DVec3::new(x.0[lane], y.0[lane], z.0[lane]);
        let [a, b, c] = self.change.map(column);
        let start = DQuat::from_array(self.rotation.map(|value| value.0[lane]));
        let found = fit_anew(&(DMat3::from_cols(a, b, c) + rest), start);
        for (own, value) in self.rotation.iter_mut().zip(found.to_array()) {
            own.0[lane] = value;
        }
    }
}

/// The rotation matrices less the identity.
#[inline(always)]
fn turns<S: Simd>([x, y, z, w]: [Vector<S>; 4]) -> Matrices<S> {
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (xx, yy, zz) = (x * x2, y * y2, z * z2);
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (wx, wy, wz) = (w * x2, w * y2, w * z2);
    [
        [-(yy + zz), xy + wz, xz - wy],
        [xy - wz, -(xx + zz), yz + wx],
        [xz + wy, yz - wx, -(xx + yy)],
    ]
}

/// Newton's method of [`crate::numerical::rotation`] in every lane at once: the rotations that maximise tr(Rᵀ S), from
/// the guesses `start`, and the lanes that found theirs.
#[inline(always)]
fn newton<S: Simd>(simd: S, s: &Matrices<S>, start: [Vector<S>; 4]) -> ([Vector<S>; 4], Mask<S>) {
    let (zero, one, half) = (
        Vector::splat(simd, 0.0),
        Vector::splat(simd, 1.0),
        Vector::splat(simd, 0.5),
    );
    let mut rotation = start;
    let mut done = Mask::none(simd);
    let mut found = !done;
    for _ in 0..STEPS {
        let mut r = turns(rotation);
        for k in 0..3 {
            r[k][k] = r[k][k] + one;
        }
        // b[c][k]: entry k, c of Rᵀ S.
        let mut b = *s;
        for c in 0..3 {
            for k in 0..3 {
                b[c][k] = r[k][0] * s[c][0] + r[k][1] * s[c][1] + r[k][2] * s[c][2];
            }
        }
        let skew = [b[1][2] - b[2][1], b[2][0] - b[0][2], b[0][1] - b[1][0]];
        let trace = b[0][0] + b[1][1] + b[2][2];
        let open = Vector::splat(simd, OPEN) * trace;
        let (hxx, hyy, hzz) = (
            b[1][1] + b[2][2] + open,
            b[0][0] + b[2][2] + open,
            b[0][0] + b[1][1] + open,
        );
        let minus_half = -half;
        let (hxy, hxz, hyz) = (
            minus_half * (b[1][0] + b[0][1]),
            minus_half * (b[2][0] + b[0][2]),
            minus_half * (b[2][1] + b[1][2]),
        );
        let i1 = one / hxx;
        let (lxy, lxz) = (hxy * i1, hxz * i1);
        let d2 = hyy - lxy * hxy;
        let m = hyz - lxy * hxz;
        let i2 = one / d2;
        let lyz = m * i2;
        let d3 = hzz - lxz * hxz - lyz * m;
        let u = skew[0];
        let v = skew[1] - lxy * u;
        let turn_z = (skew[2] - lxz * u - lyz * v) / d3;
        let turn_y = v * i2 - lyz * turn_z;
        let turn_x = u * i1 - lxy * turn_y - lxz * turn_z;
        let square = turn_x * turn_x + turn_y * turn_y + turn_z * turn_z;
        let residual = skew[0].abs().max(skew[1].abs()).max(skew[2].abs());
        // H must be positive definite and the turn sound; this is also false for NaN.
        let definite = zero.less(trace) & zero.less(hxx) & zero.less(d2) & zero.less(d3);
        let sound = square.less(Vector::splat(simd, 4.0));
        let ends = definite & residual.less(Vector::splat(simd, STATIONARY) * trace);
        let [qx, qy, qz, qw] = rotation;
        let (x, y, z) = (half * turn_x, half * turn_y, half * turn_z);
        let turned = [
            qx + qw * x + qy * z - qz * y,
            qy + qw * y + qz * x - qx * z,
            qz + qw * z + qx * y - qy * x,
            qw - qx * x - qy * y - qz * z,
        ];
        let norm = turned[0] * turned[0] + turned[1] * turned[1] + turned[2] * turned[2] + turned[3] * turned[3];
        let inverse = one / norm.sqrt();
        let fails = !(done | ends | (definite & sound));
        let keeps = done | ends | fails;
        found = found & !fails;
        done = keeps | square.less(Vector::splat(simd, SMALL_RAD * SMALL_RAD));
        for k in 0..4 {
            rotation[k] = rotation[k].or(keeps, turned[k] * inverse);
        }
        if done.is_full() {
            break;
        }
    }
    (rotation, found & done)
}
