//! The solver's warnings, in sentences with the handles' names.

use pliant_deform::{METHODS, Warning};

use crate::document::{Document, HandleId};

/// A warning of a binding, with the handle that it is about: the binding knows only its number.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct HandleWarning {
    warning: Warning,
    handle: Option<HandleId>,
}

impl HandleWarning {
    /// The warnings of a binding with these handles.
    pub(crate) fn list(warnings: &[Warning], handles: &[HandleId]) -> Vec<Self> {
        let with_handle = |warning: &Warning| Self {
            handle: warning.handle().and_then(|number| handles.get(number).copied()),
            warning: warning.clone(),
        };
        warnings.iter().map(with_handle).collect()
    }

    /// The sentence in the words of the window, with the present name of the handle.
    pub(crate) fn worded(&self, document: &Document) -> String {
        let handle = self.handle.and_then(|id| document.handle(id));
        in_window_words(&worded(&self.warning, handle.map(|handle| &*handle.name)))
    }
}

/// The sentence of a warning about a handle of this name, if it is about one that has a name.
pub(crate) fn worded(warning: &Warning, name: Option<&str>) -> String {
    match name.filter(|name| !name.is_empty()) {
        Some(name) => warning.naming(&format!("\"{}\"", shortened(name))),
        None => warning.to_string(),
    }
}

/// A sentence of the engine in the words of the window: names of the edit format, which it has in backticks, become
/// the labels of methods and options.
pub(crate) fn in_window_words(sentence: &str) -> String {
    let label = |name: &str| match METHODS.iter().find(|method| method.name == name) {
        Some(method) => method.title.to_owned(),
        None => name.replace('_', " "),
    };
    let parts = sentence.split('`').enumerate();
    parts
        .map(|(number, part)| match number % 2 {
            0 => part.to_owned(),
            _ => format!("\"{}\"", label(part)),
        })
        .collect()
}

/// Keeps a refusal to one readable line, for any content of the file.
pub(crate) fn shortened(text: &str) -> String {
    let clean: String = text
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .take(60)
        .collect();
    if text.chars().count() > 60 { clean + ".." } else { clean }
}

#[cfg(test)]
mod tests {
    use pliant_deform::Method;

    use super::in_window_words;

    #[test]
    fn names_of_the_edit_format_become_the_labels_of_the_window() {
        let title = Method::from_name("poisson").map(|method| method.declaration().title);
        assert_eq!(
            in_window_words("arap bends: set `max_iterations`, or take `poisson`"),
            format!(
                "arap bends: set \"max iterations\", or take \"{}\"",
                title.unwrap_or_default()
            )
        );
        assert_eq!(in_window_words("a sentence without names"), "a sentence without names");
    }
}
