//! The names in an OBJ file, which a new OBJ file of its materials and groups gets again.

use crate::Bytes;

/// An OBJ file's material libraries and textures as read, and the names of its groups.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct ObjNames {
    /// The material libraries, by their paths.
    pub libraries: Vec<(String, Bytes)>,
    /// The textures that were read, by their paths.
    pub textures: Vec<(String, Bytes)>,
    /// True if the libraries name further maps, which are not read.
    pub names_other_maps: bool,
    /// The `o` and the `g` name and the smoothing group `s` of each of the appearance's groups; empty where the file gives
    /// none.
    pub groups: Vec<[String; 3]>,
}

impl ObjNames {
    /// The names of two files in one: `others` come after the own groups. `None` if a material would get another meaning:
    /// `own_names` and `other_names` are the materials that the faces of each use, and an empty name is none.
    pub fn joined(&self, own_names: &[&str], other: &Self, other_names: &[&str]) -> Option<Self> {
        let follows_a_name = own_names.iter().any(|name| !name.is_empty()) && other_names.contains(&"");
        let is_same = self.libraries == other.libraries && self.textures == other.textures;
        let mean_another = |files: &[(String, Bytes)], others: &[(String, Bytes)]| {
            files
                .iter()
                .any(|(path, bytes)| others.iter().any(|(other, theirs)| path == other && bytes != theirs))
        };
        let are_defined = |names: &[&str], libraries: &[(String, Bytes)]| {
            libraries
                .iter()
                .any(|(_, text)| names.iter().any(|name| defines(text, name)))
        };
        let clashes = mean_another(&self.libraries, &other.libraries)
            || mean_another(&self.textures, &other.textures)
            || are_defined(own_names, &other.libraries)
            || are_defined(other_names, &self.libraries);
        if follows_a_name || (!is_same && clashes) {
            return None;
        }
        let mut joined = self.clone();
        let new = |files: &[(String, Bytes)], others: &[(String, Bytes)]| -> Vec<(String, Bytes)> {
            others.iter().filter(|file| !files.contains(file)).cloned().collect()
        };
        joined.libraries.extend(new(&self.libraries, &other.libraries));
        joined.textures.extend(new(&self.textures, &other.textures));
        joined.names_other_maps |= other.names_other_maps;
        joined.groups.extend(other.groups.iter().cloned());
        Some(joined)
    }
}

/// Returns true if a library defines a material.
fn defines(library: &[u8], name: &str) -> bool {
    let text = String::from_utf8_lossy(library);
    let mut lines = text.split(['\n', '\r']).map(str::trim);
    lines.any(|line| {
        line.strip_prefix("newmtl")
            .is_some_and(|rest| rest.trim() == name && rest != name)
    })
}
