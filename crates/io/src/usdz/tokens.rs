//! The tokens of a USD text layer, with their places.

use std::ops::Range;

/// A token.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Token<'a> {
    /// A name, a number or a keyword.
    Word(&'a [u8]),
    /// The content of a string, as written.
    Text(&'a [u8]),
    /// The path of another file, between `@`.
    Asset(&'a [u8]),
    /// The path of a prim or property, between `<` and `>`.
    Path(&'a [u8]),
    /// One of `()[]{}=,;`.
    Mark(u8),
}

/// A place in a layer's text that moves from token to token.
#[derive(Clone)]
pub(super) struct Tokens<'a> {
    text: &'a [u8],
    at: usize,
    end: usize,
}

impl<'a> Tokens<'a> {
    /// The tokens in a range of a text.
    pub fn new(text: &'a [u8], range: Range<usize>) -> Self {
        let end = range.end.min(text.len());
        Self {
            text,
            at: range.start.min(end),
            end,
        }
    }

    /// The place after the last token.
    pub fn at(&self) -> usize {
        self.at
    }

    /// The next token and its range, quotes included; `None` at the end.
    ///
    /// # Errors
    /// A string or path that does not end.
    pub fn next(&mut self) -> Result<Option<(Token<'a>, Range<usize>)>, String> {
        self.skip_blanks();
        let start = self.at;
        let rest = &self.text[start..self.end];
        let Some(&first) = rest.first() else {
            return Ok(None);
        };
        let token = match first {
            b'(' | b')' | b'[' | b']' | b'{' | b'}' | b'=' | b',' | b';' => {
                self.at += 1;
                Token::Mark(first)
            }
            b'"' | b'\'' => {
                let long = [first; 3];
                match rest.starts_with(&long) {
                    true => Token::Text(self.until(&long, 3)?),
                    false => Token::Text(self.until(&[first], 1)?),
                }
            }
            b'@' if rest.starts_with(b"@@@") => Token::Asset(self.until(b"@@@", 3)?),
            b'@' => Token::Asset(self.until(b"@", 1)?),
            b'<' => Token::Path(self.until(b">", 1)?),
            _ => {
                let ends = |byte: &u8| byte.is_ascii_whitespace() || b"()[]{}=,;\"'@<#".contains(byte);
                // A byte that begins nothing is a word of its own.
                let length = rest.iter().position(ends).unwrap_or(rest.len()).max(1);
                self.at += length;
                Token::Word(&rest[..length])
            }
        };
        Ok(Some((token, start..self.at)))
    }

    /// Moves past the brackets that close what the token before has opened.
    ///
    /// # Errors
    /// They do not close, or the text between has a string that does not end.
    pub fn skip_group(&mut self) -> Result<(), String> {
        let opened = self.at;
        let mut depth = 1_usize;
        while depth > 0 {
            match self.next()? {
                Some((Token::Mark(b'(' | b'[' | b'{'), _)) => depth += 1,
                Some((Token::Mark(b')' | b']' | b'}'), _)) => depth -= 1,
                Some(_) => {}
                None => return Err(format!("the bracket before byte {opened} does not close")),
            }
        }
        Ok(())
    }

    fn skip_blanks(&mut self) {
        while let Some(byte) = self.text[self.at..self.end].first() {
            match byte {
                b'#' => {
                    let rest = &self.text[self.at..self.end];
                    let line = rest.iter().position(|byte| *byte == b'\n');
                    self.at += line.unwrap_or(rest.len());
                }
                byte if byte.is_ascii_whitespace() => self.at += 1,
                _ => return,
            }
        }
    }

    /// The bytes between an opening of this length and the next mark.
    fn until(&mut self, mark: &[u8], opening: usize) -> Result<&'a [u8], String> {
        let start = self.at + opening;
        let mut at = start;
        while at < self.end {
            let rest = &self.text[at..self.end];
            if rest.starts_with(mark) {
                self.at = at + mark.len();
                return Ok(&self.text[start..at]);
            }
            // A backslash hides the letter after it, but not in paths.
            at += if rest[0] == b'\\' && matches!(mark[0], b'"' | b'\'') {
                2
            } else {
                1
            };
        }
        Err(format!("the text from byte {} on does not end", self.at))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn tokens_have_their_places() {
        let text = b"def Mesh \"a\\\"b\" { # rest\n point3f[] points = [(-1, 2e3)] @@@a@b@@@ </A/b> }";
        let mut tokens = Tokens::new(text, 0..text.len());
        let mut found = Vec::new();
        while let Some((token, range)) = tokens.next().unwrap() {
            found.push((token, String::from_utf8_lossy(&text[range]).into_owned()));
        }
        let shown: Vec<&str> = found.iter().map(|(_, text)| text.as_str()).collect();
        let wanted = [
            "def",
            "Mesh",
            "\"a\\\"b\"",
            "{",
            "point3f",
            "[",
            "]",
            "points",
            "=",
            "[",
            "(",
            "-1",
            ",",
            "2e3",
            ")",
            "]",
            "@@@a@b@@@",
            "</A/b>",
            "}",
        ];
        assert_eq!(shown, wanted);
        assert_eq!(found[2].0, Token::Text(b"a\\\"b"));
        assert_eq!(found[16].0, Token::Asset(b"a@b"));
        assert!(Tokens::new(b"\"open", 0..5).next().is_err());
        assert!(Tokens::new(b"a ( [ ]", 3..7).skip_group().is_err());
    }
}
