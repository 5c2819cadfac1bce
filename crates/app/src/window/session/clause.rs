//! Clauses that are shown alone.

/// A clause as a sentence.
pub(super) fn as_sentence(clause: &str) -> String {
    let mut letters = clause.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    let end = if clause.ends_with('.') { "" } else { "." };
    first.chain(letters).chain(end.chars()).collect()
}
