//! The problem to solve: a surface, and the role of each of its vertices.

use pliant_mesh::{Bounds, Cancel, Progress, Surface, Topology, bounding_box};

use crate::Loose;
use crate::Role;
use crate::budget::{ORDERING_ROW, bytes_of};
use crate::size;
use crate::sparse::refactorisation::Refactorisation;
use crate::{Attachment, BindError, Bound, Budget, Constraints, Examples, Method, Ordering, ReusableFactor};

/// Everything that a deformation depends on, except the handles' transforms.
///
/// All slices have one entry per surface vertex. [`Problem::bind`] keeps none of them.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// The rest shape, in world units.
    pub surface: &'a Surface,
    /// The adjacency of `surface`.
    pub topology: &'a Topology,
    /// The role of each surface vertex.
    pub roles: &'a [Role],
    /// The number of handles; [`Role::Handle`] numbers are below it, and every number occurs.
    pub handle_count: usize,
    /// Painted stiffness of each surface vertex, above 0, 1 where nothing was painted: the factor of the energy's
    /// density there. A face is as stiff as the mean of its three vertices. The surface is rigid where it is
    /// [`f64::INFINITY`]: each connected part of such vertices moves as one body, by every method; if some of its
    /// vertices belong to a handle or are fixed, it moves with those.
    pub stiffness: &'a [f64],
    /// The strength of the handles' pull, and the smoothness at constrained vertices.
    pub constraints: Constraints<'a>,
    /// The behaviour of components that nothing holds; [`Constraints::parts`] overrides it for single ones.
    pub loose: Loose,
    /// The method and its options.
    pub method: &'a Method,
    /// The attachments, by the names that methods declare. The method makes those that are missing, and ignores those
    /// that other methods declare.
    pub attachments: &'a [(&'static str, Attachment)],
    /// The caller's stamp, handed back by [`Bound::revision`].
    pub revision: u64,
}

/// Sizes whose logarithms differ by less than this need no sentence.
const ABOUT_ALIKE: f64 = 0.25;

impl Problem<'_> {
    /// The attachments that the method declares.
    pub(crate) fn attachment(&self) -> Option<(&'static str, &Attachment)> {
        let declared = self.method.declaration();
        let own = self
            .attachments
            .iter()
            .find(|(name, _)| declared.attachment(name).is_some());
        own.map(|(name, attachment)| (*name, attachment))
    }

    /// The examples, if the method takes some.
    pub(crate) fn examples(&self) -> Option<&Examples> {
        match self.attachment() {
            Some((_, Attachment::Shapes(examples))) => Some(examples),
            _ => None,
        }
    }

    /// The behaviour of each component if nothing holds it.
    pub(crate) fn loose_by_component(&self) -> Vec<Loose> {
        let mut loose = vec![self.loose; self.topology.components().len()];
        for &(part, own) in self.constraints.parts {
            if let Some(loose) = loose.get_mut(part as usize) {
                *loose = own;
            }
        }
        loose
    }

    /// The surface's bounding box; bare points don't count if there are triangles.
    pub(crate) fn bounds(&self) -> Option<Bounds> {
        bounding_box(self.topology.main_positions(&self.surface.positions))
    }

    /// The size of the bending part, in world units.
    pub(crate) fn size(&self) -> f64 {
        size::size(self)
    }

    /// The sentence about an edit made while an option was still in diagonals of the scene's box, if that makes a
    /// difference.
    pub fn counted_otherwise(&self) -> Option<String> {
        let (option, power) = self.method.counts_in_sizes()?;
        let (now, former) = (self.size(), self.bounds()?.diagonal());
        let factor = former / now;
        ((factor.ln().abs() > ABOUT_ALIKE) && factor.is_finite()).then(|| {
            format!(
                "`{option}` counts in the size of what bends ({now:.4}), no longer in the diagonal of the scene's box \
                 ({former:.4}): an edit from before that bends as it did with {:.3} times the value",
                factor.powi(power)
            )
        })
    }

    /// The power of the ordering to make for [`Problem::bind_within`] this budget: see
    /// [`Method::ordering_power_within`].
    pub fn ordering_power_within(&self, budget: Budget) -> Option<u32> {
        self.method.ordering_power_within(self.free_count(), budget)
    }

    fn free_count(&self) -> usize {
        self.roles.iter().filter(|role| **role == Role::Free).count()
    }

    /// Refuses the problem if its tables and its ordering alone would exceed a budget, before any of them is made.
    ///
    /// # Errors
    /// [`BindError::Budget`].
    pub fn check_tables(&self, budget: Budget) -> Result<(), BindError> {
        let power = self.ordering_power_within(budget).map_or(0, |power| power as usize);
        let bytes = bytes_of(self.roles.len(), ORDERING_ROW * power);
        let free = self.free_count();
        let checked = budget.without(bytes).map(|_| ());
        checked.map_err(|limit| BindError::budget(free, limit).with_culprit(self.topology, budget))
    }

    /// Factors and solves everything that does not depend on the handles' transforms.
    ///
    /// `ordering` must come from [`Method::ordering`] for the same topology, or be of the power that
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
