//! JSON values as text that a person can read and compare.

use std::fmt::Write;

use serde_json::Value;

/// The text of a value, with a newline at its end: a member or an element in each line, but lists of numbers, or of such
/// lists, in one, because an edit of a scan has thousands of them.
pub(super) fn text_of(value: &Value) -> String {
    let mut text = String::new();
    write(value, 0, &mut text);
    text.push('\n');
    text
}

fn write(value: &Value, depth: usize, text: &mut String) {
    let line = |text: &mut String, depth: usize| {
        text.push('\n');
        text.extend(std::iter::repeat_n("  ", depth));
    };
    // Writing to a String can't fail.
    match value {
        Value::Array(elements) if !elements.iter().all(is_numeric) => {
            text.push('[');
            for (index, element) in elements.iter().enumerate() {
                text.push_str(if index == 0 { "" } else { "," });
                line(text, depth + 1);
                write(element, depth + 1, text);
            }
            line(text, depth);
            text.push(']');
        }
        Value::Object(members) if !members.is_empty() => {
            text.push('{');
            for (index, (name, member)) in members.iter().enumerate() {
                text.push_str(if index == 0 { "" } else { "," });
                line(text, depth + 1);
                let _ = write!(text, "{}: ", Value::from(&**name));
                write(member, depth + 1, text);
            }
            line(text, depth);
            text.push('}');
        }
        other => {
            let _ = write!(text, "{other}");
        }
    }
}

/// Returns true for a number, and for a list of numbers or of such lists.
fn is_numeric(value: &Value) -> bool {
    match value {
        Value::Number(_) => true,
        Value::Array(elements) => elements.iter().all(is_numeric),
        _ => false,
    }
}
