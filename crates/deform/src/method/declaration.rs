//! A method's declaration: everything that lists, explains or offers methods reads it.

use super::attachment::AttachmentDeclaration;
use super::{Method, OptionDeclaration};

/// The listing and explanation of a method. Each method's folder has one, and [`super::METHODS`] has them all.
#[derive(Clone, Copy, Debug)]
pub struct MethodDeclaration {
    /// Its name in the edit format and on the command line.
    pub name: &'static str,
    /// Its label for a person.
    pub title: &'static str,
    /// One sentence on its use.
    pub when_to_use: &'static str,
    /// Its other names, in lower case.
    pub keywords: &'static str,
    /// Its options, in the order of the window.
    pub options: &'static [OptionDeclaration],
    /// Its inputs beside handles, such as a cage. The method makes those that are not brought.
    pub attachments: &'static [AttachmentDeclaration],
    /// The constraints that it supports beyond handles and fixed vertices.
    pub heeds: &'static [ConstraintKind],
    /// The method with the defaults of the edit format.
    pub default: fn() -> Method,
    /// The window's initial method. It may differ from the defaults, which can't change because edits leave them out.
    pub first_choice: fn() -> Method,
}

/// A constraint that not every method supports.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ConstraintKind {
    /// Handles that only pull at their vertices.
    SoftHandles,
    /// The smoothness with which the free surface joins constrained vertices.
    Continuity,
    /// Painted stiffness.
    Stiffness,
}

/// The domain of a method.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Needs {
    /// Points in space, connected or not. The method moves every free vertex.
    Points,
    /// A surface's triangles. The method moves the vertices that a handle can reach.
    Surface {
        /// The number of edges over which a handle's influence spreads at a time, across constrained vertices too; at
        /// least 1.
        reach: u32,
        /// The power of the Laplacian whose graph gives its system's order of elimination; `None` if it needs no
        /// [`crate::Ordering`].
        ordering_power: Option<u32>,
    },
}

/// The way in which a bound method finds its shape.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Solve {
    /// In one step.
    Direct,
    /// Step by step, each from the last one's shape.
    Iterative {
        /// The most steps towards one set of targets; at least 1.
        max_iterations: u32,
    },
}

impl MethodDeclaration {
    /// The attachment of this name, if the method takes it.
    pub fn attachment(&self, name: &str) -> Option<&'static AttachmentDeclaration> {
        self.attachments.iter().find(|attachment| attachment.name == name)
    }

    /// Whether it supports this constraint.
    pub fn heeds(&self, constraint: ConstraintKind) -> bool {
        self.heeds.contains(&constraint)
    }
}

impl Needs {
    /// The power of the ordering that it needs, if it needs one.
    pub fn ordering_power(self) -> Option<u32> {
        match self {
            Self::Points => None,
            Self::Surface { ordering_power, .. } => ordering_power,
        }
    }
}
