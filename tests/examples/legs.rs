//! Two adjacent legs, one of which is moved: the example measures the motion of the other, by each method that bends
//! space. `legs METHOD[:OPTION=VALUE ..] ..` bends `assets/creature.glb`: a cage with `assets/legs-cage.edit.json`,
//! whose own vertices are moved around one leg, every other method with the handle of `assets/legs.edit.json`.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::unwrap_used,
    reason = "a program that reports"
)]

use std::fs;

use glam::DVec3;
use pliant_deform::Role;
use pliant_editor::Beginning;
use pliant_mesh::{Cancel, Progress};
use pliant_tests::{assets, open};
use serde_json::{Value, json};

/// The number of steps after which a method must be done.
const STEPS: usize = 500;

/// The free vertices at x < 0 are the other leg, and those below this height its foot.
const FOOT: f64 = 0.12;

fn main() {
    let loaded = open(&assets().join("creature.glb"));
    let model = &loaded.model;
    println!("{:<28}{:>14}{:>22}", "method", "other foot", "other leg, at most");
    for words in std::env::args().skip(1) {
        let setup = Beginning::parse(&edit(&words).to_string()).unwrap();
        let setup = setup.resolve(model).unwrap();
        let problem = setup.problem(model);
        let mut bound = problem.bind(None, &Progress::new(), &Cancel::new()).unwrap();
        setup.targets_at(1.0).set(&mut bound).unwrap();
        let mut displacements = vec![DVec3::ZERO; model.surface.positions.len()];
        let is_done = (0..STEPS).any(|_| bound.step(&mut displacements).unwrap().converged);
        let places = problem.roles.iter().zip(&model.surface.positions);
        let free = places.zip(&displacements).filter(|((role, _), _)| **role == Role::Free);
        let other = free.filter(|((_, p), _)| p.x < 0.0);
        let (mut leg, mut foot) = (0.0_f64, Vec::new());
        for ((_, p), displacement) in other {
            leg = leg.max(displacement.length());
            if p.y < FOOT {
                foot.push(displacement.length());
            }
        }
        // Shares of the largest displacement of a moved vertex.
        let moved = displacements.iter().map(|d| d.length()).fold(0.0, f64::max);
        let foot = foot.iter().sum::<f64>() / foot.len() as f64;
        println!(
            "{words:<28}{:>13.1}%{:>21.1}%",
            100.0 * foot / moved,
            100.0 * leg / moved
        );
        if !is_done {
            eprintln!("{words} has not converged after {STEPS} steps.");
        }
    }
}

/// The edit of a method in the form `NAME[:OPTION=VALUE ..]`.
fn edit(words: &str) -> Value {
    let mut parts = words.split(':');
    let name = parts.next().unwrap();
    let file = if name == "cage" { "legs-cage" } else { "legs" };
    let text = fs::read_to_string(assets().join(format!("{file}.edit.json"))).unwrap();
    let mut edit: Value = serde_json::from_str(&text).unwrap();
    let method = &mut edit["method"];
    method["name"] = json!(name);
    for (option, value) in parts.filter_map(|part| part.split_once('=')) {
        method[option] = serde_json::from_str(value).unwrap_or_else(|_| json!(value));
    }
    edit
}
