//! How a method and its options stand in an edit, and what the command line's help says about them.

mod arap;
mod bilaplacian;

use pliant_deform::Method;
use serde_json::{Map, Value, json};

use crate::edit_error::EditError;
use crate::edit_node::Node;

/// One option of a method, for a person.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct MethodOption {
    /// Its name in the edit.
    pub name: &'static str,
    /// What it does, its unit, range and default.
    pub says: &'static str,
}

/// Each method's options.
const OPTIONS: &[(&str, &[MethodOption])] = &[("bilaplacian", bilaplacian::OPTIONS), ("arap", arap::OPTIONS)];

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
        _ => {}
    }
    Value::Object(members)
}

#[cfg(test)]
mod tests {
    use pliant_deform::Method;
    use serde_json::Value;

    use crate::edit_error::EditError;
    use crate::edit_node::Node;

    pub(super) fn read(value: &Value) -> Result<Method, EditError> {
        super::read_method(&Node::new(value, "method"))
    }
}
