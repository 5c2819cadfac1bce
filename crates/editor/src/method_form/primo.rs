//! The coupled prisms' options in an edit.

use pliant_deform::Primo;
use serde_json::{Map, Value, json};

use super::{MethodOption, OptionKind, iteration};
use crate::edit_error::EditError;
use crate::edit_node::Members;

pub(super) const OPTIONS: &[MethodOption] = &[
    MethodOption {
        name: "thickness",
        says: "the prisms' height, how much bending is resisted against stretching, in diagonals of the model, 0.001 to 1; default 0.05",
        takes: OptionKind::Number {
            range: [0.001, 1.0],
            default: 0.05,
            unit: "diagonals",
        },
    },
    iteration::TOLERANCE,
    iteration::MAX_ITERATIONS,
];

pub(super) fn read(members: &Members<'_>, options: &mut Primo) -> Result<(), EditError> {
    if let Some(node) = members.get("thickness") {
        options.thickness = match node.number()? {
            number if (0.001..=1.0).contains(&number) => number,
            _ => return Err(node.out_of_range("a number from 0.001 to 1")),
        };
    }
    iteration::read(members, &mut options.tolerance, &mut options.max_iterations)
}

/// Adds what differs from the defaults.
pub(super) fn write(options: &Primo, members: &mut Map<String, Value>) {
    let default = Primo::default();
    if options.thickness != default.thickness {
        members.insert("thickness".to_owned(), json!(options.thickness));
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

    use super::super::method_to_value;
    use super::super::tests::read;

    #[test]
    fn every_option_of_the_prisms_is_read_and_written_again_or_refused_by_name() {
        let value = json!({ "name": "primo", "thickness": 0.1, "tolerance": 1e-6, "max_iterations": 40 });
        assert_eq!(method_to_value(&read(&value).unwrap()), value);
        let default = json!({ "name": "primo" });
        assert_eq!(method_to_value(&read(&default).unwrap()), default);
        for (option, value) in [
            ("thickness", json!(0)),
            ("thickness", json!(1.5)),
            ("thickness", json!("thin")),
            ("tolerance", json!(0)),
            ("max_iterations", json!(0)),
            ("energy", json!("spokes")),
        ] {
            let refused = read(&json!({ "name": "primo", option: value })).unwrap_err();
            assert!(refused.to_string().contains(option), "{refused}");
        }
    }
}
