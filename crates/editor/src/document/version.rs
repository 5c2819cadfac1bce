//! The version of the document, aspect by aspect: data that follow from an aspect are up to date as long as they were
//! made from the same version of it.
//!
//! Within a document's life equal versions mean equal content. Every change gives the changed aspect a new version; a
//! change that is undone as a whole restores the old version, and data made from that are valid again.

/// An aspect of a document from which other data can follow.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Aspect {
    /// The paint of the vertices.
    Paint,
    /// The painted stiffness.
    Stiffness,
    /// The painted continuity.
    Continuity,
    /// The method and its options.
    Method,
    /// The rest state of the methods' inputs beside handles.
    Attachments,
    /// The state of the tips: free or fixed.
    Tips,
    /// The behaviour of loose parts.
    Loose,
    /// The rest shape.
    Rest,
    /// The present shape, as displacements from the rest shape.
    Shape,
    /// The drawn shape, as displacements from the file's.
    Drawn,
    /// The parts that are turned inside out.
    InsideOut,
    /// The hidden and locked parts.
    Access,
    /// The locked ones of these.
    Locks,
    /// Anything about handles.
    Handles,
    /// The list of handles, their reach and the way in which they hold.
    Constraints,
    /// The handles' targets, and the positions to which control points are moved by hand.
    Targets,
    /// The look of handles: colours, visibility.
    Appearance,
    /// The fluid on the surface.
    Fluid,
}

impl Aspect {
    pub(crate) const ALL: [Self; 18] = [
        Self::Paint,
        Self::Stiffness,
        Self::Continuity,
        Self::Method,
        Self::Attachments,
        Self::Tips,
        Self::Loose,
        Self::Rest,
        Self::Shape,
        Self::Drawn,
        Self::InsideOut,
        Self::Access,
        Self::Locks,
        Self::Handles,
        Self::Constraints,
        Self::Targets,
        Self::Appearance,
        Self::Fluid,
    ];

    /// The aspects from which the region and the factorisation follow.
    const OF_PROBLEM: [Self; 10] = [
        Self::Paint,
        Self::Stiffness,
        Self::Continuity,
        Self::Method,
        Self::Attachments,
        Self::Tips,
        Self::Loose,
        Self::Rest,
        Self::Locks,
        Self::Constraints,
    ];
}

/// The number of an aspect's state.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub(crate) struct Version(u64);

/// The versions of every aspect of a document.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) struct Versions([Version; Aspect::ALL.len()]);

impl Versions {
    /// The version of one aspect.
    pub(crate) fn of(&self, aspect: Aspect) -> Version {
        self.0[aspect as usize]
    }

    /// Returns true if an aspect differs from that in `other`.
    pub(crate) fn differ(&self, other: &Self, aspect: Aspect) -> bool {
        self.of(aspect) != other.of(aspect)
    }

    /// Returns true if region and factorisation of one are invalid for the other.
    pub(crate) fn are_other_problem(&self, other: &Self) -> bool {
        Aspect::OF_PROBLEM.iter().any(|&aspect| self.differ(other, aspect))
    }

    /// Returns true if they differ in an aspect from which region and factorisation of every method follow.
    pub(crate) fn are_other_edit(&self, other: &Self) -> bool {
        let mut aspects = Aspect::OF_PROBLEM.iter().filter(|&&aspect| aspect != Aspect::Method);
        aspects.any(|&aspect| self.differ(other, aspect))
    }

    /// Takes one aspect over from `other`.
    pub(crate) fn take(&mut self, other: &Self, aspect: Aspect) {
        self.0[aspect as usize] = other.of(aspect);
    }
}

/// Hands out versions. None is used twice, even after undo.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Marks {
    last: u64,
    versions: Versions,
}

impl Marks {
    /// The present versions.
    pub(super) fn versions(&self) -> &Versions {
        &self.versions
    }

    /// Gives these aspects new versions.
    pub(super) fn mark(&mut self, aspects: &[Aspect]) {
        self.last += 1;
        for &aspect in aspects {
            self.versions.0[aspect as usize] = Version(self.last);
        }
    }

    /// Restores `versions`.
    pub(super) fn go_back_to(&mut self, versions: &Versions) {
        self.versions = *versions;
    }

    /// Restores one aspect of `versions`.
    pub(super) fn go_back(&mut self, versions: &Versions, aspect: Aspect) {
        self.versions.take(versions, aspect);
    }

    /// Continues the count of another.
    pub(super) fn count_on_from(&mut self, other: &Self) {
        self.last = self.last.max(other.last);
    }
}

#[cfg(test)]
mod tests {
    use super::{Aspect, Marks};

    #[test]
    fn what_is_taken_back_has_its_old_version_and_what_comes_after_it_a_new_one() {
        let mut marks = Marks::default();
        marks.mark(&[Aspect::Paint]);
        let before = *marks.versions();
        marks.mark(&[Aspect::Paint, Aspect::Constraints]);
        let during = *marks.versions();
        assert!(during.are_other_problem(&before) && !during.differ(&before, Aspect::Method));
        marks.go_back_to(&before);
        assert_eq!(*marks.versions(), before);
        marks.mark(&[Aspect::Paint]);
        assert!(marks.versions().differ(&during, Aspect::Paint), "none is given twice");
    }

    #[test]
    fn aspects_stand_at_their_own_numbers() {
        for (number, aspect) in Aspect::ALL.into_iter().enumerate() {
            assert_eq!(aspect as usize, number);
        }
    }
}
