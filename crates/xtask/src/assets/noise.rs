//! Deterministic noise: an integer hash of lattice points, gradient noise, and a cellular pattern for scales.

use super::vector::{Vec3, v};

/// A 64-bit hash of a lattice point and a seed (the finaliser of SplitMix64 [SLF14]).
pub fn hash(x: i64, y: i64, z: i64, seed: u64) -> u64 {
    let mut h = seed
        .wrapping_add((x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15))
        .wrapping_add((y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f))
        .wrapping_add((z as u64).wrapping_mul(0x1656_67b1_9e37_79f9));
    h = (h ^ (h >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    h = (h ^ (h >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    h ^ (h >> 31)
}

/// A number in [-1, 1) from 21 of the hash's bits, the `which`-th group of three.
fn signed(h: u64, which: u32) -> f64 {
    ((h >> (21 * which)) & 0x1f_ffff) as f64 / 1_048_576.0 - 1.0
}

/// A number in [-1, 1) for a vertex: simulated scanner noise.
pub fn white(index: u64, seed: u64) -> f64 {
    signed(hash(index as i64, 0, 0, seed), 0)
}

/// Gradient noise [Per02]: smooth, about [-1, 1], features of size 1, zero at lattice points.
pub fn gradient(p: Vec3, seed: u64) -> f64 {
    let (bx, by, bz) = (p.x.floor(), p.y.floor(), p.z.floor());
    let f = v(p.x - bx, p.y - by, p.z - bz);
    let (ix, iy, iz) = (bx as i64, by as i64, bz as i64);
    let fade = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let (u, w, s) = (fade(f.x), fade(f.y), fade(f.z));
    let corner = |dx: i64, dy: i64, dz: i64| {
        let h = hash(ix + dx, iy + dy, iz + dz, seed);
        let slope = v(signed(h, 0), signed(h, 1), signed(h, 2));
        slope.dot(f - v(dx as f64, dy as f64, dz as f64))
    };
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let x00 = mix(corner(0, 0, 0), corner(1, 0, 0), u);
    let x10 = mix(corner(0, 1, 0), corner(1, 1, 0), u);
    let x01 = mix(corner(0, 0, 1), corner(1, 0, 1), u);
    let x11 = mix(corner(0, 1, 1), corner(1, 1, 1), u);
    mix(mix(x00, x10, w), mix(x01, x11, w), s) * 1.4
}

/// `octaves` of gradient noise, each with half the size and half the amplitude of the last.
pub fn fractal(p: Vec3, octaves: u32, seed: u64) -> f64 {
    let (mut sum, mut height, mut q) = (0.0, 1.0, p);
    for octave in 0..octaves {
        sum += height * gradient(q, seed + u64::from(octave));
        height *= 0.5;
        q = q * 2.03 + v(17.3, 5.7, 9.1);
    }
    sum
}

/// Scales: about 1 on a cell and 0 in the groove between two cells ([Wor96]: second distance minus first).
pub fn scales(p: Vec3, seed: u64) -> f64 {
    let (ix, iy, iz) = (p.x.floor() as i64, p.y.floor() as i64, p.z.floor() as i64);
    let (mut first, mut second) = (f64::INFINITY, f64::INFINITY);
    for dz in -1..=1 {
        for dy in -1..=1 {
            for dx in -1..=1 {
                let (cx, cy, cz) = (ix + dx, iy + dy, iz + dz);
                let h = hash(cx, cy, cz, seed);
                let point = v(cx as f64, cy as f64, cz as f64)
                    + v(0.5, 0.5, 0.5)
                    + v(signed(h, 0), signed(h, 1), signed(h, 2)) * 0.36;
                let d = p - point;
                let square = d.dot(d);
                if square < first {
                    second = first;
                    first = square;
                } else if square < second {
                    second = square;
                }
            }
        }
    }
    let groove = (second.sqrt() - first.sqrt()).min(0.45) / 0.45;
    groove * (2.0 - groove)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_bounded_and_zero_at_lattice_points() {
        for i in 0..2000_i64 {
            let p = v(i as f64 * 0.137, i as f64 * 0.071, i as f64 * -0.193);
            assert!(gradient(p, 3).abs() <= 2.1, "{p:?}");
            let s = scales(p, 3);
            assert!((0.0..=1.0).contains(&s), "{p:?}");
            assert_eq!(gradient(v(i as f64, -(i as f64), 2.0), 3), 0.0);
        }
    }

    #[test]
    fn white_noise_fills_its_range_evenly() {
        let mean = (0..10_000).map(|i| white(i, 1)).sum::<f64>() / 10_000.0;
        assert!(mean.abs() < 0.03, "{mean}");
        assert!((0..10_000).all(|i| (-1.0..1.0).contains(&white(i, 1))));
    }
}
