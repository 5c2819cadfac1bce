//! Choices by name, declared once for the command line, Python and assistants.

/// A value with its name and its help.
#[derive(Clone, Copy, Debug)]
pub struct Choice<T: 'static> {
    /// The name, in lower case.
    pub name: &'static str,
    /// The value.
    pub value: T,
    /// The help, a sentence without a full stop; empty if the name says it all.
    pub help: &'static str,
}

impl<T> Choice<T> {
    /// A choice without help.
    pub(crate) const fn of(name: &'static str, value: T) -> Self {
        Self { name, value, help: "" }
    }

    /// A choice with help.
    pub(crate) const fn with_help(name: &'static str, value: T, help: &'static str) -> Self {
        Self { name, value, help }
    }
}

/// The value with this name.
///
/// # Errors
/// The end of a sentence, which lists the names.
pub fn named<T: Copy>(choices: &[Choice<T>], name: &str) -> Result<T, String> {
    let found = choices.iter().find(|choice| choice.name == name);
    found.map(|choice| choice.value).ok_or_else(|| {
        let names: Vec<&str> = choices.iter().map(|choice| choice.name).collect();
        format!("give one of {}", names.join(", "))
    })
}
