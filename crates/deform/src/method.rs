//! The methods by name.

use crate::{Arap, Bilaplacian, Primo};

/// How a surface follows its handles. Later methods join as variants.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub enum Method {
    /// The linear shell, by default a thin plate (Botsch & Kobbelt 2004).
    Bilaplacian(Bilaplacian),
    /// As-rigid-as-possible (Sorkine & Alexa 2007).
    Arap(Arap),
    /// Coupled prisms (Botsch et al. 2006).
    Primo(Primo),
}

impl Method {
    /// Every method's name, in the order in which they are shown.
    pub const NAMES: &'static [&'static str] = &["bilaplacian", "arap", "primo"];

    /// The method called `name`, with its defaults.
    pub fn from_name(name: &str) -> Option<Self> {
        match name {
            "bilaplacian" => Some(Self::Bilaplacian(Bilaplacian::default())),
            "arap" => Some(Self::Arap(Arap::default())),
            "primo" => Some(Self::Primo(Primo::default())),
            _ => None,
        }
    }

    /// The name that [`Method::from_name`] takes.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Bilaplacian(_) => "bilaplacian",
            Self::Arap(_) => "arap",
            Self::Primo(_) => "primo",
        }
    }

    /// The power of the Laplacian whose graph the method's system has: what [`crate::Ordering::of`] takes.
    pub fn operator_power(&self) -> u32 {
        match self {
            Self::Bilaplacian(options) => options.operator_power(),
            Self::Arap(options) => options.operator_power(),
            Self::Primo(_) => 1,
        }
    }
}

impl Default for Method {
    fn default() -> Self {
        Self::Bilaplacian(Bilaplacian::default())
    }
}

#[cfg(test)]
mod tests {
    use super::Method;

    #[test]
    fn every_name_names_its_method() {
        for name in Method::NAMES {
            assert_eq!(Method::from_name(name).map(|method| method.name()), Some(*name));
        }
        assert_eq!(Method::from_name("no such method"), None);
    }
}
