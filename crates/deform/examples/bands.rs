//! Measures painted bands of limbs: `bands MESH.off,.. METHOD[:OPTION=VALUE,..] ..`.
//!
//! The part that a mesh's file of roles (MESH.sel) frees is a limb from its fixed vertices to its handle. Bands of it
//! beside the fixed part, in the middle and beside the handle are painted, and the handle turns by 60° about a point
//! half-way: across the limb, then along it. Each line gives the mesh, the method, the turn, the band, and the band's
//! departure from a rigid motion (root mean square, % of the free part's diagonal), the limb's volume and length (over
//! those at rest), the turn between the band's ends in degrees and the steps at each stiffness; at the end, the departures that do not fall with stiffness and the volumes that a stiffness raises
//! above both 1 and the unpainted volume.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

mod common;

use std::collections::HashSet;
use std::path::Path;

use common::{chosen_method, edit, name, pool, read};
use glam::{DAffine3, DQuat, DVec3};
use pliant_deform::{Method, Problem, RigidMotion, Role};
use pliant_mesh::{Cancel, Model, Progress, SurfaceVertex};

const STIFFNESS: [f64; 7] = [0.01, 0.1, 0.3, 1.0, 10.0, 100.0, 1000.0];

/// The shares of the way from the fixed part to the handle between which bands are.
const BANDS: [std::ops::Range<f64>; 3] = [0.04..0.34, 0.34..0.66, 0.66..0.96];

/// Steps after which a descent is not waited for.
const MOST_STEPS: u32 = 1000;

fn main() {
    let mut words = std::env::args().skip(1);
    let meshes = words
        .next()
        .unwrap_or_else(|| panic!("usage: bands MESH.off,.. METHOD.."));
    let methods: Vec<String> = words.collect();
    let pool = pool(2);
    for mesh in meshes.split(',') {
        let limb = Limb::of(Path::new(mesh));
        for word in &methods {
            let method = chosen_method(word);
            for axis in [limb.across, limb.along] {
                let target = limb.turned(axis);
                for band in &BANDS {
                    let of = |stiffness| pool.install(|| limb.bent(&method, target, band, stiffness));
                    let found: Vec<Bent> = STIFFNESS.into_iter().map(of).collect();
                    let turn = if axis == limb.across { "bent" } else { "twisted" };
                    println!(
                        "{} {word} {turn} {:.2} | {}",
                        name(Path::new(mesh)),
                        band.start,
                        line(&found)
                    );
                }
            }
        }
    }
}

/// The figures of one band at all stiffnesses, and their faults.
fn line(found: &[Bent]) -> String {
    let words = |of: fn(&Bent) -> String| found.iter().map(of).collect::<Vec<_>>().join(" ");
    let even = found[3].volume;
    let mut faults = String::new();
    for (pair, stiffness) in found.windows(2).zip(STIFFNESS) {
        if pair[1].departure >= pair[0].departure {
            let rise = pair[1].departure / pair[0].departure;
            faults += &format!(" RISES:{stiffness}:{rise:.3}");
        }
    }
    for (own, stiffness) in found.iter().zip(STIFFNESS) {
        if own.volume > even.max(1.0) + 0.03 {
            faults += &format!(" SWELLS:{stiffness}:{:.3}", own.volume / even.max(1.0));
        }
    }
    format!(
        "{} | {} | {} | {} | {}{faults}",
        words(|bent| format!("{:.4}", bent.departure)),
        words(|bent| format!("{:.3}", bent.volume)),
        words(|bent| format!("{:.3}", bent.length)),
        words(|bent| format!("{:.1}", bent.turn)),
        words(|bent| bent.steps.to_string()),
    )
}

/// A shape's figures.
struct Bent {
    departure: f64,
    volume: f64,
    /// The length of the limb over that at rest.
    length: f64,
    /// The turn between the band's ends, in degrees.
    turn: f64,
    steps: u32,
}

/// A limb of a mesh.
struct Limb {
    model: Model,
    roles: Vec<Role>,
    /// The share of the way from the fixed part, for each vertex.
    shares: Vec<f64>,
    diagonal: f64,
    middle: DVec3,
    along: DVec3,
    across: DVec3,
}

impl Limb {
    fn of(mesh: &Path) -> Self {
        let model = read(mesh);
        let (roles, _) = edit(mesh, &model);
        let positions = &model.surface.positions;
        let neighbours = |v: usize| model.topology.neighbours(SurfaceVertex(v as u32));
        let all = &roles;
        let of = |role: Role| (0..all.len()).filter(move |&v| all[v] == role);
        let free: Vec<usize> = of(Role::Free).collect();
        let rim = |role: Role| -> DVec3 {
            let beside = |v: &usize| neighbours(*v).iter().any(|other| all[other.index()] == Role::Free);
            let rim: Vec<usize> = of(role).filter(beside).collect();
            rim.iter().map(|&v| positions[v]).sum::<DVec3>() / rim.len() as f64
        };
        let (from, to) = (rim(Role::Fixed), rim(Role::Handle(0)));
        let distances = |role: Role| {
            let mut distance: Vec<f64> = all.iter().map(|r| if *r == role { 0.0 } else { f64::MAX }).collect();
            loop {
                let mut is_settled = true;
                for &v in &free {
                    for other in neighbours(v) {
                        let through = distance[other.index()] + positions[v].distance(positions[other.index()]);
                        if through < distance[v] {
                            distance[v] = through;
                            is_settled = false;
                        }
                    }
                }
                if is_settled {
                    return distance;
                }
            }
        };
        let (back, ahead) = (distances(Role::Fixed), distances(Role::Handle(0)));
        let shares = back.iter().zip(&ahead).map(|(a, b)| a / (a + b)).collect();
        let low = free.iter().map(|&v| positions[v]).reduce(DVec3::min).unwrap();
        let high = free.iter().map(|&v| positions[v]).reduce(DVec3::max).unwrap();
        let along = (to - from).normalize();
        Self {
            shares,
            diagonal: low.distance(high),
            middle: (from + to) / 2.0,
            along,
            across: along.any_orthonormal_vector(),
            roles,
            model,
        }
    }

    fn turned(&self, axis: DVec3) -> DAffine3 {
        let turn = DAffine3::from_quat(DQuat::from_axis_angle(axis, std::f64::consts::FRAC_PI_3));
        DAffine3::from_translation(self.middle) * turn * DAffine3::from_translation(-self.middle)
    }

    fn bent(&self, method: &Method, target: DAffine3, band: &std::ops::Range<f64>, stiffness: f64) -> Bent {
        let positions = &self.model.surface.positions;
        let is_in = |v: &usize| self.roles[*v] == Role::Free && band.contains(&self.shares[*v]);
        let members: Vec<usize> = (0..positions.len()).filter(is_in).collect();
        let mut painted = vec![1.0; positions.len()];
        members.iter().for_each(|&v| painted[v] = stiffness);
        let (progress, cancel) = (Progress::new(), Cancel::new());
        let topology = &self.model.topology;
        let ordering = method.ordering(topology, &progress, &cancel).unwrap();
        let problem = Problem::new((&self.model.surface, topology), &self.roles, &painted, method);
        let mut bound = problem.bind(ordering.as_ref(), &progress, &cancel).unwrap();
        bound.set_targets(&[target]).unwrap();
        let mut displacements = vec![DVec3::ZERO; positions.len()];
        let mut steps = 0;
        while steps < MOST_STEPS {
            steps += 1;
            if bound.step(&mut displacements).unwrap().finished {
                break;
            }
        }
        let moved: Vec<DVec3> = positions.iter().zip(&displacements).map(|(p, d)| *p + *d).collect();
        let rest: Vec<DVec3> = members.iter().map(|&v| positions[v]).collect();
        let of_band: Vec<DVec3> = members.iter().map(|&v| displacements[v]).collect();
        let fit = RigidMotion::fit(&rest, &of_band).unwrap();
        let apart = rest
            .iter()
            .zip(&of_band)
            .map(|(p, d)| (fit.displace(*p) - *d).length_squared());
        let departure = (apart.sum::<f64>() / rest.len() as f64).sqrt() / self.diagonal;
        Bent {
            departure: 100.0 * departure,
            volume: self.volume(&moved) / self.volume(positions),
            length: self.length(&moved) / self.length(positions),
            turn: self.turn(&displacements, band),
            steps,
        }
    }

    /// The length of the line through the middles of twelve slices of the limb.
    fn length(&self, places: &[DVec3]) -> f64 {
        let slice = |number: usize| -> DVec3 {
            let range = number as f64 / 12.0..(number + 1) as f64 / 12.0;
            let own: Vec<usize> = self.free().filter(|&v| range.contains(&self.shares[v])).collect();
            own.iter().map(|&v| places[v]).sum::<DVec3>() / own.len().max(1) as f64
        };
        (1..12).map(|number| slice(number - 1).distance(slice(number))).sum()
    }

    /// The angle between the rigid motions that fit the first and the last fifth of a band best, in degrees.
    fn turn(&self, displacements: &[DVec3], band: &std::ops::Range<f64>) -> f64 {
        let fifth = 0.2 * (band.end - band.start);
        let [first, last] = [band.start..band.start + fifth, band.end - fifth..band.end].map(|range| {
            let own: Vec<usize> = self.free().filter(|&v| range.contains(&self.shares[v])).collect();
            let of = |all: &[DVec3]| own.iter().map(|&v| all[v]).collect::<Vec<_>>();
            RigidMotion::fit(&of(&self.model.surface.positions), &of(displacements)).unwrap()
        });
        let turned = |fit: &RigidMotion, axis: DVec3| axis + fit.displace(axis) - fit.displace(DVec3::ZERO);
        let cosine: f64 = DVec3::AXES
            .iter()
            .map(|&axis| turned(&first, axis).dot(turned(&last, axis)))
            .sum();
        (0.5 * (cosine - 1.0)).clamp(-1.0, 1.0).acos().to_degrees()
    }

    fn free(&self) -> impl Iterator<Item = usize> {
        (0..self.roles.len()).filter(|&v| self.roles[v] == Role::Free)
    }

    /// Six times the volume of the limb, closed at both rims by fans from their middles.
    fn volume(&self, places: &[DVec3]) -> f64 {
        let is_free = |v: SurfaceVertex| self.roles[v.index()] == Role::Free;
        let of_limb = self
            .model
            .surface
            .triangles
            .iter()
            .filter(|corners| corners.iter().any(|&v| is_free(v)));
        let limb: Vec<[usize; 3]> = of_limb.map(|corners| corners.map(SurfaceVertex::index)).collect();
        let edges = || limb.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        let own: HashSet<(usize, usize)> = edges().collect();
        let rim = |role: Role| -> f64 {
            let rim: Vec<(usize, usize)> = edges()
                .filter(|&(a, b)| !own.contains(&(b, a)) && self.roles[a] == role)
                .collect();
            let middle = rim.iter().map(|&(a, _)| places[a]).sum::<DVec3>() / rim.len().max(1) as f64;
            rim.iter().map(|&(a, b)| middle.dot(places[b].cross(places[a]))).sum()
        };
        let sides: f64 = limb
            .iter()
            .map(|&[a, b, c]| places[a].dot(places[b].cross(places[c])))
            .sum();
        sides + rim(Role::Fixed) + rim(Role::Handle(0))
    }
}
