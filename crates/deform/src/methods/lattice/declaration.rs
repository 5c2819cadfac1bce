//! The lattice as one of the methods.

use std::f64::consts::PI;

use glam::{DVec3, Mat3};

use super::fit::{fit_bytes, fitted, soft_unit};
use super::grid::Grid;
use super::{Lattice, brought};
use crate::attachment::{Attachment, AttachmentDeclaration, AttachmentKind, ControlLattice};
use crate::attachment_refused::AttachmentRefused;
use crate::handles::Motion;
use crate::handles::controls::{Controls, Hand, hand_bytes};
use crate::handles::finite::Finite;
use crate::handles::turns::Followed;
use crate::method::{BindInput, BoundMethod, DeformMethod, MethodDeclaration, Stepped};
use crate::needs::{ConstraintKind, HandleFit, Needs, Solve};
use crate::space::affine::AffineParts;
use crate::space::falloff::Falloff;
use crate::space::field::{Coefficients, FIELD_ROW, LinearField, SpaceMap, moving};
use crate::space::fit_samples::{RegionBox, holds, samples};
use crate::space::hand_field::HandField;
use crate::{BindError, Picture, SolveError};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "lattice",
    title: "Lattice",
    paper: "free-form deformation",
    when_to_use: "Bends a box around the surface by a coarse lattice: for broad, soft bends and stretches of \
                  everything inside it, including loose pieces. The lattice fits the handles closely, not exactly.",
    keywords: "lattice ffd free-form deformation box spline space",
    picture: Picture::Lattice,
    slider: None,
    options: Lattice::OPTIONS,
    attachments: &[AttachmentDeclaration {
        name: "lattice",
        title: "lattice",
        help: "a lattice of your own: its `counts` of control points along x, y and z, its `box` with `min` and \
               `max`, and the positions to which its points are `moved`, x running fastest; without it, one around \
               the region with the cells of `resolution`",
        kind: AttachmentKind::ControlLattice,
    }],
    heeds: &[ConstraintKind::SoftHandles],
    default: || Lattice::default().into(),
    first_choice: || Lattice::first_choice().into(),
};

/// The most samples of a handle, or of the fixed vertices.
const SAMPLES: usize = 20_000;

/// The bound method.
#[derive(Debug)]
struct BoundLattice {
    field: LinearField,
    controls: Controls,
    /// The position of the control points, if a person brought the lattice.
    by_hand: Option<HandField<Grid>>,
    solved_count: usize,
    warnings: Vec<String>,
}

/// The field of the control points' displacements.
struct LatticeMap<'a> {
    grid: &'a Grid,
    /// Row-major: one entry per control point and handle.
    controls: &'a [[f64; 4]],
    handle_count: usize,
}

impl SpaceMap for LatticeMap<'_> {
    fn coefficients(&self, world_points: &[DVec3], out: &mut [Coefficients]) {
        let count = self.handle_count;
        for (&point, out) in world_points.iter().zip(out.chunks_exact_mut(count)) {
            self.grid.weights(point, |control, weight, gradient| {
                let controls = &self.controls[control * count..][..count];
                for (out, control) in out.iter_mut().zip(controls) {
                    for k in 0..4 {
                        out.value[k] += weight * control[k];
                        out.gradient[k] += gradient * control[k];
                    }
                }
            });
        }
    }
}

impl DeformMethod for Lattice {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    /// Between two turns it is their mean, which is narrower by the cosine of half the angle.
    fn follows_turns(&self) -> Option<Followed> {
        Some(Followed::by_limbs(90.0))
    }

    fn needs(&self) -> Needs {
        Needs::Points
    }

    fn solve(&self) -> Solve {
        Solve::Direct
    }

    fn handle_fit(&self) -> HandleFit {
        HandleFit::LeastSquares
    }

    fn handle_row_bytes(&self) -> usize {
        FIELD_ROW
    }

    fn lattice_points(&self, lattice: &ControlLattice) -> Vec<DVec3> {
        brought::points(self, lattice)
    }

    fn check_attachment(&self, attachment: &Attachment) -> Result<(), AttachmentRefused> {
        brought::check(self, attachment)
    }

    fn largest_gap_rad(&self) -> f64 {
        PI
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        let within = RegionBox::of(input);
        let lattice = match input.attachment {
            Some(Attachment::Lattice(lattice)) => lattice.clone(),
            _ => brought::made(self, &within),
        };
        let is_brought = input.attachment.is_some();
        let grid = brought::grid(self, &lattice);
        let solved_count = input.partition.solved.len();
        let of_hand = if is_brought { hand_bytes(grid.count()) } else { 0 };
        let bytes = fit_bytes(&grid, input.handles.len()) + of_hand;
        let budget = input.partition.budget.without(bytes);
        budget.map_err(|limit| BindError::budget(solved_count, limit))?;
        let samples = samples(input, &within, soft_unit(&grid, self.norm), SAMPLES);
        let affine = AffineParts::fitted(&samples, input.handles, within.middle(), within.diagonal);
        input.progress.set(0.1);
        let handles = (input.handles, &*input.partition.soft);
        let controls = fitted(&grid, self.norm, &samples, handles, &affine, input.cancel)?;
        input.progress.set(0.5);
        let vertices = moving(HandleFit::LeastSquares, input);
        let falloff = Falloff::of(input.problem, &vertices, self.falloff * within.diagonal);
        let map = LatticeMap {
            grid: &grid,
            controls: &controls,
            handle_count: input.handles.len(),
        };
        let field = LinearField::bind(&map, &falloff, HandleFit::LeastSquares, input)?;
        let positions = &input.problem.surface.positions;
        let world_points: Vec<DVec3> = vertices.iter().map(|&vertex| positions[vertex as usize]).collect();
        let warnings = if is_brought {
            outside(&lattice, &world_points)
        } else {
            None
        };
        let hand = is_brought.then(|| {
            Hand::new(grid.count(), &holds(&samples), |sample, visit| {
                grid.weights(samples[sample].world_point, |control, weight, _| visit(control, weight));
            })
        });
        let by_hand = is_brought.then(|| HandField::new(grid, vertices, world_points, falloff));
        input.progress.set(1.0);
        Ok(Box::new(BoundLattice {
            field,
            controls: Controls {
                rest: brought::points(self, &lattice),
                attachment: Attachment::Lattice(lattice),
                driven: controls,
                hand,
            },
            by_hand,
            solved_count,
            warnings: warnings.into_iter().collect(),
        }))
    }
}

/// A sentence about points outside of a lattice's box, where its outermost polynomials continue.
fn outside(lattice: &ControlLattice, world_points: &[DVec3]) -> Option<String> {
    let is_in = |point: &&DVec3| point.cmpge(lattice.low).all() && point.cmple(lattice.high).all();
    let count = world_points.len() - world_points.iter().filter(is_in).count();
    (count > 0).then(|| {
        format!("{count} vertices lie outside the lattice's box and may move against it: enlarge the box around them")
    })
}

impl BoundMethod for BoundLattice {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        let mut finite = self.field.frame(motions, displacements);
        if let (Some(by_hand), Some(moves)) = (&self.by_hand, self.controls.corrected()) {
            by_hand.add(moves, displacements);
            finite = Finite::Unknown;
        }
        Ok(Stepped::at_once(0.0, finite))
    }

    fn jacobians(&self, motions: &[Motion], out: &mut [Mat3]) -> bool {
        self.field.jacobians(motions, out);
        if let (Some(by_hand), Some(moves)) = (&self.by_hand, self.controls.corrected()) {
            by_hand.add_jacobians(moves, out);
        }
        true
    }

    fn controls(&self) -> Option<&Controls> {
        Some(&self.controls)
    }

    fn controls_mut(&mut self) -> Option<&mut Controls> {
        Some(&mut self.controls)
    }

    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    fn solved_count(&self) -> usize {
        self.solved_count
    }
}
