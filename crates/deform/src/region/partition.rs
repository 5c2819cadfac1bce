//! The roles applied to this surface: solved vertices, prescribed vertices and followers.
//!
//! Only vertices that a handle can reach are solved. The system's graph is that of Lⁿ, n the bi-Laplacian's order, so
//! influence travels n edges at a time, across constrained vertices too, and ends at a band of constrained vertices
//! that is n rings wide. Free vertices out of its reach have the solution zero and stay out of the factor, so that the
//! cost of binding depends on the deformed part, not on the loaded mesh.

use glam::DVec3;
use pliant_mesh::SurfaceVertex;

use super::demands::Demands;
use super::partition_warnings::{unheeded, warning_of_points, warnings_of_loose, warnings_of_unheld};
use super::strays::strays;
use crate::budget::bytes_of;
use crate::numerical::graph::Graph;
use crate::operators::triangulation::Triangulation;
use crate::region::boundary_problem::BoundaryProblem;
use crate::{BindError, Budget, ConstraintKind, Loose, Needs, Role, Warning};

/// The vertices by role, all lists ascending.
#[derive(Debug)]
pub(crate) struct Partition<'a> {
    /// The triangles of the method's operator.
    pub triangulation: Triangulation<'a>,
    /// Free vertices that some handle influences, and those of soft handles.
    pub solved: Vec<u32>,
    /// For a method of space: the vertices that are neither fixed nor on a part that follows, ascending.
    pub moving: Vec<u32>,
    /// The vertices of each handle.
    pub handles: Vec<Vec<u32>>,
    /// Each handle's weight, `None` if it is hard.
    pub soft: Vec<Option<f64>>,
    /// Components with a handle, ascending.
    pub driven: Vec<u32>,
    /// Components without a handle and without a fixed vertex that follow, ascending, and the way in which they do.
    pub following: Vec<(u32, Loose)>,
    /// For each component: whether it has a fixed vertex.
    pub held: Vec<bool>,
    /// The number of vertices with the role [`Role::Free`].
    pub free_count: usize,
    /// The budget of memory.
    pub budget: Budget,
    /// Sentences for a person about components.
    pub warnings: Vec<Warning>,
}

impl<'a> Partition<'a> {
    /// Sorts the vertices of a problem that was [checked](check).
    pub fn of(
        problem: &BoundaryProblem<'a>,
        demands: &Demands,
        triangulation: Triangulation<'a>,
    ) -> Result<Self, BindError> {
        let mut handles = vec![Vec::new(); problem.handle_count];
        let component_count = problem.topology.components().len();
        let mut held = vec![false; component_count];
        let mut driven = vec![false; component_count];
        let mut free_count = 0;
        let soft = soft_weights(problem, demands);
        for (vertex, &role) in problem.roles.iter().enumerate() {
            let component = problem.topology.component(SurfaceVertex(vertex as u32)) as usize;
            match role {
                Role::Fixed => held[component] = true,
                Role::Free => free_count += 1,
                // A spring on a bare point would have no effect: the point follows like others.
                Role::Handle(handle) if soft[usize::from(handle)].is_some() && is_bare(problem, demands, vertex) => {}
                Role::Handle(handle) => {
                    handles[usize::from(handle)].push(vertex as u32);
                    driven[component] = true;
                }
            }
        }
        if let Some(handle) = handles.iter().position(Vec::is_empty) {
            return Err(BindError::EmptyHandle { handle });
        }
        let indices = |test: &dyn Fn(usize) -> bool| {
            (0..component_count)
                .filter(|&c| test(c))
                .map(|c| c as u32)
                .collect::<Vec<_>>()
        };
        let loose_of = problem.loose_by_component();
        let (loose, mut warnings): (_, Vec<Warning>) = match demands.needs {
            // If nothing needs to be connected, only distant components are loose.
            Needs::Points => {
                let loose = strays(problem, &driven, &held);
                let warnings = warnings_of_loose(problem, &loose, &loose_of);
                (loose, warnings.into_iter().map(Warning::from).collect())
            }
            Needs::Surface { .. } => {
                let loose = indices(&|c| !held[c] && !driven[c]);
                let has_faces = |component: u32| problem.topology.components()[component as usize].face_count > 0;
                // Components of one vertex come last.
                let bare = loose.partition_point(|&component| has_faces(component));
                let unheld = indices(&|c| driven[c] && !held[c] && has_faces(c as u32));
                let of_loose = warnings_of_loose(problem, &loose[..bare], &loose_of)
                    .into_iter()
                    .map(Warning::from);
                let of_unheld = warnings_of_unheld(problem, &unheld, &handles);
                let of_points = warning_of_points(problem, &loose[bare..], &loose_of).map(Warning::from);
                (loose, of_loose.chain(of_unheld).chain(of_points).collect())
            }
        };
        let follows = |component: u32| match loose_of[component as usize] {
            Loose::Rest => None,
            how => (!handles.is_empty()).then_some((component, how)),
        };
        let moving = match demands.needs {
            Needs::Points => moving(problem, &loose),
            Needs::Surface { .. } => Vec::new(),
        };
        warnings.extend(unheeded(problem, demands));
        warnings.extend(triangulation.warning().map(Warning::from));
        Ok(Self {
            solved: solved(
                problem,
                demands,
                &triangulation,
                &handles,
                &soft,
                &led_by_examples(problem, demands, &held, &driven),
                &moving,
            ),
            moving,
            triangulation,
            following: loose.into_iter().filter_map(follows).collect(),
            handles,
            soft,
            driven: indices(&|c| driven[c]),
            held,
            free_count,
            budget: Budget::default(),
            warnings,
        })
    }
}

impl Partition<'_> {
    /// Sets the budget, less the tables that grow with the mesh, the data of every handle at every solved vertex, and
    /// the data of every pair of handles.
    ///
    /// # Errors
    /// [`BindError::Budget`] or [`BindError::Handles`] if these alone exceed it.
    /// `row_bytes` and `handle_row_bytes` are those of the method.
    pub fn take_budget(
        &mut self,
        vertex_count: usize,
        row_bytes: usize,
        handle_row_bytes: usize,
        budget: Budget,
    ) -> Result<(), BindError> {
        let (handles, solved) = (self.handles.len(), self.solved.len());
        let of_handles = bytes_of(handles, handle_row_bytes * solved).saturating_add(bytes_of(handles, PAIR * handles));
        let budget = budget.without(of_handles).map_err(|_| BindError::Handles {
            handle_count: handles,
            free_count: solved,
        })?;
        let of_tables = bytes_of(vertex_count, SURFACE_ROW).saturating_add(bytes_of(solved, row_bytes));
        self.budget = budget
            .without(of_tables)
            .map_err(|limit| BindError::budget(solved, limit))?;
        Ok(())
    }
}

/// Bytes of a surface vertex in all tables of a binding except the solver's: as allocated, measured by
/// `tests/memory.rs`.
const SURFACE_ROW: usize = 190;

/// Bytes of the energy's block of a pair of handles: 4 × 4 numbers.
const PAIR: usize = 128;

/// Checks that every table fits the surface and that every number is in its range.
pub(crate) fn check(problem: &BoundaryProblem) -> Result<(), BindError> {
    let expected = problem.surface.positions.len();
    for (table, found) in [
        ("the roles' table", problem.roles.len()),
        ("the stiffness table", problem.stiffness.len()),
    ] {
        if found != expected {
            return Err(BindError::Length { table, found, expected });
        }
    }
    problem.constraints.check(expected, problem.handle_count)?;
    for (vertex, role) in problem.roles.iter().enumerate() {
        if let Role::Handle(handle) = *role
            && usize::from(handle) >= problem.handle_count
        {
            return Err(BindError::UnknownHandle {
                vertex: vertex as u32,
                handle,
                handle_count: problem.handle_count,
            });
        }
    }
    for (vertex, &value) in problem.stiffness.iter().enumerate() {
        if !(value.is_finite() && value > 0.0) {
            return Err(BindError::Stiffness {
                vertex: vertex as u32,
                value,
            });
        }
    }
    match problem
        .surface
        .positions
        .iter()
        .position(|position| !position.is_finite())
    {
        Some(vertex) => Err(BindError::Position { vertex: vertex as u32 }),
        None => Ok(()),
    }
}

/// Each handle's weight, `None` if it is hard. A surface method holds a handle with only bare points hard, because its
/// springs would have no effect.
fn soft_weights(problem: &BoundaryProblem, demands: &Demands) -> Vec<Option<f64>> {
    let heeds_soft = demands.heeds.contains(&ConstraintKind::SoftHandles);
    let mut pulls = vec![false; problem.handle_count];
    for (vertex, role) in problem.roles.iter().enumerate() {
        if let Role::Handle(handle) = *role {
            pulls[usize::from(handle)] |= !is_bare(problem, demands, vertex);
        }
    }
    let weight = |handle: usize| problem.constraints.weight(handle as u16);
    (0..problem.handle_count)
        .map(|handle| weight(handle).filter(|_| heeds_soft && pulls[handle]))
        .collect()
}

/// The vertices that are neither fixed nor on these components, ascending.
fn moving(problem: &BoundaryProblem, strays: &[u32]) -> Vec<u32> {
    let is_stray = |vertex: u32| {
        let component = problem.topology.component(SurfaceVertex(vertex));
        strays.binary_search(&component).is_ok()
    };
    (0..)
        .zip(problem.roles)
        .filter(|(vertex, role)| **role != Role::Fixed && !is_stray(*vertex))
        .map(|(vertex, _)| vertex)
        .collect()
}

/// Returns true if a surface method does not solve for a vertex, because no triangle uses it.
fn is_bare(problem: &BoundaryProblem, demands: &Demands, vertex: usize) -> bool {
    let is_alone = || problem.topology.neighbours(SurfaceVertex(vertex as u32)).is_empty();
    demands.needs != Needs::Points && is_alone()
}

/// For each component: whether its free vertices are solved because an example moves it. If there are handles, a
/// component that nothing holds still follows the others.
fn led_by_examples(problem: &BoundaryProblem, demands: &Demands, held: &[bool], driven: &[bool]) -> Vec<bool> {
    let mut led = vec![false; held.len()];
    if !demands.examples_bend {
        return led;
    }
    for shape in problem.examples.iter().flat_map(|examples| &*examples.shapes) {
        for (vertex, displacement) in (0..).zip(&*shape.displacements) {
            let component = problem.topology.component(SurfaceVertex(vertex)) as usize;
            led[component] |= *displacement != DVec3::ZERO;
        }
    }
    for (component, led) in led.iter_mut().enumerate() {
        *led &= problem.handle_count == 0 || held[component] || driven[component];
    }
    led
}

/// The solved vertices, ascending. On a surface these are the free vertices that handles reach by walks without `reach`
/// successive constrained vertices, and those of the components `led` by examples; for points, all free ones. A soft
/// handle's vertices count as free.
fn solved(
    problem: &BoundaryProblem,
    demands: &Demands,
    triangulation: &Triangulation,
    handles: &[Vec<u32>],
    soft: &[Option<f64>],
    led: &[bool],
    moving: &[u32],
) -> Vec<u32> {
    let is_free = |vertex: usize| match problem.roles[vertex] {
        Role::Free => true,
        Role::Fixed => false,
        Role::Handle(handle) => soft[usize::from(handle)].is_some(),
    };
    let chosen = |is_chosen: &dyn Fn(usize) -> bool| {
        (0..problem.roles.len())
            .filter(|&vertex| is_chosen(vertex))
            .map(|vertex| vertex as u32)
            .collect()
    };
    let reach = match demands.needs {
        Needs::Points => {
            let moving = moving.iter().copied();
            return moving.filter(|&vertex| is_free(vertex as usize)).collect();
        }
        Needs::Surface { reach, .. } => reach,
    };
    // The number of further edges on a walk from here before it must meet a free vertex; `reach` at a reached one.
    let mut left = vec![0; problem.roles.len()];
    let mut queue: Vec<u32> = handles.iter().flatten().copied().collect();
    for &vertex in &queue {
        left[vertex as usize] = reach;
    }
    while let Some(vertex) = queue.pop() {
        let beyond = left[vertex as usize] - 1;
        for &next in triangulation.neighbours(SurfaceVertex(vertex)) {
            let allowed = if is_free(next.index()) { reach } else { beyond };
            if allowed > left[next.index()] {
                left[next.index()] = allowed;
                queue.push(next.0);
            }
        }
    }
    let is_led = |vertex: usize| led[problem.topology.component(SurfaceVertex(vertex as u32)) as usize];
    chosen(&|vertex| (left[vertex] > 0 || is_led(vertex)) && is_free(vertex) && !is_bare(problem, demands, vertex))
}
