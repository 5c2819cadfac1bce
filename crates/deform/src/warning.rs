//! Facts about a binding or its targets that a person should know, each in a sentence.

use std::fmt;
use std::ops::{Deref, Range};
use std::sync::Arc;

/// A sentence for a person. If it is about a handle, it has the handle's number, which only the problem knows;
/// [`Warning::naming`] replaces it by the name that a person knows.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Warning {
    sentence: String,
    /// The handle that it is about, and the bytes of the sentence that name it.
    handle: Option<(usize, Range<usize>)>,
    /// For each component that nothing holds: its handles, and the number of its vertices in each. Empty for other
    /// warnings.
    unheld: Arc<[Holders]>,
}

/// Handles, and the number of a component's vertices in each.
type Holders = Box<[(usize, usize)]>;

/// The number of vertices with places that hold a component.
const HOLDING: usize = 3;

impl Warning {
    /// The sentence that `word` makes with the handle's designation, which it uses once.
    pub(crate) fn of_handle(handle: usize, word: impl FnOnce(&str) -> String) -> Self {
        let designation = format!("handle {handle}");
        let sentence = word(&designation);
        let start = sentence.find(&designation);
        Self {
            handle: start.map(|start| (handle, start..start + designation.len())),
            sentence,
            unheld: Arc::default(),
        }
    }

    /// The warning with another number for the handle that it is about.
    pub(crate) fn renumbered(self, number: impl Fn(usize) -> usize) -> Self {
        let Some((handle, place)) = self.handle.clone() else {
            return self;
        };
        let designation = format!("handle {}", number(handle));
        Self {
            sentence: self.naming(&designation),
            handle: Some((number(handle), place.start..place.start + designation.len())),
            unheld: self.unheld,
        }
    }

    /// A sentence on components that nothing holds; `unheld` gives each component's handles, and the number of its
    /// vertices in each.
    pub(crate) fn of_unheld(sentence: String, unheld: Vec<Vec<(usize, usize)>>) -> Self {
        Self {
            sentence,
            handle: None,
            unheld: unheld.into_iter().map(Vec::into_boxed_slice).collect(),
        }
    }

    /// Returns true if the warning is that nothing holds a component that handles move. Vertices with places hold a
    /// component, so targets can make the warning void.
    pub fn is_of_unheld(&self) -> bool {
        !self.unheld.is_empty()
    }

    /// Returns true if vertices of the handles in `placed`, which have places, hold every component that the warning
    /// names.
    pub(crate) fn is_void(&self, placed: &[bool]) -> bool {
        let is_placed = |&&(handle, _): &&(usize, usize)| placed.get(handle).is_some_and(|placed| *placed);
        let count =
            |handles: &[(usize, usize)]| handles.iter().filter(is_placed).map(|(_, count)| count).sum::<usize>();
        self.is_of_unheld() && self.unheld.iter().all(|handles| count(handles) >= HOLDING)
    }

    /// The number of the handle that it is about, if it is about one.
    pub fn handle(&self) -> Option<usize> {
        self.handle.as_ref().map(|(number, _)| *number)
    }

    /// The sentence with `designation` instead of "handle" and its number.
    pub fn naming(&self, designation: &str) -> String {
        let mut sentence = self.sentence.clone();
        if let Some((_, place)) = &self.handle {
            sentence.replace_range(place.clone(), designation);
        }
        sentence
    }
}

impl From<String> for Warning {
    fn from(sentence: String) -> Self {
        Self {
            sentence,
            handle: None,
            unheld: Arc::default(),
        }
    }
}

impl Deref for Warning {
    type Target = str;

    fn deref(&self) -> &str {
        &self.sentence
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}

#[cfg(test)]
mod tests {
    use super::Warning;

    #[test]
    fn the_name_replaces_the_designation_and_nothing_else() {
        let turned = Warning::of_handle(1, |handle| format!("at 11 s {handle} turns by 100°: take arap"));
        assert_eq!(&*turned, "at 11 s handle 1 turns by 100°: take arap");
        assert_eq!(turned.handle(), Some(1));
        assert_eq!(turned.naming("the trunk"), "at 11 s the trunk turns by 100°: take arap");
        let other = Warning::from("handle 1 is mentioned in passing".to_owned());
        assert_eq!((other.handle(), other.naming("the trunk")), (None, other.to_string()));
    }
}
