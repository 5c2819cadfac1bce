//! The list of all methods, and everything that reads it: methods by name, and the methods that a message advises.

use std::fmt;

use crate::option::joined;
use crate::{Method, MethodDeclaration, Needs, Remedy};

/// Every method, in the order of the window. A new method adds its line here.
pub const METHODS: &[&MethodDeclaration] = &[
    &crate::methods::bilaplacian::DECLARATION,
    &crate::methods::arap::DECLARATION,
    &crate::methods::primo::DECLARATION,
    &crate::methods::shells::DECLARATION,
    &crate::methods::wrinkles::DECLARATION,
    &crate::methods::poisson::DECLARATION,
    &crate::methods::laplacian::DECLARATION,
    &crate::methods::frames::DECLARATION,
    &crate::methods::rbf::DECLARATION,
    &crate::methods::mls::DECLARATION,
    &crate::methods::embedded::DECLARATION,
    &crate::methods::lattice::DECLARATION,
    &crate::methods::cage::DECLARATION,
    &crate::methods::space_primo::DECLARATION,
    #[cfg(feature = "identity-method")]
    &crate::methods::identity::DECLARATION,
];

impl Method {
    /// The method `name`, with its defaults.
    pub fn from_name(name: &str) -> Option<Self> {
        let declaration = METHODS.iter().find(|declaration| declaration.name == name)?;
        Some((declaration.default)())
    }

    /// The method of a new document.
    pub fn of_new_documents() -> Self {
        (crate::methods::arap::DECLARATION.first_choice)()
    }

    /// The method of a merge that names none.
    pub fn of_merges() -> Self {
        (crate::methods::poisson::DECLARATION.default)()
    }
}

impl Default for Method {
    /// The method of an edit that names none.
    fn default() -> Self {
        (METHODS[0].default)()
    }
}

impl fmt::Display for Remedy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let can = |method: &Method| {
            let declaration = method.declaration();
            let bends_space = method.needs() == Needs::Points;
            match self {
                Self::OfSpace => bends_space,
                Self::OfSpaceForManyHandles => bends_space && method.implementation().handle_row_bytes() == 0,
                Self::Heeding(constraint) => declaration.heeds(*constraint),
                Self::TakingPlaces => method.implementation().takes_places(),
                Self::TurningByMoves => method.implementation().turns_by_moves(),
                Self::FollowingTurns(degrees) => method.implementation().advised_for_degrees() >= *degrees,
                Self::OfDamageBy(own) => declaration.name != *own && method.implementation().resists_collapse(),
            }
        };
        let able = |declaration: &&MethodDeclaration| {
            let (default, first_choice) = ((declaration.default)(), (declaration.first_choice)());
            if can(&default) {
                return Some(format!("`{}`", declaration.name));
            }
            can(&first_choice).then(|| named_with(&first_choice, &default))
        };
        let most = if *self == Self::OfSpace { 2 } else { METHODS.len() };
        let names = METHODS.iter().filter_map(able).take(most);
        let Self::OfDamageBy(_) = self else {
            return f.write_str(&joined(names, "or"));
        };
        let take = names.map(|name| format!("take {name}"));
        let less = ["lower the strength", "leave more of the surface free"].map(str::to_owned);
        f.write_str(&joined(less.into_iter().chain(take), "or"))
    }
}

/// The method's name with the options that differ from those of another one: "`arap` with `energy` smooth".
fn named_with(method: &Method, other: &Method) -> String {
    let options = method.declaration().options.iter();
    let differing = options.filter_map(|option| {
        let value = method.value(option.name)?;
        (other.value(option.name) != Some(value)).then(|| format!("`{}` {value}", option.name))
    });
    format!("`{}` with {}", method.name(), joined(differing, "and"))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::{OptionKind, OptionValue};

    #[test]
    fn advice_names_the_options_without_which_a_method_cannot_do_it() {
        let said = |degrees| Remedy::FollowingTurns(degrees).to_string();
        assert!(
            said(90).contains("`arap` or") || said(90).contains("`arap`,"),
            "{}",
            said(90)
        );
        assert!(said(120).contains("`arap` with `energy` \"smooth\""), "{}", said(120));
        assert!(!said(170).contains("arap"), "{}", said(170));
    }

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
                !declaration.title.is_empty()
                    && !declaration.paper.is_empty()
                    && declaration.when_to_use.ends_with('.'),
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
