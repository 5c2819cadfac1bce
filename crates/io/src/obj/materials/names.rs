//! The names of libraries and textures: after a statement's options, and as paths.

use crate::appearance::Wrap;

/// The file name after a `map_Kd`'s options, and its continuation beyond its edges.
pub(in crate::obj) fn texture_file(texture: &str) -> (String, Wrap) {
    let (file, wrap) = behind_options(texture);
    (as_uri(file), wrap)
}

/// As [`texture_file`], with the name as written.
pub(in crate::obj) fn behind_options(texture: &str) -> (&str, Wrap) {
    let mut rest = texture.trim();
    let mut wrap = Wrap::Repeat;
    while let Some(option) = rest.split_whitespace().next().filter(|word| word.starts_with('-')) {
        let behind = rest[option.len()..].trim_start();
        let arguments = match option {
            "-o" | "-s" | "-t" => behind
                .split_whitespace()
                .take(3)
                .take_while(|word| word.parse::<f32>().is_ok())
                .count(),
            "-mm" => 2,
            _ => 1,
        };
        if option == "-clamp" && behind.starts_with("on") {
            wrap = Wrap::ClampToEdge;
        }
        rest = behind;
        for _ in 0..arguments {
            rest = rest
                .split_once(char::is_whitespace)
                .map_or("", |(_, behind)| behind.trim_start());
        }
    }
    (rest, wrap)
}

/// A name as a path with `/`.
pub(in crate::obj) fn as_uri(name: &str) -> String {
    name.trim().trim_matches('"').replace('\\', "/")
}

/// Everything before a path's file name, with its `/`.
pub(in crate::obj) fn folder_of(uri: &str) -> &str {
    uri.rfind('/').map_or("", |end| &uri[..=end])
}

pub(in crate::obj) fn join(folder: &str, file: &str) -> String {
    if file.starts_with('/') {
        file.to_owned()
    } else {
        format!("{folder}{file}")
    }
}

#[cfg(test)]
mod tests {
    use super::texture_file;

    #[test]
    fn options_without_a_file_end() {
        assert_eq!(texture_file("-o -s -mm 1").0, "");
        assert_eq!(texture_file("a\\b\\c.png").0, "a/b/c.png");
    }
}
