//! A text layer as a tree of prims, whose properties' values stay text until they are needed.

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

use pliant_mesh::Cancel;

use super::fault::Fault;
use super::tokens::{Token, Tokens};

/// Tokens between two checks for cancelling.
const TOKENS_BETWEEN_LOOKS: usize = 1 << 14;

/// The metadata that bring in other layers or other opinions.
const COMPOSITION: [&[u8]; 9] = [
    b"references",
    b"payload",
    b"inherits",
    b"specializes",
    b"variants",
    b"variantSets",
    b"subLayers",
    b"clips",
    b"instanceable",
];

/// A property.
#[derive(Debug)]
pub(super) struct Property {
    /// Its type with `[]` for an array.
    pub kind: String,
    /// The place of its value.
    pub value: Range<usize>,
    /// The place of its metadata.
    pub metadata: Range<usize>,
}

/// A prim of the layer.
#[derive(Debug)]
pub(super) struct Prim {
    pub name: String,
    /// Its type; empty if the layer gives none.
    pub kind: String,
    /// False for `over` and `class`, which show nothing by themselves.
    pub is_defined: bool,
    pub parent: Option<usize>,
    pub children: Vec<usize>,
    pub properties: BTreeMap<String, Property>,
}

/// A layer.
#[derive(Debug, Default)]
pub(super) struct Layer {
    /// Every prim, parents before their children.
    pub prims: Vec<Prim>,
    /// Prims by their parents and names.
    known: HashMap<(Option<usize>, String), usize>,
}

impl Layer {
    /// The prim with a path such as `/A/b`, which may end with a property.
    pub fn prim(&self, path: &str) -> Option<usize> {
        let path = path.split_once('.').map_or(path, |(prim, _)| prim);
        let mut found = None;
        for name in path.strip_prefix('/')?.split('/') {
            found = Some(*self.known.get(&(found, name.to_owned()))?);
        }
        found
    }
}

/// Reads a layer.
///
/// # Errors
/// The layer is no text of USD, or needs other layers.
pub(super) fn layer(text: &[u8], cancel: &Cancel) -> Result<Layer, Fault> {
    if !text.starts_with(b"#usda 1") {
        return Err(Fault::Malformed("its layer does not begin with #usda 1.0".to_owned()));
    }
    let mut tokens = Tokens::new(text, 0..text.len());
    let mut layer = Layer::default();
    let mut open: Option<usize> = None;
    let mut words: Vec<&[u8]> = Vec::new();
    let mut passed = 0_usize;
    while let Some((token, range)) = tokens.next()? {
        passed += 1;
        if passed.is_multiple_of(TOKENS_BETWEEN_LOOKS) {
            cancel.check().map_err(|stopped| Fault::Stopped(stopped.into()))?;
        }
        match token {
            Token::Word(word) => words.push(word),
            // The layer's own metadata.
            Token::Mark(b'(') if open.is_none() && words.is_empty() => {
                metadata(text, &mut tokens)?;
            }
            Token::Text(name) if is_specifier(&words) => {
                let prim = begun(&mut tokens, text, name, &words, (open, &mut layer))?;
                open = Some(prim);
                words.clear();
            }
            Token::Text(_) if words.contains(&b"variantSet".as_slice()) => return Err(Fault::Composed),
            Token::Mark(b'[') if !words.is_empty() => words.push(b"["),
            Token::Mark(b']') if words.last() == Some(&b"[".as_slice()) => {}
            Token::Mark(b'=') if let Some(prim) = open => {
                property(&mut tokens, &words, &mut layer.prims[prim])?;
                words.clear();
            }
            Token::Mark(b'}') => {
                let Some(prim) = open else {
                    return Err(unexpected(range.start));
                };
                open = layer.prims[prim].parent;
                words.clear();
            }
            Token::Mark(b';') => words.clear(),
            // The metadata of a property without a value.
            Token::Mark(b'(') => {
                tokens.skip_group()?;
                words.clear();
            }
            _ => return Err(unexpected(range.start)),
        }
        // Properties without a value follow each other without a mark between them.
        if words.len() > 64 {
            words.drain(..32);
        }
    }
    match open {
        Some(_) => Err(Fault::Malformed("its layer ends within a prim".to_owned())),
        None => Ok(layer),
    }
}

fn unexpected(at: usize) -> Fault {
    Fault::Malformed(format!("byte {at} of its layer is unexpected"))
}

/// Returns true if the last words begin a prim: a specifier, and a type.
fn is_specifier(words: &[&[u8]]) -> bool {
    let is = |word: Option<&&[u8]>| matches!(word.copied(), Some(b"def" | b"over" | b"class"));
    let count = words.len();
    is(words.last()) || (count > 1 && is(words.get(count - 2)))
}

/// Reads a prim up to the brace that opens it, and gives its number.
fn begun(
    tokens: &mut Tokens<'_>,
    text: &[u8],
    name: &[u8],
    words: &[&[u8]],
    (parent, layer): (Option<usize>, &mut Layer),
) -> Result<usize, Fault> {
    let specifier = words
        .iter()
        .rposition(|word| matches!(*word, b"def" | b"over" | b"class"));
    let specifier = specifier.unwrap_or_default();
    let kind = words.get(specifier + 1).copied().unwrap_or_default();
    let name = String::from_utf8_lossy(name).into_owned();
    let number = layer.prims.len();
    layer.known.insert((parent, name.clone()), number);
    layer.prims.push(Prim {
        name,
        kind: String::from_utf8_lossy(kind).into_owned(),
        is_defined: words[specifier] == b"def",
        parent,
        children: Vec::new(),
        properties: BTreeMap::new(),
    });
    if let Some(parent) = parent {
        layer.prims[parent].children.push(number);
    }
    loop {
        match tokens.next()? {
            Some((Token::Mark(b'('), _)) => metadata(text, tokens)?,
            Some((Token::Mark(b'{'), _)) => return Ok(number),
            _ => return Err(unexpected(tokens.at())),
        }
    }
}

/// Moves past metadata whose bracket is open, and refuses those that name other layers.
fn metadata(text: &[u8], tokens: &mut Tokens<'_>) -> Result<(), Fault> {
    let start = tokens.at();
    tokens.skip_group()?;
    let mut inner = Tokens::new(text, start..tokens.at());
    while let Some((token, _)) = inner.next()? {
        match token {
            Token::Word(word) if COMPOSITION.contains(&word) => return Err(Fault::Composed),
            Token::Mark(b'(' | b'[' | b'{') => inner.skip_group()?,
            _ => {}
        }
    }
    Ok(())
}

/// Reads a property's value and metadata, after its `=`.
fn property(tokens: &mut Tokens<'_>, words: &[&[u8]], prim: &mut Prim) -> Result<(), Fault> {
    let Some((name, before)) = words.split_last() else {
        return Err(unexpected(tokens.at()));
    };
    let is_array = before.last() == Some(&b"[".as_slice());
    let kind = before
        .iter()
        .rev()
        .find(|word| **word != b"[")
        .copied()
        .unwrap_or_default();
    let kind = format!("{}{}", String::from_utf8_lossy(kind), if is_array { "[]" } else { "" });
    let Some((first, range)) = tokens.next()? else {
        return Err(unexpected(tokens.at()));
    };
    if matches!(first, Token::Mark(b'(' | b'[' | b'{')) {
        tokens.skip_group()?;
    }
    let value = range.start..tokens.at();
    let mut ahead = tokens.clone();
    let mut metadata = value.end..value.end;
    if let Some((Token::Mark(b'('), range)) = ahead.next()? {
        ahead.skip_group()?;
        metadata = range.end..ahead.at().saturating_sub(1);
        *tokens = ahead;
    }
    let name = String::from_utf8_lossy(name).into_owned();
    prim.properties.insert(name, Property { kind, value, metadata });
    Ok(())
}
