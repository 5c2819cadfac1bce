//! Methods on the command line: `arap`, or `arap:energy=smooth` with some of its options set.

use pliant_deform::{METHODS, Method, OptionKind, OptionRefused, OptionValue};
use pliant_io::quoted;

use pliant_engine::EngineError;

/// The method that `text`, the value of `option`, names; options that it does not set have their defaults.
///
/// # Errors
/// An unknown name, or a value that the option does not take.
pub(super) fn method_argument(option: &str, text: &str) -> Result<Method, EngineError> {
    let mut parts = text.split(':');
    let name = parts.next().unwrap_or_default();
    let refuse = |why: String| EngineError::Arguments(format!("{option} {}: {why}", quoted(text)));
    let method = Method::from_name(name).ok_or_else(|| {
        let names: Vec<&str> = METHODS.iter().map(|declaration| declaration.name).collect();
        EngineError::Arguments(format!(
            "{option} {} is not known: use one of {}",
            quoted(name),
            names.join(", ")
        ))
    })?;
    let mut values = Vec::new();
    for part in parts {
        let (key, value) = part
            .split_once('=')
            .ok_or_else(|| refuse(format!("an option is set as OPTION=VALUE, not as {}", quoted(part))))?;
        let declared = method.declaration().options.iter().find(|own| own.name == key);
        // The method itself refuses an unknown option, with the same words as in an edit.
        let value = declared.map_or(Some(OptionValue::Switch(true)), |own| value_of(own.kind, value));
        let value = value.ok_or_else(|| {
            let allowed = declared.map(|own| own.kind.allowed()).unwrap_or_default();
            refuse(format!("the option `{key}` takes {allowed}"))
        })?;
        values.push((key, value));
    }
    let refused =
        |OptionRefused { option, allowed }| refuse(format!("the option `{}` takes {allowed}", quoted(&option)));
    method.with(values).map_err(refused)
}

/// A value of this kind; `None` if the text is not one.
fn value_of(kind: OptionKind, text: &str) -> Option<OptionValue> {
    match kind {
        OptionKind::Number { .. } => text.parse().ok().map(OptionValue::Number),
        OptionKind::Whole { .. } | OptionKind::Numbered { .. } => text.parse().ok().map(OptionValue::Whole),
        OptionKind::Named { choices } => choices
            .iter()
            .find(|name| **name == text)
            .map(|name| OptionValue::Name(name)),
        OptionKind::Switch => text.parse().ok().map(OptionValue::Switch),
    }
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn every_option_can_be_set_to_its_default_and_a_wrong_value_is_refused_by_name() {
        for declaration in METHODS {
            let method = method_argument("--method", declaration.name).unwrap();
            assert_eq!(method, (declaration.default)());
            for own in declaration.options {
                let value = match method.value(own.name).unwrap() {
                    OptionValue::Number(number) => number.to_string(),
                    OptionValue::Whole(number) => number.to_string(),
                    OptionValue::Name(name) => name.to_owned(),
                    OptionValue::Switch(switch) => switch.to_string(),
                };
                let set =
                    |value: &str| method_argument("--method", &format!("{}:{}={value}", declaration.name, own.name));
                assert_eq!(set(&value).unwrap(), method);
                let said = set("banana").unwrap_err().to_string();
                assert!(said.contains(own.name) && said.contains("banana"), "{said}");
            }
            for (wrong, word) in [("no-such=1", "no-such"), ("alone", "OPTION=VALUE")] {
                let said = method_argument("--method", &format!("{}:{wrong}", declaration.name)).unwrap_err();
                assert!(said.to_string().contains(word), "{said}");
            }
        }
        let smooth = method_argument("--method", "arap:energy=smooth:smoothness=0.01").unwrap();
        assert_eq!(smooth.value("energy"), Some(OptionValue::Name("smooth")));
        assert_eq!(smooth.value("smoothness"), Some(OptionValue::Number(0.01)));
    }
}
