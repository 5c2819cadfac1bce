//! Measures what large turns leave of a limb: `turns METHOD[:OPTION=VALUE,..] ..`.
//!
//! A tube of 16 by 40 quads, five times as long as wide, has a neck in its middle with the given share of its radius.
//! One end is fixed; the other turns about the limb, or about an axis beside its middle. Each line gives the method, the
//! neck, the turn, and for the twist and the bend: the least distance of a vertex from the middle of its ring as a share
//! of the rest distance, the least ring's area as a share, the triangles whose normal turned against their neighbours',
//! the number of steps, and whether a warning names the turn.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

mod common;

use std::collections::BTreeMap;

use common::chosen_method;
use glam::{DAffine3, DVec3};
use pliant_deform::{Method, Problem, Role};
use pliant_mesh::{Cancel, Progress, SurfaceVertex, shapes};

const RADIUS: f64 = 0.5;
const LENGTH: f64 = 5.0;

fn main() {
    println!(
        "method neck degrees | twist: narrowest area flips steps energy said | bend: the same | drag's twist: narrowest energy"
    );
    for word in std::env::args().skip(1) {
        let method = chosen_method(&word);
        for neck in [1.0, 0.6, 0.3, 0.2] {
            for degrees in [90.0, 120.0, 150.0, 170.0, 180.0] {
                let twist = |share: f64| DAffine3::from_rotation_z((share * degrees).to_radians());
                let bend = |share: f64| {
                    let pivot = DVec3::new(1.2 * RADIUS, 0.0, 0.5 * LENGTH);
                    DAffine3::from_translation(pivot)
                        * DAffine3::from_rotation_y((share * degrees).to_radians())
                        * DAffine3::from_translation(-pivot)
                };
                let twisted = turned(&method, neck, twist, 1);
                let bent = turned(&method, neck, bend, 1);
                let dragged = turned(&method, neck, twist, 20);
                println!(
                    "{word} {neck} {degrees} | {} | {} | {:.2} {:.5}",
                    twisted.words(),
                    bent.words(),
                    dragged.narrowest,
                    dragged.energy
                );
            }
        }
    }
}

struct Outcome {
    narrowest: f64,
    area: f64,
    flips: usize,
    steps: u32,
    energy: f64,
    said: bool,
}

impl Outcome {
    fn words(&self) -> String {
        let Self {
            narrowest,
            area,
            flips,
            steps,
            energy,
            said,
        } = self;
        format!("{narrowest:.2} {area:.2} {flips} {steps} {energy:.5} {said}")
    }
}

fn turned(method: &Method, neck: f64, target: impl Fn(f64) -> DAffine3, frames: u32) -> Outcome {
    let mut drawn = shapes::tube(16, 40, LENGTH);
    for p in &mut drawn.positions {
        let scale = RADIUS * (1.0 - (1.0 - neck) * (-(3.0 * (p.z - 0.5 * LENGTH)).powi(2)).exp());
        p.x *= scale;
        p.y *= scale;
    }
    let model = shapes::model(drawn);
    let (surface, topology) = (&model.surface, &model.topology);
    let role = |p: &DVec3| match p.z {
        z if z < 0.1 * LENGTH => Role::Fixed,
        z if z > 0.9 * LENGTH => Role::Handle(0),
        _ => Role::Free,
    };
    let roles: Vec<Role> = surface.positions.iter().map(role).collect();
    let stiffness = vec![1.0; roles.len()];
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let ordering = method.ordering(topology, &progress, &cancel).unwrap();
    let problem = Problem::new((surface, topology), &roles, &stiffness, method);
    let mut bound = problem.bind(ordering.as_ref(), &progress, &cancel).unwrap();
    let mut displacements = vec![DVec3::ZERO; roles.len()];
    let (mut steps, mut energy) = (0, 0.0);
    for frame in 1..=frames {
        bound
            .set_targets(&[target(f64::from(frame) / f64::from(frames))])
            .unwrap();
        loop {
            let step = bound.step(&mut displacements).unwrap();
            (steps, energy) = (step.iteration, step.energy);
            if step.finished || (frame < frames && steps >= 3) {
                break;
            }
        }
    }
    let mut rings: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    for (v, p) in surface.positions.iter().enumerate() {
        rings.entry((p.z * 1e6).round() as i64).or_default().push(v);
    }
    let moved: Vec<DVec3> = surface
        .positions
        .iter()
        .zip(&displacements)
        .map(|(p, d)| *p + *d)
        .collect();
    let (mut narrowest, mut area) = (f64::INFINITY, f64::INFINITY);
    for ring in rings.values().filter(|ring| ring.len() > 3) {
        let mut ring = ring.clone();
        ring.sort_by(|&a, &b| {
            let angle = |v: usize| surface.positions[v].y.atan2(surface.positions[v].x);
            angle(a).total_cmp(&angle(b))
        });
        let of = |places: &[DVec3]| {
            let middle = ring.iter().map(|&v| places[v]).sum::<DVec3>() / ring.len() as f64;
            let least = ring
                .iter()
                .map(|&v| places[v].distance(middle))
                .fold(f64::INFINITY, f64::min);
            let pairs = ring.iter().zip(ring.iter().cycle().skip(1));
            let area: DVec3 = pairs
                .map(|(&a, &b)| (places[a] - middle).cross(places[b] - middle))
                .sum();
            (least, area.length())
        };
        let (rest, now) = (of(&surface.positions), of(&moved));
        narrowest = narrowest.min(now.0 / rest.0);
        area = area.min(now.1 / rest.1);
    }
    let normal = |face: usize, places: &[DVec3]| {
        let [a, b, c] = surface.triangles[face].map(|v| places[v.index()]);
        (b - a).cross(c - a).normalize_or_zero()
    };
    let mut flips = 0;
    for (face, corners) in surface.triangles.iter().enumerate() {
        let mut sum = DVec3::ZERO;
        for &corner in corners {
            for other in topology.faces(SurfaceVertex(corner.0), &surface.triangles) {
                sum += normal(other as usize, &moved);
            }
        }
        flips += usize::from(normal(face, &moved).dot(sum) < 0.0);
    }
    Outcome {
        narrowest,
        area,
        flips,
        steps,
        energy,
        said: bound.warnings().iter().any(|w| w.to_string().contains("turns by")),
    }
}
