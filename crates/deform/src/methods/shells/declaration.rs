//! Declares discrete shells as one of the methods.

use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::Cancel;

use super::coarse::Coarse;
use super::elements::Elements;
use super::lead::Led;
use super::{Descent, Lead, Shells, ShellsSolver};
use crate::attachment::{AttachmentDeclaration, AttachmentKind};
use crate::descent::prescribed::Prescribed;
use crate::handles::finite::Finite;
use crate::handles::offsets::Offsets;
use crate::handles::turns::Followed;
use crate::handles::{Motion, clear};
use crate::method::{BindInput, BoundMethod, DeformMethod, MethodDeclaration, Stepped};
use crate::needs::{ConstraintKind, Needs, Solve};
use crate::{BindError, OptionSlider, Picture, SolveError};

/// The attachment's name.
pub(super) const EXAMPLES: &str = "examples";

/// The bending of materials.
const PAPER_TO_RUBBER: OptionSlider = OptionSlider {
    option: "bending",
    ends: ["Paper", "rubber"],
    range: Shells::PAPER_TO_RUBBER,
    help: "Paper keeps its lengths and creases; thick rubber bends evenly and stretches. The slider sets `bending`.",
};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "shells",
    title: "Cloth",
    paper: "discrete shells",
    when_to_use: "Keeps the surface's lengths and angles and, if you wish, its volume, step by step: for skin, sheets \
                  and balloons, from paper, which creases (`bending` 1e-6), to thick rubber, which bends evenly \
                  (1e-2). Poses that you keep as examples guide it, and their weights alone blend shapes along arcs.",
    keywords: "skin discrete shells nonlinear thin shell paper cloth rubber balloon volume isometric developable examples pose blend interpolation grinspun",
    picture: Picture::Triangles,
    slider: Some(&PAPER_TO_RUBBER),
    options: Shells::OPTIONS,
    attachments: &[AttachmentDeclaration {
        name: EXAMPLES,
        title: "examples",
        help: "further shapes of the same vertices and triangles, whose lengths, angles, areas and volumes the \
               surface may take on: a list with the `file` or the `morph_target` of each and its `weight`, 0 for rest \
               and 1 for the example; the solver finds a weight that is left out",
        kind: AttachmentKind::Shapes,
    }],
    heeds: &[ConstraintKind::SoftHandles, ConstraintKind::Stiffness],
    default: || Shells::default().into(),
    first_choice: || Shells::default().into(),
};

impl DeformMethod for Shells {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    fn counts_in_sizes(&self) -> Option<(&'static str, i32)> {
        Some(("bending", 2))
    }

    /// Like ARAP, the surface gives way where it twists most.
    fn follows_turns(&self) -> Option<Followed> {
        Some(Followed::by_necks(125.0))
    }

    fn resists_collapse(&self) -> bool {
        true
    }

    fn turns_by_moves(&self) -> bool {
        true
    }

    fn needs(&self) -> Needs {
        Needs::Surface {
            // A hinge joins the two vertices across its edge, which may both be constrained.
            reach: 2,
            // The elimination orders the hinges' own graph.
            ordering_power: None,
        }
    }

    fn solve(&self) -> Solve {
        Solve::Iterative {
            max_iterations: self.max_iterations,
        }
    }

    fn row_bytes(&self) -> usize {
        1500
    }

    fn takes_places(&self) -> bool {
        true
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        let &BindInput {
            problem,
            partition,
            handles,
            progress,
            cancel,
            ..
        } = input;
        let led_by = |coarse| -> Lead<'_> { Box::new(move |means| Box::new(Led::new(coarse, means))) };
        let coarse = |fine: &Elements, budget| {
            Coarse::of(problem, self, handles, &partition.solved, fine, budget, cancel).map(led_by)
        };
        let solver = ShellsSolver::bind_led(problem, self, partition, handles, progress, cancel, coarse)?;
        Ok(Box::new(solver))
    }
}

impl BoundMethod for ShellsSolver {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        clear(displacements);
        Prescribed::write(&self.prescribed, motions, displacements);
        let mut outcome = (true, 0.0);
        // The whole step enters the pool once: otherwise each of the many short loops would wait for it.
        rayon::scope(|_| outcome = self.advance(motions));
        let elements = &self.energy.elements;
        let solved = &elements.vertices[..elements.solved_count];
        let placed = self.placed();
        let own = placed.as_ref().unwrap_or(&self.shown().displacements);
        for (&vertex, displacement) in solved.iter().zip(own) {
            displacements[vertex as usize] = *displacement;
        }
        let (converged, energy) = outcome;
        Ok(Stepped {
            converged,
            stalled: self.has_stalled && self.rival.first().is_none(),
            energy,
            finite: Finite::Unknown,
        })
    }

    fn set_offsets(&mut self, offsets: &Arc<Offsets>) {
        ShellsSolver::set_offsets(self, offsets);
    }

    fn set_cancel(&mut self, cancel: &Cancel) {
        if let Some(Descent::Led(led)) = &mut self.descent {
            led.set_cancel(cancel);
        }
    }

    fn rest(&mut self) {
        self.rival.end();
        self.back_to_rest();
    }

    fn energy_of(&self, motions: &[Motion], displacements: &[DVec3]) -> Option<f64> {
        let mut springs = self.energy.springs.clone();
        springs.aim(motions);
        let mut shape = self.shown().clone();
        for (own, &vertex) in shape.displacements.iter_mut().zip(&self.energy.elements.vertices) {
            *own = displacements[vertex as usize];
        }
        self.energy.evaluate(&mut shape, &springs);
        Some(shape.energy * self.energy.unit)
    }

    fn set_weights(&mut self, weights: &[Option<f64>]) {
        self.give(weights);
    }

    fn weights(&self) -> &[f64] {
        &self.shown().weights
    }

    fn solved_count(&self) -> usize {
        self.energy.elements.solved_count
    }

    fn factor_len(&self) -> usize {
        self.stored()
    }

    /// A Newton step factors: 6·10¹⁰ operations take about as long as cheap steps of three million vertices.
    fn step_cost(&self) -> usize {
        let solved = self.energy.elements.solved_count;
        match &self.descent {
            Some(Descent::Newton(system)) => 20 * solved + (5e-5 * system.work()) as usize,
            Some(Descent::Led(led)) if led.is_settling() => 20 * solved,
            Some(Descent::Led(_)) | None => 5 * solved,
        }
    }

    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }
}
