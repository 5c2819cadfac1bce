//! What is to be solved: a surface, and what each of its vertices does.

use pliant_mesh::{Bounds, Cancel, Progress, Surface, Topology, bounding_box};

use crate::budget::{ORDERING_ROW, bytes_of};
use crate::size;
use crate::sparse::refactorisation::Refactorisation;
use crate::{Attachment, BindError, Bound, Budget, Constraints, Examples, Method, Ordering, ReusableFactor};

/// What a surface vertex does.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Role {
    /// Stays where it is.
    Fixed,
    /// Goes where the method puts it.
    #[default]
    Free,
    /// Moves with the handle of this number.
    Handle(u16),
}

/// What a connected component without a handle and without a fixed vertex does.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Loose {
    /// It moves rigidly with what it touches: the deformed surface, or a larger part that follows. If it touches
    /// neither, it moves with the nearest part of the deformed surface. Eyes, buttons and straps do so.
    #[default]
    Follow,
    /// It stays where it is.
    Rest,
    /// Each place on it moves with the nearest part of the deformed surface: a strap bends along with what it lies on.
    Bend,
}

/// Everything that a deformation depends on, except the handles' transforms.
///
/// All slices have one entry per surface vertex. [`Problem::bind`] keeps none of them.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// The rest shape, in world units.
    pub surface: &'a Surface,
    /// The adjacency of `surface`.
    pub topology: &'a Topology,
    /// What each surface vertex does.
    pub roles: &'a [Role],
    /// How many handles there are; [`Role::Handle`] numbers lie below it, and every number occurs.
    pub handle_count: usize,
    /// Painted stiffness of each surface vertex, above 0, 1 where nothing was painted: the factor of the
    /// energy's density there. A face is as stiff as the mean of its three vertices. Where it is [`f64::INFINITY`] the
    /// surface is rigid: each connected part of such vertices moves as one body, by every method, and with the handle or
    /// what is fixed that some of its vertices belong to.
    pub stiffness: &'a [f64],
    /// How firmly handles pull and how smoothly the surface joins what holds it.
    pub constraints: Constraints<'a>,
    /// What components that nothing holds do; [`Constraints::parts`] overrides it for single ones.
    pub loose: Loose,
    /// The method and its options.
    pub method: &'a Method,
    /// What was brought beside the handles, by the names that methods declare. The method makes for itself what is not
    /// here, and what others declare it leaves alone.
    pub attachments: &'a [(&'static str, Attachment)],
    /// The caller's stamp, handed back by [`Bound::revision`].
    pub revision: u64,
}

/// Sizes whose logarithms differ by less make no difference that is to be told.
const ABOUT_ALIKE: f64 = 0.25;

impl Problem<'_> {
    /// What was brought of what the method declares.
    pub(crate) fn attachment(&self) -> Option<(&'static str, &Attachment)> {
        let declared = self.method.declaration();
        let own = self
            .attachments
            .iter()
            .find(|(name, _)| declared.attachment(name).is_some());
        own.map(|(name, attachment)| (*name, attachment))
    }

    /// The examples that were brought, if the method takes some.
    pub(crate) fn examples(&self) -> Option<&Examples> {
        match self.attachment() {
            Some((_, Attachment::Shapes(examples))) => Some(examples),
            _ => None,
        }
    }

    /// What each component does if nothing holds it.
    pub(crate) fn loose_by_component(&self) -> Vec<Loose> {
        let mut loose = vec![self.loose; self.topology.components().len()];
        for &(part, own) in self.constraints.parts {
            if let Some(loose) = loose.get_mut(part as usize) {
                *loose = own;
            }
        }
        loose
    }

    /// The surface's bounding box; bare points beside triangles don't count.
    pub(crate) fn bounds(&self) -> Option<Bounds> {
        bounding_box(self.topology.main_positions(&self.surface.positions))
    }

    /// The size of what bends, in world units.
    pub(crate) fn size(&self) -> f64 {
        size::size(self)
    }

    /// What to say of an edit that was made while an option still counted in diagonals of the scene's box, where that makes
    /// a difference.
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

    /// Refuses the problem where already its tables and its ordering would exceed a budget, before any of it is made.
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
    /// [`Problem::ordering_power_within`] gives. A method that needs none ignores it. Uses
    /// rayon's current pool; the result is the same bit for bit whatever its size.
    ///
    /// # Errors
    /// [`BindError`] names what is wrong with the problem, or where the system could not be solved;
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

    /// As [`Problem::bind`], with another budget of memory than the default one.
    ///
    /// # Errors
    /// As [`Problem::bind`]; [`BindError::Budget`] if the binding would take more.
    pub fn bind_within<'o>(
        &self,
        ordering: impl Into<Option<&'o Ordering>>,
        budget: Budget,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Bound, BindError> {
        Bound::bind(self, ordering.into(), Refactorisation::Never, budget, progress, cancel)
    }

    /// As [`Problem::bind`], with the same result to the bit, for callers that bind repeatedly: whatever an earlier
    /// binding's `reusable_factor` holds and no change has touched is not factored again. What is kept for the next
    /// binding takes at most as much memory as the factor.
    ///
    /// # Errors
    /// As [`Problem::bind`].
    pub fn rebind<'o>(
        &self,
        ordering: impl Into<Option<&'o Ordering>>,
        reusable_factor: Option<&ReusableFactor>,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Bound, BindError> {
        self.rebind_within(ordering, reusable_factor, Budget::default(), progress, cancel)
    }

    /// As [`Problem::rebind`], with another budget of memory than the default one.
    ///
    /// # Errors
    /// As [`Problem::bind_within`].
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
