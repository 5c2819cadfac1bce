//! The file formats that are read and written.

use std::fmt;

use crate::quote::quoted;

/// A name whose extension is that of no known format.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("\"{}\" has no extension of a known kind: name it .glb, .gltf, .obj, .ply, .stl, .off, .3mf or .usdz", quoted(.name))]
pub struct UnknownFormat {
    /// The file's name.
    pub name: String,
}

/// A file format, recognised by the extension of the file's name.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Format {
    /// Binary glTF 2.0, everything in one file.
    Glb,
    /// Textual glTF 2.0, buffers and images as neighbours or embedded.
    Gltf,
    /// Wavefront OBJ with its MTL neighbours.
    Obj,
    /// Stanford PLY, ascii or binary of either byte order.
    Ply,
    /// STL, ascii or binary.
    Stl,
    /// OFF with its COFF and NOFF variants.
    Off,
    /// 3D Manufacturing Format, objects in a zip archive.
    Threemf,
    /// USD in a zip archive, for phones.
    Usdz,
}

impl Format {
    /// Every format, in the order in which they are listed for a person.
    pub const ALL: [Self; 8] = [
        Self::Glb,
        Self::Gltf,
        Self::Obj,
        Self::Ply,
        Self::Stl,
        Self::Off,
        Self::Threemf,
        Self::Usdz,
    ];

    /// Their extensions, in the same order.
    pub const EXTENSIONS: [&'static str; Self::ALL.len()] = {
        let mut extensions = [""; Self::ALL.len()];
        let mut place = 0;
        while place < extensions.len() {
            extensions[place] = Self::ALL[place].extension();
            place += 1;
        }
        extensions
    };

    /// The format for the extension of a file's name or path, in any case.
    pub fn of_name(name: &str) -> Result<Self, UnknownFormat> {
        let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
        let extension = file.rsplit_once('.').map_or("", |(_, extension)| extension);
        Self::ALL
            .into_iter()
            .find(|format| format.extension().eq_ignore_ascii_case(extension))
            .ok_or_else(|| UnknownFormat { name: file.to_owned() })
    }

    /// The extension without its dot, in lower case.
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::Gltf => "gltf",
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Stl => "stl",
            Self::Off => "off",
            Self::Threemf => "3mf",
            Self::Usdz => "usdz",
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Glb => "GLB",
            Self::Gltf => "glTF",
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
            Self::Off => "OFF",
            Self::Threemf => "3MF",
            Self::Usdz => "USDZ",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_tells_the_kind_whatever_its_case() {
        assert_eq!(Format::of_name("a/b.c/Scan.GLB"), Ok(Format::Glb));
        assert_eq!(Format::of_name("scan.stl"), Ok(Format::Stl));
        for name in ["scan", "glb", "a.glb/scan", "scan.glb.bak", ""] {
            assert!(Format::of_name(name).is_err(), "{name}");
        }
    }
}
