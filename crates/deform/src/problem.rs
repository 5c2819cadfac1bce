//! The problem to solve: a surface, and the role of each of its vertices.

use pliant_mesh::{Cancel, Cancelled, Progress, Surface, Topology};

use crate::budget::{ORDERING_ROW, bytes_of};
use crate::region::boundary_problem::{BoundaryProblem, handle_count};
use crate::{Attachment, BindError, Budget, Constraints, Loose, Method, Ordering, Role};

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
    /// The caller's stamp, handed back by [`crate::Bound::revision`].
    pub revision: u64,
}

/// The fewest vertices of a surface of which only a part is ordered: a smaller one is ordered at once, and its shape
/// has the same bits here as in the window.
const LARGE: usize = 100_000;

/// Sizes whose logarithms differ by less than this need no sentence.
const ABOUT_ALIKE: f64 = 0.25;

impl<'a> Problem<'a> {
    /// The problem of these roles and this stiffness, with hard handles and without attachments; loose components
    /// follow.
    pub fn new(
        (surface, topology): (&'a Surface, &'a Topology),
        roles: &'a [Role],
        stiffness: &'a [f64],
        method: &'a Method,
    ) -> Self {
        Self {
            surface,
            topology,
            roles,
            handle_count: handle_count(roles),
            stiffness,
            constraints: Constraints::default(),
            loose: Loose::default(),
            method,
            attachments: &[],
            revision: 0,
        }
    }

    /// The problem without its method.
    pub(crate) fn boundary(&self) -> BoundaryProblem<'a> {
        let examples = match self.attachment() {
            Some((_, Attachment::Shapes(examples))) => Some(examples),
            _ => None,
        };
        BoundaryProblem {
            handle_count: self.handle_count,
            constraints: self.constraints,
            loose: self.loose,
            examples,
            ..BoundaryProblem::new((self.surface, self.topology), self.roles, self.stiffness)
        }
    }

    /// The attachments that the method declares.
    pub(crate) fn attachment(&self) -> Option<(&'static str, &'a Attachment)> {
        let declared = self.method.declaration();
        let own = self
            .attachments
            .iter()
            .find(|(name, _)| declared.attachment(name).is_some());
        own.map(|(name, attachment)| (*name, attachment))
    }

    /// The sentence about an edit made while an option was still in diagonals of the scene's box, if that makes a
    /// difference.
    pub fn counted_otherwise(&self) -> Option<String> {
        let (option, power) = self.method.counts_in_sizes()?;
        let boundary = self.boundary();
        let (now, former) = (boundary.size(), boundary.bounds()?.diagonal());
        let factor = former / now;
        ((factor.ln().abs() > ABOUT_ALIKE) && factor.is_finite()).then(|| {
            format!(
                "the unit of `{option}` is the size of the bending part ({now:.4}), no longer the diagonal of the \
                 scene's box ({former:.4}): multiply the value of an older edit by {:.3} to bend as before",
                factor.powi(power)
            )
        })
    }

    /// The power of the ordering to make for [`Problem::bind_within`] this budget: see
    /// [`Method::ordering_power_within`].
    pub fn ordering_power_within(&self, budget: Budget) -> Option<u32> {
        self.method.ordering_power_within(self.free_count(), budget)
    }

    /// The ordering for [`Problem::bind_within`] this budget, if the method needs one: of the whole surface, or, if much
    /// of a large one stays where it is, of the surroundings of what moves.
    ///
    /// # Errors
    /// [`Cancelled`] soon after `cancel` is raised.
    pub fn ordering_within(
        &self,
        budget: Budget,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Option<Ordering>, Cancelled> {
        let Some(power) = self.ordering_power_within(budget) else {
            return Ok(None);
        };
        let ordering = match self.ordered_part() {
            Some(solved) => Ordering::around(self.topology, &solved, power, progress, cancel),
            None => Ordering::of(self.topology, power, progress, cancel),
        };
        ordering.map(Some)
    }

    /// The vertices that may be solved for, if an ordering of their surroundings pays.
    fn ordered_part(&self) -> Option<Vec<bool>> {
        let is_solved = |role: &Role| match role {
            Role::Free => true,
            Role::Handle(handle) => self.constraints.weight(*handle).is_some(),
            Role::Fixed => false,
        };
        let solved: Vec<bool> = self.roles.iter().map(is_solved).collect();
        let count = solved.iter().filter(|is_solved| **is_solved).count();
        (solved.len() >= LARGE && 2 * count < solved.len()).then_some(solved)
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
        let ordered = match self.ordered_part() {
            Some(solved) => solved.iter().filter(|is_solved| **is_solved).count(),
            None => self.roles.len(),
        };
        let bytes = bytes_of(ordered, ORDERING_ROW * power);
        let free = self.free_count();
        let checked = budget.without(bytes).map(|_| ());
        checked.map_err(|limit| BindError::budget(free, limit).with_culprit(self.topology, budget))
    }
}
