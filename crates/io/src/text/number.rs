//! Numbers in text files: parsing and printing.

use std::io::Write;

/// Parses a word as a real number, including C's printed specials (`-nan(ind)`, `1.#INF`).
pub(super) fn parse_real(word: &[u8]) -> Option<f64> {
    // The longest exact decimal of an f64 has fewer than 1100 characters, so a longer word is not accepted as a number.
    if word.len() > 2000 {
        return None;
    }
    let text = std::str::from_utf8(word).ok()?;
    if let Ok(value) = text.parse::<f64>() {
        return Some(value);
    }
    let unsigned = text.trim_start_matches(['+', '-']).to_ascii_lowercase();
    let sign = if text.starts_with('-') { -1.0 } else { 1.0 };
    if unsigned.starts_with("nan") || unsigned.starts_with("1.#qnan") || unsigned.starts_with("1.#ind") {
        Some(f64::NAN)
    } else if unsigned.starts_with("1.#inf") {
        Some(sign * f64::INFINITY)
    } else {
        None
    }
}

/// Appends the shortest decimals that read back as `value`.
pub(crate) fn push_f64(out: &mut Vec<u8>, value: f64) {
    // Writing into a Vec can't fail. Display never uses an exponent, and 1e-300 would take 300 zeros.
    let magnitude = value.abs();
    let _ = if magnitude == 0.0 || (1e-5..1e16).contains(&magnitude) {
        write!(out, "{value}")
    } else if value.is_finite() {
        write!(out, "{value:e}")
    } else {
        write!(out, "{}", non_finite(value))
    };
}

/// Appends the shortest decimals that read back as the f32 `value`.
pub(crate) fn push_f32(out: &mut Vec<u8>, value: f32) {
    let magnitude = value.abs();
    let _ = if magnitude == 0.0 || (1e-5..1e7).contains(&magnitude) {
        write!(out, "{value}")
    } else if value.is_finite() {
        write!(out, "{value:e}")
    } else {
        write!(out, "{}", non_finite(f64::from(value)))
    };
}

/// The number as which the shortest decimals of the f32 nearest to `value` are read back: text is read as f64, in which
/// it is another number than the f32 itself.
pub(crate) fn shortest_f32(value: f64) -> f64 {
    let mut text = Vec::new();
    push_f32(&mut text, value as f32);
    parse_real(&text).unwrap_or(value)
}

/// The spelling of a number that isn't finite, understood by every reader that accepts such numbers.
fn non_finite(value: f64) -> &'static str {
    if value.is_nan() {
        "nan"
    } else if value > 0.0 {
        "inf"
    } else {
        "-inf"
    }
}
