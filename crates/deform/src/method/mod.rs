//! A method: its declaration, its options and their binding.
//!
//! `README.md` beside the sources explains the addition of a method and the needs of later ones.

mod bind_input;
mod bound_method;
mod deform_method;

use std::fmt;

use glam::DVec3;
use pliant_mesh::{Cancel, Cancelled, Progress, Surface, Topology};

pub(crate) use self::bind_input::BindInput;
pub(crate) use self::bound_method::{BoundMethod, FactoredSystem, Stepped};
pub(crate) use self::deform_method::{DeformMethod, Options};
pub use self::deform_method::{Method, MethodDeclaration};
use crate::budget::plate_bytes;
use crate::option::joined;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::demands::Demands;
use crate::region::partition::{Partition, check};
use crate::{
    Attachment, AttachmentRefused, BindError, Budget, HandleFit, Needs, OptionRefused, OptionValue, Ordering, Solve,
};

impl Method {
    pub(crate) fn of(options: impl DeformMethod) -> Self {
        Self(Box::new(options))
    }

    /// Its declaration.
    pub fn declaration(&self) -> &'static MethodDeclaration {
        self.0.declaration()
    }

    /// The name that [`Method::from_name`] takes.
    pub fn name(&self) -> &'static str {
        self.declaration().name
    }

    /// Returns true if [`crate::Constraints::continuity`] sets the smoothness at constrained vertices; other methods
    /// have no choice, and neither has the membrane.
    pub fn has_continuity(&self) -> bool {
        self.0.has_continuity()
    }

    /// See [`DeformMethod::counts_in_sizes`].
    pub(crate) fn counts_in_sizes(&self) -> Option<(&'static str, i32)> {
        self.0.counts_in_sizes()
    }

    /// Its domain, with its present options.
    pub fn needs(&self) -> Needs {
        self.0.needs()
    }

    /// Refuses a surface without triangles if the method needs some.
    ///
    /// # Errors
    /// [`BindError::NoTriangles`].
    pub fn check_bends(&self, surface: &Surface) -> Result<(), BindError> {
        match self.needs() {
            Needs::Surface { .. } if surface.triangles.is_empty() => {
                Err(BindError::NoTriangles { method: self.name() })
            }
            _ => Ok(()),
        }
    }

    /// Returns true if the vertices of handles can have places of their own ([`crate::Target::Places`]).
    pub fn takes_places(&self) -> bool {
        self.0.takes_places()
    }

    /// The power of the Laplacian of the ordering's graph, if it needs one.
    pub fn ordering_power(&self) -> Option<u32> {
        self.needs().ordering_power()
    }

    /// The power of the ordering for this many free vertices within a budget: [`Method::ordering_power`], or 1 if the
    /// factor of the method's own system is not expected to fit and the Laplacian's is enough. `None` if it needs no
    /// ordering. The factor's size is estimated from the number of vertices.
    pub fn ordering_power_within(&self, free_count: usize, budget: Budget) -> Option<u32> {
        let power = self.ordering_power()?;
        let fits = || plate_bytes(free_count) <= budget.bytes;
        Some(if !self.implementation().takes_first_power() || fits() {
            power
        } else {
            1
        })
    }

    /// The ordering that it needs, if it needs one.
    ///
    /// # Errors
    /// [`Cancelled`] soon after `cancel` is raised.
    pub fn ordering(
        &self,
        topology: &Topology,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Option<Ordering>, Cancelled> {
        let power = self.ordering_power();
        power
            .map(|power| Ordering::of(topology, power, progress, cancel))
            .transpose()
    }

    /// The way in which it finds its shape, with its present options.
    pub fn solve(&self) -> Solve {
        self.0.solve()
    }

    /// The way in which hard handles hold their vertices, with its present options.
    pub fn handle_fit(&self) -> HandleFit {
        self.0.handle_fit()
    }

    /// Returns true if its examples bend the surface by their weights, 0 being rest. Otherwise they only add to the
    /// handles' effect, and a weight multiplies its example's addition, 1 without a weight.
    pub fn examples_bend(&self) -> bool {
        self.0.examples_bend()
    }

    /// The rest positions of an attachment's points, in world units. A lattice's depend on the options; examples have
    /// none.
    pub fn control_rest(&self, attachment: &Attachment) -> Vec<DVec3> {
        match attachment {
            Attachment::Mesh(mesh) => mesh.rest.to_vec(),
            Attachment::Lattice(lattice) => self.0.lattice_points(lattice),
            Attachment::Shapes(_) => Vec::new(),
        }
    }

    /// Checks an attachment of this declared name, as far as that does not depend on the surface.
    ///
    /// # Errors
    /// The fault of the attachment.
    pub fn check_attachment(&self, name: &str, attachment: &Attachment) -> Result<(), AttachmentRefused> {
        let declared = self.declaration().attachment(name);
        if declared.is_none_or(|declared| declared.kind != attachment.kind()) {
            return Err(AttachmentRefused::Kind);
        }
        self.0.check_attachment(attachment)?;
        attachment.check()
    }

    /// The value of an option; `None` if the method has none of this name.
    pub fn value(&self, option: &str) -> Option<OptionValue> {
        self.0.value(option)
    }

    /// The method with some of its options set.
    ///
    /// # Errors
    /// An option that it does not have, or a value that the option does not allow, alone or together with the other
    /// options.
    pub fn with<'a>(&self, values: impl IntoIterator<Item = (&'a str, OptionValue)>) -> Result<Self, OptionRefused> {
        let mut set = self.clone();
        for (name, value) in values {
            let options = self.declaration().options;
            let Some(option) = options.iter().find(|option| option.name == name) else {
                let names = options.iter().map(|option| format!("`{}`", option.name));
                return Err(OptionRefused {
                    option: name.to_owned(),
                    allowed: format!("no value: {} has only {}", self.name(), joined(names, "and")),
                });
            };
            if !option.kind.takes(value) {
                return Err(option.refused());
            }
            set.0.set(name, value).ok_or_else(|| option.refused())?;
        }
        set.0.check()?;
        Ok(set)
    }

    /// The options as the method's own type, if it is that method.
    pub fn options<T: 'static>(&self) -> Option<&T> {
        (&*self.0 as &dyn std::any::Any).downcast_ref()
    }

    /// Checks a problem and sorts its vertices for this method.
    ///
    /// # Errors
    /// The fault of a table, or of the surface.
    pub(crate) fn partition<'a>(&self, problem: &BoundaryProblem<'a>) -> Result<Partition<'a>, BindError> {
        check(problem)?;
        let declaration = self.declaration();
        if let Some(examples) = problem.examples {
            let title = declaration.attachments.first().map_or("examples", |own| own.title);
            let checked = examples.check_fits(problem.surface.positions.len());
            checked.map_err(|refused| BindError::Attachment { title, refused })?;
        }
        // An empty surface needs no refusal.
        if !problem.surface.positions.is_empty() {
            self.check_bends(problem.surface)?;
        }
        let demands = Demands {
            method: declaration.name,
            needs: self.needs(),
            heeds: declaration.heeds,
            examples_bend: self.examples_bend(),
        };
        Partition::of(problem, &demands, self.0.triangulation(problem))
    }

    /// The trait behind it.
    pub(crate) fn implementation(&self) -> &dyn DeformMethod {
        &*self.0
    }
}

impl Clone for Method {
    fn clone(&self) -> Self {
        Self(self.0.boxed_clone())
    }
}

impl PartialEq for Method {
    fn eq(&self, other: &Self) -> bool {
        self.0.equals(other.implementation())
    }
}

impl fmt::Debug for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}
