//! Names of methods that do what another one can't, for messages.

use crate::method::option::joined;
use crate::{ConstraintKind, METHODS, MethodDeclaration, Needs};

/// The names of the first methods that bend space and need no surface, joined by "or".
pub fn of_space() -> String {
    let points = |declaration: &&&MethodDeclaration| (declaration.default)().needs() == Needs::Points;
    either(METHODS.iter().filter(points).take(2))
}

/// All methods that heed a constraint.
pub(crate) fn heeding(constraint: ConstraintKind) -> String {
    either(METHODS.iter().filter(|declaration| declaration.heeds(constraint)))
}

fn either<'a>(declarations: impl Iterator<Item = &'a &'static MethodDeclaration>) -> String {
    joined(declarations.map(|declaration| declaration.name.to_owned()), "or")
}
