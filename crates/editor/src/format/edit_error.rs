//! The refusal of an edit: one sentence that names the culprit and the remedy.

/// The reason why an edit can't be read, or can't be applied to a model.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum EditError {
    /// The text is not JSON.
    #[error("the edit is not valid JSON: {0}")]
    Json(String),
    /// The edit's `version` is one that this program does not know.
    #[error("the edit's `version` is {found}, and this program reads version 1: set it to 1 or use a newer Pliant")]
    Version {
        /// The value there.
        found: String,
    },
    /// The text is not a project.
    #[error("the project can't be read: {0}")]
    Project(String),
    /// The project's `version` is one that this program does not know.
    #[error("the project's `version` is {0}, and this program reads version 1: use a newer Pliant")]
    ProjectVersion(String),
    /// The project was made on another mesh.
    #[error(
        "the project was made on another mesh than {name} (its hash is {found}, the project's {expected}): give the \
         project's mesh"
    )]
    OtherMesh {
        /// The open mesh.
        name: String,
        /// Its hash.
        found: String,
        /// The project's.
        expected: String,
    },
    /// A member that the format does not have.
    #[error("unknown member `{member}` in {place}: {remedy}")]
    UnknownMember {
        /// The member's name.
        member: String,
        /// Its place, e.g. `handles[0].transform`.
        place: String,
        /// The nearest known name, or all of them.
        remedy: String,
    },
    /// A name (of a method, an axis, ..) that the format does not have.
    #[error("unknown name `{name}` at {place}: {remedy}")]
    UnknownName {
        /// The name.
        name: String,
        /// Its place.
        place: String,
        /// The nearest known name, or all of them.
        remedy: String,
    },
    /// A missing member that is required.
    #[error("{place} lacks its member `{member}`: add it")]
    Missing {
        /// The member's name.
        member: &'static str,
        /// Its expected place.
        place: String,
    },
    /// A value of the wrong kind.
    #[error("{place} must be {expected}, not {found}")]
    WrongKind {
        /// Its place.
        place: String,
        /// The expected kind, with its article.
        expected: String,
        /// The value there.
        found: String,
    },
    /// A value outside its range.
    #[error("{place} is {found}, which is out of range: give {allowed}")]
    OutOfRange {
        /// Its place.
        place: String,
        /// The value there.
        found: String,
        /// The range in words.
        allowed: String,
    },
    /// A member that occurs twice in the same object.
    #[error("`{member}` appears twice in {place}: keep one of them")]
    Duplicate {
        /// The member's name.
        member: String,
        /// Its place.
        place: String,
    },
    /// Another fault of a value.
    #[error("{place} {sentence}")]
    Other {
        /// Its place.
        place: String,
        /// The fault and the correction, without its subject.
        sentence: String,
    },
    /// A vertex number that the file does not have.
    #[error("{place} names vertex {vertex}, but the file has {count} vertices: use numbers from 0 to {}", .count.saturating_sub(1))]
    NoSuchVertex {
        /// The place that names it.
        place: String,
        /// The number.
        vertex: u64,
        /// The number of the file's vertices.
        count: usize,
    },
    /// A component number that the surface does not have.
    #[error("{place} names component {component}, but the surface has {count}: use numbers from 0 to {}", .count.saturating_sub(1))]
    NoSuchComponent {
        /// The place that names it.
        place: String,
        /// The number.
        component: u32,
        /// The number of the surface's components.
        count: usize,
    },
    /// A per-vertex field whose length is not the file's vertex count.
    #[error("{place} has {found} values, but the file has {count} vertices: give one value for each")]
    FieldLength {
        /// Its place.
        place: String,
        /// The number of values.
        found: usize,
        /// The number of the file's vertices.
        count: usize,
    },
    /// A handle without vertices.
    #[error("handle `{handle}` (handles[{index}]) selects no vertex that a triangle uses: widen its `select`")]
    EmptyHandle {
        /// The handle's name.
        handle: String,
        /// Its place in the list.
        index: usize,
    },
    /// A vertex in two handles.
    #[error(
        "handles `{first}` and `{second}` share {shared} of the surface's vertices, such as the file's vertex \
         {file_vertex}: take them out of one of the two"
    )]
    SharedVertex {
        /// The handle that comes first in the list.
        first: String,
        /// The other.
        second: String,
        /// The number of surface vertices in both.
        shared: usize,
        /// One of them, by the file's number.
        file_vertex: u32,
    },
    /// An edit of another mesh that lies elsewhere.
    #[error(
        "the edit was made on another mesh, and only {found} of {set} is within {within} of this one's surface: move, turn \
         and scale this file to the place and size of that mesh, or paint anew"
    )]
    Elsewhere {
        /// The handle, or the free region.
        set: String,
        /// The share of its places that was found.
        found: String,
        /// The distance within which a place counts as found, in world units.
        within: String,
    },
    /// More handles than there are numbers.
    #[error("the edit has {0} handles, more than the 65535 that an edit may have: join some of them")]
    TooManyHandles(usize),
}

impl EditError {
    /// The refusal for the outer value: its place is in this member (`transform`) or element (`[3]`).
    pub(crate) fn under(mut self, step: &str) -> Self {
        if let Some(place) = self.place_mut() {
            *place = match place.chars().next() {
                None => step.to_owned(),
                Some('[') => format!("{step}{place}"),
                Some(_) => format!("{step}.{place}"),
            };
        }
        self
    }

    /// The refusal of a part of `whole`, "the edit" or so.
    pub(crate) fn at(mut self, whole: &str) -> Self {
        if let Some(place) = self.place_mut()
            && place.is_empty()
        {
            whole.clone_into(place);
        }
        self
    }

    fn place_mut(&mut self) -> Option<&mut String> {
        match self {
            Self::UnknownMember { place, .. }
            | Self::UnknownName { place, .. }
            | Self::Missing { place, .. }
            | Self::WrongKind { place, .. }
            | Self::OutOfRange { place, .. }
            | Self::Duplicate { place, .. }
            | Self::Other { place, .. } => Some(place),
            _ => None,
        }
    }
}

/// "did you mean `scale`?" if a known name is near, else the list of them.
pub(crate) fn remedy(name: &str, known: &[&str]) -> String {
    let near = known.iter().map(|known| (edit_distance(name, known), known)).min();
    match near {
        Some((distance, known)) if distance <= 2.max(name.chars().count() / 3) && distance < known.len() => {
            format!("did you mean `{known}`?")
        }
        _ => format!("known are {}", listed(known)),
    }
}

/// "`a`, `b`, `c`".
pub(crate) fn listed(names: &[&str]) -> String {
    names
        .iter()
        .map(|name| format!("`{name}`"))
        .collect::<Vec<_>>()
        .join(", ")
}

/// Levenshtein's distance in characters.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    // The distance of a name far longer than all known ones is not computed, to save time.
    for (i, ca) in a.chars().take(64).enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &cb) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(ca != cb);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[b.len()] + a.chars().skip(64).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_near_name_is_proposed_and_a_far_one_lists_all() {
        assert_eq!(remedy("scales", &["scale", "pivot"]), "did you mean `scale`?");
        assert_eq!(remedy("Rotaton", &["rotation", "scale"]), "did you mean `rotation`?");
        assert_eq!(remedy("banana", &["x", "y"]), "known are `x`, `y`");
    }
}
