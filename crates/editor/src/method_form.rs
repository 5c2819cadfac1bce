//! How a method and its options stand in an edit, and what the command line's help says about them.

use pliant_deform::{Arap, ArapEnergy, Bilaplacian, Discretisation, Method, ShellOrder};
use serde_json::{Map, Value, json};

use crate::edit_error::EditError;
use crate::edit_node::{Members, Node};

/// One option of a method, for a person.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct MethodOption {
    /// Its name in the edit.
    pub name: &'static str,
    /// What it does, its unit, range and default.
    pub says: &'static str,
}

/// Each method's options.
const OPTIONS: &[(&str, &[MethodOption])] = &[("bilaplacian", BILAPLACIAN), ("arap", ARAP)];

/// The largest coefficient of the linear shell.
const LARGEST_COEFFICIENT: f64 = 1e12;

const BILAPLACIAN: &[MethodOption] = &[
    MethodOption {
        name: "order",
        says: "1 membrane, 2 thin plate, 3 least change of curvature; default 2",
    },
    MethodOption {
        name: "bending",
        says: "resistance k_b to what the order names, 0 to 1e12; default 1",
    },
    MethodOption {
        name: "stretching",
        says: "resistance k_s to stretching, in units of k_b per squared diagonal of the model, 0 to 1e12; default 0",
    },
    MethodOption {
        name: "discretisation",
        says: "\"uniform\", \"cotangent\" or \"cotangent-area\" Laplacian; default \"cotangent-area\"",
    },
];

const ARAP: &[MethodOption] = &[
    MethodOption {
        name: "energy",
        says: "a vertex's cell: \"spokes\", its edges, or \"spokes-and-rims\", its triangles' edges; default \"spokes-and-rims\"",
    },
    MethodOption {
        name: "tolerance",
        says: "iteration ends where a step lowers the energy by less than this share of it, 1e-12 to 0.1; default 1e-4",
    },
    MethodOption {
        name: "max_iterations",
        says: "iteration ends after so many steps a frame, 1 to 100000; default 500",
    },
];

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
        Method::Bilaplacian(options) => read_bilaplacian(&members, options)?,
        Method::Arap(options) => read_arap(&members, options)?,
        _ => {}
    }
    Ok(method)
}

fn read_bilaplacian(members: &Members<'_>, options: &mut Bilaplacian) -> Result<(), EditError> {
    if let Some(node) = members.get("order") {
        let number = node.whole()?;
        options.order = *ShellOrder::ALL
            .iter()
            .find(|order| u64::from(order.number()) == number)
            .ok_or_else(|| node.out_of_range("1, 2 or 3"))?;
    }
    let coefficient = |node: &Node<'_>| match node.number()? {
        number if (0.0..=LARGEST_COEFFICIENT).contains(&number) => Ok(number),
        _ => Err(node.out_of_range("a number from 0 to 1e12")),
    };
    if let Some(node) = members.get("stretching") {
        options.stretching = coefficient(&node)?;
    }
    if let Some(node) = members.get("bending") {
        options.bending = coefficient(&node)?;
        if options.bending + options.stretching == 0.0 {
            return Err(node.out_of_range("above 0 where stretching is 0"));
        }
    }
    if let Some(node) = members.get("discretisation") {
        let text = node.string("a discretisation's name")?;
        let names = Discretisation::ALL.map(Discretisation::name);
        options.discretisation = *Discretisation::ALL
            .iter()
            .find(|discretisation| discretisation.name() == text)
            .ok_or_else(|| node.unknown_name(text, &names))?;
    }
    Ok(())
}

fn read_arap(members: &Members<'_>, options: &mut Arap) -> Result<(), EditError> {
    if let Some(node) = members.get("energy") {
        let text = node.string("an energy's name")?;
        let names = ArapEnergy::ALL.map(ArapEnergy::name);
        options.energy = *ArapEnergy::ALL
            .iter()
            .find(|energy| energy.name() == text)
            .ok_or_else(|| node.unknown_name(text, &names))?;
    }
    if let Some(node) = members.get("tolerance") {
        options.tolerance = match node.number()? {
            number if (1e-12..=0.1).contains(&number) => number,
            _ => return Err(node.out_of_range("a number from 1e-12 to 0.1")),
        };
    }
    if let Some(node) = members.get("max_iterations") {
        options.max_iterations = match node.whole()? {
            number @ 1..=100_000 => number as u32,
            _ => return Err(node.out_of_range("a whole number from 1 to 100000")),
        };
    }
    Ok(())
}

/// The method as the edit format has it: its name and what differs from its defaults.
pub(crate) fn method_to_value(method: &Method) -> Value {
    let mut members = Map::new();
    members.insert("name".to_owned(), json!(method.name()));
    if let Method::Bilaplacian(options) = method {
        let default = Bilaplacian::default();
        if options.order != default.order {
            members.insert("order".to_owned(), json!(options.order.number()));
        }
        if options.bending != default.bending {
            members.insert("bending".to_owned(), json!(options.bending));
        }
        if options.stretching != default.stretching {
            members.insert("stretching".to_owned(), json!(options.stretching));
        }
        if options.discretisation != default.discretisation {
            members.insert("discretisation".to_owned(), json!(options.discretisation.name()));
        }
    }
    if let Method::Arap(options) = method {
        let default = Arap::default();
        if options.energy != default.energy {
            members.insert("energy".to_owned(), json!(options.energy.name()));
        }
        if options.tolerance != default.tolerance {
            members.insert("tolerance".to_owned(), json!(options.tolerance));
        }
        if options.max_iterations != default.max_iterations {
            members.insert("max_iterations".to_owned(), json!(options.max_iterations));
        }
    }
    Value::Object(members)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use pliant_deform::{Discretisation, Method, ShellOrder};
    use serde_json::{Value, json};

    use super::{method_options, method_to_value, read_method};
    use crate::edit_error::EditError;
    use crate::edit_node::Node;

    fn read(value: &Value) -> Result<Method, EditError> {
        read_method(&Node::new(value, "method"))
    }

    #[test]
    fn every_option_of_the_shell_is_read_and_written_again() {
        let value = json!({
            "name": "bilaplacian", "order": 3, "stretching": 2.5, "bending": 0.5, "discretisation": "uniform"
        });
        let method = read(&value).unwrap();
        let Method::Bilaplacian(options) = &method else {
            unreachable!("{method:?}");
        };
        assert_eq!(
            (
                options.order,
                options.stretching,
                options.bending,
                options.discretisation
            ),
            (ShellOrder::CurvatureVariation, 2.5, 0.5, Discretisation::Uniform)
        );
        assert_eq!(method_to_value(&method), value);
        let listed = method_options("bilaplacian");
        for member in value.as_object().unwrap().keys().filter(|member| *member != "name") {
            assert!(listed.iter().any(|option| option.name == member), "{member}");
        }
        assert_eq!(listed.len() + 1, value.as_object().unwrap().len());
    }

    #[test]
    fn defaults_are_not_written() {
        let value = json!({ "name": "bilaplacian" });
        assert_eq!(method_to_value(&read(&value).unwrap()), value);
        let spelled = json!({ "name": "bilaplacian", "order": 2, "bending": 1, "discretisation": "cotangent-area" });
        assert_eq!(read(&spelled).unwrap(), Method::default());
    }

    #[test]
    fn every_option_of_arap_is_read_and_written_again_or_refused_by_name() {
        let value = json!({ "name": "arap", "energy": "spokes", "tolerance": 1e-6, "max_iterations": 40 });
        let method = read(&value).unwrap();
        assert_eq!(method_to_value(&method), value);
        assert_eq!(method_options("arap").len() + 1, value.as_object().unwrap().len());
        let default = json!({ "name": "arap" });
        assert_eq!(method_to_value(&read(&default).unwrap()), default);
        for (option, value) in [
            ("energy", json!("rims")),
            ("energy", json!(2)),
            ("tolerance", json!(0)),
            ("tolerance", json!(0.2)),
            ("tolerance", json!("little")),
            ("max_iterations", json!(0)),
            ("max_iterations", json!(100_001)),
            ("max_iterations", json!(1.5)),
            ("order", json!(2)),
        ] {
            let refused = read(&json!({ "name": "arap", option: value })).unwrap_err();
            assert!(refused.to_string().contains(option), "{refused}");
        }
    }

    #[test]
    fn options_out_of_range_are_refused_by_name() {
        for (option, value) in [
            ("order", json!(0)),
            ("order", json!(4)),
            ("order", json!(1.5)),
            ("order", json!("two")),
            ("stretching", json!(-1.0)),
            ("stretching", json!(1e13)),
            ("bending", json!(-0.1)),
            ("bending", json!(0)),
            ("bending", json!(null)),
            ("discretisation", json!("cotangents")),
            ("discretisation", json!(1)),
            ("ordre", json!(2)),
        ] {
            let refused = read(&json!({ "name": "bilaplacian", option: value })).unwrap_err();
            assert!(refused.to_string().contains(option), "{refused}");
        }
        let membrane = json!({ "name": "bilaplacian", "bending": 0, "stretching": 1 });
        assert_eq!(read(&membrane).unwrap().operator_power(), 1);
    }
}
