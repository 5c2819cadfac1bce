//! Options of methods. Each is declared once; reading, writing, showing and explaining all use the declaration.

use std::fmt;

/// An option of a method.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct OptionDeclaration {
    /// Its name in the edit format.
    pub name: &'static str,
    /// Its effect, as a phrase. Values, range, unit and default are not part of it: [`OptionKind`] has them.
    pub help: &'static str,
    /// Its kind of values.
    pub kind: OptionKind,
    /// True if it is an expert option: the window folds such options away.
    pub is_advanced: bool,
    /// The choice option, and its names with which this option has an effect.
    pub only_with: Option<(&'static str, &'static [&'static str])>,
}

/// A slider of an option, on a logarithmic scale.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct OptionSlider {
    /// The option, a number.
    pub option: &'static str,
    /// The words at the ends.
    pub ends: [&'static str; 2],
    /// The values at the ends.
    pub range: [f64; 2],
    /// Its effect.
    pub help: &'static str,
}

/// The values of an option.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum OptionKind {
    /// A finite number.
    Number {
        /// The smallest and the largest value.
        range: [f64; 2],
        /// Its unit; empty for a plain number.
        unit: &'static str,
    },
    /// A whole number.
    Whole {
        /// The smallest and the largest value.
        range: [u32; 2],
    },
    /// One of a few whole numbers.
    Numbered {
        /// The numbers, each with its meaning.
        choices: &'static [(u32, &'static str)],
    },
    /// One of a few names.
    Named {
        /// The names.
        choices: &'static [&'static str],
    },
    /// Yes or no.
    Switch,
}

/// The value of an option.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum OptionValue {
    /// The value of [`OptionKind::Number`].
    Number(f64),
    /// The value of [`OptionKind::Whole`] and [`OptionKind::Numbered`].
    Whole(u32),
    /// The value of [`OptionKind::Named`].
    Name(&'static str),
    /// The value of [`OptionKind::Switch`].
    Switch(bool),
}

/// An option was given a value that it does not allow.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("the option `{option}` takes {allowed}")]
pub struct OptionRefused {
    /// The option's name.
    pub option: String,
    /// Its allowed values, e.g. "a number from 0 to 1".
    pub allowed: String,
}

impl OptionKind {
    /// Returns true if `value` is of this kind and within its range.
    pub fn takes(&self, value: OptionValue) -> bool {
        match (self, value) {
            (
                Self::Number {
                    range: [least, most], ..
                },
                OptionValue::Number(number),
            ) => (*least..=*most).contains(&number),
            (Self::Whole { range: [least, most] }, OptionValue::Whole(number)) => (*least..=*most).contains(&number),
            (Self::Numbered { choices }, OptionValue::Whole(number)) => choices.iter().any(|(own, _)| *own == number),
            (Self::Named { choices }, OptionValue::Name(name)) => choices.contains(&name),
            (Self::Switch, OptionValue::Switch(_)) => true,
            _ => false,
        }
    }

    /// Its allowed values, for a refusal: "a number from 0 to 1".
    pub fn allowed(&self) -> String {
        match self {
            Self::Number {
                range: [least, most], ..
            } => format!("a number from {} to {}", Short(*least), Short(*most)),
            Self::Whole { range: [least, most] } => format!("a whole number from {least} to {most}"),
            Self::Numbered { choices } => joined(choices.iter().map(|(number, _)| number.to_string()), "or"),
            Self::Named { choices } => joined(choices.iter().map(|name| format!("\"{name}\"")), "or"),
            Self::Switch => "true or false".to_owned(),
        }
    }

    /// The values and the unit, for the help: "0 to 1 diagonals".
    fn values(&self) -> String {
        match self {
            Self::Number {
                range: [least, most],
                unit,
            } => {
                let range = format!("{} to {}", Short(*least), Short(*most));
                if unit.is_empty() {
                    range
                } else {
                    format!("{range} {unit}")
                }
            }
            Self::Whole { range: [least, most] } => format!("{least} to {most}"),
            Self::Numbered { choices } => joined(choices.iter().map(|(number, word)| format!("{number} {word}")), "or"),
            Self::Named { .. } | Self::Switch => self.allowed(),
        }
    }
}

impl OptionDeclaration {
    /// Its effect, values, unit and default, on one line.
    pub fn sentence(&self, default: OptionValue) -> String {
        format!("{}; {}; default {default}", self.help, self.kind.values())
    }

    /// The same as an expert option.
    pub(crate) const fn advanced(self) -> Self {
        Self {
            is_advanced: true,
            ..self
        }
    }

    /// The same with an effect only if the choice `other` is one of `names`.
    pub(crate) const fn only_with(self, other: &'static str, names: &'static [&'static str]) -> Self {
        Self {
            only_with: Some((other, names)),
            ..self
        }
    }

    /// The reason why it has no effect, if it has none; `value` gives the values of the method's options.
    pub fn idle_because(&self, value: impl Fn(&str) -> Option<OptionValue>) -> Option<String> {
        let (other, names) = self.only_with?;
        let has_effect = matches!(value(other), Some(OptionValue::Name(name)) if names.contains(&name));
        (!has_effect).then(|| {
            let names = joined(names.iter().map(|name| format!("\"{name}\"")), "or");
            format!("Takes effect only if {other} is {names}.")
        })
    }

    /// The refusal of a value that it does not allow.
    pub(crate) fn refused(&self) -> OptionRefused {
        OptionRefused {
            option: self.name.to_owned(),
            allowed: self.kind.allowed(),
        }
    }
}

impl fmt::Display for OptionValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => Short(*number).fmt(f),
            Self::Whole(number) => number.fmt(f),
            Self::Name(name) => write!(f, "\"{name}\""),
            Self::Switch(on) => on.fmt(f),
        }
    }
}

/// A number with an exponent if it would have many zeros: 1e-6, 0.05, 1e12.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.abs() {
            size if size == 0.0 || (1e-3..1e6).contains(&size) => write!(f, "{}", self.0),
            _ => write!(f, "{:e}", self.0),
        }
    }
}

/// "a, b or c".
pub(crate) fn joined(words: impl IntoIterator<Item = String>, last: &str) -> String {
    let words: Vec<String> = words.into_iter().collect();
    match words.split_last() {
        Some((end, [])) => end.clone(),
        Some((end, others)) => format!("{} {last} {end}", others.join(", ")),
        None => String::new(),
    }
}

/// Declares a number, for [`options!`].
pub(crate) struct Number {
    pub default: f64,
    pub range: [f64; 2],
    pub unit: &'static str,
    pub help: &'static str,
}

/// Declares a whole number.
pub(crate) struct Whole {
    pub default: u32,
    pub range: [u32; 2],
    pub help: &'static str,
}

/// Declares a choice.
pub(crate) struct Choice<T> {
    pub default: T,
    pub help: &'static str,
}

impl Number {
    pub const fn declare(&self, name: &'static str) -> OptionDeclaration {
        OptionDeclaration {
            name,
            help: self.help,
            kind: OptionKind::Number {
                range: self.range,
                unit: self.unit,
            },
            is_advanced: false,
            only_with: None,
        }
    }
}

impl Whole {
    pub const fn declare(&self, name: &'static str) -> OptionDeclaration {
        OptionDeclaration {
            name,
            help: self.help,
            kind: OptionKind::Whole { range: self.range },
            is_advanced: false,
            only_with: None,
        }
    }
}

impl<T: Choices> Choice<T> {
    pub const fn declare(&self, name: &'static str) -> OptionDeclaration {
        OptionDeclaration {
            name,
            help: self.help,
            kind: T::KIND,
            is_advanced: false,
            only_with: None,
        }
    }
}

/// The type of an option's field.
pub(crate) trait OptionType: Copy {
    fn to_value(self) -> OptionValue;
    /// `None` for a value of another kind.
    fn of_value(value: OptionValue) -> Option<Self>;
}

/// A type whose values are a few choices.
pub(crate) trait Choices: OptionType {
    const KIND: OptionKind;
}

impl OptionType for f64 {
    fn to_value(self) -> OptionValue {
        OptionValue::Number(self)
    }

    fn of_value(value: OptionValue) -> Option<Self> {
        match value {
            OptionValue::Number(number) => Some(number),
            _ => None,
        }
    }
}

impl OptionType for u32 {
    fn to_value(self) -> OptionValue {
        OptionValue::Whole(self)
    }

    fn of_value(value: OptionValue) -> Option<Self> {
        match value {
            OptionValue::Whole(number) => Some(number),
            _ => None,
        }
    }
}

/// An enum whose variants are names in the edit format: `Variant = "its-name"`.
macro_rules! named_choices {
    ($(#[$meta:meta])* pub enum $type:ident { $($(#[$doc:meta])* $variant:ident = $name:literal),+ $(,)? }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
        pub enum $type {
            $($(#[$doc])* $variant),+
        }

        impl $type {
            /// Every choice, in the order of the window.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$variant),+];

            /// Its name in the edit format.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name),+
                }
            }
        }

        impl $crate::option::OptionType for $type {
            fn to_value(self) -> $crate::OptionValue {
                $crate::OptionValue::Name(self.name())
            }

            fn of_value(value: $crate::OptionValue) -> Option<Self> {
                match value {
                    $($crate::OptionValue::Name($name) => Some(Self::$variant),)+
                    _ => None,
                }
            }
        }

        impl $crate::option::Choices for $type {
            const KIND: $crate::OptionKind = $crate::OptionKind::Named { choices: &[$($name),+] };
        }
    };
}

/// The options of a method: a struct with its defaults, its list of declarations, and access by name.
///
/// A field `name: type = declaration` is an option; the declaration is a [`Number`], a [`Whole`] or a [`Choice`]. After
/// it, `; advanced` makes the window fold it away, and `; only_with(other, names)` declares its dependence. Fields in
/// `beside { .. }` are no options: only tests and measurements set them.
macro_rules! options {
    (
        $(#[$meta:meta])*
        pub struct $type:ident {
            $($(#[$doc:meta])* $option:ident: $kind:ty = $declaration:expr $(; $level:ident $(($($argument:expr),*))?)*,)*
        }
        $(beside { $($(#[$beside_doc:meta])* $beside:ident: $beside_kind:ty = $beside_default:expr,)* })?
    ) => {
        $(#[$meta])*
        #[derive(Clone, PartialEq, Debug)]
        #[non_exhaustive]
        pub struct $type {
            $($(#[$doc])* pub $option: $kind,)*
            $($($(#[$beside_doc])* pub $beside: $beside_kind,)*)?
        }

        impl $type {
            pub(crate) const OPTIONS: &'static [$crate::OptionDeclaration] =
                &[$($declaration.declare(stringify!($option))$(.$level($($($argument),*)?))*),*];
        }

        impl Default for $type {
            fn default() -> Self {
                Self {
                    $($option: $declaration.default,)*
                    $($($beside: $beside_default,)*)?
                }
            }
        }

        impl $crate::method::Options for $type {
            fn value(&self, option: &str) -> Option<$crate::OptionValue> {
                match option {
                    $(stringify!($option) => Some($crate::option::OptionType::to_value(self.$option)),)*
                    _ => None,
                }
            }

            fn set(&mut self, option: &str, value: $crate::OptionValue) -> Option<()> {
                match option {
                    $(stringify!($option) => {
                        self.$option = $crate::option::OptionType::of_value(value)?;
                        Some(())
                    })*
                    _ => {
                        let _ = value;
                        None
                    }
                }
            }

            fn boxed_clone(&self) -> Box<dyn $crate::method::DeformMethod> {
                Box::new(self.clone())
            }

            fn equals(&self, other: &dyn $crate::method::DeformMethod) -> bool {
                (other as &dyn std::any::Any).downcast_ref() == Some(self)
            }
        }

        impl From<$type> for $crate::Method {
            fn from(options: $type) -> Self {
                Self::of(options)
            }
        }
    };
}

pub(crate) use {named_choices, options};
