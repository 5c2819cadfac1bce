//! A method's declaration: everything that lists, explains or offers methods reads it.

use super::Method;
use crate::ConstraintKind;
use crate::attachment::AttachmentDeclaration;
use crate::option::OptionDeclaration;

/// The listing and explanation of a method. Each method's folder has one, and [`crate::METHODS`] has them all.
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
