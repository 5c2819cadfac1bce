//! A method and its options in an edit: `{"name": .., <options>}`, where what is left out has its default.
//!
//! The members follow from the method's name, by its declaration, so there is no type that could derive them.

use pliant_deform::{METHODS, Method, OptionDeclaration, OptionKind, OptionValue};
use serde_json::{Map, Value, json};

use super::edit_error::EditError;
use super::reader::{read, require};

/// Reads a method.
pub(crate) fn read_method(value: &Value) -> Result<Method, EditError> {
    let Some(members) = value.as_object() else {
        return Err(EditError::wrong_kind(
            value,
            "an object with the method's `name` and options",
        ));
    };
    // The name first: it decides which options there are.
    let name: &str = read(require(members, "name")?).map_err(|error| error.under("name"))?;
    let method = Method::from_name(name).ok_or_else(|| {
        let names: Vec<&str> = METHODS.iter().map(|declaration| declaration.name).collect();
        EditError::unknown_name(name, &names).under("name")
    })?;
    let options = method.declaration().options;
    let mut values = Vec::new();
    for (member, value) in members.iter().filter(|(member, _)| *member != "name") {
        let Some(option) = options.iter().find(|option| option.name == member) else {
            let known: Vec<&str> = ["name"]
                .into_iter()
                .chain(options.iter().map(|option| option.name))
                .collect();
            return Err(EditError::unknown_member(member, &known));
        };
        values.push((
            option.name,
            read_option(option, value).map_err(|error| error.under(member))?,
        ));
    }
    method.with(values).map_err(|refused| {
        let value = members.get(&refused.option).unwrap_or(value);
        EditError::out_of_range(value, &refused.allowed).under(&refused.option)
    })
}

fn read_option(option: &OptionDeclaration, value: &Value) -> Result<OptionValue, EditError> {
    match option.kind {
        OptionKind::Number { .. } => read(value).map(OptionValue::Number),
        OptionKind::Whole { .. } | OptionKind::Numbered { .. } => read(value).map(OptionValue::Whole),
        OptionKind::Switch => read(value).map(OptionValue::Switch),
        OptionKind::Named { choices } => {
            let name: &str = read(value)?;
            let choice = choices.iter().find(|choice| **choice == name);
            choice
                .map(|choice| OptionValue::Name(choice))
                .ok_or_else(|| EditError::unknown_name(name, choices))
        }
    }
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
    use pliant_deform::{Bilaplacian, BilaplacianOrder, Discretisation};

    use super::*;

    fn parsed(value: &Value) -> Result<Method, EditError> {
        read_method(value).map_err(|error| error.under("method"))
    }

    #[test]
    fn every_option_is_read_and_written_again() {
        let value = json!({
            "name": "bilaplacian", "order": 3, "stretching": 2.5, "bending": 0.5, "discretisation": "uniform",
            "triangulation": "tufted", "anisotropy": 0.25, "detail": "displacement-volumes", "base_order": 3,
            "volume_iterations": 20
        });
        let method = parsed(&value).unwrap();
        let options = method.options::<Bilaplacian>().unwrap();
        let Bilaplacian {
            stretching, bending, ..
        } = *options;
        assert_eq!((stretching, bending), (2.5, 0.5));
        assert_eq!(options.order, BilaplacianOrder::CurvatureVariation);
        assert_eq!(options.discretisation, Discretisation::Uniform);
        for value in [
            value,
            json!({ "name": "arap", "energy": "smooth", "smoothness": 0.5, "tolerance": 1e-6, "max_iterations": 40 }),
            json!({ "name": "primo", "thickness": 0.1, "tolerance": 1e-6, "max_iterations": 40 }),
        ] {
            let method = parsed(&value).unwrap();
            assert_eq!(method_to_value(&method), value);
            assert_eq!(method.declaration().options.len() + 1, value.as_object().unwrap().len());
        }
    }

    #[test]
    fn defaults_are_not_written() {
        for declaration in METHODS {
            let value = json!({ "name": declaration.name });
            assert_eq!(method_to_value(&parsed(&value).unwrap()), value);
        }
        let spelled = json!({ "name": "bilaplacian", "order": 2, "bending": 1, "discretisation": "cotangent-area" });
        assert_eq!(parsed(&spelled).unwrap(), Method::default());
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
            ("bilaplacian", "discretisation", json!(1), "a string"),
            ("bilaplacian", "triangulation", json!("delaunay"), "as-is"),
            ("bilaplacian", "anisotropy", json!(1.5), "from 0 to 1"),
            ("bilaplacian", "ordre", json!(2), "did you mean `order`?"),
            ("arap", "energy", json!("rims"), "smooth"),
            ("arap", "smoothness", json!(0), "from 1e-6 to 10"),
            ("arap", "tolerance", json!(0.2), "from 1e-12 to 0.1"),
            ("arap", "tolerance", json!("little"), "a number"),
            ("arap", "max_iterations", json!(0), "from 1 to 100000"),
            ("arap", "max_iterations", json!(9_999_999_999_u64), "a whole number"),
            ("arap", "max_iterations", json!(1.5), "whole"),
            ("arap", "order", json!(2), "known are"),
            ("primo", "thickness", json!("thin"), "a number"),
            ("primo", "energy", json!("spokes"), "known are"),
        ] {
            let refused = parsed(&json!({ "name": method, option: value }))
                .unwrap_err()
                .to_string();
            assert!(refused.contains("method") && refused.contains(option), "{refused}");
            assert!(refused.contains(allowed), "{refused}: {allowed}");
        }
        let membrane = json!({ "name": "bilaplacian", "bending": 0, "stretching": 1 });
        assert_eq!(parsed(&membrane).unwrap().ordering_power(), Some(1));
    }
}
