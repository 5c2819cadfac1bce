//! A method and its options in an edit: `{"name": .., <options>}`, where what is left out has its default.

use pliant_deform::{METHODS, Method, OptionDeclaration, OptionKind, OptionValue};
use serde_json::{Map, Value, json};

use crate::edit_error::EditError;
use crate::edit_node::Node;

/// Reads a method.
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
    let method = Method::from_name(text).ok_or_else(|| {
        let names: Vec<&str> = METHODS.iter().map(|declaration| declaration.name).collect();
        name.unknown_name(text, &names)
    })?;
    let options = method.declaration().options;
    let mut known = vec!["name"];
    known.extend(options.iter().map(|option| option.name));
    let members = node.object(expected, &known)?;
    let mut values = Vec::new();
    for option in options {
        if let Some(node) = members.get(option.name) {
            values.push((option.name, read_option(option, &node)?));
        }
    }
    method
        .with(values)
        .map_err(|refused| match members.get(&refused.option) {
            Some(node) => node.out_of_range(refused.allowed),
            None => node.out_of_range(refused),
        })
}

fn read_option(option: &OptionDeclaration, node: &Node<'_>) -> Result<OptionValue, EditError> {
    let value = match option.kind {
        OptionKind::Number { .. } => OptionValue::Number(node.number()?),
        OptionKind::Whole { .. } | OptionKind::Numbered { .. } => match u32::try_from(node.whole()?) {
            Ok(number) => OptionValue::Whole(number),
            Err(_) => return Err(node.out_of_range(option.kind.allowed())),
        },
        OptionKind::Named { choices } => {
            let text = node.string("a name")?;
            match choices.iter().find(|choice| **choice == text) {
                Some(choice) => OptionValue::Name(choice),
                None => return Err(node.unknown_name(text, choices)),
            }
        }
        OptionKind::Switch => match node.value().as_bool() {
            Some(on) => OptionValue::Switch(on),
            None => return Err(node.wrong_kind("true or false")),
        },
    };
    Ok(value)
}

/// The method as the edit format has it: its name and what differs from its defaults.
pub(crate) fn method_to_value(method: &Method) -> Value {
    let declaration = method.declaration();
    let default = (declaration.default)();
    let mut members = Map::new();
    members.insert("name".to_owned(), json!(declaration.name));
    for OptionDeclaration { name, .. } in declaration.options {
        let value = method.value(name);
        if value != default.value(name)
            && let Some(value) = value
        {
            let value = match value {
                OptionValue::Number(number) => json!(number),
                OptionValue::Whole(number) => json!(number),
                OptionValue::Name(name) => json!(name),
                OptionValue::Switch(on) => json!(on),
            };
            members.insert((*name).to_owned(), value);
        }
    }
    Value::Object(members)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use pliant_deform::{Bilaplacian, Discretisation, ShellOrder};

    use super::*;

    fn read(value: &Value) -> Result<Method, EditError> {
        read_method(&Node::new(value, "method"))
    }

    #[test]
    fn every_option_is_read_and_written_again() {
        let value = json!({
            "name": "bilaplacian", "order": 3, "stretching": 2.5, "bending": 0.5, "discretisation": "uniform",
            "triangulation": "tufted", "anisotropy": 0.25
        });
        let method = read(&value).unwrap();
        let options = method.options::<Bilaplacian>().unwrap();
        let Bilaplacian {
            stretching, bending, ..
        } = *options;
        assert_eq!((stretching, bending), (2.5, 0.5));
        assert_eq!(options.order, ShellOrder::CurvatureVariation);
        assert_eq!(options.discretisation, Discretisation::Uniform);
        for value in [
            value,
            json!({ "name": "arap", "energy": "smooth", "smoothness": 0.5, "tolerance": 1e-6, "max_iterations": 40 }),
            json!({ "name": "primo", "thickness": 0.1, "tolerance": 1e-6, "max_iterations": 40 }),
        ] {
            let method = read(&value).unwrap();
            assert_eq!(method_to_value(&method), value);
            assert_eq!(method.declaration().options.len() + 1, value.as_object().unwrap().len());
        }
    }

    #[test]
    fn defaults_are_not_written() {
        for declaration in METHODS {
            let value = json!({ "name": declaration.name });
            assert_eq!(method_to_value(&read(&value).unwrap()), value);
        }
        let spelled = json!({ "name": "bilaplacian", "order": 2, "bending": 1, "discretisation": "cotangent-area" });
        assert_eq!(read(&spelled).unwrap(), Method::default());
    }

    #[test]
    fn options_out_of_range_are_refused_by_name_with_what_is_allowed() {
        for (method, option, value, allowed) in [
            ("bilaplacian", "order", json!(0), "1, 2 or 3"),
            ("bilaplacian", "order", json!(4), "1, 2 or 3"),
            ("bilaplacian", "order", json!(1.5), "whole"),
            ("bilaplacian", "order", json!("two"), "whole"),
            ("bilaplacian", "stretching", json!(-1.0), "from 0 to 1e12"),
            ("bilaplacian", "stretching", json!(1e13), "from 0 to 1e12"),
            ("bilaplacian", "bending", json!(0), "above 0"),
            ("bilaplacian", "bending", json!(null), "a number"),
            (
                "bilaplacian",
                "discretisation",
                json!("cotangents"),
                "did you mean `cotangent`?",
            ),
            ("bilaplacian", "discretisation", json!(1), "a name"),
            ("bilaplacian", "triangulation", json!("delaunay"), "as-is"),
            ("bilaplacian", "anisotropy", json!(1.5), "from 0 to 1"),
            ("bilaplacian", "ordre", json!(2), "did you mean `order`?"),
            ("arap", "energy", json!("rims"), "smooth"),
            ("arap", "smoothness", json!(0), "from 1e-6 to 10"),
            ("arap", "tolerance", json!(0.2), "from 1e-12 to 0.1"),
            ("arap", "tolerance", json!("little"), "a number"),
            ("arap", "max_iterations", json!(0), "from 1 to 100000"),
            ("arap", "max_iterations", json!(9_999_999_999_u64), "from 1 to 100000"),
            ("arap", "max_iterations", json!(1.5), "whole"),
            ("arap", "order", json!(2), "known are"),
            ("primo", "thickness", json!("thin"), "a number"),
            ("primo", "energy", json!("spokes"), "known are"),
        ] {
            let refused = read(&json!({ "name": method, option: value })).unwrap_err().to_string();
            assert!(refused.contains("method") && refused.contains(option), "{refused}");
            assert!(refused.contains(allowed), "{refused}: {allowed}");
        }
        let membrane = json!({ "name": "bilaplacian", "bending": 0, "stretching": 1 });
        assert_eq!(read(&membrane).unwrap().ordering_power(), Some(1));
    }
}
