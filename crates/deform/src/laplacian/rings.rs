//! Each vertex' neighbours within some edges, and the transformation that carries them best from rest to a shape
//! [BS08, section 3.2.5].

use glam::{DMat3, DQuat, DVec3};
use rayon::prelude::*;

use super::LocalScale;
use crate::Laplacian;
use crate::numerical::rotation::fit;
use crate::operators::CHUNK;

/// The rings of the vertices with full rows, in local vertices.
#[derive(Debug)]
pub(super) struct Rings {
    offsets: Vec<u32>,
    others: Vec<u32>,
}

impl Rings {
    /// Within `size` edges.
    pub fn of(laplacian: &Laplacian, size: u32) -> Self {
        let count = laplacian.vertices().len();
        let chunks: Vec<(Vec<u32>, Vec<u32>)> = (0..count.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let (mut counts, mut others) = (Vec::new(), Vec::new());
                for local in chunk * CHUNK..((chunk + 1) * CHUNK).min(count) {
                    let before = others.len();
                    if laplacian.is_full(local) {
                        append_ring(laplacian, local as u32, size, &mut others);
                    }
                    counts.push((others.len() - before) as u32);
                }
                (counts, others)
            })
            .collect();
        let mut rings = Self {
            offsets: vec![0],
            others: Vec::new(),
        };
        let mut end = 0;
        for (counts, others) in chunks {
            for count in counts {
                end += count;
                rings.offsets.push(end);
            }
            rings.others.extend(others);
        }
        rings
    }

    fn around(&self, local: usize) -> &[u32] {
        &self.others[self.offsets[local] as usize..self.offsets[local + 1] as usize]
    }

    /// What the best transformation of a vertex' neighbourhood changes, T − I, from the rest positions to these plus the
    /// displacements `d`. Its rotation is searched for from `guess` on.
    pub fn change(&self, local: usize, rest: &[DVec3], d: &[[f64; 3]], scale: LocalScale, guess: DQuat) -> DMat3 {
        let at = |place: u32| (rest[place as usize], DVec3::from_array(d[place as usize]));
        let (own, own_shift) = at(local as u32);
        let (mut covariance, mut square) = (DMat3::ZERO, 0.0);
        let mut is_at_rest = true;
        for &other in self.around(local) {
            let (other, shift) = at(other);
            let (edge, change) = (other - own, shift - own_shift);
            is_at_rest &= change == DVec3::ZERO;
            let turned = edge + change;
            covariance += DMat3::from_cols(turned * edge.x, turned * edge.y, turned * edge.z);
            square += edge.length_squared();
        }
        if is_at_rest {
            return DMat3::ZERO;
        }
        let rotation = DMat3::from_quat(fit(&covariance, guess));
        let size = match scale {
            LocalScale::Free if square > 0.0 => {
                let aligned = rotation.transpose() * covariance;
                (aligned.x_axis.x + aligned.y_axis.y + aligned.z_axis.z) / square
            }
            _ => 1.0,
        };
        rotation * size - DMat3::IDENTITY
    }
}

/// A ring beyond the nearest neighbours ends at so many vertices: beside hubs it would be a large part of the surface.
const LARGEST: usize = 256;

fn append_ring(laplacian: &Laplacian, local: u32, size: u32, others: &mut Vec<u32>) {
    let first = others.len();
    others.extend(laplacian.neighbours(local as usize));
    let mut begin = first;
    for _ in 1..size {
        let end = others.len();
        for place in begin..end {
            let beside = others[place] as usize;
            for &next in laplacian.neighbours(beside) {
                if others.len() - first >= LARGEST {
                    return;
                }
                if next != local && !others[first..].contains(&next) {
                    others.push(next);
                }
            }
        }
        begin = end;
    }
}
