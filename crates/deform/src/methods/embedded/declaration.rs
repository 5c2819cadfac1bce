//! Embedded deformation as one of the methods.

use glam::{DVec3, Mat3};

use super::Embedded;
use super::energy::{Energy, constrained};
use super::graph::{Graph, NEAREST};
use super::solver::Solver;
use super::system::System;
use crate::budget::bytes_of;
use crate::handles::Motion;
use crate::handles::finite::Finite;
use crate::handles::turns::Followed;
use crate::method::{BindInput, BoundMethod, DeformMethod, MethodDeclaration, Stepped};
use crate::needs::{ConstraintKind, Needs, Solve};
use crate::region::nodes::spread_alike;
use crate::space::blend::{Affine, Blend, Share};
use crate::space::shaping::shaping;
use crate::sparse::system_error::SystemError;
use crate::{BindError, Picture, SolveError};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "embedded",
    title: "Loose parts",
    paper: "embedded graph",
    when_to_use: "Bends a few hundred nodes as rigidly as possible, step by step, and moves everything around them \
                  along: for large bends of large scans, and of loose or broken pieces.",
    keywords: "embedded deformation graph nodes sumner rigid nonlinear space points soup",
    picture: Picture::Graph,
    slider: None,
    options: Embedded::OPTIONS,
    attachments: &[],
    heeds: &[ConstraintKind::SoftHandles, ConstraintKind::Stiffness],
    default: || Embedded::default().into(),
    first_choice: || Embedded::default().into(),
};

/// Bytes of a pair of nodes: their shared sums, and the dense matrix of the handles' weights with its factor.
const NODE_PAIR: usize = size_of::<[f64; 2]>() + 2 * size_of::<f64>();

/// The reach over which the nodes' misses are blended out, and within which fixed vertices hold nodes, in mean
/// distances of nodes.
const REACH: f64 = 1.0;

/// The bound method.
#[derive(Debug)]
pub(super) struct BoundEmbedded {
    graph: Graph,
    pub solver: Solver,
    blend: Blend,
    /// The nodes' motions in the last step.
    affine: Vec<Affine>,
}

impl DeformMethod for Embedded {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    /// Nodes may stretch, and near half a turn that costs less than turning.
    fn follows_turns(&self) -> Option<Followed> {
        Some(Followed::by_necks(95.0))
    }

    fn needs(&self) -> Needs {
        Needs::Points
    }

    fn solve(&self) -> Solve {
        Solve::Iterative {
            max_iterations: self.max_iterations,
        }
    }

    fn row_bytes(&self) -> usize {
        // Up to this many shares of nodes, twice while the graph is made, and those of the handles nearby.
        300 + (14 + 2 * NEAREST) * size_of::<Share>()
    }

    fn handle_row_bytes(&self) -> usize {
        0
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        Ok(Box::new(bound(self, input)?))
    }
}

/// Spreads and joins the nodes, analyses the matrix and weighs every vertex.
pub(super) fn bound(options: &Embedded, input: &BindInput<'_>) -> Result<BoundEmbedded, BindError> {
    let positions = &input.problem.surface.positions;
    let moving = shaping(input.problem, input.partition.moving.iter().copied());
    let most = (options.nodes as usize).min(moving.len());
    let budget = input.partition.budget.without(bytes_of(most * most, NODE_PAIR));
    let budget = budget.map_err(|limit| BindError::budget(input.partition.solved.len(), limit))?;
    let nodes = spread_alike(input.problem, &moving, most);
    input.progress.set(0.2);
    // Fixed vertices hold the nodes that are about as near to them as to each other.
    let spacing = spacing(&nodes.vertices, positions);
    let sets = constrained(input, &moving, REACH * spacing);
    let places: Vec<DVec3> = sets.iter().flat_map(|set| set.places(positions)).collect();
    let graph = Graph::of(input, &nodes, &moving, &places)?;
    input.progress.set(0.5);
    let energy = Energy::of(input, &graph, &sets);
    let refused = |error| {
        let free_count = input.partition.solved.len();
        SystemError::of_definite(error).into_bind_error(input.problem.topology, free_count)
    };
    let system = System::of(&energy, &graph, budget).map_err(refused)?;
    let is_held = energy.constraints.iter().any(|constraint| constraint.handle.is_none());
    let solver = Solver::of(energy, system, &graph, input.handles, is_held, options.tolerance);
    input.progress.set(0.7);
    let blend = Blend::bind(input, REACH * graph.world_unit, |place| graph.influence(place))?;
    input.progress.set(1.0);
    Ok(BoundEmbedded {
        affine: solver.affine(&graph),
        graph,
        solver,
        blend,
    })
}

/// The mean distance of nodes to their nearest one, in world units.
fn spacing(nodes: &[u32], positions: &[DVec3]) -> f64 {
    let places: Vec<DVec3> = nodes.iter().map(|&node| positions[node as usize]).collect();
    let tree = crate::space::neighbours::Neighbours::of(&places);
    let nearest = places
        .iter()
        .filter_map(|&place| tree.nearest(place, 2).get(1).map(|(_, distance)| *distance));
    nearest.sum::<f64>() / places.len().max(1) as f64
}

impl BoundMethod for BoundEmbedded {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        let (converged, energy) = self.solver.step(motions);
        self.affine = self.solver.affine(&self.graph);
        let finite = self.blend.frame(&self.affine, motions, displacements);
        Ok(Stepped {
            converged,
            stalled: self.solver.has_stalled(),
            energy,
            finite: if energy.is_finite() { finite } else { Finite::Unknown },
        })
    }

    fn rest(&mut self) {
        self.solver.rest();
    }

    fn jacobians(&self, motions: &[Motion], out: &mut [Mat3]) -> bool {
        self.blend.jacobians(&self.affine, motions, out);
        true
    }

    fn solved_count(&self) -> usize {
        self.blend.row_count()
    }

    fn factor_len(&self) -> usize {
        self.solver.stored()
    }

    fn step_cost(&self) -> usize {
        self.blend.row_count() + 500 * self.graph.world_nodes.len()
    }
}
