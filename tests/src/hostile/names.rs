//! Difficult names: control characters, spaces, colons, bytes that are not text, great lengths, other spellings of
//! paths, URIs of objects other than files.

use std::ffi::OsString;
use std::os::unix::ffi::OsStringExt as _;

use crate::trials::Chance;

/// A text that a file may contain and a message may quote, or that may be a file's name.
pub fn odd_text(chance: &mut Chance) -> String {
    match chance.below(16) {
        0 => "\u{1b}[31mred\u{1b}[0m".to_owned(),
        1 => "line\nbreak\r\ttab".to_owned(),
        2 => "x".repeat(*chance.of(&[199, 201, 255, 256, 4096, 100_000])),
        3 => "é".repeat(*chance.of(&[99, 127, 128, 3000])),
        4 => "\u{0}".to_owned(),
        5 => "\u{202e}right to left\u{9b}31m".to_owned(),
        6 => "/proc/self/environ".to_owned(),
        7 => "//server/share/x.bin".to_owned(),
        8 => r"\\server\share\x.bin".to_owned(),
        9 => "file:///etc/hostname".to_owned(),
        10 => "http://127.0.0.1:9/x.bin".to_owned(),
        11 => "../outside/secret.bin".to_owned(),
        12 => "data:application/octet-stream;base64,AAAAAA==".to_owned(),
        13 => "data:,\u{1b}[2J".to_owned(),
        14 => "%ff%00%2e%2e/".to_owned(),
        _ => "in.bin".to_owned(),
    }
}

/// Another spelling of a neighbour's path, which may or may not lead to the same file.
pub fn respelled(path: &str, chance: &mut Chance) -> String {
    match chance.below(16) {
        0 => format!("./{path}"),
        1 => format!("sub/../{path}"),
        2 => path.bytes().map(|byte| format!("%{byte:02x}")).collect(),
        3 => path.bytes().map(|byte| format!("%{byte:02X}")).collect(),
        4 => format!("../work/{path}"),
        5 => format!(".//./{path}"),
        6 => path.to_uppercase(),
        7 => path.replace('/', "\\"),
        8 => format!("{path}?query#fragment"),
        9 => format!("@ROOT@/work/{path}"),
        10 => format!("file://@ROOT@/work/{path}"),
        11 => format!("{path}/"),
        12 => format!("missing/../{path}"),
        13 => format!(".\\{path}"),
        14 => "../outside/secret.bin".to_owned(),
        _ => path.to_owned(),
    }
}

/// A name for an output file, with the given extension.
pub fn odd_name(extension: &str, chance: &mut Chance) -> OsString {
    let stem: Vec<u8> = match chance.below(14) {
        0 => b"\xff\xfe".to_vec(),
        1 => b"12:30".to_vec(),
        2 => b"with space".to_vec(),
        3 => b"line\nbreak".to_vec(),
        4 => b"\x1b[31mred".to_vec(),
        5 => vec![b'x'; *chance.of(&[240, 250, 300, 5000])],
        6 => b"-out".to_vec(),
        7 => b"".to_vec(),
        8 => b"50%25".to_vec(),
        9 => b"a#b?c".to_vec(),
        10 => b"back\\slash".to_vec(),
        11 => b"data:x".to_vec(),
        12 => "é\u{202e}".into(),
        _ => b"..".to_vec(),
    };
    let extension = match chance.below(6) {
        0 => extension.to_uppercase(),
        1 => (*chance.of(&["", "xyz", "glb.tmp", "gltf"])).to_owned(),
        _ => extension.to_owned(),
    };
    let dot: &[u8] = if extension.is_empty() { b"" } else { b"." };
    OsString::from_vec([&stem, dot, extension.as_bytes()].concat())
}
