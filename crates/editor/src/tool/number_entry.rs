//! A number typed during a transform: digits, a point and a sign, taken back with Backspace.

use crate::input::Key;

/// The typed text.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(crate) struct NumberEntry {
    digits: String,
    negative: bool,
}

impl NumberEntry {
    /// Takes a key; false if it is not part of a number.
    pub(crate) fn take(&mut self, key: Key) -> bool {
        let key = match key {
            Key::Numpad(digit) => Key::Character(char::from(b'0' + digit.min(9))),
            key => key,
        };
        match key {
            Key::Character(digit) if digit.is_ascii_digit() && self.digits.len() < 15 => self.digits.push(digit),
            Key::Character('.' | ',') if !self.digits.contains('.') => self.digits.push('.'),
            Key::Character('-') => self.negative = !self.negative,
            Key::Backspace if !self.digits.is_empty() => {
                self.digits.pop();
            }
            Key::Backspace if self.negative => self.negative = false,
            _ => return false,
        }
        true
    }

    /// The number, after at least one digit.
    pub(crate) fn value(&self) -> Option<f64> {
        let value: f64 = self.digits.parse().ok()?;
        Some(if self.negative { -value } else { value })
    }

    /// The text as typed; empty if nothing was typed.
    pub(crate) fn text(&self) -> String {
        format!("{}{}", if self.negative { "-" } else { "" }, self.digits)
    }
}

#[cfg(test)]
mod tests {
    use super::NumberEntry;
    use crate::input::Key;

    #[test]
    fn typed_characters_make_the_number() {
        for (typed, value) in [
            ("12.5", Some(12.5)),
            ("-3", Some(-3.0)),
            ("3-", Some(-3.0)),
            (".5", Some(0.5)),
            ("--2", Some(2.0)),
            ("-", None),
            ("1..2", Some(1.2)),
        ] {
            let mut entry = NumberEntry::default();
            for character in typed.chars() {
                entry.take(Key::Character(character));
            }
            assert_eq!(entry.value(), value, "{typed}");
        }
    }

    #[test]
    fn backspace_takes_back_one_character_and_then_is_not_ours() {
        let mut entry = NumberEntry::default();
        entry.take(Key::Character('-'));
        entry.take(Key::Character('4'));
        assert!(entry.take(Key::Backspace) && entry.text() == "-");
        assert!(entry.take(Key::Backspace) && entry.text().is_empty());
        assert!(!entry.take(Key::Backspace));
    }
}
