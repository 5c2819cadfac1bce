//! Slivers that a linear shape turns over are turned back.
//!
//! A smooth shape moves a vertex by as little as its bend asks, and still by more than the height of a thin triangle: a
//! line of three vertices that bends within the surface puts the middle one beyond the side of its sliver, however
//! right the shape is. Triangles of a Laplacian do not help, intrinsic ones either, because the *exact* bend of the
//! vertices turns such triangles, too. So after the step, corners of turned slivers are moved across the longest side
//! by the least distance with which the sliver faces the same side as the triangles around it. A move is kept if fewer
//! triangles are turned after it, or as many but not this one: in a row of slivers a turned one then goes from one to
//! the next until it has room. So the number of turned triangles never rises, and a shape without turned slivers stays
//! the same to the bit.

use glam::DVec3;
use pliant_mesh::{SurfaceVertex, has_normal};
use rayon::prelude::*;

use crate::numerical::lists::Lists;
use crate::{Problem, Role};

/// A triangle is a sliver if its height is below this share of its longest side.
const THIN: f64 = 0.08;

/// A sliver that was turned back has this share of its height at rest.
const HEIGHT_LEFT: f64 = 0.05;

/// The triangles around a sliver on whose normals a decision depends: those at its corners, those next to them, and those
/// with which these are compared.
const RINGS: u32 = 3;

/// Rounds over the turned slivers. A move can turn the next sliver of a row, which the next round moves.
const MOST_ROUNDS: u32 = 12;

/// The slivers of a surface, and the triangles around them.
#[derive(Debug)]
pub(super) struct Slivers {
    slivers: Vec<Sliver>,
    patch: Patch,
}

#[derive(Clone, Copy, Debug)]
struct Sliver {
    /// Its number among the patch's triangles.
    triangle: u32,
    /// Its height over its longest side at rest, in world units.
    height: f64,
    /// The corner opposite its longest side.
    apex: u8,
    /// The triangles at its sides; itself where there is none.
    beside: [u32; 3],
}

/// The triangles within two edges of a sliver, over vertices with numbers of their own.
#[derive(Debug)]
struct Patch {
    /// The surface's vertices.
    vertices: Vec<u32>,
    rest: Vec<DVec3>,
    /// True for vertices that a sliver may move.
    may_move: Vec<bool>,
    triangles: Vec<[u32; 3]>,
    /// The triangles at each vertex.
    around: Lists,
}

impl Slivers {
    /// The slivers of a problem that have a vertex to move; `None` if there are none.
    pub fn of(problem: &Problem) -> Option<Self> {
        let (surface, topology) = (problem.surface, problem.topology);
        let may_move = |v: SurfaceVertex| problem.roles[v.index()] == Role::Free;
        let found: Vec<(u32, f64, u8)> = surface
            .triangles
            .par_iter()
            .enumerate()
            .filter(|(_, triangle)| triangle.iter().any(|&v| may_move(v)))
            .filter_map(|(t, _)| thin(surface.corners(t)).map(|(height, apex)| (t as u32, height, apex)))
            .collect();
        if found.is_empty() {
            return None;
        }
        let mut is_near = vec![false; surface.triangles.len()];
        let mut is_passed = vec![false; surface.positions.len()];
        let mut ring: Vec<u32> = found.iter().map(|sliver| sliver.0).collect();
        for _ in 0..RINGS {
            let corners = ring.iter().flat_map(|&t| surface.triangles[t as usize]);
            let new = corners.filter(|v| !std::mem::replace(&mut is_passed[v.index()], true));
            let faces = new.flat_map(|v| topology.faces(v, &surface.triangles));
            ring = faces
                .filter(|&t| !std::mem::replace(&mut is_near[t as usize], true))
                .collect();
        }
        let near: Vec<u32> = (0..surface.triangles.len() as u32)
            .filter(|&t| is_near[t as usize])
            .collect();
        let mut numbers = vec![u32::MAX; surface.positions.len()];
        for v in near.iter().flat_map(|&t| surface.triangles[t as usize]) {
            numbers[v.index()] = 0;
        }
        let vertices: Vec<u32> = (0..numbers.len() as u32)
            .filter(|&v| numbers[v as usize] == 0)
            .collect();
        for (number, &v) in vertices.iter().enumerate() {
            numbers[v as usize] = number as u32;
        }
        let local = |v: SurfaceVertex| numbers[v.index()];
        let triangles: Vec<[u32; 3]> = near.iter().map(|&t| surface.triangles[t as usize].map(local)).collect();
        let at_corners = (0..)
            .zip(&triangles)
            .flat_map(|(number, corners)| corners.map(|v| (v, number)));
        let around = Lists::of(vertices.len(), at_corners);
        let patch = Patch {
            rest: vertices.iter().map(|&v| surface.positions[v as usize]).collect(),
            may_move: vertices.iter().map(|&v| may_move(SurfaceVertex(v))).collect(),
            vertices,
            triangles,
            around,
        };
        let slivers = found.iter().map(|&(number, height, apex)| {
            let triangle = near.partition_point(|&other| other < number) as u32;
            Sliver {
                triangle,
                height,
                apex,
                beside: patch.beside(triangle),
            }
        });
        let slivers: Vec<Sliver> = slivers.filter(|own| !patch.is_exempt(own.triangle)).collect();
        (!slivers.is_empty()).then_some(Self { slivers, patch })
    }

    /// Turns slivers back in a step's displacements, world units.
    pub fn turn_back(&self, displacements: &mut [DVec3]) {
        for _ in 0..MOST_ROUNDS {
            let at = self.patch.shape(displacements);
            let may_be_turned = |sliver: &&Sliver| self.patch.opposes_one_beside(sliver, at);
            let candidates: Vec<Sliver> = self.slivers.iter().filter(may_be_turned).copied().collect();
            let moves = candidates
                .iter()
                .filter(|sliver| self.patch.turn(sliver, displacements));
            if moves.count() == 0 {
                break;
            }
        }
    }
}

impl Patch {
    fn around(&self, v: u32) -> &[u32] {
        self.around.at(v as usize)
    }

    /// The place of each of its vertices.
    fn shape(&self, displacements: &[DVec3]) -> impl Fn(u32) -> DVec3 + Copy {
        |v| self.rest[v as usize] + displacements[self.vertices[v as usize] as usize]
    }

    /// Twice a triangle's area, along its normal.
    fn area(&self, triangle: u32, at: impl Fn(u32) -> DVec3) -> DVec3 {
        let [a, b, c] = self.triangles[triangle as usize].map(at);
        (b - a).cross(c - a)
    }

    /// The sum of the areas of the other triangles at a triangle's corners.
    fn others(&self, triangle: u32, at: impl Fn(u32) -> DVec3 + Copy) -> DVec3 {
        let others = |v: u32| self.around(v).iter().filter(|&&other| other != triangle);
        let corners = self.triangles[triangle as usize].into_iter();
        corners.flat_map(others).map(|&other| self.area(other, at)).sum()
    }

    /// The triangles at a triangle's sides; itself where there is none.
    fn beside(&self, triangle: u32) -> [u32; 3] {
        let corners = self.triangles[triangle as usize];
        [0, 1, 2].map(|k| {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            let shares = |other: &&u32| **other != triangle && self.triangles[**other as usize].contains(&to);
            self.around(from).iter().find(shares).copied().unwrap_or(triangle)
        })
    }

    /// Returns true if a sliver opposes a triangle at one of its sides. One that is turned among others that are not
    /// does; this reads three triangles, where those at its corners are some twenty.
    fn opposes_one_beside(&self, sliver: &Sliver, at: impl Fn(u32) -> DVec3 + Copy) -> bool {
        let own = self.area(sliver.triangle, at);
        sliver.beside.iter().any(|&other| own.dot(self.area(other, at)) < 0.0)
    }

    fn opposes(&self, triangle: u32, at: impl Fn(u32) -> DVec3 + Copy) -> bool {
        self.area(triangle, at).dot(self.others(triangle, at)) < 0.0
    }

    /// Returns true for a triangle whose normal opposes the others at rest, or that has none.
    fn is_exempt(&self, triangle: u32) -> bool {
        let rest = |v: u32| self.rest[v as usize];
        self.opposes(triangle, rest) || !has_normal(self.triangles[triangle as usize].map(rest))
    }

    fn is_turned(&self, triangle: u32, at: impl Fn(u32) -> DVec3 + Copy) -> bool {
        self.opposes(triangle, at) && !self.is_exempt(triangle)
    }

    /// The number of turned triangles among those to which a move of `vertices` matters.
    fn turned_near(&self, vertices: &[u32], at: impl Fn(u32) -> DVec3 + Copy) -> usize {
        let ring = vertices.iter().flat_map(|&v| self.around(v));
        let mut ring: Vec<u32> = ring.flat_map(|&t| self.triangles[t as usize]).collect();
        ring.sort_unstable();
        ring.dedup();
        let mut near: Vec<u32> = ring.iter().flat_map(|&v| self.around(v)).copied().collect();
        near.sort_unstable();
        near.dedup();
        near.iter().filter(|&&t| self.is_turned(t, at)).count()
    }

    /// Moves the sliver's apex, or else the ends of its longest side, or all three; returns false if all stay.
    fn turn(&self, sliver: &Sliver, displacements: &mut [DVec3]) -> bool {
        let corners = self.triangles[sliver.triangle as usize];
        let [v, a, b] = [0, 1, 2].map(|k| corners[(usize::from(sliver.apex) + k) % 3]);
        let at = self.shape(displacements);
        let (side, arm) = (at(b) - at(a), at(v) - at(a));
        // The direction within the surface in which the apex lies.
        let across = self.others(sliver.triangle, at).cross(side).normalize_or_zero();
        if across == DVec3::ZERO || !self.is_turned(sliver.triangle, at) {
            return false;
        }
        let before = self.turned_near(&corners, at);
        let lack = HEIGHT_LEFT * sliver.height - across.dot(arm);
        let foot = (side.dot(arm) / side.length_squared()).clamp(0.0, 1.0);
        let all = [(v, 1.0), (a, foot - 1.0), (b, -foot)];
        let own = |corner: u32| self.vertices[corner as usize] as usize;
        for moving in [&all[..1], &all[1..], &all[..]] {
            let moving = || moving.iter().filter(|(corner, _)| self.may_move[*corner as usize]);
            let reach: f64 = moving().map(|(_, share)| share * share).sum();
            if reach < 0.1 {
                continue;
            }
            let kept = corners.map(|corner| displacements[own(corner)]);
            for &(corner, share) in moving() {
                displacements[own(corner)] += across * (share * lack / reach);
            }
            let at = self.shape(displacements);
            let after = self.turned_near(&corners, at);
            if after < before || after == before && !self.is_turned(sliver.triangle, at) {
                return true;
            }
            for (corner, displacement) in corners.into_iter().zip(kept) {
                displacements[own(corner)] = displacement;
            }
        }
        false
    }
}

/// A triangle's height over its longest side and the corner opposite it, if it is a sliver.
fn thin([a, b, c]: [DVec3; 3]) -> Option<(f64, u8)> {
    let squares = [b.distance_squared(c), c.distance_squared(a), a.distance_squared(b)];
    let apex = (0..3).max_by(|&i, &j| squares[i].total_cmp(&squares[j]))?;
    let area_squared = (b - a).cross(c - a).length_squared();
    let share_squared = area_squared / (squares[apex] * squares[apex]);
    let is_thin = share_squared < THIN * THIN && has_normal([a, b, c]);
    is_thin.then(|| ((area_squared / squares[apex]).sqrt(), apex as u8))
}
