//! Mutations of a file's bytes: bits, words, lines, lengths, and the JSON inside a container.

use super::json_text;
use crate::trials::Chance;

const WORDS: [u32; 12] = [
    0,
    1,
    2,
    36,
    0xff,
    0xffff,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_fffe,
    0xffff_ffff,
    0x7f80_0000,
    0x7fc0_0000,
];

const WORDS_OF_TEXT: [&str; 18] = [
    "0",
    "-1",
    "1",
    "3",
    "255",
    "65536",
    "4294967295",
    "-9223372036854775808",
    "18446744073709551616",
    "1e308",
    "1e39",
    "1e-310",
    "nan",
    "-inf",
    "",
    "x",
    "1/2/3//",
    "\u{1b}[31mred",
];

/// One random change that depends on how the file is built, or now and then a plain one.
pub fn mutate(bytes: &mut Vec<u8>, chance: &mut Chance) {
    if bytes.is_empty() {
        return;
    }
    let is_glb = bytes.starts_with(b"glTF");
    let is_json = bytes.starts_with(b"{");
    match chance.below(8) {
        0 => plain(bytes, chance),
        1 => words(bytes, chance),
        _ if is_json => json_text::mutate(bytes, chance),
        2..=5 if is_glb => glb_json(bytes, chance),
        6 if is_glb => container(bytes, chance),
        _ if is_glb => bin(bytes, chance),
        _ => lines(bytes, chance),
    }
}

/// Changes bits and bytes, and removes or repeats pieces.
pub fn plain(bytes: &mut Vec<u8>, chance: &mut Chance) {
    if bytes.is_empty() {
        return;
    }
    let at = chance.below(bytes.len());
    let end = bytes.len().min(at + chance.below(40));
    match chance.below(6) {
        0 => bytes[at] ^= 1 << chance.below(8),
        1 => bytes[at] = chance.bits() as u8,
        2 => bytes.truncate(at),
        3 => drop(bytes.drain(at..end)),
        4 => {
            let copy = bytes[at..end].to_vec();
            bytes.splice(at..at, copy);
        }
        _ => bytes[at..end].fill(0xff),
    }
}

/// Replaces a number of 32 bits by an unusual one, in either byte order.
fn words(bytes: &mut [u8], chance: &mut Chance) {
    if bytes.len() < 4 {
        return;
    }
    let at = chance.below(bytes.len() - 3) & !(chance.below(2) * 3);
    let word = *chance.of(&WORDS);
    let word = if chance.one_in(2) {
        word.to_le_bytes()
    } else {
        word.to_be_bytes()
    };
    bytes[at..at + 4].copy_from_slice(&word);
}

/// Swaps, repeats or removes lines, and replaces words of text.
fn lines(bytes: &mut Vec<u8>, chance: &mut Chance) {
    let mut lines: Vec<Vec<u8>> = bytes
        .split_inclusive(|&byte| byte == b'\n')
        .map(<[u8]>::to_vec)
        .collect();
    let (a, b) = (chance.below(lines.len()), chance.below(lines.len()));
    match chance.below(5) {
        0 => drop(lines.remove(a)),
        1 => lines.swap(a, b),
        2 => {
            let times = *chance.of(&[1, 2, 300]);
            let copy = vec![lines[a].clone(); times.min(1 + 300_000 / lines[a].len())];
            lines.splice(b..b, copy);
        }
        _ => {
            let mut words: Vec<&[u8]> = lines[a].split(|&byte| byte == b' ').collect();
            let at = chance.below(words.len());
            words[at] = chance.of(&WORDS_OF_TEXT).as_bytes();
            let mut line = words.join(&b' ');
            if !line.ends_with(b"\n") {
                line.push(b'\n');
            }
            lines[a] = line;
        }
    }
    *bytes = lines.concat();
}

/// Changes a GLB's JSON and updates the lengths.
fn glb_json(bytes: &mut Vec<u8>, chance: &mut Chance) {
    with_glb_json(bytes, |text| json_text::mutate(text, chance));
}

/// Changes a GLB's JSON by `change` and updates the lengths. Bytes that are no GLB stay unchanged.
pub fn with_glb_json(bytes: &mut Vec<u8>, change: impl FnOnce(&mut Vec<u8>)) {
    let Some(length) = word(bytes, 12) else { return };
    let Some(text) = bytes.get(20..length.saturating_add(20)) else {
        return;
    };
    let mut text = text.to_vec();
    change(&mut text);
    text.resize(text.len().next_multiple_of(4), b' ');
    let new = text.len() as u32;
    bytes.splice(20..20 + length, text);
    bytes[12..16].copy_from_slice(&new.to_le_bytes());
    let total = bytes.len() as u32;
    bytes[8..12].copy_from_slice(&total.to_le_bytes());
}

/// Changes the lengths and types of a GLB's chunks.
fn container(bytes: &mut Vec<u8>, chance: &mut Chance) {
    let bin = word(bytes, 12).map_or(20, |length| length.saturating_add(20));
    let places = [4, 8, 12, 16, bin, bin.saturating_add(4)];
    let at = *chance.of(&places);
    if chance.one_in(6) {
        bytes.extend_from_slice(b"\x10\0\0\0ABCD0123456789abcdef");
        return;
    }
    let Some(old) = word(bytes, at) else { return };
    let new = match chance.below(4) {
        0 => old.wrapping_add(4) as u32,
        1 => old.wrapping_sub(4) as u32,
        _ => *chance.of(&WORDS),
    };
    bytes[at..at + 4].copy_from_slice(&new.to_le_bytes());
}

/// Changes numbers in a GLB's binary chunk.
fn bin(bytes: &mut [u8], chance: &mut Chance) {
    let start = word(bytes, 12).map_or(0, |length| length.saturating_add(28).min(bytes.len()));
    words(&mut bytes[start..], chance);
}

fn word(bytes: &[u8], at: usize) -> Option<usize> {
    Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?) as usize)
}
