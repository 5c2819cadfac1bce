//! Carries velocity and dye along the velocity [SY04].
//!
//! Each vertex looks back along the velocity to the place from which its fluid comes (semi-Lagrangian), by the midpoint
//! rule: with the velocity half a step back. Vectors found there are carried along the way to the vertex by parallel
//! transport. With the second order, the same is done forward with the result, and half of the difference from the
//! start corrects it (MacCormack) [SFK+08].
//!
//! Only changes of the vertices' velocities are added to the triangles'. A part of the triangles' velocity, the finer
//! the larger, is lost in the vertices' means; it would be lost in each step if the means themselves went back to the
//! triangles, and a turning sphere would stop in a few seconds. So this part stays where it is. A frequency of which the
//! means keep the share s, and which a step multiplies by z, is multiplied by 1 − s + s z, so it does not grow.

use glam::DVec2;
use pliant_mesh::{Cancel, Cancelled};
use rayon::prelude::*;

use crate::domain::Place;
use crate::fluid::Fluid;
use crate::plane::turned_back;
use crate::settings::Advection;
use crate::sums::CHUNK;
use crate::trace::BLOCK;

/// Dye at a vertex: red, green and blue, multiplied by the coverage, and the coverage, each from 0 to 1.
pub(crate) type Dye = [f64; 4];

/// The larger value of each channel; of two that are numbers, in one instruction, unlike [`f64::max`].
#[inline]
pub(crate) fn larger(a: Dye, b: Dye) -> Dye {
    std::array::from_fn(|k| if a[k] > b[k] { a[k] } else { b[k] })
}

/// The smaller value of each channel.
#[inline]
pub(crate) fn smaller(a: Dye, b: Dye) -> Dye {
    std::array::from_fn(|k| if a[k] < b[k] { a[k] } else { b[k] })
}

/// Fields that are kept from step to step: at the vertices, but for the first one.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// Each triangle's own velocity and its carried one, times its area.
    fields: Vec<[DVec2; 2]>,
    /// The velocity, in the tangent planes.
    pub own: Vec<DVec2>,
    /// The velocity that is carried.
    carried: Vec<DVec2>,
    /// It after a first-order step.
    first: Vec<DVec2>,
    /// The way forward, then the change of the velocity.
    pub change: Vec<DVec2>,
    /// The triangle from which the fluid comes.
    source: Vec<u32>,
    first_dye: Vec<Dye>,
    pub dye: Vec<Dye>,
}

impl Scratch {
    fn resize(&mut self, fluid: &Fluid<'_>, has_dye: bool) {
        let count = fluid.vertex_count();
        self.fields.resize(fluid.triangle_count(), [DVec2::ZERO; 2]);
        self.own.resize(count, DVec2::ZERO);
        self.carried.resize(count, DVec2::ZERO);
        self.first.resize(count, DVec2::ZERO);
        self.change.resize(count, DVec2::ZERO);
        self.source.resize(count, 0);
        let dyed = if has_dye { count } else { 0 };
        self.first_dye.resize(dyed, Dye::default());
        self.dye.resize(dyed, Dye::default());
    }
}

/// Carries `velocity`, and `dye` unless it is empty, for `seconds`. `scratch.dye` is free afterwards.
///
/// Fluid on its way is also pushed by the pressure. Half of that comes before the way and half after it, or a turning
/// sphere would slow by a share of the step. `pressure` is that of the last step, whose gradient the velocity has lost,
/// and the number of such steps in this one. The half after the way is a gradient and needs not be subtracted.
pub(crate) fn advect(
    fluid: &Fluid<'_>,
    (pressure, steps): (&[f64], f64),
    velocity: &mut [DVec2],
    dye: &mut Vec<Dye>,
    (seconds, advection): (f64, Advection),
    scratch: &mut Scratch,
    cancel: &Cancel,
) -> Result<(), Cancelled> {
    scratch.resize(fluid, !dye.is_empty());
    let own_and_half_pushed = |(triangle, fields): (usize, &mut [DVec2; 2])| {
        let chart = &fluid.domain.charts[triangle];
        let own = velocity[triangle] * chart.area();
        let values = fluid.corners(triangle).map(|corner| pressure[corner]);
        *fields = [own, own - 0.5 * steps * chart.gradient_area(values)];
    };
    let fields = scratch.fields.par_iter_mut().with_min_len(CHUNK).enumerate();
    fields.for_each(own_and_half_pushed);
    fluid.to_vertices(&scratch.fields, [&mut scratch.own, &mut scratch.carried]);
    backward(fluid, dye, seconds, scratch, cancel)?;
    match advection {
        Advection::FirstOrder => {
            let pairs = scratch.change.par_iter_mut().zip(&scratch.first).zip(&scratch.carried);
            pairs
                .with_min_len(CHUNK)
                .for_each(|((change, first), carried)| *change = first - carried);
            std::mem::swap(dye, &mut scratch.first_dye);
        }
        Advection::SecondOrder => {
            correct(fluid, dye, scratch, cancel)?;
            std::mem::swap(dye, &mut scratch.dye);
        }
    }
    fluid.add_to_triangles(&scratch.change, velocity);
    Ok(())
}

/// The first-order step, and for each vertex the way forward and the triangle behind.
fn backward(
    fluid: &Fluid<'_>,
    dye: &[Dye],
    seconds: f64,
    scratch: &mut Scratch,
    cancel: &Cancel,
) -> Result<(), Cancelled> {
    let domain = &fluid.domain;
    let (own, carried) = (&scratch.own, &scratch.carried);
    let at = |place: &Place, field: &[DVec2]| domain.vector_at(place, fluid.corners(place.triangle as usize), field);
    let dyes = chunks_of(&mut scratch.first_dye, fluid.vertex_count());
    let velocities = scratch
        .first
        .par_chunks_mut(CHUNK)
        .zip(scratch.change.par_chunks_mut(CHUNK));
    let chunks = velocities.zip(scratch.source.par_chunks_mut(CHUNK)).zip(dyes);
    chunks
        .enumerate()
        .try_for_each(|(chunk, (((first, forward), source), first_dye))| {
            cancel.check()?;
            // One thing after another for several vertices, so that the processor waits for several places at a time.
            let (mut places, mut ways) = ([None; BLOCK], [DVec2::ZERO; BLOCK]);
            for start in (0..first.len()).step_by(BLOCK) {
                let vertices = start..(start + BLOCK).min(first.len());
                let vertex = |i: usize| chunk * CHUNK + i;
                let ways = &mut ways[..vertices.len()];
                for (i, way) in vertices.clone().zip(ways.iter_mut()) {
                    *way = own[vertex(i)] * (-0.5 * seconds);
                }
                domain.trace(vertex(start), ways, &mut places);
                for ((i, way), place) in vertices.clone().zip(ways.iter_mut()).zip(&places) {
                    let middle = place.map_or(DVec2::ZERO, |half| at(&half, own));
                    *way = middle * -seconds;
                    // The velocity half a step forward, by extrapolation.
                    forward[i] = (2.0 * own[vertex(i)] - middle) * seconds;
                }
                domain.trace(vertex(start), ways, &mut places);
                for (i, place) in vertices.clone().zip(&places) {
                    if let Some(back) = place {
                        first[i] = at(back, carried);
                        source[i] = back.triangle;
                    }
                }
                for (first_dye, place) in first_dye.iter_mut().skip(start).zip(&places) {
                    if let Some(back) = place {
                        *first_dye = dye_at(fluid, back, dye);
                    }
                }
            }
            Ok(())
        })
}

/// Takes half the error of going forth and back off the first-order step.
fn correct(fluid: &Fluid<'_>, dye: &[Dye], scratch: &mut Scratch, cancel: &Cancel) -> Result<(), Cancelled> {
    let Scratch {
        carried,
        first,
        change,
        source,
        first_dye,
        dye: new_dye,
        ..
    } = scratch;
    let (carried, first, source, first_dye) = (&*carried, &*first, &*source, &*first_dye);
    let dyes = chunks_of(new_dye, fluid.vertex_count());
    let chunks = change.par_chunks_mut(CHUNK).zip(dyes);
    chunks.enumerate().try_for_each(|(chunk, (change, new_dye))| {
        cancel.check()?;
        let mut places = [None; BLOCK];
        for start in (0..change.len()).step_by(BLOCK) {
            let vertices = start..(start + BLOCK).min(change.len());
            fluid
                .domain
                .trace(chunk * CHUNK + start, &change[vertices.clone()], &mut places);
            for (i, place) in vertices.clone().zip(&places) {
                let vertex = chunk * CHUNK + i;
                change[i] = place.map_or(DVec2::ZERO, |ahead| {
                    let corners = fluid.corners(ahead.triangle as usize);
                    let correction = 0.5 * (carried[vertex] - fluid.domain.vector_at(&ahead, corners, first));
                    let most = spread(fluid, source[vertex] as usize, carried);
                    first[vertex] + correction.clamp_length_max(most) - carried[vertex]
                });
            }
            for (i, (new_dye, place)) in new_dye.iter_mut().skip(start).zip(&places).enumerate() {
                let vertex = chunk * CHUNK + start + i;
                let Some(ahead) = place else { continue };
                let returned = dye_at(fluid, ahead, first_dye);
                let corrected: Dye =
                    std::array::from_fn(|k| first_dye[vertex][k] + 0.5 * (dye[vertex][k] - returned[k]));
                let [a, b, c] = fluid.corners(source[vertex] as usize).map(|corner| dye[corner]);
                let (least, most) = (smaller(smaller(a, b), c), larger(larger(a, b), c));
                *new_dye = smaller(larger(corrected, least), most);
            }
        }
        Ok(())
    })
}

/// The chunks of a field, or as many empty ones if it is empty.
fn chunks_of<T: Send>(field: &mut [T], count: usize) -> rayon::vec::IntoIter<&mut [T]> {
    let chunks = count.div_ceil(CHUNK);
    let mut cut: Vec<&mut [T]> = field.chunks_mut(CHUNK).collect();
    cut.resize_with(chunks, Default::default);
    cut.into_par_iter()
}

/// The largest difference between the velocities at a triangle's corners: independent of the tangent planes' axes,
/// unlike the bounds of components.
fn spread(fluid: &Fluid<'_>, triangle: usize, field: &[DVec2]) -> f64 {
    let rotations = fluid.domain.fans.rotations(triangle);
    let corners = fluid.corners(triangle);
    let [a, b, c] = [0, 1, 2].map(|k| turned_back(rotations[k], field[corners[k]]));
    let squares = [a.distance_squared(b), b.distance_squared(c), c.distance_squared(a)];
    squares.into_iter().fold(0.0, f64::max).sqrt()
}

/// The dye at a place.
fn dye_at(fluid: &Fluid<'_>, place: &Place, dye: &[Dye]) -> Dye {
    let [a, b, c] = fluid.corners(place.triangle as usize).map(|corner| dye[corner]);
    let [u, v, w] = place.weights;
    std::array::from_fn(|k| u * a[k] + v * b[k] + w * c[k])
}
