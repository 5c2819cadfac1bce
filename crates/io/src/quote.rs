//! Text from a file or a name, made safe for a message.

/// The most characters of foreign text that a message shows.
const MOST: usize = 200;

/// The number of a longer text's first characters that are shown; its last ones fill the rest.
const HEAD: usize = 120;

/// `text` as a message may show it: one line of at most 200 characters.
///
/// Control characters, line separators and marks that turn the direction of writing become U+FFFD, so that a file's
/// words can't steer a terminal or rearrange the sentence around them. A longer text keeps its beginning and its end (a
/// path's last part says most), with `…` between them. No quotation marks are added.
pub fn quoted(text: &str) -> String {
    let shown = |letter: char| if steers(letter) { '\u{fffd}' } else { letter };
    // No text has more characters than bytes, so most need no counting.
    let count = if text.len() <= MOST { 0 } else { text.chars().count() };
    if count <= MOST {
        return text.chars().map(shown).collect();
    }
    let tail = MOST - HEAD - 1;
    let head = text.chars().take(HEAD).map(shown);
    let mut out: String = head.collect();
    out.push('…');
    out.extend(text.chars().skip(count - tail).map(shown));
    out
}

/// The most names in a list of [`listed`].
const MOST_NAMES: usize = 8;

/// Names as a message lists them: each [`quoted`], with a count in place of those beyond the eighth.
pub(crate) fn listed(names: &[&str]) -> String {
    let mut list: Vec<String> = names.iter().take(MOST_NAMES).map(|name| quoted(name)).collect();
    if names.len() > MOST_NAMES {
        list.push(format!("{} more", names.len() - MOST_NAMES));
    }
    list.join(", ")
}

/// Returns true if a character controls a terminal or a line of text instead of being shown.
pub fn steers(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_text_stays_as_it_is() {
        for text in ["", "scan.glb", "ä ö/漢字/مرحبا.gltf", "👩‍🚀 \"quoted\" 'text'"] {
            assert_eq!(quoted(text), text);
        }
        let longest = "ä".repeat(MOST);
        assert_eq!(quoted(&longest), longest);
    }

    #[test]
    fn nothing_that_steers_a_terminal_comes_through() {
        let steering = (0..=0x9f_u32).chain(0x200e..0x2070).chain([0x61c]);
        for letter in steering.filter_map(char::from_u32).filter(|&letter| steers(letter)) {
            assert_eq!(quoted(&format!("a{letter}b")), "a\u{fffd}b", "{letter:?}");
        }
        for letter in [
            '\u{1b}', '\n', '\r', '\u{7f}', '\u{9b}', '\u{202e}', '\u{2066}', '\u{2028}',
        ] {
            assert!(steers(letter), "{letter:?}");
        }
    }

    #[test]
    fn a_long_text_is_cut_to_two_hundred_characters_and_keeps_both_ends() {
        for length in [MOST + 1, 1000, 1_000_000] {
            let text: String = format!("first{}last", "x".repeat(length - 9));
            let cut = quoted(&text);
            assert_eq!(cut.chars().count(), MOST);
            assert!(cut.starts_with("first") && cut.ends_with("last") && cut.contains('…'));
        }
    }
}
