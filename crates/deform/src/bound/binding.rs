//! Binding a problem: everything that does not depend on the handles' transforms.

use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::{Cancel, Progress};

use super::sections::Split;
use super::slivers::Slivers;
use super::{Bound, RigidParts};
use crate::budget::bytes_of;
use crate::handles::residual::HandleResidual;
use crate::handles::turns::{TurnLimit, ends_among};
use crate::handles::{Handle, Motion};
use crate::method::BindInput;
use crate::needs::Solve;
use crate::region::follow::followers;
use crate::region::limbs::ends_of_limbs;
use crate::rigid::Softened;
use crate::sparse::refactorisation::Refactorisation;
use crate::{BindError, Budget, HandleFit, Needs, Ordering, Problem, ReusableFactor, Warning};

impl Problem<'_> {
    /// Factors and solves everything that does not depend on the handles' transforms.
    ///
    /// `ordering` must come from [`crate::Method::ordering`] for the same topology, or be of the power that
    /// [`Problem::ordering_power_within`] gives. A method that needs none ignores it. Uses rayon's current pool; the
    /// result is the same bit for bit for every size of the pool.
    ///
    /// # Errors
    /// [`BindError`] names the problem's fault, or the place where the system could not be solved;
    /// [`BindError::Cancelled`] once `cancel` is raised, which is checked between the steps and many times within a
    /// factorisation.
    pub fn bind<'o>(
        &self,
        ordering: impl Into<Option<&'o Ordering>>,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Bound, BindError> {
        self.bind_within(ordering, Budget::default(), progress, cancel)
    }

    /// Like [`Problem::bind`], with another budget of memory than the default one.
    ///
    /// # Errors
    /// Those of [`Problem::bind`]; [`BindError::Budget`] if the binding would exceed the budget.
    pub fn bind_within<'o>(
        &self,
        ordering: impl Into<Option<&'o Ordering>>,
        budget: Budget,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Bound, BindError> {
        Bound::bind(self, ordering.into(), Refactorisation::Never, budget, progress, cancel)
    }

    /// Like [`Problem::bind`], with the same result to the bit, for callers that bind repeatedly: parts of an earlier
    /// binding's `reusable_factor` that no change has touched are not factored again. The data kept for the next
    /// binding need at most as much memory as the factor.
    ///
    /// # Errors
    /// Those of [`Problem::bind`].
    pub fn rebind<'o>(
        &self,
        ordering: impl Into<Option<&'o Ordering>>,
        reusable_factor: Option<&ReusableFactor>,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Bound, BindError> {
        self.rebind_within(ordering, reusable_factor, Budget::default(), progress, cancel)
    }

    /// Like [`Problem::rebind`], with another budget of memory than the default one.
    ///
    /// # Errors
    /// Those of [`Problem::bind_within`].
    pub fn rebind_within<'o>(
        &self,
        ordering: impl Into<Option<&'o Ordering>>,
        reusable_factor: Option<&ReusableFactor>,
        budget: Budget,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Bound, BindError> {
        let refactorisation = Refactorisation::From(reusable_factor.map(ReusableFactor::factored));
        Bound::bind(self, ordering.into(), refactorisation, budget, progress, cancel)
    }
}

impl Bound {
    fn bind(
        problem: &Problem,
        ordering: Option<&Ordering>,
        refactorisation: Refactorisation,
        budget: Budget,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, BindError> {
        let split = Split::of(problem);
        let of_sections = split.as_ref().map(|split| split.problem(problem));
        let bound = Self::bind_within(
            of_sections.as_ref().unwrap_or(problem),
            ordering,
            refactorisation,
            budget,
            progress,
            cancel,
        );
        let mut bound = bound.map_err(|refused| refused.with_culprit(problem.topology, budget))?;
        if let Some(Split { sections, .. }) = split {
            let positions = &problem.surface.positions;
            let rest = |handle: &Handle| handle.vertices.iter().map(|&own| positions[own as usize]).collect();
            bound.world_rest = bound.handles.iter().map(rest).collect();
            // A section follows its neighbours, so its turn against the far end is no sign of a narrow limb.
            if let Some(limit) = &mut bound.turn_limit {
                let is_whole = sections.are_whole();
                limit.retain(|handle| is_whole[usize::from(handle)]);
            }
            bound.sections = Some(sections);
        }
        let of_sections = std::mem::take(&mut bound.of_binding);
        bound.of_binding = bound.about_handles(of_sections);
        bound.warnings.clone_from(&bound.of_binding);
        Ok(bound)
    }

    fn bind_within(
        problem: &Problem,
        ordering: Option<&Ordering>,
        refactorisation: Refactorisation,
        budget: Budget,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, BindError> {
        let Some(softened) = Softened::of(problem)? else {
            return Self::bind_plain(problem, ordering, refactorisation, budget, progress, cancel);
        };
        let firm = softened.problem(problem);
        let mut bound = Self::bind_plain(&firm, ordering, refactorisation, budget, progress, cancel)?;
        let left = budget.without(bytes_of(bound.factor_len(), size_of::<f64>()));
        let left = left.map_err(|limit| BindError::budget(bound.solved_count(), limit))?;
        if let Some(bodies) = softened.bodies(problem) {
            let with_bodies = bodies.problem(&firm);
            let never = Refactorisation::Never;
            bound.rigid = Some(Box::new(RigidParts {
                bound: Self::bind_plain(&with_bodies, ordering, never, left, progress, cancel)?,
                moved: Vec::new(),
                parts: bodies.parts,
            }));
        }
        // Those about the last step and its targets come after those of the binding.
        bound.warnings.extend(softened.warning());
        bound.of_binding.clone_from(&bound.warnings);
        bound.binding_warnings = bound.warnings.len();
        bound.target_warnings = bound.warnings.len();
        Ok(bound)
    }

    /// Binds a problem in which nothing is rigid.
    fn bind_plain(
        problem: &Problem,
        ordering: Option<&Ordering>,
        refactorisation: Refactorisation,
        budget: Budget,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Self, BindError> {
        cancel.check()?;
        let boundary = problem.boundary();
        let implementation = problem.method.implementation();
        let positions = &problem.surface.positions;
        let mut partition = problem.method.partition(&boundary)?;
        let (row, handle_row) = (implementation.row_bytes(), implementation.handle_row_bytes());
        partition.take_budget(positions.len(), row, handle_row, budget)?;
        let takes_places = implementation.takes_places();
        if takes_places {
            let held = partition.handles.iter().map(Vec::len).sum();
            let budget = partition.budget.without(bytes_of(held, size_of::<DVec3>()));
            partition.budget = budget.map_err(|limit| BindError::budget(partition.free_count, limit))?;
        }
        let handles: Vec<Handle> = partition
            .handles
            .iter()
            .map(|vertices| Handle::new(vertices.clone(), positions))
            .collect();
        let declaration = problem.method.declaration();
        let brought = problem.attachment();
        if let Some((name, attachment)) = brought {
            let title = declaration.attachment(name).map_or(name, |declared| declared.title);
            let checked = problem.method.check_attachment(name, attachment);
            checked.map_err(|refused| BindError::Attachment { title, refused })?;
        }
        let mut method = implementation.bind(&BindInput {
            problem: &boundary,
            needs: implementation.needs(),
            takes_first_power: implementation.takes_first_power(),
            partition: &partition,
            handles: &handles,
            attachment: brought.map(|(_, attachment)| attachment),
            ordering,
            refactorisation,
            progress,
            cancel,
        })?;
        if let (Some((_, attachment)), Some(controls)) = (brought, method.controls_mut())
            && let Some(moved) = attachment.moved()
        {
            controls.move_to(Arc::clone(moved));
        }
        let attachment = declaration.attachments.first();
        let weights = boundary
            .examples
            .map(|examples| examples.weights.clone())
            .unwrap_or_default();
        method.set_weights(&weights);
        let residual = match implementation.handle_fit() {
            HandleFit::Exact => HandleResidual::default(),
            HandleFit::LeastSquares => {
                HandleResidual::new(declaration.name, boundary.size(), positions, &handles, &partition.soft)
            }
        };
        let turn_limit = implementation.follows_turns();
        let turn_limit = turn_limit.map(|followed| TurnLimit {
            method: declaration.name,
            followed,
            ends: match implementation.needs() {
                Needs::Points => {
                    let all: Vec<u16> = (0..handles.len() as u16).collect();
                    ends_among(&all, partition.held.contains(&true)).collect()
                }
                Needs::Surface { .. } => ends_of_limbs(&boundary),
            },
        });
        let bends_slivers = matches!(
            (implementation.needs(), problem.method.solve()),
            (Needs::Surface { .. }, Solve::Direct)
        );
        let slivers = bends_slivers.then(|| Slivers::of(problem)).flatten();
        let rest = |handle: &Handle| handle.vertices.iter().map(|&own| positions[own as usize]).collect();
        let world_rest = handles.iter().filter(|_| takes_places).map(rest).collect();
        let mut warnings = partition.warnings;
        warnings.extend(method.warnings().into_iter().map(Warning::from));
        Ok(Self {
            revision: problem.revision,
            vertex_count: positions.len(),
            free_count: partition.free_count,
            motions: vec![Motion::default(); handles.len()],
            offsets: Arc::default(),
            own_ways: Vec::new(),
            sections: None,
            slides: None,
            world_rest,
            takes_places,
            largest_gap_rad: implementation.largest_gap_rad(),
            is_exact: implementation.handle_fit() == HandleFit::Exact,
            soft: partition.soft,
            handles,
            iteration: 0,
            slivers: slivers.map(Box::new),
            solve: problem.method.solve(),
            name: declaration.name,
            method,
            attachment: attachment.map(|declared| (declared.name, declared.title)),
            weights,
            followers: followers(
                problem.surface,
                problem.topology,
                &partition.following,
                &partition.driven,
                cancel,
            )?,
            rigid: None,
            turn_limit,
            residual,
            of_binding: warnings.clone(),
            binding_warnings: warnings.len(),
            target_warnings: warnings.len(),
            warnings,
        })
    }
}
