//! The addresses of buffers and images: data within the JSON, neighbours by path, or the web.

use base64::Engine as _;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::{AsciiSet, CONTROLS, percent_decode_str, percent_encode, utf8_percent_encode};

/// The target of a URI.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Address {
    /// Bytes written into the URI itself.
    Data(Vec<u8>),
    /// A path, percent-decoded, `/` between folders.
    Neighbour(String),
    /// Something with a scheme that is never fetched.
    Elsewhere,
}

const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The characters that must be encoded in a path. A reader would take the text before a colon for a scheme.
const ESCAPED: &AsciiSet = &CONTROLS
    .add(b' ')
    .add(b':')
    .add(b'"')
    .add(b'#')
    .add(b'%')
    .add(b'?')
    .add(b'\\')
    .add(b'<')
    .add(b'>');

/// Reads a URI; the error names the fault of a data URI.
pub(crate) fn address(uri: &str) -> Result<Address, String> {
    if let Some(rest) = uri
        .get(..5)
        .filter(|scheme| scheme.eq_ignore_ascii_case("data:"))
        .and(uri.get(5..))
    {
        let Some((kind, payload)) = rest.split_once(',') else {
            return Err("a data URI without a comma".to_owned());
        };
        let bytes = if kind.to_ascii_lowercase().ends_with(";base64") {
            BASE64
                .decode(payload)
                .map_err(|error| format!("a data URI with broken base64 ({error})"))?
        } else {
            percent_decode_str(payload).collect()
        };
        return Ok(Address::Data(bytes));
    }
    // One letter before a colon is a drive, not a scheme.
    let has_scheme = uri.split_once(':').is_some_and(|(scheme, _)| {
        scheme.len() > 1
            && scheme
                .bytes()
                .all(|byte| byte.is_ascii_alphanumeric() || b"+-.".contains(&byte))
    });
    if has_scheme {
        return Ok(Address::Elsewhere);
    }
    Ok(Address::Neighbour(match percent_decode_str(uri).decode_utf8() {
        Ok(path) => path.into_owned(),
        Err(_) => uri.to_owned(),
    }))
}

/// A path in its shortest form if it stays in its folder, `None` if it leaves it (absolute, or by `..`).
pub(crate) fn inside(path: &str) -> Option<String> {
    let is_absolute = path.starts_with(['/', '\\']) || path.as_bytes().get(1) == Some(&b':');
    if is_absolute {
        return None;
    }
    let mut steps = Vec::new();
    for step in path.split(['/', '\\']) {
        match step {
            "" | "." => {}
            ".." => {
                steps.pop()?;
            }
            _ => steps.push(step),
        }
    }
    (!steps.is_empty()).then(|| steps.join("/"))
}

/// A path as a URI. A name that is not UTF-8 is already encoded, see [`name_of_bytes`].
pub(crate) fn encoded(path: &str) -> String {
    if percent_decode_str(path).decode_utf8().is_err() {
        return path.to_owned();
    }
    utf8_percent_encode(path, ESCAPED).to_string()
}

/// A file's name as text. If it is not UTF-8 its bytes are percent-encoded, as in a URI: no other text decodes to them.
pub fn name_of_bytes(name: &[u8]) -> String {
    match std::str::from_utf8(name) {
        Ok(name) => name.to_owned(),
        Err(_) => percent_encode(name, ESCAPED).to_string(),
    }
}

/// The bytes of a name that [`name_of_bytes`] or a URI gives percent-encoded because they are not UTF-8; `None` for
/// every other name, which is its own bytes.
pub fn bytes_of_name(name: &str) -> Option<Vec<u8>> {
    let bytes: Vec<u8> = percent_decode_str(name).collect();
    std::str::from_utf8(&bytes).is_err().then_some(bytes)
}

/// A path as a JSON string that holds its URI.
pub(crate) fn json_uri(path: &str) -> String {
    serde_json::Value::from(encoded(path)).to_string()
}

/// Bytes as a JSON string that holds a data URI.
pub(crate) fn json_data_uri(mime: &str, bytes: &[u8]) -> String {
    format!(
        "\"data:{mime};base64,{}\"",
        base64::engine::general_purpose::STANDARD.encode(bytes)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_told_apart() {
        let cases = [
            ("a%20b.bin", Ok(Address::Neighbour("a b.bin".to_owned()))),
            ("../x/a.bin", Ok(Address::Neighbour("../x/a.bin".to_owned()))),
            ("https://x.org/a.bin", Ok(Address::Elsewhere)),
            (
                "data:application/octet-stream;base64,AQID",
                Ok(Address::Data(vec![1, 2, 3])),
            ),
            ("DATA:;BASE64,AQI=", Ok(Address::Data(vec![1, 2]))),
            ("data:text/plain,a%20b", Ok(Address::Data(b"a b".to_vec()))),
        ];
        for (uri, wanted) in cases {
            assert_eq!(address(uri), wanted, "{uri}");
        }
        assert!(address("data:nothing").is_err());
        assert!(address("data:;base64,@@@").is_err());
        assert!(address("däta:").is_ok());
    }

    #[test]
    fn paths_that_leave_the_folder_are_known() {
        for path in ["/a", "..", "../a", "a/../../b", "C:\\a", "\\\\server\\a", "..\\a", ""] {
            assert_eq!(inside(path), None, "{path}");
        }
        assert_eq!(inside("./a//b/../c.bin").as_deref(), Some("a/c.bin"));
    }

    #[test]
    fn a_name_that_is_not_utf_8_survives_its_uri() {
        for bytes in [b"caf\xe9.bin".as_slice(), b"\xff%41:.bin"] {
            let name = name_of_bytes(bytes);
            assert_eq!(bytes_of_name(&name).as_deref(), Some(bytes));
            assert_eq!(address(&encoded(&name)), Ok(Address::Neighbour(name)));
        }
        assert_eq!(
            (name_of_bytes("é%41".as_bytes()).as_str(), bytes_of_name("é%41")),
            ("é%41", None)
        );
    }

    #[test]
    fn a_path_survives_its_uri() {
        for path in [
            "a b.bin",
            "ä%.bin",
            "x/y\"z.bin",
            "12:30.bin",
            "data:x,y.bin",
            "https://a.bin",
        ] {
            let json = json_uri(path);
            let uri: Result<String, _> = serde_json::from_str(&json);
            assert!(
                uri.is_ok_and(|uri| address(&uri) == Ok(Address::Neighbour(path.to_owned()))),
                "{json}"
            );
        }
    }
}
