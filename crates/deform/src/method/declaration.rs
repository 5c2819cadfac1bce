//! A method's declaration: everything that lists, explains or offers methods reads it.

use super::attachment::AttachmentDeclaration;
use super::{Method, OptionDeclaration};

/// A method, as it is listed and explained. Each method's folder has one, and [`super::METHODS`] has them all.
#[derive(Clone, Copy, Debug)]
pub struct MethodDeclaration {
    /// Its name in the edit format and on the command line.
    pub name: &'static str,
    /// What a person calls it.
    pub title: &'static str,
    /// One sentence on when to take it.
    pub when_to_use: &'static str,
    /// What else it is called, in lower case.
    pub keywords: &'static str,
    /// Its options, in the order in which they are shown.
    pub options: &'static [OptionDeclaration],
    /// What it takes beside handles, such as a cage. It makes for itself what is not brought.
    pub attachments: &'static [AttachmentDeclaration],
    /// Which constraints it supports beyond handles and fixed vertices.
    pub heeds: &'static [ConstraintKind],
    /// The method with the defaults of the edit format.
    pub default: fn() -> Method,
    /// The method as the window begins with it. It may differ from the defaults, which can't change because edits leave
    /// them out.
    pub first_choice: fn() -> Method,
}

/// A constraint that not every method supports.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ConstraintKind {
    /// Handles that only pull at their vertices.
    SoftHandles,
    /// How smoothly the free surface joins constrained vertices.
    Continuity,
    /// Painted stiffness.
    Stiffness,
}

/// What a method works on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Needs {
    /// Points in space, connected or not. It moves every free vertex.
    Points,
    /// A surface's triangles. It moves what a handle can reach.
    Surface {
        /// How many edges a handle's influence travels at a time, across constrained vertices too; at least 1.
        reach: u32,
        /// The power of the Laplacian in whose graph's order its system is eliminated; `None` if it needs no
        /// [`crate::Ordering`].
        ordering_power: Option<u32>,
    },
}

/// How a bound method comes to its shape.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Solve {
    /// In one step.
    Direct,
    /// Step by step, each going on from the shape of the last one.
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

    /// Whether it heeds this.
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
