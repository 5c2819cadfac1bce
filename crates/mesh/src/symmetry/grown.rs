//! Counterparts along the surface, for limbs that stand differently on both sides.
//!
//! The image of a bent arm does not lie on the other arm, or crosses it in slivers. So only images count that are
//! connected: the largest part of a component whose vertices and images are neighbours alike, such as the trunk. From
//! there the pairs grow over the rest: the place of a vertex' counterpart follows from its neighbours' by a reflection
//! and a rotation, which is fitted to the pairs around it, so lengths along the surface stay, and the nearest point of the
//! surface there is taken. Where the surface is too far away, or faces elsewhere, the other side lacks the part.
//!
//! Growing adds errors up, differently on both sides, so that the image of a part would have rags and holes. Rounds of
//! relaxation follow: each pair goes to the mean of the places at which its neighbours' pairs expect it and at which the
//! vertices expect it whose counterpart it is.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{DQuat, DVec3};
use rayon::prelude::*;

use super::plane::MirrorPlane;
use crate::geometry::{nearest_on_triangle, vertex_normals};
use crate::{Cancel, Cancelled, Surface, SurfaceVertex, Topology};

/// A set of images counts if it has this share of the vertices of its component.
const KEPT_SHARE: f64 = 0.2;

/// An edge's image is at most so many times as long as the edge, and so many more edges of its surroundings.
const STRETCH: f64 = 2.0;

/// The least cosine between a vertex' mirrored normal and its image's.
const ALIKE: f64 = 0.3;

/// How often the grown pairs are moved to where their surroundings expect them.
const ROUNDS: usize = 24;

/// A counterpart is at most so many times as far from its expected place as the longest edges there, and so much farther
/// for each unit of its way from the set that counts: what a bend stretches and shrinks adds up until the limb's tip.
const FAR: [f64; 2] = [1.5, 0.25];

/// The images with those that are not connected to a large part taken off, and grown along the surface from there. On a
/// component without a large part they stay.
///
/// # Errors
/// If it was cancelled.
pub(super) fn grown(
    surface: &Surface,
    topology: &Topology,
    plane: MirrorPlane,
    images: Vec<Option<SurfaceVertex>>,
    cancel: &Cancel,
) -> Result<Vec<Option<SurfaceVertex>>, Cancelled> {
    let mut normals = Vec::new();
    vertex_normals(&surface.triangles, topology, &surface.positions, &mut normals);
    let mut growth = Growth {
        surface,
        topology,
        plane,
        normals,
        pairs: vec![None; images.len()],
    };
    let kept = growth.connected(&images);
    cancel.check()?;
    let mut is_grown = vec![false; topology.components().len()];
    for (vertex, kept) in kept.iter().enumerate() {
        if let Some(image) = images[vertex].filter(|_| *kept) {
            let vertex = SurfaceVertex(vertex as u32);
            is_grown[topology.component(vertex) as usize] = true;
            growth.pairs[vertex.index()] = Some(growth.nearest(image, plane.mirrored(growth.position(vertex))));
        }
    }
    growth.grow(cancel)?;
    for _ in 0..ROUNDS {
        cancel.check()?;
        growth.relax(&kept);
    }
    let own = (0..).map(SurfaceVertex).zip(&growth.pairs);
    let image = own.map(|(vertex, pair)| match is_grown[topology.component(vertex) as usize] {
        true => pair.map(|pair| pair.vertex),
        false => images[vertex.index()],
    });
    Ok(image.collect())
}

/// A vertex' counterpart: a point of the surface, and the vertex nearest to it.
#[derive(Clone, Copy, Debug)]
struct Pair {
    point: DVec3,
    vertex: SurfaceVertex,
}

struct Growth<'a> {
    surface: &'a Surface,
    topology: &'a Topology,
    plane: MirrorPlane,
    normals: Vec<DVec3>,
    pairs: Vec<Option<Pair>>,
}

impl Growth<'_> {
    fn position(&self, vertex: SurfaceVertex) -> DVec3 {
        self.surface.positions[vertex.index()]
    }

    fn longest_edge(&self, vertex: SurfaceVertex) -> f64 {
        let lengths = self.topology.neighbours(vertex).iter();
        lengths
            .map(|&other| self.position(vertex).distance(self.position(other)))
            .fold(0.0, f64::max)
    }

    /// The vertices whose images are in the connected sets that count.
    fn connected(&self, images: &[Option<SurfaceVertex>]) -> Vec<bool> {
        let faces_alike = |vertex: SurfaceVertex, image: SurfaceVertex| {
            let mirrored = self.plane.mirrored_vector(self.normals[vertex.index()]);
            mirrored.dot(self.normals[image.index()]) >= ALIKE
        };
        let image = |vertex: SurfaceVertex| images[vertex.index()].filter(|&image| faces_alike(vertex, image));
        let goes_on = |vertex: SurfaceVertex, other: SurfaceVertex| {
            let (Some(one), Some(next)) = (image(vertex), image(other)) else {
                return false;
            };
            let edge = self.position(vertex).distance(self.position(other));
            let rounded = self.longest_edge(one) + self.longest_edge(next);
            self.position(one).distance(self.position(next)) <= STRETCH * edge + rounded
        };
        let mut kept = vec![false; images.len()];
        let mut seen = vec![false; images.len()];
        for first in (0..images.len() as u32).map(SurfaceVertex) {
            if seen[first.index()] || image(first).is_none() {
                continue;
            }
            seen[first.index()] = true;
            let mut set = vec![first];
            let mut next = 0;
            while let Some(&vertex) = set.get(next) {
                next += 1;
                for &other in self.topology.neighbours(vertex) {
                    if !seen[other.index()] && goes_on(vertex, other) {
                        seen[other.index()] = true;
                        set.push(other);
                    }
                }
            }
            let all = self.topology.components()[self.topology.component(first) as usize].vertex_count;
            if set.len() as f64 >= KEPT_SHARE * all as f64 {
                set.iter().for_each(|vertex| kept[vertex.index()] = true);
            }
        }
        kept
    }

    /// The point of the surface nearest to `point`, by a way over vertices that come nearer, from `from` on.
    fn nearest(&self, from: SurfaceVertex, point: DVec3) -> Pair {
        let away = |vertex: SurfaceVertex| self.position(vertex).distance_squared(point);
        let mut vertex = from;
        loop {
            let around = self.topology.neighbours(vertex).iter().copied();
            let Some(next) = around.min_by(|&a, &b| away(a).total_cmp(&away(b))) else {
                break;
            };
            // Not a number is no nearer.
            if away(next) >= away(vertex) || away(next).is_nan() {
                break;
            }
            vertex = next;
        }
        let faces = self.topology.faces(vertex, &self.surface.triangles);
        let corners = faces.map(|face| self.surface.triangles[face as usize].map(|v| self.position(v)));
        let points = corners.map(|corners| nearest_on_triangle(point, corners));
        let nearest = points.min_by(|a, b| a.distance_squared(point).total_cmp(&b.distance_squared(point)));
        Pair {
            point: nearest.unwrap_or(self.position(vertex)),
            vertex,
        }
    }

    /// Pairs the other vertices of components with pairs, nearest to these first.
    fn grow(&mut self, cancel: &Cancel) -> Result<(), Cancelled> {
        let mut front = BinaryHeap::new();
        let kept = (0..)
            .map(SurfaceVertex)
            .zip(&self.pairs)
            .filter(|(_, pair)| pair.is_some());
        front.extend(kept.map(|(vertex, _)| Reverse((0_u64, vertex))));
        let mut is_done = vec![false; self.pairs.len()];
        let mut count = 0_usize;
        while let Some(Reverse((bits, vertex))) = front.pop() {
            if std::mem::replace(&mut is_done[vertex.index()], true) {
                continue;
            }
            count += 1;
            if count.is_multiple_of(1 << 12) {
                cancel.check()?;
            }
            let way = f64::from_bits(bits);
            if self.pairs[vertex.index()].is_none() {
                self.pairs[vertex.index()] = self.expected(vertex, way);
            }
            if self.pairs[vertex.index()].is_some() {
                for &other in self
                    .topology
                    .neighbours(vertex)
                    .iter()
                    .filter(|other| !is_done[other.index()])
                {
                    let farther = way + self.position(vertex).distance(self.position(other));
                    front.push(Reverse((farther.to_bits(), other)));
                }
            }
        }
        Ok(())
    }

    /// Moves the counterparts of the vertices that were not `kept` to where those of their neighbours expect them, and
    /// where the vertices expect them whose counterpart is there.
    fn relax(&mut self, kept: &[bool]) {
        let is_moved = |vertex: SurfaceVertex| !kept[vertex.index()];
        let neighbours = |vertex: SurfaceVertex| self.topology.neighbours(vertex).iter();
        let is_used = |vertex: SurfaceVertex| is_moved(vertex) || neighbours(vertex).any(|other| is_moved(*other));
        let turns: Vec<DQuat> = (0..self.pairs.len() as u32)
            .into_par_iter()
            .map(SurfaceVertex)
            .map(|vertex| match self.pairs[vertex.index()] {
                Some(pair) if is_used(vertex) => self.turn(vertex, pair),
                _ => DQuat::IDENTITY,
            })
            .collect();
        let mut back: Vec<Vec<SurfaceVertex>> = vec![Vec::new(); self.pairs.len()];
        for (vertex, pair) in (0..).map(SurfaceVertex).zip(&self.pairs) {
            if let Some(pair) = pair.filter(|_| is_used(vertex)) {
                back[pair.vertex.index()].push(vertex);
            }
        }
        let relaxed = |vertex: SurfaceVertex| -> Option<Pair> {
            let pair = self.pairs[vertex.index()]?;
            if !is_moved(vertex) {
                return Some(pair);
            }
            let here = self.position(vertex);
            let by_neighbours = neighbours(vertex).filter_map(|&other| {
                let edge = self.plane.mirrored_vector(here - self.position(other));
                Some(self.pairs[other.index()]?.point + turns[other.index()] * edge)
            });
            let by_counterparts = back[vertex.index()].iter().filter_map(|&other| {
                let off = turns[other.index()].inverse() * (here - self.pairs[other.index()]?.point);
                Some(self.position(other) + self.plane.mirrored_vector(off))
            });
            let means: Vec<DVec3> = [mean(by_neighbours), mean(by_counterparts)]
                .into_iter()
                .flatten()
                .collect();
            let expected = mean(means.into_iter())?;
            Some(self.nearest(pair.vertex, expected))
        };
        let vertices = (0..self.pairs.len() as u32).into_par_iter().map(SurfaceVertex);
        let pairs = vertices.map(relaxed).collect();
        self.pairs = pairs;
    }

    /// The counterpart of a vertex so far from the set that counts, by those of its neighbours.
    fn expected(&self, vertex: SurfaceVertex, way: f64) -> Option<Pair> {
        let (mut sum, mut count, mut from) = (DVec3::ZERO, 0.0, None);
        for &other in self.topology.neighbours(vertex) {
            if let Some(pair) = self.pairs[other.index()] {
                let edge = self.plane.mirrored_vector(self.position(vertex) - self.position(other));
                sum += pair.point + self.turn(other, pair) * edge;
                count += 1.0;
                from = Some(pair.vertex);
            }
        }
        let expected = sum / count;
        let pair = self.nearest(from?, expected);
        let longest = self.longest_edge(vertex).max(self.longest_edge(pair.vertex));
        (pair.point.distance(expected) <= FAR[0] * longest + FAR[1] * way).then_some(pair)
    }

    /// The rotation from the mirrored surroundings of a vertex to those of its counterpart: from normal to normal, and
    /// about that as its neighbours' pairs fit best.
    fn turn(&self, vertex: SurfaceVertex, pair: Pair) -> DQuat {
        let mirrored = self.plane.mirrored_vector(self.normals[vertex.index()]);
        let normal = self.normals[pair.vertex.index()];
        let (Some(from), Some(to)) = (mirrored.try_normalize(), normal.try_normalize()) else {
            return DQuat::IDENTITY;
        };
        let tilt = DQuat::from_rotation_arc(from, to);
        let (mut along, mut across) = (0.0, 0.0);
        let mut add = |other: SurfaceVertex| {
            if let Some(own) = self.pairs[other.index()] {
                let way = tilt * self.plane.mirrored_vector(self.position(other) - self.position(vertex));
                let image = own.point - pair.point;
                along += way.dot(image);
                across += to.dot(way.cross(image));
            }
        };
        for &other in self.topology.neighbours(vertex) {
            add(other);
            // Vertices of the second ring count once for each way to them.
            self.topology.neighbours(other).iter().for_each(|&second| add(second));
        }
        DQuat::from_axis_angle(to, across.atan2(along)) * tilt
    }
}

/// The mean of points; `None` if there are none.
fn mean(points: impl Iterator<Item = DVec3>) -> Option<DVec3> {
    let (sum, count) = points.fold((DVec3::ZERO, 0.0), |(sum, count), point| (sum + point, count + 1.0));
    (count > 0.0).then(|| sum / count)
}
