//! Names of methods that can do something that another one can't, for messages.

use crate::method::option::joined;
use crate::{ConstraintKind, METHODS, MethodDeclaration, Needs};

/// The names of the first methods that bend space and need no surface, joined by "or".
pub fn of_space() -> String {
    let points = |declaration: &&&MethodDeclaration| (declaration.default)().needs() == Needs::Points;
    either(METHODS.iter().filter(points).take(2))
}

/// The names of the methods that bend space and keep no table for each handle, joined by "or".
pub(crate) fn of_space_for_many_handles() -> String {
    let keeps_nothing = |declaration: &&&MethodDeclaration| {
        let method = (declaration.default)();
        method.needs() == Needs::Points && method.implementation().handle_row_bytes() == 0
    };
    either(METHODS.iter().filter(keeps_nothing))
}

/// All methods that support a constraint.
pub(crate) fn heeding(constraint: ConstraintKind) -> String {
    either(METHODS.iter().filter(|declaration| declaration.heeds(constraint)))
}

/// All methods in which each vertex of a handle can have its own target position.
pub(crate) fn taking_places() -> String {
    let takes = |declaration: &&&MethodDeclaration| (declaration.default)().implementation().takes_places();
    either(METHODS.iter().filter(takes))
}

fn either<'a>(declarations: impl Iterator<Item = &'a &'static MethodDeclaration>) -> String {
    joined(declarations.map(|declaration| declaration.name.to_owned()), "or")
}
