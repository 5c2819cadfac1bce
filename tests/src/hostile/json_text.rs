//! Mutations of JSON text by its structure: values replaced, moved, nested and removed, members repeated and renamed,
//! numbers at the ends of their ranges. They work on text, because a tree of values can have neither a repeated member
//! nor a number like `1e999`.

use std::ops::Range;

use super::names;
use crate::trials::Chance;

/// Numbers that a range check may miss.
const NUMBERS: [&str; 26] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "3",
    "255",
    "65535",
    "65536",
    "4294967295",
    "4294967296",
    "9007199254740993",
    "18446744073709551615",
    "18446744073709551616",
    "-9223372036854775809",
    "0.5",
    "1e-7",
    "1e-320",
    "-1e-3",
    "1e6",
    "1e12",
    "1e38",
    "3.5e38",
    "1e300",
    "1.7976931348623157e308",
    "1e999",
];

const VALUES: [&str; 20] = [
    "null",
    "true",
    "false",
    "\"\"",
    "\"all\"",
    "\"none\"",
    "[]",
    "{}",
    "[null]",
    "[[]]",
    "[0,1]",
    "[1,0]",
    "[0,0,0]",
    "[1e300,0,0]",
    "[0,0,0,0]",
    "{\"not\":\"all\"}",
    "{\"union\":[]}",
    "{\"intersection\":[]}",
    "NaN",
    "-Infinity",
];

/// The places of the parts of a JSON text.
#[derive(Default, Debug)]
struct Places {
    /// Every value except the outermost.
    values: Vec<Range<usize>>,
    /// Every member, from its key's quote to its value's end.
    members: Vec<Range<usize>>,
    /// Every element of a list.
    elements: Vec<Range<usize>>,
    /// Every key with its quotes.
    keys: Vec<Range<usize>>,
}

/// Makes one change to a JSON text. A text without anything to change stays unchanged.
pub fn mutate(text: &mut Vec<u8>, chance: &mut Chance) {
    let places = places(text);
    if places.values.is_empty() {
        return;
    }
    let value = chance.of(&places.values).clone();
    let old = text[value.clone()].to_vec();
    match chance.below(12) {
        0 | 1 => {
            let is_number = |place: &&Range<usize>| matches!(text[place.start], b'-' | b'0'..=b'9');
            let numbers: Vec<_> = places.values.iter().filter(is_number).collect();
            if !numbers.is_empty() {
                let at = (*chance.of(&numbers)).clone();
                let new = number(&text[at.clone()], chance);
                text.splice(at, new);
            }
        }
        2 => drop(text.splice(value, chance.of(&VALUES).bytes())),
        3 => {
            let other = chance.of(&places.values).clone();
            let other = text[other].to_vec();
            text.splice(value, other);
        }
        4 => {
            let depth = *chance.of(&[1, 2, 100, 127, 128, 129, 5000, 100_000]);
            let (open, close) = *chance.of(&[("[", "]"), ("{\"not\":", "}"), ("{\"union\":[", "]}"), ("{\"a\":", "}")]);
            let nested = [open.repeat(depth).into_bytes(), old, close.repeat(depth).into_bytes()].concat();
            text.splice(value, nested);
        }
        5 if !places.members.is_empty() => remove(text, chance.of(&places.members).clone()),
        6 if !places.elements.is_empty() => remove(text, chance.of(&places.elements).clone()),
        7 | 8 if !places.members.is_empty() => {
            // Repeats a member, with its own value or with another's.
            let member = chance.of(&places.members).clone();
            let mut copy = text[member.clone()].to_vec();
            if chance.one_in(2) {
                let key_end = places
                    .keys
                    .iter()
                    .find(|key| key.start == member.start)
                    .map_or(0, |key| key.end);
                copy = [&text[member.start..key_end], b":", &old].concat();
            }
            copy.insert(0, b',');
            text.splice(member.end..member.end, copy);
        }
        9 if !places.keys.is_empty() => {
            let key = chance.of(&places.keys).clone();
            let new = if chance.one_in(2) {
                text[chance.of(&places.keys).clone()].to_vec()
            } else {
                quoted(&names::odd_text(chance))
            };
            text.splice(key, new);
        }
        10 if !places.elements.is_empty() => {
            let element = chance.of(&places.elements).clone();
            let times = *chance.of(&[1, 1, 2, 3, 50, 3000]);
            let copy = [b",", &text[element.clone()]].concat();
            let copy = copy.repeat(times.min(1 + 300_000 / copy.len()));
            text.splice(element.end..element.end, copy);
        }
        _ => {
            let is_text = |place: &&Range<usize>| text[place.start] == b'"';
            let texts: Vec<_> = places.values.iter().filter(is_text).collect();
            if texts.is_empty() {
                text.splice(value, quoted(&names::odd_text(chance)));
            } else {
                let at = (*chance.of(&texts)).clone();
                text.splice(at, quoted(&names::odd_text(chance)));
            }
        }
    }
}

/// Replaces the values of all members with this name, or of a random half of them.
pub fn set_some(text: &mut Vec<u8>, key: &str, new: &mut dyn FnMut(&mut Chance) -> Vec<u8>, chance: &mut Chance) {
    let quoted_key = quoted(key);
    let places = places(text);
    let mut found: Vec<Range<usize>> = places
        .members
        .iter()
        .zip(&places.keys)
        .filter(|(_, name)| text[(*name).clone()] == quoted_key[..])
        .map(|(member, name)| name.end..member.end)
        .collect();
    found.sort_by_key(|place| std::cmp::Reverse(place.start));
    let all = chance.one_in(2);
    for place in found {
        if all || chance.one_in(2) {
            let value = [b":".to_vec(), new(chance)].concat();
            text.splice(place, value);
        }
    }
}

/// The string values of all members with this name, at any depth.
pub fn texts_of(text: &[u8], key: &str) -> Vec<String> {
    let quoted_key = quoted(key);
    let places = places(text);
    let members = places.members.iter().zip(&places.keys);
    let values = members
        .filter(|(_, name)| text[(*name).clone()] == quoted_key[..])
        .map(|(member, name)| {
            let rest = &text[name.end..member.end];
            let colon = rest.iter().position(|byte| *byte == b':').map_or(0, |at| at + 1);
            &rest[colon..]
        });
    values.filter_map(|value| serde_json::from_slice(value).ok()).collect()
}

/// A text as a JSON string.
pub fn quoted(text: &str) -> Vec<u8> {
    serde_json::Value::from(text).to_string().into_bytes()
}

/// A number to replace another: near it, its opposite, or at the end of some range.
fn number(old: &[u8], chance: &mut Chance) -> Vec<u8> {
    let old = std::str::from_utf8(old).unwrap_or("0");
    let near = |by: i64| old.parse::<i64>().map(|number| number.wrapping_add(by).to_string());
    match chance.below(5) {
        0 => near(1),
        1 => near(-1),
        2 => old.parse::<i64>().map(|number| number.wrapping_mul(2).to_string()),
        _ => Ok((*chance.of(&NUMBERS)).to_owned()),
    }
    .unwrap_or_else(|_| format!("-{old}"))
    .replace("--", "")
    .into_bytes()
}

/// Removes a member or an element together with one comma beside it.
fn remove(text: &mut Vec<u8>, place: Range<usize>) {
    let after = text[place.end..].iter().position(|byte| !byte.is_ascii_whitespace());
    let before = text[..place.start].iter().rposition(|byte| !byte.is_ascii_whitespace());
    match (before, after) {
        (_, Some(space)) if text[place.end + space] == b',' => drop(text.drain(place.start..place.end + space + 1)),
        (Some(at), _) if text[at] == b',' => drop(text.drain(at..place.end)),
        _ => drop(text.drain(place)),
    }
}

/// Scans a text that is JSON or was; the scan ends where the text is no longer readable.
fn places(text: &[u8]) -> Places {
    let mut places = Places::default();
    // Open lists and objects: the start of each, and the incomplete member or element.
    let mut open: Vec<(usize, Option<usize>)> = Vec::new();
    let mut at = 0;
    while at < text.len() {
        match text[at] {
            b'{' | b'[' => {
                open.push((at, None));
                at += 1;
            }
            b'}' | b']' => {
                let Some((start, _)) = open.pop() else { break };
                at += 1;
                close(&mut places, text, &mut open, start..at);
            }
            b'"' => {
                let end = string_end(text, at);
                let after = end + text[end..].iter().take_while(|byte| byte.is_ascii_whitespace()).count();
                if text.get(after) == Some(&b':') {
                    places.keys.push(at..end);
                    // The member ends with its value. Until then this is a placeholder, which keeps the two lists the
                    // same length.
                    places.members.push(at..end);
                    let member = places.members.len() - 1;
                    if let Some((_, under_way)) = open.last_mut() {
                        *under_way = Some(member);
                    }
                    at = after + 1;
                } else {
                    close(&mut places, text, &mut open, at..end);
                    at = end;
                }
            }
            b' ' | b'\n' | b'\r' | b'\t' | b',' | b':' => at += 1,
            _ => {
                let rest = &text[at..];
                let length = rest
                    .iter()
                    .take_while(|byte| !b",]} \n\r\t:".contains(byte))
                    .count()
                    .max(1);
                close(&mut places, text, &mut open, at..at + length);
                at += length;
            }
        }
    }
    places
}

/// Records the end of a value.
fn close(places: &mut Places, text: &[u8], open: &mut [(usize, Option<usize>)], value: Range<usize>) {
    let Some((parent, under_way)) = open.last_mut() else {
        return;
    };
    if let Some(member) = under_way.take() {
        places.members[member].end = value.end;
    } else if text[*parent] == b'[' {
        places.elements.push(value.clone());
    }
    places.values.push(value);
}

/// The position after the closing quote of the string that begins at `start`.
fn string_end(text: &[u8], start: usize) -> usize {
    let mut at = start + 1;
    while at < text.len() {
        match text[at] {
            b'\\' => at += 2,
            b'"' => return at + 1,
            _ => at += 1,
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_member_and_element_is_found() {
        let text = br#"{"a": [1, {"b\"": "x,]"}], "c": null}"#;
        let found = places(text);
        let texts = |ranges: &[Range<usize>]| -> Vec<String> {
            ranges
                .iter()
                .map(|range| String::from_utf8_lossy(&text[range.clone()]).into_owned())
                .collect()
        };
        assert_eq!(texts(&found.keys), ["\"a\"", r#""b\"""#, "\"c\""]);
        assert_eq!(texts(&found.elements), ["1", r#"{"b\"": "x,]"}"#]);
        assert_eq!(texts(&found.members)[2], "\"c\": null");
        assert_eq!(found.values.len(), 5);
    }

    #[test]
    fn a_removed_member_leaves_json() {
        for member in 0..3 {
            let mut text = br#"{"a": 1, "b": [2], "c": {"d": 3}}"#.to_vec();
            let range = places(&text).members[member].clone();
            remove(&mut text, range);
            serde_json::from_slice::<serde_json::Value>(&text).unwrap();
        }
    }
}
