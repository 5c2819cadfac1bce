//! What a person should know about a binding or its targets, in a sentence.

use std::fmt;
use std::ops::{Deref, Range};

/// A sentence for a person. Where it is about a handle, it calls the handle by its number, which only the problem knows;
/// [`Warning::naming`] puts the name there that a person knows.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Warning {
    sentence: String,
    /// The handle that it is about, and which bytes of the sentence name it.
    handle: Option<(usize, Range<usize>)>,
    /// Of each component that it says nothing holds: its handles, and how many of its vertices each has.
    unheld: Vec<Vec<(usize, usize)>>,
}

/// So many vertices that have places hold a component.
const HOLDING: usize = 3;

impl Warning {
    /// What `word` makes of the handle's designation, which it uses once.
    pub(crate) fn of_handle(handle: usize, word: impl FnOnce(&str) -> String) -> Self {
        let designation = format!("handle {handle}");
        let sentence = word(&designation);
        let start = sentence.find(&designation);
        Self {
            handle: start.map(|start| (handle, start..start + designation.len())),
            sentence,
            unheld: Vec::new(),
        }
    }

    /// A sentence on components that nothing holds: each with its handles, and how many of its vertices each has.
    pub(crate) fn of_unheld(sentence: String, unheld: Vec<Vec<(usize, usize)>>) -> Self {
        Self {
            sentence,
            handle: None,
            unheld,
        }
    }

    /// Whether it says that nothing holds a component that handles move. Vertices with places of their own hold one, so
    /// it may be void once there are targets.
    pub fn is_of_unheld(&self) -> bool {
        !self.unheld.is_empty()
    }

    /// Whether it is about components alone that are held, because their vertices have places by the handles `placed`.
    pub(crate) fn is_void(&self, placed: &[bool]) -> bool {
        let is_placed = |&&(handle, _): &&(usize, usize)| placed.get(handle).is_some_and(|placed| *placed);
        let count = |handles: &Vec<(usize, usize)>| handles.iter().filter(is_placed).map(|(_, count)| count).sum();
        self.is_of_unheld() && self.unheld.iter().map(count).all(|count: usize| count >= HOLDING)
    }

    /// The number of the handle that it is about, if it is about one.
    pub fn handle(&self) -> Option<usize> {
        self.handle.as_ref().map(|(number, _)| *number)
    }

    /// The sentence with `designation` in place of "handle" and its number.
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
            unheld: Vec::new(),
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
