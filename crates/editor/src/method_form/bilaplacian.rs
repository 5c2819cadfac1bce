//! The linear shell's options in an edit.

use pliant_deform::{Bilaplacian, Discretisation, ShellOrder, Triangulation};
use serde_json::{Map, Value, json};

use super::{MethodOption, OptionKind};
use crate::edit_error::EditError;
use crate::edit_node::{Members, Node};

/// The largest coefficient of the linear shell.
const LARGEST_COEFFICIENT: f64 = 1e12;

pub(super) const OPTIONS: &[MethodOption] = &[
    MethodOption {
        name: "order",
        says: "1 membrane, 2 thin plate, 3 least change of curvature; default 2",
        takes: OptionKind::Numbered {
            choices: &[(1, "membrane"), (2, "thin plate"), (3, "least change of curvature")],
            default: 2,
        },
    },
    MethodOption {
        name: "bending",
        says: "resistance k_b to what the order names, 0 to 1e12; default 1",
        takes: OptionKind::Number {
            range: [0.0, LARGEST_COEFFICIENT],
            default: 1.0,
            unit: "",
        },
    },
    MethodOption {
        name: "stretching",
        says: "resistance k_s to stretching, in units of k_b per squared diagonal of the model, 0 to 1e12; default 0",
        takes: OptionKind::Number {
            range: [0.0, LARGEST_COEFFICIENT],
            default: 0.0,
            unit: "k_b/d²",
        },
    },
    MethodOption {
        name: "discretisation",
        says: "\"uniform\", \"cotangent\" or \"cotangent-area\" Laplacian; default \"cotangent-area\"",
        takes: OptionKind::Named {
            choices: &["uniform", "cotangent", "cotangent-area"],
            default: "cotangent-area",
        },
    },
    MethodOption {
        name: "triangulation",
        says: "triangles of the Laplacian: \"as-is\", or without negative weights \"intrinsic-delaunay\" or, also on \
               non-manifold meshes, \"tufted\"; default \"as-is\"",
        takes: OptionKind::Named {
            choices: &["as-is", "intrinsic-delaunay", "tufted"],
            default: "as-is",
        },
    },
    MethodOption {
        name: "anisotropy",
        says: "stiffer along what is long: 0 not at all, 1 as if the part that may move were as wide as long; default 0",
        takes: OptionKind::Number {
            range: [0.0, 1.0],
            default: 0.0,
            unit: "",
        },
    },
];

pub(super) fn read(members: &Members<'_>, options: &mut Bilaplacian) -> Result<(), EditError> {
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
    if let Some(node) = members.get("triangulation") {
        let text = node.string("a triangulation's name")?;
        let names = Triangulation::ALL.map(Triangulation::name);
        options.triangulation = *Triangulation::ALL
            .iter()
            .find(|triangulation| triangulation.name() == text)
            .ok_or_else(|| node.unknown_name(text, &names))?;
    }
    if let Some(node) = members.get("anisotropy") {
        options.anisotropy = match node.number()? {
            number if (0.0..=1.0).contains(&number) => number,
            _ => return Err(node.out_of_range("a number from 0 to 1")),
        };
    }
    Ok(())
}

/// Adds what differs from the defaults.
pub(super) fn write(options: &Bilaplacian, members: &mut Map<String, Value>) {
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
    if options.triangulation != default.triangulation {
        members.insert("triangulation".to_owned(), json!(options.triangulation.name()));
    }
    if options.anisotropy != default.anisotropy {
        members.insert("anisotropy".to_owned(), json!(options.anisotropy));
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use pliant_deform::{Discretisation, Method, ShellOrder};
    use serde_json::json;

    use super::super::tests::read;
    use super::super::{method_options, method_to_value};

    #[test]
    fn every_option_of_the_shell_is_read_and_written_again() {
        let value = json!({
            "name": "bilaplacian", "order": 3, "stretching": 2.5, "bending": 0.5, "discretisation": "uniform",
            "triangulation": "tufted", "anisotropy": 0.25
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
            ("triangulation", json!("delaunay")),
            ("anisotropy", json!(1.5)),
            ("anisotropy", json!(-0.5)),
            ("ordre", json!(2)),
        ] {
            let refused = read(&json!({ "name": "bilaplacian", option: value })).unwrap_err();
            assert!(refused.to_string().contains(option), "{refused}");
        }
        let membrane = json!({ "name": "bilaplacian", "bending": 0, "stretching": 1 });
        assert_eq!(read(&membrane).unwrap().operator_power(), 1);
    }
}
