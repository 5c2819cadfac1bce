//! How a method and its options stand in an edit, and what the command line's help says about them.

mod arap;
mod bilaplacian;
mod iteration;
mod primo;

use pliant_deform::Method;
use serde_json::{Map, Value, json};

use crate::edit_error::EditError;
use crate::edit_node::Node;

/// One option of a method, for a person: the command line's help and the window's panel are made of it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct MethodOption {
    /// Its name in the edit.
    pub name: &'static str,
    /// What it does, its unit, range and default.
    pub says: &'static str,
    /// What values it takes.
    pub takes: OptionKind,
}

/// What values an option takes, and which one it has where an edit says nothing.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum OptionKind {
    /// A number.
    Number {
        /// The smallest and the largest that are taken.
        range: [f64; 2],
        /// What it is at first.
        default: f64,
        /// What it is counted in; empty for a plain number.
        unit: &'static str,
    },
    /// A whole number.
    Whole {
        /// The smallest and the largest that are taken.
        range: [u64; 2],
        /// What it is at first.
        default: u64,
    },
    /// One of a few whole numbers, each with what it stands for.
    Numbered {
        /// The numbers and their words.
        choices: &'static [(u64, &'static str)],
        /// What it is at first.
        default: u64,
    },
    /// One of a few names.
    Named {
        /// The names.
        choices: &'static [&'static str],
        /// What it is at first.
        default: &'static str,
    },
    /// Yes or no.
    Switch {
        /// What it is at first.
        default: bool,
    },
}

/// Each method's options.
const OPTIONS: &[(&str, &[MethodOption])] = &[
    ("bilaplacian", bilaplacian::OPTIONS),
    ("arap", arap::OPTIONS),
    ("primo", primo::OPTIONS),
];

/// How people speak of a method.
struct Words {
    name: &'static str,
    title: &'static str,
    /// When it is the one to take.
    when: &'static str,
    /// What else it is called, in lower case.
    keywords: &'static str,
}

const WORDS: &[Words] = &[
    Words {
        name: "bilaplacian",
        title: "Thin plate",
        when: "Bends like a thin plate, at once: for small turns and smooth bulges.",
        keywords: "bilaplacian bi-laplacian biharmonic linear shell laplacian",
    },
    Words {
        name: "arap",
        title: "As rigid as possible",
        when: "Keeps every neighbourhood as rigid as it can, step by step: for large turns and long drags.",
        keywords: "arap as-rigid-as-possible",
    },
    Words {
        name: "primo",
        title: "Coupled prisms",
        when: "Bends like a rubber sheet of a thickness you choose, step by step: for even bends and twists.",
        keywords: "primo rubber nonlinear shell",
    },
];

fn words(name: &str) -> Option<&'static Words> {
    WORDS.iter().find(|words| words.name == name)
}

/// A sentence on when the method called `name` is the one to take; empty for a name that is not known.
pub fn when_to_use(name: &str) -> &'static str {
    words(name).map_or("", |words| words.when)
}

/// What a person calls the method called `name`: its own name where nothing shorter is known.
pub fn method_title(name: &str) -> &str {
    words(name).map_or(name, |words| words.title)
}

/// What else the method called `name` is called, in lower case.
pub fn method_keywords(name: &str) -> &'static str {
    words(name).map_or("", |words| words.keywords)
}

/// What an option of a method is now, its default where the method says nothing else.
pub fn option_value(method: &Method, option: &MethodOption) -> Value {
    match method_to_value(method).get(option.name) {
        Some(value) => value.clone(),
        None => match option.takes {
            OptionKind::Number { default, .. } => json!(default),
            OptionKind::Whole { default, .. } | OptionKind::Numbered { default, .. } => json!(default),
            OptionKind::Named { default, .. } => json!(default),
            OptionKind::Switch { default } => json!(default),
        },
    }
}

/// The method with one of its options set.
///
/// # Errors
/// An option or a value that the method does not take, in a sentence.
pub fn with_option(method: &Method, name: &str, value: Value) -> Result<Method, EditError> {
    let mut members = method_to_value(method);
    if let Some(members) = members.as_object_mut() {
        members.insert(name.to_owned(), value);
    }
    read_method(&Node::new(&members, "method"))
}

/// The options of the method called `name`, empty where it has none.
pub fn method_options(name: &str) -> &'static [MethodOption] {
    OPTIONS
        .iter()
        .find(|(method, _)| *method == name)
        .map_or(&[], |(_, options)| options)
}

/// Reads `{"name": .., <options>}`.
pub(crate) fn read_method(node: &Node<'_>) -> Result<Method, EditError> {
    let expected = "an object with the method's `name` and options";
    let object = node.value().as_object().ok_or_else(|| node.wrong_kind(expected))?;
    // The name first: it decides which options there are.
    let name = object.get("name").ok_or_else(|| EditError::Missing {
        member: "name",
        place: node.place().to_owned(),
    })?;
    let name = Node::new(name, &format!("{}.name", node.place()));
    let text = name.string("a method's name")?;
    let mut method = Method::from_name(text).ok_or_else(|| name.unknown_name(text, Method::NAMES))?;
    let mut known = vec!["name"];
    known.extend(method_options(text).iter().map(|option| option.name));
    let members = node.object(expected, &known)?;
    match &mut method {
        Method::Bilaplacian(options) => bilaplacian::read(&members, options)?,
        Method::Arap(options) => arap::read(&members, options)?,
        Method::Primo(options) => primo::read(&members, options)?,
        _ => {}
    }
    Ok(method)
}

/// The method as the edit format has it: its name and what differs from its defaults.
pub(crate) fn method_to_value(method: &Method) -> Value {
    let mut members = Map::new();
    members.insert("name".to_owned(), json!(method.name()));
    match method {
        Method::Bilaplacian(options) => bilaplacian::write(options, &mut members),
        Method::Arap(options) => arap::write(options, &mut members),
        Method::Primo(options) => primo::write(options, &mut members),
        _ => {}
    }
    Value::Object(members)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use pliant_deform::Method;
    use serde_json::{Value, json};

    use super::{OptionKind, method_options, option_value, when_to_use, with_option};
    use crate::edit_error::EditError;
    use crate::edit_node::Node;

    pub(super) fn read(value: &Value) -> Result<Method, EditError> {
        super::read_method(&Node::new(value, "method"))
    }

    #[test]
    fn every_listed_option_has_the_default_it_says_and_takes_the_ends_of_its_range() {
        for &name in Method::NAMES {
            let method = Method::from_name(name).unwrap();
            assert!(!when_to_use(name).is_empty(), "{name}");
            for option in method_options(name) {
                let default = option_value(&method, option);
                assert_eq!(
                    with_option(&method, option.name, default.clone()).unwrap(),
                    method,
                    "{name} {}",
                    option.name
                );
                let (taken, refused) = match option.takes {
                    OptionKind::Number {
                        range: [least, most], ..
                    } => (vec![json!(most)], vec![json!(least - 1.0), json!(most * 1.01)]),
                    OptionKind::Whole {
                        range: [least, most], ..
                    } => (vec![json!(least), json!(most)], vec![json!(most + 1)]),
                    OptionKind::Numbered { choices, .. } => (
                        choices.iter().map(|(number, _)| json!(number)).collect(),
                        vec![json!("many")],
                    ),
                    OptionKind::Named { choices, .. } => (
                        choices.iter().map(|choice| json!(choice)).collect(),
                        vec![json!("banana")],
                    ),
                    OptionKind::Switch { .. } => (vec![json!(true), json!(false)], vec![json!(1)]),
                };
                for value in taken {
                    let set = with_option(&method, option.name, value.clone()).unwrap();
                    let read = option_value(&set, option);
                    assert!(
                        read == value || read.as_f64() == value.as_f64(),
                        "{name} {}: {read} {value}",
                        option.name
                    );
                }
                for value in refused {
                    assert!(
                        with_option(&method, option.name, value).is_err(),
                        "{name} {}",
                        option.name
                    );
                }
            }
        }
    }
}
