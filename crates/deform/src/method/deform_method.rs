//! A method as its options: its declaration and its binding.

use std::any::Any;
use std::fmt::Debug;

use glam::DVec3;

use super::{BindInput, BoundMethod};
use crate::handles::turns::Followed;
use crate::operators::triangulation::Triangulation;
use crate::region::boundary_problem::BoundaryProblem;
use crate::{
    Attachment, AttachmentDeclaration, AttachmentRefused, BindError, ConstraintKind, ControlLattice, HandleFit, Needs,
    OptionDeclaration, OptionRefused, OptionSlider, OptionValue, Picture, Solve,
};

/// A method with its options: the law by which a surface follows its handles.
pub struct Method(pub(super) Box<dyn DeformMethod>);

/// The listing and explanation of a method. Each method's folder has one, and [`crate::METHODS`] has them all.
#[derive(Clone, Copy, Debug)]
pub struct MethodDeclaration {
    /// Its name in the edit format and on the command line.
    pub name: &'static str,
    /// Its label for a person, in words of its use.
    pub title: &'static str,
    /// Its name in the literature.
    pub paper: &'static str,
    /// One sentence on its use.
    pub when_to_use: &'static str,
    /// Its other names, in lower case.
    pub keywords: &'static str,
    /// The elements that its picture shows.
    pub picture: Picture,
    /// The slider of the option that counts most, if it has one; shown while the option has an effect.
    pub slider: Option<&'static OptionSlider>,
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

    /// Its name in the literature, with a capital.
    pub fn paper_title(&self) -> String {
        let mut paper = self.paper.chars();
        let first = paper.next().map(|first| first.to_uppercase().to_string());
        first.unwrap_or_default() + paper.as_str()
    }

    /// Its name in the literature and its use, in sentences.
    pub fn explanation(&self) -> String {
        format!("{}. {}", self.paper_title(), self.when_to_use)
    }

    /// Returns true if it supports this constraint.
    pub fn heeds(&self, constraint: ConstraintKind) -> bool {
        self.heeds.contains(&constraint)
    }
}

/// Options by name; [`crate::option::options!`] implements it.
pub(crate) trait Options: Any + Debug + Send + Sync {
    /// The value of an option; `None` if there is none of this name.
    fn value(&self, option: &str) -> Option<OptionValue>;

    /// Sets an option without checking its range; `None` if there is none of this name and kind.
    fn set(&mut self, option: &str, value: OptionValue) -> Option<()>;

    /// A copy.
    fn boxed_clone(&self) -> Box<dyn DeformMethod>;

    /// Whether `other` is the same method with the same options.
    fn equals(&self, other: &dyn DeformMethod) -> bool;
}

/// A method: its options, and their binding.
pub(crate) trait DeformMethod: Options {
    /// Its declaration.
    fn declaration(&self) -> &'static MethodDeclaration;

    /// Its domain.
    fn needs(&self) -> Needs;

    /// The way in which it is solved once it is bound.
    fn solve(&self) -> Solve;

    /// Refuses options that exclude each other. The range of each option was checked before.
    fn check(&self) -> Result<(), OptionRefused> {
        Ok(())
    }

    /// The rest positions of a lattice's control points, for a method with a lattice.
    fn lattice_points(&self, _lattice: &ControlLattice) -> Vec<DVec3> {
        Vec::new()
    }

    /// Refuses an attachment of a declared kind that can't be bound with these options to any surface. Its table
    /// `moved` and non-finite values are checked afterwards.
    fn check_attachment(&self, _attachment: &Attachment) -> Result<(), AttachmentRefused> {
        Ok(())
    }

    /// Returns true if examples bend the surface by their weights, 0 being rest. Otherwise they only add to the
    /// handles' effect, and a weight multiplies its example's addition.
    fn examples_bend(&self) -> bool {
        true
    }

    /// The triangles of its operator.
    fn triangulation<'a>(&self, problem: &BoundaryProblem<'a>) -> Triangulation<'a> {
        Triangulation::of_surface(problem.surface, problem.topology)
    }

    /// The way in which hard handles hold their vertices.
    fn handle_fit(&self) -> HandleFit {
        HandleFit::Exact
    }

    /// Returns true if [`crate::Constraints::continuity`] has an effect.
    fn has_continuity(&self) -> bool {
        false
    }

    /// The option, at its present value, that is in sizes of the bending part ([`crate::Problem`]), and the power of
    /// the size in it.
    fn counts_in_sizes(&self) -> Option<(&'static str, i32)> {
        None
    }

    /// The largest turns of a limb that it does not narrow; `None` if it follows half a turn, or has its own sentence.
    fn follows_turns(&self) -> Option<Followed> {
        None
    }

    /// Returns true if the surface turns though the handles only move.
    fn turns_by_moves(&self) -> bool {
        false
    }

    /// The largest turn between handles for which it is advised instead of a method that follows less; 0 for none.
    fn advised_for_degrees(&self) -> u16 {
        0
    }

    /// Returns true if a triangle resists the more, the less of its area is left.
    fn resists_collapse(&self) -> bool {
        false
    }

    /// Returns true if it can be bound with an ordering of power 1 instead of its own, by the Laplacian's factor, which takes
    /// less memory and more time.
    fn takes_first_power(&self) -> bool {
        false
    }

    /// Returns true if each vertex of a handle can have its own place, by an offset from the handle's motion
    /// ([`crate::handles::offsets::Offsets`]).
    fn takes_places(&self) -> bool {
        false
    }

    /// Returns true if the shape depends on the handles' turns, and not only on the positions of their vertices. A
    /// method that takes no turns takes places.
    fn takes_turns(&self) -> bool {
        true
    }

    /// The largest difference, in radians, between the turns of two vertices of a handle ([`crate::TurnedMap::turn_rad`])
    /// with which the surface between them turns.
    fn largest_gap_rad(&self) -> f64 {
        f64::INFINITY
    }

    /// Bytes of a solved vertex in the method's tables, without matrices and factors, whose entries are counted one by
    /// one: as allocated, measured by `tests/memory.rs`.
    fn row_bytes(&self) -> usize {
        300
    }

    /// Bytes of each handle at a solved vertex during binding: twice four numbers in single precision.
    fn handle_row_bytes(&self) -> usize {
        32
    }

    /// Computes everything that does not depend on the handles' transforms.
    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError>;
}
