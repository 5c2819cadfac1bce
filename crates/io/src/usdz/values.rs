//! Values of properties: numbers, words and paths in a range of a layer's text.

use std::ops::Range;

use super::layer::{Prim, Property};
use super::tokens::{Token, Tokens};

/// Calls `visit` with each number of a value and its place.
///
/// # Errors
/// Something else is among them.
pub(super) fn each_number(
    text: &[u8],
    value: &Range<usize>,
    mut visit: impl FnMut(f64, Range<usize>),
) -> Result<(), String> {
    let mut tokens = Tokens::new(text, value.clone());
    while let Some((token, range)) = tokens.next()? {
        match token {
            Token::Mark(_) | Token::Word(b"None") => {}
            Token::Word(word) => {
                let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
                let number = number.ok_or_else(|| format!("byte {} is no number", range.start))?;
                visit(number, range);
            }
            _ => return Err(format!("byte {} is no number", range.start)),
        }
    }
    Ok(())
}

/// The numbers of a value.
///
/// # Errors
/// Something else is among them.
pub(super) fn numbers(text: &[u8], value: &Range<usize>) -> Result<Vec<f64>, String> {
    let mut found = Vec::new();
    each_number(text, value, |number, _| found.push(number))?;
    Ok(found)
}

/// The vectors of a value, each with the place of its first number. f32: looks are only drawn.
///
/// # Errors
/// Something else is among them, or the last vector is incomplete.
pub(super) fn vectors<const N: usize>(text: &[u8], value: &Range<usize>) -> Result<Vec<[f32; N]>, String> {
    let mut found: Vec<[f32; N]> = Vec::new();
    let mut place = 0;
    each_number(text, value, |number, _| {
        if place == 0 {
            found.push([0.0; N]);
        }
        if let Some(last) = found.last_mut() {
            last[place] = number as f32;
        }
        place = (place + 1) % N;
    })?;
    match place {
        0 => Ok(found),
        _ => Err(format!("the value at byte {} ends within a vector", value.start)),
    }
}

/// The indices of a value.
///
/// # Errors
/// Something else than numbers from 0 to 4294967294 is among them.
pub(super) fn indices(text: &[u8], value: &Range<usize>) -> Result<Vec<u32>, String> {
    let mut found = Vec::new();
    let mut wrong = None;
    each_number(text, value, |number, range| {
        match (0.0..f64::from(u32::MAX)).contains(&number) && number.fract() == 0.0 {
            true => found.push(number as u32),
            false => wrong = wrong.or(Some(range.start)),
        }
    })?;
    wrong.map_or(Ok(found), |at| Err(format!("byte {at} is no index")))
}

/// The strings, assets, paths and words of a value, as written.
pub(super) fn words(text: &[u8], value: &Range<usize>) -> Result<Vec<String>, String> {
    let mut tokens = Tokens::new(text, value.clone());
    let mut found = Vec::new();
    while let Some((token, _)) = tokens.next()? {
        match token {
            Token::Mark(_) => {}
            Token::Text(word) | Token::Asset(word) | Token::Path(word) | Token::Word(word) => {
                found.push(String::from_utf8_lossy(word).into_owned());
            }
        }
    }
    Ok(found)
}

/// The first word of a property's value.
pub(super) fn word(text: &[u8], prim: &Prim, name: &str) -> Result<Option<String>, String> {
    let Some(property) = prim.properties.get(name) else {
        return Ok(None);
    };
    Ok(words(text, &property.value)?.into_iter().next())
}

/// The value of a word among a property's metadata, such as its interpolation.
pub(super) fn metadatum(text: &[u8], property: &Property, name: &str) -> Result<Option<String>, String> {
    let all = words(text, &property.metadata)?;
    let at = all.iter().position(|word| word == name);
    Ok(at.and_then(|at| all.get(at + 1).cloned()))
}
