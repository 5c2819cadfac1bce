//! ARAP's options in an edit.

use pliant_deform::{Arap, ArapEnergy};
use serde_json::{Map, Value, json};

use super::{MethodOption, OptionKind, iteration};
use crate::edit_error::EditError;
use crate::edit_node::Members;

pub(super) const OPTIONS: &[MethodOption] = &[
    MethodOption {
        name: "energy",
        says: "a vertex's cell: \"spokes\", its edges, \"spokes-and-rims\", its triangles' edges, or \"smooth\", those and how it bends; default \"spokes-and-rims\"",
        takes: OptionKind::Named {
            choices: &["spokes", "spokes-and-rims", "smooth"],
            default: "spokes-and-rims",
        },
    },
    MethodOption {
        name: "smoothness",
        says: "how much the energy \"smooth\" resists bending, whatever the mesh's size and density, 1e-6 to 10; default 0.003",
        takes: OptionKind::Number {
            range: [*Arap::SMOOTHNESS.start(), *Arap::SMOOTHNESS.end()],
            default: 0.003,
            unit: "",
        },
    },
    iteration::TOLERANCE,
    iteration::MAX_ITERATIONS,
];

pub(super) fn read(members: &Members<'_>, options: &mut Arap) -> Result<(), EditError> {
    if let Some(node) = members.get("energy") {
        let text = node.string("an energy's name")?;
        let names = ArapEnergy::ALL.map(ArapEnergy::name);
        options.energy = *ArapEnergy::ALL
            .iter()
            .find(|energy| energy.name() == text)
            .ok_or_else(|| node.unknown_name(text, &names))?;
    }
    if let Some(node) = members.get("smoothness") {
        options.smoothness = match node.number()? {
            number if Arap::SMOOTHNESS.contains(&number) => number,
            _ => return Err(node.out_of_range("a number from 1e-6 to 10")),
        };
    }
    iteration::read(members, &mut options.tolerance, &mut options.max_iterations)
}

/// Adds what differs from the defaults.
pub(super) fn write(options: &Arap, members: &mut Map<String, Value>) {
    let default = Arap::default();
    if options.energy != default.energy {
        members.insert("energy".to_owned(), json!(options.energy.name()));
    }
    if options.smoothness != default.smoothness {
        members.insert("smoothness".to_owned(), json!(options.smoothness));
    }
    if options.tolerance != default.tolerance {
        members.insert("tolerance".to_owned(), json!(options.tolerance));
    }
    if options.max_iterations != default.max_iterations {
        members.insert("max_iterations".to_owned(), json!(options.max_iterations));
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use serde_json::json;

    use super::super::tests::read;
    use super::super::{method_options, method_to_value};

    #[test]
    fn every_option_of_arap_is_read_and_written_again_or_refused_by_name() {
        let value =
            json!({ "name": "arap", "energy": "smooth", "smoothness": 0.5, "tolerance": 1e-6, "max_iterations": 40 });
        let method = read(&value).unwrap();
        assert_eq!(method_to_value(&method), value);
        assert_eq!(method_options("arap").len() + 1, value.as_object().unwrap().len());
        let default = json!({ "name": "arap" });
        assert_eq!(method_to_value(&read(&default).unwrap()), default);
        for (option, value) in [
            ("energy", json!("rims")),
            ("energy", json!(2)),
            ("smoothness", json!(0)),
            ("smoothness", json!(11)),
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
}
