//! Sentences on a partition: constraints that the method does not support, and parts that nothing holds.

use pliant_mesh::SurfaceVertex;

use super::demands::Demands;
use crate::region::boundary_problem::BoundaryProblem;
use crate::{CONTINUITY_RANGE, ConstraintKind, Loose, Remedy, Warning};

/// Sentences about constraints that the method does not support, with the methods that do.
pub(super) fn unheeded(problem: &BoundaryProblem, demands: &Demands) -> Vec<Warning> {
    let constraints = &problem.constraints;
    let soft = constraints.soft.iter().position(Option::is_some);
    let has_joints = constraints
        .continuity
        .iter()
        .any(|&value| value != *CONTINUITY_RANGE.end());
    let is_painted = problem.stiffness.iter().any(|&value| value != 1.0);
    let name = demands.method;
    let remedy = |kind: ConstraintKind, purpose: &str| format!("take {} for {purpose}", Remedy::Heeding(kind));
    let is_unheeded = |kind: ConstraintKind, is_asked: bool| is_asked && !demands.heeds.contains(&kind);
    let mut warnings = Vec::new();
    if let Some(handle) = soft.filter(|_| is_unheeded(ConstraintKind::SoftHandles, true)) {
        let remedy = remedy(ConstraintKind::SoftHandles, "soft handles");
        warnings.push(Warning::of_handle(handle, |handle| {
            format!("{handle} is soft, but {name} treats every handle as hard: {remedy}")
        }));
    }
    if is_unheeded(ConstraintKind::Continuity, has_joints) {
        let remedy = remedy(ConstraintKind::Continuity, "hinges and smooth joints");
        warnings.push(format!("{name} has no choice of continuity: {remedy}").into());
    }
    if is_unheeded(ConstraintKind::Stiffness, is_painted) {
        let remedy = remedy(ConstraintKind::Stiffness, "parts that are stiffer than others");
        warnings.push(format!("{name} ignores painted stiffness: {remedy}").into());
    }
    warnings
}

/// A sentence on the points that no triangle uses and nothing holds.
pub(super) fn warning_of_points(problem: &BoundaryProblem, points: &[u32], loose_of: &[Loose]) -> Option<String> {
    let resting = points
        .iter()
        .filter(|&&point| loose_of[point as usize] == Loose::Rest)
        .count();
    let does = match (points.len() - resting, resting) {
        _ if problem.handle_count == 0 => return None,
        (0, 0) => return None,
        (0, _) => "stay".to_owned(),
        (_, 0) => "follow the nearest deformed surface".to_owned(),
        (_, resting) => format!("follow the nearest deformed surface, except for {resting} that stay"),
    };
    Some(format!(
        "points that no triangle uses ({}) {does}: {} bends them with the space around",
        points.len(),
        Remedy::OfSpace
    ))
}

/// The number of components to name; more are only counted.
const NAMED: usize = 4;

/// Sentences on components without a handle and a fixed vertex.
pub(super) fn warnings_of_loose(problem: &BoundaryProblem, loose: &[u32], loose_of: &[Loose]) -> Vec<String> {
    let mut sentences = Vec::new();
    if problem.handle_count == 0 {
        return sentences;
    }
    let size = |component: u32| problem.topology.components()[component as usize].vertex_count;
    let sum = |components: &[u32]| components.iter().map(|&component| size(component)).sum::<usize>();
    for (how, [it, they]) in [
        (
            Loose::Follow,
            [
                "follows the nearest deformed surface",
                "follow the nearest deformed surface",
            ],
        ),
        (
            Loose::Bend,
            [
                "bends along with the nearest deformed surface",
                "bend along with the nearest deformed surface",
            ],
        ),
        (Loose::Rest, ["stays in place", "stay in place"]),
    ] {
        let alike = loose
            .iter()
            .copied()
            .filter(|&component| loose_of[component as usize] == how);
        let alike: Vec<u32> = alike.collect();
        if alike.len() > NAMED {
            sentences.push(format!(
                "{} components ({} vertices, from component {} on) have no handle and no fixed vertex: they {they}; \
                 {} bends them with the space around",
                alike.len(),
                sum(&alike),
                alike[0],
                Remedy::OfSpace,
            ));
            continue;
        }
        for component in alike {
            sentences.push(format!(
                "component {component} ({} vertices) has no handle and no fixed vertex: it {it}",
                size(component),
            ));
        }
    }
    sentences
}

/// Sentences on components with a handle and without a fixed vertex. One that handles hold whole goes where they take it.
pub(super) fn warnings_of_unheld(problem: &BoundaryProblem, unheld: &[u32], handles: &[Vec<u32>]) -> Vec<Warning> {
    let size = |component: u32| problem.topology.components()[component as usize].vertex_count;
    let mut holders = vec![Vec::new(); unheld.len()];
    if !unheld.is_empty() {
        for (handle, vertices) in handles.iter().enumerate() {
            for &vertex in vertices {
                let component = problem.topology.component(SurfaceVertex(vertex));
                let Ok(place) = unheld.binary_search(&component) else {
                    continue;
                };
                match holders[place].last_mut() {
                    Some((last, count)) if *last == handle => *count += 1,
                    _ => holders[place].push((handle, 1)),
                }
            }
        }
    }
    let (unheld, holders): (Vec<u32>, Vec<Vec<(usize, usize)>>) = unheld
        .iter()
        .copied()
        .zip(holders)
        .filter(|(component, holders)| holders.iter().map(|(_, count)| count).sum::<usize>() < size(*component))
        .unzip();
    if unheld.is_empty() {
        return Vec::new();
    }
    if unheld.len() <= NAMED {
        let one = |(&component, holders): (&u32, Vec<(usize, usize)>)| {
            let sentence = match problem.topology.components().len() {
                1 => "no vertex is fixed, so the shape can move as a whole".to_owned(),
                _ => format!(
                    "component {component} ({} vertices) has a handle but no fixed vertex, so it can move as a whole",
                    size(component)
                ),
            };
            Warning::of_unheld(sentence, vec![holders])
        };
        return unheld.iter().zip(holders).map(one).collect();
    }
    let sentence = format!(
        "{} components ({} vertices, from component {} on) have a handle but no fixed vertex, so they can move as \
         wholes",
        unheld.len(),
        unheld.iter().map(|&component| size(component)).sum::<usize>(),
        unheld[0]
    );
    vec![Warning::of_unheld(sentence, holders)]
}
