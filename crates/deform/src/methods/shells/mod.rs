//! Discrete shells [GHDS03]: a surface keeps the lengths of its edges, the angles at them, its triangles' areas and, if
//! wished, its enclosed volume. [FB11] minimises the energy by Gauss–Newton; here Newton's method does, with the
//! elements' exact Hessians.
//!
//! E = ½ Σ_e k_s s_e A_e (l_e / l̄_e − 1)² + ½ Σ_t k_a k_s s_t Ā_t (A_t / Ā_t − 1)²
//!   + ½ Σ_e k_b D² s_e (l̄_e² / A_e) (θ_e − θ̄_e)² + ½ Σ_c k_v A_c (V_c / V̄_c − 1)²
//!
//! over the edges e, the triangles t and the closed components c: l is an edge's length, θ the angle between the
//! normals of its two triangles, A_t a triangle's area, V a component's volume, and the bar marks the rest shape. A_e
//! is a third of the areas of the edge's triangles, as in [GHDS03] and [SHHR20], so that the energy hardly depends on
//! the mesh; A_c is a component's area, D the size of the bending region, and s_e and s_t are the means of the painted
//! stiffness of the edge's ends and the triangle's corners. k_s, k_b and k_v are the options `stretching`, `bending`
//! and `volume`. k_a = 1/4: [FB11] omits the areas of [GHDS03], but edges alone are a truss, in which compressed
//! triangles give way within their plane until they have no area. Compressed triangles resist without bound, by a
//! barrier (`face`).
//!
//! The angle is followed from step to step (`hinge`), so that it does not jump where a fold passes half a turn, and a
//! surface that went through itself returns. An edge at a border has no angle. Where more than two triangles meet at an
//! edge, each pair of them has one, weaker in proportion, so that each triangle is held as firmly as at any other edge;
//! where very many meet, each is paired only with the largest.
//!
//! Newton steps use a matrix as close to the Hessian as remains positive definite (`system`). Its pattern is analysed
//! once. The volume's gradient would fill the matrix: it stays outside and enters by the formula of Sherman and
//! Morrison, component by component, since components do not meet in the matrix. A line search on the true energy ends
//! each step, so the energy never rises; where no length lowers it, the diagonal is raised [NW06, section 10.3].
//!
//! Examples change the targets l̄, θ̄, Ā and V̄ by weights that are given or found (`examples`, `leaning`). If they
//! alone move a part, `frames` places it.
//!
//! Parts: `elements` defines the edges, hinges and triangles, `hinge` the angle and its gradient, `face` the area's
//! gradient and barrier, `curvature` their second derivatives, `enclosed` the volumes, `springs` the soft handles,
//! `shape` the positions and their energy, `system` the matrix, and `unfolded` a quadratic energy that gives the
//! handles' weights. `start` chooses the first shape for new targets, `blended` gives the one for examples, and
//! `descent` takes a step. At the end of a drag a `second` descent begins from rest. A large surface has a `coarse` level that takes the `lead`; `carry` transfers its motion.

mod blended;
mod carry;
mod coarse;
mod curvature;
mod declaration;
mod descent;
mod elements;
mod enclosed;
mod examples;
mod face;
mod first;
mod frames;
mod hinge;
mod lead;
mod leaning;
mod options;
mod rounding;
mod second;
mod shape;
mod springs;
mod start;
mod system;
mod unfolded;

use std::fmt::Debug;

use glam::DVec3;
use pliant_mesh::{Cancel, Progress};

pub(crate) use self::declaration::DECLARATION;
pub use self::options::Shells;

use self::blended::Turns;
use self::carry::Carrier;
use self::elements::Elements;
use self::examples::Examples;
use self::first::First;
use self::rounding::rounding;
use self::shape::{Energy, Shape, Slopes};
use self::system::{Pattern, System};
use self::unfolded::{Preconditioner, Unfolded};
use crate::budget::bytes_of;
use crate::descent::prescribed::Prescribed;
use crate::descent::rival::{Rival, aim, compare};
use crate::handles::blend::HandleFrame;
use crate::handles::offsets::Offsets;
use crate::handles::{Handle, Motion};
use crate::numerical::lbfgs::Memory;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;
use crate::region::slender;
use crate::sparse::system_error::SystemError;
use crate::{BindError, Budget};

/// Bytes of a solved vertex in the tables of a led surface: shares, turns, factors, positions, and the last steps with
/// their changes.
const LED_ROW: usize = 900;

/// The bound method with its present shape.
#[derive(Debug)]
pub(crate) struct ShellsSolver {
    energy: Energy,
    /// Energies below this are rounding.
    nothing: f64,
    /// None while it acts.
    descent: Option<Descent>,
    /// The data for starts from examples, if there are any.
    blending: Option<Blending>,
    /// The last steps.
    memory: Memory,
    /// The handles' weights, one row a solved vertex.
    weights: Vec<f64>,
    /// The handles relative to the solver's origin.
    handles: Vec<HandleFrame>,
    /// For each hard handle its surface vertices with their coordinates.
    prescribed: Vec<Vec<Prescribed>>,
    motions: Vec<Motion>,
    current: Shape,
    trial: Shape,
    slopes: Slopes,
    /// True if these are the gradients at the current shape.
    has_slopes: bool,
    has_converged: bool,
    /// True if no step was found that lowers the energy, though the shape has not converged.
    has_stalled: bool,
    /// True if other weights of examples were set since the last step.
    has_other_weights: bool,
    /// True if the offsets of handles' vertices changed since the last step.
    has_other_offsets: bool,
    tolerance: f64,
    rival: Rival<First>,
    warnings: Vec<String>,
}

/// The method that finds steps.
#[derive(Debug)]
enum Descent {
    /// Newton's method, with a factor of the whole matrix.
    Newton(Box<System>),
    /// A coarse level leads.
    Led(Box<dyn Leader>),
}

/// A coarse level that takes the lead of a large surface (`lead`).
trait Leader: Debug + Send + Sync {
    /// Makes the shape for new motions.
    fn start(&mut self, solver: &mut ShellsSolver, motions: &[Motion]);

    /// Takes a step towards unchanged motions.
    fn step(&mut self, solver: &mut ShellsSolver);

    /// Returns to the rest shape.
    fn rest(&mut self);

    /// See [`ShellsSolver::give`].
    fn set_weights(&mut self, weights: &[Option<f64>]);

    /// See [`ShellsSolver::set_offsets`].
    fn set_offsets(&mut self, offsets: &Offsets);

    /// Sets the flag that ends a Newton step.
    fn set_cancel(&mut self, cancel: &Cancel);

    /// True if the next step is a Newton step, if there is memory for one.
    fn is_settling(&self) -> bool;

    /// The number of entries that its factors store.
    fn stored(&self) -> usize;
}

/// The data of the fine surface that a leader takes over from the binding.
struct Means {
    preconditioner: Preconditioner,
    carrier: Carrier,
    /// The pattern of the surface's own matrix, the ends of its supernodes, and the memory that it may take; `None` if
    /// there is none left.
    matrix: Option<(Pattern, Vec<u32>, Budget)>,
}

/// Gives a coarse level the lead.
type Lead<'a> = Box<dyn FnOnce(Means) -> Box<dyn Leader> + 'a>;

/// The data for a start from examples.
#[derive(Debug)]
struct Blending {
    turns: Turns,
    carrier: Carrier,
    /// None while a coarse level leads, which has its own.
    preconditioner: Option<Preconditioner>,
}

impl ShellsSolver {
    /// Collects edges and hinges, analyses the matrix, and solves for the weights of `handles`.
    pub fn bind(
        problem: &BoundaryProblem,
        options: &Shells,
        partition: &Partition,
        handles: &[Handle],
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, BindError> {
        Self::bind_led(problem, options, partition, handles, progress, cancel, |_, _| None)
    }

    /// Like [`ShellsSolver::bind`], but a large surface is led if `coarse` gives a level.
    fn bind_led<'a>(
        problem: &BoundaryProblem,
        options: &Shells,
        partition: &Partition,
        handles: &[Handle],
        progress: &Progress,
        cancel: &Cancel,
        coarse: impl FnOnce(&Elements, Budget) -> Option<Lead<'a>>,
    ) -> Result<Self, BindError> {
        // They bend like the prisms, and are refined as little.
        let most = slender::MOST_EDGES_OF_PRISMS;
        slender::check(&partition.triangulation, &partition.solved, most, None)?;
        let world_origin = handles.first().map_or(DVec3::ZERO, |handle| handle.world_centre);
        let (elements, ends) = Elements::of(problem, options, &partition.solved, world_origin, cancel)?;
        cancel.check()?;
        progress.set(0.3);
        let free_count = partition.free_count;
        let energy = Energy::of(problem, options, partition, handles, elements);
        let elements = &energy.elements;
        let refused = |error| {
            SystemError::of(error, |local| elements.vertices[local]).into_bind_error(problem.topology, free_count)
        };
        let is_led = elements.solved_count > options.led_above;
        let examples = energy.examples.count();
        let row = examples * Examples::ROW + if is_led { LED_ROW } else { 0 };
        let kept = bytes_of(elements.hinges.len(), size_of::<[DVec3; 4]>())
            .saturating_add(bytes_of(
                elements.faces.len(),
                size_of::<[DVec3; 3]>() + size_of::<f64>(),
            ))
            .saturating_add(bytes_of(elements.solved_count, row));
        let budget = partition.budget.without(kept);
        let budget = budget.map_err(|limit| BindError::budget(free_count, limit))?;
        let pattern = Pattern::of(elements);
        progress.set(0.4);
        let lead = is_led.then(|| coarse(elements, budget)).flatten();
        cancel.check()?;
        let (system, budget) = match lead {
            None => System::of(&pattern, &ends, budget)
                .map(|(system, budget)| (Some(system), budget))
                .map_err(refused)?,
            Some(_) => (None, budget),
        };
        cancel.check()?;
        progress.set(0.6);
        // The budget must also hold a copy of its factor.
        let unfolded = Unfolded::of(&energy, &pattern, &ends, budget.shared_by(1.5), cancel).map_err(refused)?;
        let weights = unfolded.weights(problem, partition, &energy, cancel).map_err(refused)?;
        let mut blending = (examples > 0).then(|| Blending {
            turns: Turns::of(&energy),
            carrier: Carrier::of(&energy),
            preconditioner: None,
        });
        let descent = match (lead, system) {
            (Some(lead), _) => {
                let preconditioner = unfolded.preconditioner().map_err(refused)?;
                let carrier = Carrier::of(&energy);
                let left = budget.without(bytes_of(preconditioner.stored(), size_of::<f64>()));
                Descent::Led(lead(Means {
                    preconditioner,
                    carrier,
                    matrix: left.ok().map(|left| (pattern, ends, left)),
                }))
            }
            (None, Some(system)) => {
                if let Some(blending) = &mut blending {
                    blending.preconditioner = Some(unfolded.preconditioner().map_err(refused)?);
                }
                Descent::Newton(Box::new(system))
            }
            (None, None) => return Err(BindError::OutOfMemory { free_count }),
        };
        progress.set(1.0);
        let reach = world_origin.abs().max_element() + problem.size();
        let nothing = rounding(energy.elements.area, reach, problem.size());
        let current = energy.at_rest();
        let local_of = energy.elements.local_of(problem.roles.len());
        let prescribed = Prescribed::of(handles, &partition.soft, &problem.surface.positions, &local_of);
        Ok(Self {
            trial: current.clone(),
            current,
            slopes: Slopes::default(),
            has_slopes: false,
            weights,
            handles: HandleFrame::of_all(handles, world_origin),
            prescribed,
            motions: vec![Motion::default(); handles.len()],
            has_converged: true,
            has_stalled: false,
            has_other_weights: false,
            has_other_offsets: false,
            tolerance: options.tolerance,
            rival: Rival::default(),
            warnings: warnings(options, &energy),
            descent: Some(descent),
            blending,
            memory: Memory::default(),
            nothing,
            energy,
        })
    }

    /// Takes one step towards `motions`. Returns true if it converged, and the energy.
    pub fn advance(&mut self, motions: &[Motion]) -> (bool, f64) {
        let has_other_weights = std::mem::take(&mut self.has_other_weights);
        let has_other_offsets = std::mem::take(&mut self.has_other_offsets);
        if self.motions != motions || has_other_weights || has_other_offsets {
            aim(self, motions);
            self.has_stalled = false;
            self.head_for(motions);
        } else if !self.has_converged && !self.has_stalled {
            self.descend();
        }
        compare(self);
        let energy = self.shown().energy;
        if !energy.is_finite() {
            // The shape is refused; the next targets start from rest.
            self.back_to_rest();
        }
        // The second descent may have ended with its first step.
        let is_over = self.rival.first().is_none();
        (self.has_converged && is_over, energy * self.energy.unit)
    }

    /// Sets the weights of the examples; the next step approaches them.
    pub fn give(&mut self, weights: &[Option<f64>]) {
        self.energy.examples.give(weights);
        self.has_other_weights = true;
        if let Some(Descent::Led(led)) = &mut self.descent {
            led.set_weights(weights);
        }
    }

    /// Sets the offsets of handles' vertices from the motions; then the next step has new targets.
    pub fn set_offsets(&mut self, offsets: &Offsets) {
        for vertex in self.prescribed.iter_mut().flatten() {
            vertex.set_offset(offsets);
        }
        self.energy.springs.set_offsets(offsets);
        self.has_other_offsets = true;
        if let Some(Descent::Led(led)) = &mut self.descent {
            led.set_offsets(offsets);
        }
    }

    /// The solved vertices' displacements, with the components that nothing holds placed by their frames; `None` if
    /// there are no such components.
    pub fn placed(&self) -> Option<Vec<DVec3>> {
        let Energy { frames, elements, .. } = &self.energy;
        let shown = self.shown();
        let mut placed = (!frames.is_empty()).then(|| shown.displacements.clone());
        if let Some(placed) = &mut placed {
            for frame in frames {
                frame.place(&elements.rest, &shown.weights, placed);
            }
        }
        placed
    }

    /// True if neither a handle nor an example moves the present shape.
    fn is_at_rest(&self) -> bool {
        let has_places = self.prescribed.iter().flatten().any(Prescribed::has_offset);
        !has_places
            && self.motions.iter().all(Motion::is_rest)
            && self.current.weights.iter().all(|weight| *weight == 0.0)
    }

    /// The count of numbers that its factors store.
    pub fn stored(&self) -> usize {
        let of_blending = self.blending.as_ref().and_then(|own| own.preconditioner.as_ref());
        let of_descent = match &self.descent {
            Some(Descent::Newton(system)) => system.stored(),
            Some(Descent::Led(led)) => led.stored(),
            None => 0,
        };
        of_descent + of_blending.map_or(0, Preconditioner::stored)
    }

    /// Makes the first shape for new motions: a start and a step, or the prediction of the coarse level.
    fn head_for(&mut self, motions: &[Motion]) {
        let Some(mut descent) = self.descent.take() else {
            return;
        };
        if let Descent::Led(led) = &mut descent {
            led.start(self, motions);
            self.descent = Some(descent);
            return;
        }
        self.descent = Some(descent);
        self.start(motions);
        self.descend();
    }

    /// Returns to the rest shape, where no handle moves.
    pub fn back_to_rest(&mut self) {
        self.motions.fill(Motion::default());
        self.energy.springs.aim(&self.motions);
        self.energy.springs.loads.clear();
        self.energy.rest(&mut self.current);
        self.memory.clear();
        self.has_slopes = false;
        match &mut self.descent {
            Some(Descent::Newton(system)) => system.undamp(),
            Some(Descent::Led(led)) => led.rest(),
            None => {}
        }
        self.has_converged = true;
        self.has_stalled = false;
        self.has_other_weights = self.energy.examples.given().any(|weight| weight != 0.0);
    }
}

fn warnings(options: &Shells, energy: &Energy) -> Vec<String> {
    let mut sentences = Vec::new();
    if options.volume > 0.0 && energy.enclosed.parts.is_empty() {
        let sentence = "no bent part is closed, so there is no volume to keep: `volume` has no effect";
        sentences.push(sentence.to_owned());
    }
    sentences.extend(crate::operators::repairs(energy.elements.flat_faces));
    sentences
}
