//! A method and its options in an edit: `{"name": .., <options>, <attachments>}`, in which missing members have their
//! defaults.
//!
//! The declaration of the method's name gives the members, so no type could derive them.

use pliant_deform::{METHODS, Method, MethodDeclaration, OptionDeclaration, OptionKind, OptionValue};
use serde_json::{Map, Value, json};

use super::attachment::{AttachmentEntries, attachment_to_value, read_attachment};
use super::edit_error::EditError;
use super::reader::{read, require};

/// Reads a method, and its inputs beside handles.
pub(crate) fn read_method(value: &Value) -> Result<(Method, AttachmentEntries), EditError> {
    let Some(members) = value.as_object() else {
        return Err(EditError::wrong_kind(
            value,
            "an object with the method's `name` and options",
        ));
    };
    // The name comes first: it determines the options.
    let name: &str = read(require(members, "name")?).map_err(|error| error.under("name"))?;
    let method = Method::from_name(name).ok_or_else(|| {
        let names: Vec<&str> = METHODS.iter().map(|declaration| declaration.name).collect();
        EditError::unknown_name(name, &names).under("name")
    })?;
    let MethodDeclaration {
        options, attachments, ..
    } = method.declaration();
    let (mut values, mut attached) = (Vec::new(), Vec::new());
    for (member, value) in members.iter().filter(|(member, _)| *member != "name") {
        if let Some(attachment) = attachments.iter().find(|attachment| attachment.name == member) {
            attached.push((attachment, value));
        } else if let Some(option) = options.iter().find(|option| option.name == member) {
            let read = match axes_of(option, options).filter(|_| value.is_array()) {
                Some(axes) => read_axes(option, axes, value, members),
                None => read_option(option, value).map(|value| vec![(option.name, value)]),
            };
            values.extend(read.map_err(|error| error.under(member))?);
        } else {
            let options = options.iter().map(|option| option.name);
            let attachments = attachments.iter().map(|attachment| attachment.name);
            let known: Vec<&str> = ["name"].into_iter().chain(options).chain(attachments).collect();
            return Err(EditError::unknown_member(member, &known));
        }
    }
    let method = method.with(values).map_err(|refused| {
        let value = members.get(&refused.option).unwrap_or(value);
        EditError::out_of_range(value, &refused.allowed).under(&refused.option)
    })?;
    // This follows the options, on which a lattice's rest positions depend.
    let attached = attached.into_iter().map(|(attachment, value)| {
        let entry = read_attachment(attachment, &method, value);
        Ok((attachment.name, entry.map_err(|error| error.under(attachment.name))?))
    });
    let attached = attached.collect::<Result<_, EditError>>()?;
    Ok((method, attached))
}

/// The options along x, y and z that correspond to this one for all axes, if they exist.
fn axes_of<'a>(option: &OptionDeclaration, options: &'a [OptionDeclaration]) -> Option<[&'a OptionDeclaration; 3]> {
    let axis = |axis| {
        let name = format!("{}_{axis}", option.name);
        options.iter().find(|other| other.name == name)
    };
    Some([axis('x')?, axis('y')?, axis('z')?])
}

/// Reads an option as a list of its values along each axis.
fn read_axes(
    option: &OptionDeclaration,
    axes: [&OptionDeclaration; 3],
    value: &Value,
    members: &Map<String, Value>,
) -> Result<Vec<(&'static str, OptionValue)>, EditError> {
    if let Some(axis) = axes.iter().find(|axis| members.contains_key(axis.name)) {
        return Err(EditError::custom(format!(
            "is a list beside `{}`: keep one of them",
            axis.name
        )));
    }
    let counts: [u32; 3] = read(value)?;
    let axes = axes.iter().zip(counts).enumerate().map(|(place, (axis, count))| {
        let own = OptionValue::Whole(count);
        if option.kind.takes(own) {
            return Ok((axis.name, own));
        }
        let refused = EditError::out_of_range(&json!(count), &option.kind.allowed());
        Err(refused.under(&format!("[{place}]")))
    });
    axes.collect()
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

/// The method in the edit format: its name, the values that differ from its defaults, and its inputs beside handles.
pub(crate) fn method_to_value(method: &Method, attachments: &AttachmentEntries) -> Value {
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
    for (name, entry) in attachments {
        if declaration.attachment(name).is_some() {
            members.insert((*name).to_owned(), attachment_to_value(method, entry));
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
        let read = read_method(value).map_err(|error| error.under("method"));
        read.map(|(method, _)| method)
    }

    fn written(method: &Method) -> Value {
        method_to_value(method, &AttachmentEntries::new())
    }

    #[test]
    fn every_option_is_read_and_written_again() {
        let value = json!({
            "name": "bilaplacian", "order": 3, "stretching": 2.5, "bending": 0.5, "discretisation": "uniform",
            "triangulation": "tufted", "anisotropy": 0.25, "detail": "displacement-volumes", "base_order": 3,
            "base_length": 0.25, "volume_iterations": 20
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
            json!({ "name": "primo", "thickness": 0.2, "tolerance": 1e-6, "max_iterations": 40 }),
        ] {
            let method = parsed(&value).unwrap();
            assert_eq!(written(&method), value);
            assert_eq!(method.declaration().options.len() + 1, value.as_object().unwrap().len());
        }
    }

    #[test]
    fn a_resolution_is_one_count_or_a_list_of_three() {
        let listed = parsed(&json!({ "name": "lattice", "resolution": [3, 2, 5] })).unwrap();
        let spelled =
            parsed(&json!({ "name": "lattice", "resolution_x": 3, "resolution_y": 2, "resolution_z": 5 })).unwrap();
        assert_eq!(listed, spelled);
        assert_eq!(parsed(&written(&listed)).unwrap(), listed);
        for (value, said) in [
            (json!([3, 0, 5]), "method.resolution[1] is 0"),
            (json!([3, 2]), "a list of 3"),
            (json!([3, "two", 5]), "method.resolution[1] must be a whole number"),
            (json!("fine"), "a whole number"),
        ] {
            let refused = parsed(&json!({ "name": "lattice", "resolution": value })).unwrap_err();
            assert!(refused.to_string().contains(said), "{refused}");
        }
        let twice = parsed(&json!({ "name": "lattice", "resolution": [3, 2, 5], "resolution_y": 4 })).unwrap_err();
        assert!(twice.to_string().contains("`resolution_y`"), "{twice}");
        let other = parsed(&json!({ "name": "cage", "detail": [3, 2, 5] })).unwrap_err();
        assert!(
            other.to_string().contains("method.detail must be a whole number"),
            "{other}"
        );
    }

    #[test]
    fn defaults_are_not_written() {
        for declaration in METHODS {
            let value = json!({ "name": declaration.name });
            assert_eq!(written(&parsed(&value).unwrap()), value);
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
