//! The methods: their declarations and implementations, and the list of them all.
//!
//! `README.md` beside the sources explains the addition of a method and the needs of later ones.

pub(crate) mod attachment;
mod attachment_refused;
mod declaration;
pub(crate) mod iteration;
pub(crate) mod option;
mod traits;

use std::fmt;

use glam::DVec3;
use pliant_mesh::{Cancel, Cancelled, Progress, Surface, Topology};

pub use self::attachment::{
    Attachment, AttachmentDeclaration, AttachmentKind, ControlLattice, ControlMesh, ExampleShape, Examples,
    LARGEST_WEIGHT,
};
pub use self::attachment_refused::AttachmentRefused;
pub use self::declaration::{ConstraintKind, MethodDeclaration, Needs, Solve};
pub use self::option::{OptionDeclaration, OptionKind, OptionRefused, OptionValue};
pub use self::traits::HandleFit;
pub(crate) use self::traits::{BindInput, BoundMethod, DeformMethod, Finite, Options, Stepped};
use crate::budget::plate_bytes;
use crate::{BindError, Budget, Ordering};

/// Every method, in the order of the window. A new method adds its line here.
pub const METHODS: &[&MethodDeclaration] = &[
    &crate::bilaplacian::DECLARATION,
    &crate::arap::DECLARATION,
    &crate::primo::DECLARATION,
    &crate::shells::DECLARATION,
    &crate::wrinkles::DECLARATION,
    &crate::poisson::DECLARATION,
    &crate::laplacian::DECLARATION,
    &crate::frames::DECLARATION,
    &crate::rbf::DECLARATION,
    &crate::mls::DECLARATION,
    &crate::embedded::DECLARATION,
    &crate::lattice::DECLARATION,
    &crate::cage::DECLARATION,
    &crate::space_primo::DECLARATION,
    #[cfg(feature = "identity-method")]
    &crate::identity::DECLARATION,
];

/// A method with its options: the law by which a surface follows its handles.
pub struct Method(Box<dyn DeformMethod>);

impl Method {
    pub(crate) fn of(options: impl DeformMethod) -> Self {
        Self(Box::new(options))
    }

    /// The method `name`, with its defaults.
    pub fn from_name(name: &str) -> Option<Self> {
        let declaration = METHODS.iter().find(|declaration| declaration.name == name)?;
        Some((declaration.default)())
    }

    /// Its declaration.
    pub fn declaration(&self) -> &'static MethodDeclaration {
        self.0.declaration()
    }

    /// The name that [`Method::from_name`] takes.
    pub fn name(&self) -> &'static str {
        self.declaration().name
    }

    /// Whether [`crate::Constraints::continuity`] sets the smoothness at constrained vertices; other methods have no
    /// choice, and neither has the membrane.
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

    /// Whether its examples bend the surface by their weights, 0 being rest. Otherwise they only add to the handles'
    /// effect, and a weight multiplies its example's addition, 1 without a weight.
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
                    allowed: format!("nothing: {} has {}", self.name(), option::joined(names, "and")),
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

    /// The trait behind it.
    pub(crate) fn implementation(&self) -> &dyn DeformMethod {
        &*self.0
    }
}

impl Default for Method {
    /// The method of an edit that names none.
    fn default() -> Self {
        (METHODS[0].default)()
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn every_declaration_is_complete_and_its_defaults_are_its_own() {
        for (number, declaration) in METHODS.iter().enumerate() {
            let name = declaration.name;
            assert!(METHODS[..number].iter().all(|other| other.name != name), "{name} twice");
            for method in [(declaration.default)(), (declaration.first_choice)()] {
                assert_eq!(method.name(), name);
            }
            assert_eq!(Method::from_name(name), Some((declaration.default)()));
            assert!(
                !declaration.title.is_empty() && declaration.when_to_use.ends_with('.'),
                "{name}"
            );
            assert_eq!(declaration.keywords, declaration.keywords.to_lowercase());
            for attachment in declaration.attachments {
                let is_option = declaration.options.iter().any(|option| option.name == attachment.name);
                assert!(!is_option && attachment.name != "name", "{name}: {}", attachment.name);
                assert_eq!(declaration.attachment(attachment.name), Some(attachment), "{name}");
            }
        }
        assert_eq!(Method::from_name("no such method"), None);
        assert_ne!(Method::from_name("arap"), Method::from_name("primo"));
    }

    #[test]
    fn an_option_without_effect_says_which_choice_would_give_it_one() {
        for declaration in METHODS {
            let method = (declaration.default)();
            for option in declaration.options {
                let Some((other, names)) = option.only_with else {
                    assert_eq!(option.idle_because(|name| method.value(name)), None);
                    continue;
                };
                let declared = declaration.options.iter().find(|option| option.name == other);
                let OptionKind::Named { choices } = declared.unwrap().kind else {
                    panic!("{other} has no names")
                };
                assert!(names.iter().all(|name| choices.contains(name)) && names.len() < choices.len());
                for choice in choices {
                    let set = method.with([(other, OptionValue::Name(choice))]).unwrap();
                    let idle = option.idle_because(|name| set.value(name));
                    assert_eq!(idle.is_none(), names.contains(choice), "{}: {choice}", option.name);
                    assert!(idle.is_none_or(|why| why.contains(other) && why.contains(names[0])));
                }
            }
        }
    }

    #[test]
    fn every_option_takes_its_default_and_the_ends_of_its_range_and_refuses_what_lies_beyond() {
        for declaration in METHODS {
            let method = (declaration.default)();
            for option in declaration.options {
                let name = option.name;
                let default = method.value(name).unwrap();
                assert_eq!(method.with([(name, default)]).unwrap(), method, "{name}");
                let (taken, refused) = match option.kind {
                    OptionKind::Number {
                        range: [least, most], ..
                    } => (
                        vec![OptionValue::Number(most), OptionValue::Number((least + most) / 2.0)],
                        [least - 1.0, most * 1.01, f64::NAN].map(OptionValue::Number).to_vec(),
                    ),
                    OptionKind::Whole { range: [least, most] } => (
                        [least, most].map(OptionValue::Whole).to_vec(),
                        vec![OptionValue::Whole(most + 1)],
                    ),
                    OptionKind::Numbered { choices } => (
                        choices.iter().map(|(number, _)| OptionValue::Whole(*number)).collect(),
                        vec![OptionValue::Whole(77)],
                    ),
                    OptionKind::Named { choices } => (
                        choices.iter().map(|name| OptionValue::Name(name)).collect(),
                        vec![OptionValue::Name("banana")],
                    ),
                    OptionKind::Switch => ([true, false].map(OptionValue::Switch).to_vec(), Vec::new()),
                };
                for value in taken {
                    let set = method.with([(name, value)]).unwrap();
                    assert_eq!(set.value(name), Some(value), "{name}");
                    assert_eq!(set == method, value == default, "{name}");
                }
                let other_kind = match option.kind {
                    OptionKind::Switch => OptionValue::Number(1.0),
                    _ => OptionValue::Switch(true),
                };
                for value in refused.into_iter().chain([other_kind]) {
                    let said = method.with([(name, value)]).unwrap_err().to_string();
                    assert!(said.contains(name) && said.contains(&option.kind.allowed()), "{said}");
                }
            }
            let said = method.with([("no such option", OptionValue::Switch(true))]);
            assert!(said.unwrap_err().to_string().contains("no such option"));
        }
    }
}
