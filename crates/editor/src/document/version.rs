//! Which state of the document this is, aspect by aspect: what follows from an aspect is up to date as long as it was
//! made from the same version of it.
//!
//! Within a document's life equal versions mean equal content. Every change gives what it changes a new version; a
//! change that is taken back as a whole gives back the old one, and what was made from that is good again.

/// What about a document something else can follow from.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Aspect {
    /// What is painted on the vertices.
    Paint,
    /// The painted stiffness.
    Stiffness,
    /// The painted continuity.
    Continuity,
    /// The method and its options.
    Method,
    /// How what methods take beside handles rests.
    Attachments,
    /// Whether tips come along.
    Tips,
    /// What loose parts do.
    Loose,
    /// The rest shape.
    Rest,
    /// The present shape, as displacements from the rest shape.
    Shape,
    /// What is drawn: the present shape, as displacements from the file's.
    Drawn,
    /// Which parts are turned inside out.
    InsideOut,
    /// What is hidden and locked.
    Access,
    /// What of that is locked.
    Locks,
    /// Anything about handles.
    Handles,
    /// Which handles there are, how far they reach and how they hold.
    Constraints,
    /// Where the handles want the surface, and where control points are moved to by hand.
    Targets,
    /// How handles look: colours, what is shown.
    Appearance,
}

impl Aspect {
    pub(crate) const ALL: [Self; 17] = [
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
    ];

    /// What the region and the factorisation follow from.
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

/// The number of a state of one aspect.
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

    /// Whether an aspect is another than in `other`.
    pub(crate) fn differ(&self, other: &Self, aspect: Aspect) -> bool {
        self.of(aspect) != other.of(aspect)
    }

    /// Whether region and factorisation of one are no good for the other.
    pub(crate) fn are_other_problem(&self, other: &Self) -> bool {
        Aspect::OF_PROBLEM.iter().any(|&aspect| self.differ(other, aspect))
    }

    /// Whether they differ in something that region and factorisation of every method follow from.
    pub(crate) fn are_other_edit(&self, other: &Self) -> bool {
        let mut aspects = Aspect::OF_PROBLEM.iter().filter(|&&aspect| aspect != Aspect::Method);
        aspects.any(|&aspect| self.differ(other, aspect))
    }

    /// Takes one aspect over from `other`.
    pub(crate) fn take(&mut self, other: &Self, aspect: Aspect) {
        self.0[aspect as usize] = other.of(aspect);
    }
}

/// Hands out versions. None is given twice, whatever is taken back.
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

    /// These aspects have changed.
    pub(super) fn mark(&mut self, aspects: &[Aspect]) {
        self.last += 1;
        for &aspect in aspects {
            self.versions.0[aspect as usize] = Version(self.last);
        }
    }

    /// Everything is as it was at `versions` again.
    pub(super) fn go_back_to(&mut self, versions: &Versions) {
        self.versions = *versions;
    }

    /// One aspect is as it was at `versions` again.
    pub(super) fn go_back(&mut self, versions: &Versions, aspect: Aspect) {
        self.versions.take(versions, aspect);
    }

    /// Goes on counting where another left off.
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
