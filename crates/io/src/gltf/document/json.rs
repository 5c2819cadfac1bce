//! JSON as text: the place of each value, so that single values can be replaced and everything else keeps its bytes.
//!
//! A parsed document is a tape: one token per key or value, in the order of the text, each with its span and the token
//! after its whole subtree. A token takes twelve bytes and parsing does not recurse, so that neither deep nor long
//! files are a problem.

use std::ops::Range;

use serde::de::{DeserializeOwned, IgnoredAny};

/// A JSON text and its tape.
#[derive(Debug)]
pub(crate) struct Json {
    text: Vec<u8>,
    tape: Vec<Token>,
}

#[derive(Clone, Copy, Debug)]
struct Token {
    start: u32,
    end: u32,
    /// The token after this one's subtree.
    next: u32,
}

/// A value's place on the tape.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(crate) struct At(u32);

impl Json {
    /// Checks a text against JSON's grammar and notes the places of its values.
    pub fn parse(text: Vec<u8>) -> Result<Self, String> {
        if u32::try_from(text.len()).is_err() {
            return Err("its JSON is larger than 4 GiB".to_owned());
        }
        serde_json::from_slice::<IgnoredAny>(&text).map_err(|error| format!("its JSON is broken: {error}"))?;
        let tape = scan(&text);
        if tape.is_empty() {
            return Err("its JSON is empty".to_owned());
        }
        Ok(Self { text, tape })
    }

    /// The text as it was read.
    pub fn text(&self) -> &[u8] {
        &self.text
    }

    /// The outermost value.
    pub fn root(&self) -> At {
        At(0)
    }

    /// The value's bytes in the text, quotes and brackets included.
    pub fn span(&self, at: At) -> Range<usize> {
        let token = self.tape[at.0 as usize];
        token.start as usize..token.end as usize
    }

    /// The value as written.
    pub fn raw(&self, at: At) -> &[u8] {
        &self.text[self.span(at)]
    }

    /// Keys and values of an object, in order; nothing for any other value.
    pub fn members(&self, at: At) -> impl Iterator<Item = (At, At)> + '_ {
        let tokens = self.children(at, b'{');
        let mut tokens = tokens.peekable();
        std::iter::from_fn(move || Some((tokens.next()?, tokens.next()?)))
    }

    /// Elements of an array, in order; nothing for any other value.
    pub fn elements(&self, at: At) -> impl Iterator<Item = At> + '_ {
        self.children(at, b'[')
    }

    /// The value of an object's member.
    pub fn member(&self, at: At, key: &str) -> Option<At> {
        self.members(at)
            .find(|&(name, _)| self.is_string(name, key))
            .map(|(_, value)| value)
    }

    /// The value at the end of a path of keys.
    pub fn path(&self, at: At, keys: &[&str]) -> Option<At> {
        keys.iter().try_fold(at, |at, key| self.member(at, key))
    }

    /// The value as a number.
    pub fn number(&self, at: At) -> Option<f64> {
        std::str::from_utf8(self.raw(at)).ok()?.parse().ok()
    }

    /// The value as a string, its escapes resolved.
    pub fn string(&self, at: At) -> Option<String> {
        serde_json::from_slice(self.raw(at)).ok()
    }

    /// The value as a type of the `gltf` crate or any other.
    pub fn typed<T: DeserializeOwned>(&self, at: At) -> Result<T, String> {
        serde_json::from_slice(self.raw(at)).map_err(|error| error.to_string())
    }

    fn is_string(&self, at: At, wanted: &str) -> bool {
        let raw = self.raw(at);
        match raw {
            [b'"', inner @ .., b'"'] if !inner.contains(&b'\\') => inner == wanted.as_bytes(),
            _ => self.string(at).is_some_and(|string| string == wanted),
        }
    }

    fn children(&self, at: At, bracket: u8) -> impl Iterator<Item = At> + '_ {
        let token = self.tape[at.0 as usize];
        let end = if self.text[token.start as usize] == bracket {
            token.next
        } else {
            0
        };
        let mut child = at.0 + 1;
        std::iter::from_fn(move || {
            (child < end).then(|| {
                let here = At(child);
                child = self.tape[child as usize].next;
                here
            })
        })
    }
}

/// The tape of a text that is known to be JSON.
fn scan(text: &[u8]) -> Vec<Token> {
    let mut tape: Vec<Token> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    let mut at = 0;
    while at < text.len() {
        match text[at] {
            b'{' | b'[' => {
                open.push(tape.len());
                tape.push(Token {
                    start: at as u32,
                    end: 0,
                    next: 0,
                });
                at += 1;
            }
            b'}' | b']' => {
                at += 1;
                let length = tape.len() as u32;
                if let Some(token) = open.pop().and_then(|index| tape.get_mut(index)) {
                    token.end = at as u32;
                    token.next = length;
                }
            }
            b' ' | b'\t' | b'\n' | b'\r' | b',' | b':' => at += 1,
            first => {
                let end = if first == b'"' {
                    string_end(text, at)
                } else {
                    scalar_end(text, at)
                };
                let next = tape.len() as u32 + 1;
                tape.push(Token {
                    start: at as u32,
                    end: end as u32,
                    next,
                });
                at = end;
            }
        }
    }
    tape
}

/// The place after the closing quote of the string that opens at `start`.
fn string_end(text: &[u8], start: usize) -> usize {
    let mut at = start + 1;
    while at < text.len() {
        match text[at] {
            b'"' => return at + 1,
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
    text.len()
}

/// The place after the number or word that begins at `start`.
fn scalar_end(text: &[u8], start: usize) -> usize {
    let is_end = |byte: &u8| {
        matches!(
            byte,
            b' ' | b'\t' | b'\n' | b'\r' | b',' | b':' | b'}' | b']' | b'{' | b'[' | b'"'
        )
    };
    text[start + 1..]
        .iter()
        .position(is_end)
        .map_or(text.len(), |length| start + 1 + length)
}

/// Replacements in a text, applied at once.
#[derive(Clone, Debug, Default)]
pub(crate) struct Edits(Vec<(Range<usize>, String)>);

impl Edits {
    /// Replaces the bytes of `span` by `new`. Spans must not overlap; an empty span inserts.
    pub fn replace(&mut self, span: Range<usize>, new: impl Into<String>) {
        self.0.push((span, new.into()));
    }

    /// Adds elements, written out, to the end of an array.
    pub fn append_elements(&mut self, json: &Json, array: At, elements: &[String]) {
        if elements.is_empty() {
            return;
        }
        let added = elements.join(",");
        match json.elements(array).last() {
            Some(last) => self.insert(json.span(last).end, format!(",{added}")),
            None => self.insert(json.span(array).start + 1, added),
        }
    }

    /// Sets a member of an object: replaces the one of that name, or adds it as the last.
    pub fn set_member(&mut self, json: &Json, object: At, key: &str, value: &str) {
        match (json.member(object, key), json.members(object).last()) {
            (Some(old), _) => self.replace(json.span(old), value),
            (None, Some((_, last))) => self.insert(json.span(last).end, format!(",\"{key}\":{value}")),
            (None, None) => self.insert(json.span(object).start + 1, format!("\"{key}\":{value}")),
        }
    }

    /// Removes members of an object, with their commas; at most one call per object.
    pub fn remove_members(&mut self, json: &Json, object: At, keys: &[&str]) {
        let members = json.members(object).map(|(name, value)| {
            let is_removed = keys.iter().any(|key| json.is_string(name, key));
            (json.span(name).start..json.span(value).end, is_removed)
        });
        self.remove(&members.collect::<Vec<_>>());
    }

    /// Removes an element of an array, with its comma; at most one call per array.
    pub fn remove_element(&mut self, json: &Json, array: At, place: usize) {
        let elements = json.elements(array).enumerate();
        let elements = elements.map(|(number, at)| (json.span(at), number == place));
        self.remove(&elements.collect::<Vec<_>>());
    }

    /// Removes some parts of a list: each with the comma before it or, as long as none is kept, with the one after it.
    fn remove(&mut self, parts: &[(Range<usize>, bool)]) {
        let first_kept = parts.iter().position(|(_, is_removed)| !is_removed);
        for (place, (own, _)) in parts.iter().enumerate().filter(|(_, (_, is_removed))| *is_removed) {
            let span = match parts.get(place + 1) {
                _ if first_kept.is_some_and(|kept| kept < place) => parts[place - 1].0.end..own.end,
                Some((next, _)) => own.start..next.start,
                None => own.clone(),
            };
            self.replace(span, "");
        }
    }

    /// Returns true if there is nothing to do.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// `text[within]` with the replacements inside it.
    pub fn apply(&self, text: &[u8], within: Range<usize>) -> Vec<u8> {
        let mut edits: Vec<&(Range<usize>, String)> = self
            .0
            .iter()
            .filter(|(span, _)| span.start >= within.start && span.end <= within.end)
            .collect();
        // A stable sort: insertions at one place stay in the order of their requests.
        edits.sort_by_key(|(span, _)| span.start);
        let mut out = Vec::with_capacity(within.len() + edits.iter().map(|(_, new)| new.len()).sum::<usize>());
        let mut at = within.start;
        for (span, new) in edits {
            out.extend_from_slice(&text[at..span.start.max(at)]);
            out.extend_from_slice(new.as_bytes());
            at = at.max(span.end);
        }
        out.extend_from_slice(&text[at..within.end]);
        out
    }

    fn insert(&mut self, at: usize, new: String) {
        self.replace(at..at, new);
    }
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    const TEXT: &str = "{ \"a\" : [1, 2.50, {\"b\":[]}],\n\"c\\\"\": \"x,]\", \"d\":{} , \"e\":-1e3}  ";

    fn parsed() -> Json {
        Json::parse(TEXT.as_bytes().to_vec()).unwrap()
    }

    #[test]
    fn values_are_found_where_they_stand() {
        let json = parsed();
        let a = json.member(json.root(), "a").unwrap();
        let elements: Vec<At> = json.elements(a).collect();
        assert_eq!(json.raw(elements[1]), b"2.50");
        assert_eq!(json.elements(json.member(elements[2], "b").unwrap()).count(), 0);
        assert_eq!(json.string(json.member(json.root(), "c\"").unwrap()).unwrap(), "x,]");
        assert_eq!(json.number(json.member(json.root(), "e").unwrap()), Some(-1000.0));
        assert_eq!(json.members(json.root()).count(), 4);
        assert!(json.path(json.root(), &["d", "x"]).is_none());
    }

    #[test]
    fn edits_change_their_spans_and_nothing_else() {
        let json = parsed();
        let mut edits = Edits::default();
        assert_eq!(edits.apply(json.text(), 0..TEXT.len()), TEXT.as_bytes());
        let a = json.member(json.root(), "a").unwrap();
        let b = json.member(json.elements(a).last().unwrap(), "b").unwrap();
        edits.set_member(&json, json.member(json.root(), "d").unwrap(), "k", "7");
        edits.set_member(&json, json.root(), "e", "0");
        edits.set_member(&json, json.root(), "f", "1");
        edits.append_elements(&json, a, &["8".to_owned(), "9".to_owned()]);
        edits.append_elements(&json, b, &["5".to_owned()]);
        let out = String::from_utf8(edits.apply(json.text(), 0..TEXT.len())).unwrap();
        assert_eq!(
            out,
            "{ \"a\" : [1, 2.50, {\"b\":[5]},8,9],\n\"c\\\"\": \"x,]\", \"d\":{\"k\":7} , \"e\":0,\"f\":1}  "
        );
    }

    #[test]
    fn a_member_is_taken_out_with_its_comma() {
        let json = Json::parse(b"{\"a\":1, \"b\" : [7, 8 ,9] ,\"c\":{\"d\":0}}".to_vec()).unwrap();
        let without = |edit: &dyn Fn(&mut Edits)| {
            let mut edits = Edits::default();
            edit(&mut edits);
            String::from_utf8(edits.apply(json.text(), 0..json.text().len())).unwrap()
        };
        let remove_all = |keys: &[&str]| without(&|edits: &mut Edits| edits.remove_members(&json, json.root(), keys));
        let remove = |key: &str| remove_all(&[key]);
        assert_eq!(remove("a"), "{\"b\" : [7, 8 ,9] ,\"c\":{\"d\":0}}");
        assert_eq!(remove("b"), "{\"a\":1 ,\"c\":{\"d\":0}}");
        assert_eq!(remove("c"), "{\"a\":1, \"b\" : [7, 8 ,9]}");
        assert_eq!(remove_all(&["a", "b"]), "{\"c\":{\"d\":0}}");
        assert_eq!(remove_all(&["b", "c"]), "{\"a\":1}");
        assert_eq!(remove_all(&["a", "c"]), "{\"b\" : [7, 8 ,9]}");
        assert_eq!(remove_all(&["a", "b", "c"]), "{}");
        let [b, c] = ["b", "c"].map(|key| json.member(json.root(), key).unwrap());
        let emptied = without(&|edits: &mut Edits| edits.remove_members(&json, c, &["d"]));
        assert!(emptied.ends_with("\"c\":{}}"));
        for (place, left) in ["[8 ,9]", "[7 ,9]", "[7, 8]"].iter().enumerate() {
            assert!(without(&|edits: &mut Edits| edits.remove_element(&json, b, place)).contains(left));
        }
    }

    #[test]
    fn broken_texts_are_refused() {
        for text in ["", " ", "{", "[1,]", "{\"a\" 1}", "\"", "nul", "{\"a\":1}}"] {
            assert!(Json::parse(text.as_bytes().to_vec()).is_err(), "{text}");
        }
        let deep = "[".repeat(300_000) + &"]".repeat(300_000);
        assert!(Json::parse(deep.into_bytes()).is_ok_and(|json| json.elements(json.root()).count() == 1));
    }
}
