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
use pliant_mesh::{Cancel, Cancelled, vectors};
use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use crate::corners::Corners;
use crate::dye::{Dye, dye_at, larger, smaller};
use crate::fluid::Fluid;
use crate::lanes::{LANES, Vectors, change, put, vector};
use crate::plane::turned_back;
use crate::settings::Advection;
use crate::sums::CHUNK;
use crate::trace::Ends;

/// Fields that are kept from step to step: at the vertices, but for the first one.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// Room for what lives for a part of a step: each triangle's own velocity and its carried one, times its area; then
    /// the dye after a first-order step and the new dye; then the terms of the divergence.
    pub room: Vec<f64>,
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
}

impl Scratch {
    fn resize(&mut self, fluid: &Fluid<'_>) {
        let count = fluid.vertex_count();
        self.room.resize(4 * fluid.triangle_count().max(2 * count), 0.0);
        self.own.resize(count, DVec2::ZERO);
        self.carried.resize(count, DVec2::ZERO);
        self.first.resize(count, DVec2::ZERO);
        self.change.resize(count, DVec2::ZERO);
        self.source.resize(count, 0);
    }
}

/// Carries `velocity`, and `dye` unless it is empty, for `seconds`. `scratch.room` is free afterwards.
///
/// Fluid on its way is also pushed by the pressure. Half of that comes before the way and half after it, or a turning
/// sphere would slow by a share of the step. `pressure` is that of the last step, whose gradient the velocity has lost,
/// and the number of such steps in this one. The half after the way is a gradient and needs not be subtracted.
pub(crate) fn advect(
    fluid: &Fluid<'_>,
    (pressure, steps): (&[f64], f64),
    velocity: &mut [DVec2],
    dye: &mut [Dye],
    (seconds, advection): (f64, Advection),
    scratch: &mut Scratch,
    cancel: &Cancel,
) -> Result<(), Cancelled> {
    scratch.resize(fluid);
    let own_and_half_pushed = |(triangle, fields): (usize, &mut [f64; 4])| {
        let chart = &fluid.domain.charts[triangle];
        let own = velocity[triangle] * chart.area();
        let values = fluid.corners(triangle).map(|corner| pressure[corner]);
        let carried = own - 0.5 * steps * chart.gradient_area(values);
        *fields = [own.x, own.y, carried.x, carried.y];
    };
    let (fields, _) = scratch.room[..4 * fluid.triangle_count()].as_chunks_mut();
    let each = fields.par_iter_mut().with_min_len(CHUNK).enumerate();
    each.for_each(own_and_half_pushed);
    fluid.to_vertices(fields, [&mut scratch.own, &mut scratch.carried]);
    let mut room = std::mem::take(&mut scratch.room);
    let (first_dye, new_dye) = room.split_at_mut(4 * dye.len());
    let [first_dye, new_dye] = [first_dye, &mut new_dye[..4 * dye.len()]].map(|room| room.as_chunks_mut().0);
    let carried = backward(fluid, dye, seconds, scratch, first_dye, cancel);
    let carried = carried.and_then(|()| match advection {
        Advection::FirstOrder => {
            let pairs = scratch.change.par_iter_mut().zip(&scratch.first).zip(&scratch.carried);
            pairs
                .with_min_len(CHUNK)
                .for_each(|((change, first), carried)| *change = first - carried);
            dye.copy_from_slice(first_dye);
            Ok(())
        }
        Advection::SecondOrder => {
            correct(fluid, dye, scratch, (first_dye, new_dye), cancel)?;
            dye.copy_from_slice(new_dye);
            Ok(())
        }
    });
    scratch.room = room;
    carried?;
    fluid.add_to_triangles(&scratch.change, velocity);
    Ok(())
}

/// The first-order step, and for each vertex the way forward and the triangle behind.
fn backward(
    fluid: &Fluid<'_>,
    dye: &[Dye],
    seconds: f64,
    scratch: &mut Scratch,
    first_dye: &mut [Dye],
    cancel: &Cancel,
) -> Result<(), Cancelled> {
    let fields = Fields {
        fluid,
        own: &scratch.own,
        carried: &scratch.carried,
        dye,
    };
    let dyes = chunks_of(first_dye, fluid.vertex_count());
    let velocities = scratch
        .first
        .par_chunks_mut(CHUNK)
        .zip(scratch.change.par_chunks_mut(CHUNK));
    let chunks = velocities.zip(scratch.source.par_chunks_mut(CHUNK)).zip(dyes);
    let arch = vectors();
    chunks
        .enumerate()
        .try_for_each(|(chunk, (((first, forward), source), first_dye))| {
            cancel.check()?;
            fluid.read_ahead(chunk * CHUNK..chunk * CHUNK + first.len());
            arch.dispatch(Backward {
                fields,
                start: chunk * CHUNK,
                seconds,
                first,
                forward,
                source,
                first_dye,
            });
            Ok(())
        })
}

/// The fields that a step carries.
#[derive(Clone, Copy)]
struct Fields<'a> {
    fluid: &'a Fluid<'a>,
    own: &'a [DVec2],
    carried: &'a [DVec2],
    dye: &'a [Dye],
}

/// Looks back from the vertices from `start` on.
///
/// A closure would be compiled without the vector instructions that its caller is compiled for.
struct Backward<'a> {
    fields: Fields<'a>,
    start: usize,
    seconds: f64,
    first: &'a mut [DVec2],
    forward: &'a mut [DVec2],
    source: &'a mut [u32],
    first_dye: &'a mut [Dye],
}

impl WithSimd for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Fields {
            fluid,
            own,
            carried,
            dye,
        } = self.fields;
        let (domain, seconds) = (&fluid.domain, self.seconds);
        let (mut ends, mut corners) = (Ends::new(), Corners::new());
        for from in (0..self.first.len()).step_by(LANES) {
            let count = LANES.min(self.first.len() - from);
            let vertex = self.start + from;
            let mut velocities = [[0.0; LANES]; 2];
            for (i, own) in own[vertex..][..count].iter().enumerate() {
                put(&mut velocities, i, *own);
            }
            let mut ways = velocities;
            change(&mut ways, |_, velocity| velocity * (-0.5 * seconds));
            domain.trace(vertex, count, &ways, &mut ends);
            let middles = vectors_at(fluid, &ends, count, own, &mut corners);
            // The velocity half a step forward, by extrapolation.
            change(&mut velocities, |i, velocity| {
                (2.0 * velocity - vector(&middles, i)) * seconds
            });
            let mut ways = middles;
            change(&mut ways, |_, middle| middle * -seconds);
            domain.trace(vertex, count, &ways, &mut ends);
            let first = vectors_at(fluid, &ends, count, carried, &mut corners);
            for i in 0..count {
                self.forward[from + i] = vector(&velocities, i);
                self.first[from + i] = vector(&first, i);
            }
            self.source[from..][..count].copy_from_slice(&ends.triangles[..count]);
            for (i, first_dye) in self.first_dye.iter_mut().skip(from).take(count).enumerate() {
                *first_dye = match ends.is_bare(i) {
                    true => dye[vertex + i],
                    false => dye_at(fluid, &ends, i, dye),
                };
            }
        }
    }
}

/// Takes half the error of going forth and back off the first-order step.
fn correct(
    fluid: &Fluid<'_>,
    dye: &[Dye],
    scratch: &mut Scratch,
    (first_dye, new_dye): (&[Dye], &mut [Dye]),
    cancel: &Cancel,
) -> Result<(), Cancelled> {
    let fields = Fields {
        fluid,
        own: &scratch.own,
        carried: &scratch.carried,
        dye,
    };
    let (first, source) = (&*scratch.first, &*scratch.source);
    let dyes = chunks_of(new_dye, fluid.vertex_count());
    let chunks = scratch.change.par_chunks_mut(CHUNK).zip(dyes);
    let arch = vectors();
    chunks.enumerate().try_for_each(|(chunk, (change, new_dye))| {
        cancel.check()?;
        fluid.read_ahead(chunk * CHUNK..chunk * CHUNK + change.len());
        arch.dispatch(Correction {
            fields,
            start: chunk * CHUNK,
            first,
            source,
            first_dye,
            change,
            new_dye,
        });
        Ok(())
    })
}

/// Looks forward from the vertices from `start` on. `change` has the ways, and then the changes of the velocity.
struct Correction<'a> {
    fields: Fields<'a>,
    start: usize,
    first: &'a [DVec2],
    source: &'a [u32],
    first_dye: &'a [Dye],
    change: &'a mut [DVec2],
    new_dye: &'a mut [Dye],
}

impl WithSimd for Correction<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Fields {
            fluid, carried, dye, ..
        } = self.fields;
        let (mut ends, mut corners) = (Ends::new(), Corners::new());
        for from in (0..self.change.len()).step_by(LANES) {
            let count = LANES.min(self.change.len() - from);
            let start = self.start + from;
            let mut ways = [[0.0; LANES]; 2];
            for (i, way) in self.change[from..][..count].iter().enumerate() {
                put(&mut ways, i, *way);
            }
            fluid.domain.trace(start, count, &ways, &mut ends);
            let returned = vectors_at(fluid, &ends, count, self.first, &mut corners);
            for (i, change) in self.change[from..][..count].iter_mut().enumerate() {
                let vertex = start + i;
                let (carried_here, first) = (carried[vertex], self.first[vertex]);
                let correction = 0.5 * (carried_here - vector(&returned, i));
                let most = spread(fluid, self.source[vertex] as usize, carried);
                *change = first + correction.clamp_length_max(most) - carried_here;
            }
            for (i, new_dye) in self.new_dye.iter_mut().skip(from).take(count).enumerate() {
                let vertex = start + i;
                if ends.is_bare(i) {
                    *new_dye = dye[vertex];
                    continue;
                }
                let (returned, first) = (dye_at(fluid, &ends, i, self.first_dye), self.first_dye[vertex]);
                let corrected: Dye = std::array::from_fn(|k| first[k] + 0.5 * (dye[vertex][k] - returned[k]));
                let [a, b, c] = fluid.corners(self.source[vertex] as usize).map(|corner| dye[corner]);
                let (least, most) = (smaller(smaller(a, b), c), larger(larger(a, b), c));
                *new_dye = smaller(larger(corrected, least), most);
            }
        }
    }
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
#[inline(always)]
fn spread(fluid: &Fluid<'_>, triangle: usize, field: &[DVec2]) -> f64 {
    let rotations = fluid.domain.fans.rotations(triangle);
    let corners = fluid.corners(triangle);
    let [a, b, c] = [0, 1, 2].map(|k| turned_back(rotations[k], field[corners[k]]));
    let squares = [a.distance_squared(b), b.distance_squared(c), c.distance_squared(a)];
    squares.into_iter().fold(0.0, f64::max).sqrt()
}

/// The values of a vector field, given in the vertices' tangent planes, at the ends of ways, carried back to the tangent
/// planes of the vertices at their beginnings.
#[inline(always)]
fn vectors_at(fluid: &Fluid<'_>, ends: &Ends, count: usize, field: &[DVec2], corners: &mut Corners) -> Vectors {
    for (i, &triangle) in ends.triangles.iter().enumerate().take(count) {
        let vertices = fluid.corners(triangle as usize);
        corners.read(i, &fluid.domain.fans, (triangle as usize, vertices), field);
    }
    let mut vectors = corners.interpolate(&ends.weights);
    change(&mut vectors, |i, there| turned_back(vector(&ends.rotations, i), there));
    vectors
}
