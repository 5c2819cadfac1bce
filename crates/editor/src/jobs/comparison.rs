//! The present edit bent by every method, for a choice by eye.
//!
//! One job runs at a time: it binds a method, or takes the next steps with a bound one. The methods take turns, so that
//! all of them follow a drag.

use pliant_deform::METHODS;

use super::allowance::Allowance;
use super::alternative::Alternative;
use super::compared::{Compared, Edit};
use super::computed::Computed;
use super::slot::{Unfinished, Work};
use crate::document::Document;

/// Each method's result for the present edit.
#[derive(Debug)]
pub struct Comparison {
    alternatives: Vec<Alternative>,
    /// The method and the edit of the running job.
    under_way: Option<(usize, Edit)>,
    /// The method whose turn it is.
    next: usize,
    /// The method that is shown large, and has its turn before the others.
    large: Option<usize>,
}

impl Comparison {
    /// Every method, unbound; each shows the document's shape.
    pub(super) fn new(document: &Document) -> Self {
        let alternatives = METHODS.iter().map(|declaration| {
            let own = Some(&document.method).filter(|method| method.name() == declaration.name);
            let method = own.cloned().unwrap_or_else(|| (declaration.first_choice)());
            Alternative::new(method, document)
        });
        Self {
            alternatives: alternatives.collect(),
            under_way: None,
            next: 0,
            large: None,
        }
    }

    /// One for each method, in the order of the window.
    pub fn alternatives(&self) -> &[Alternative] {
        &self.alternatives
    }

    /// The number of the method that is shown large.
    pub fn large(&self) -> Option<usize> {
        self.large
    }

    /// Shows a method large, or all of them in the same size.
    pub(crate) fn enlarge(&mut self, number: Option<usize>) {
        self.large = number.filter(|&number| number < self.alternatives.len());
    }

    /// Whether every shape is for the present edit, or refused for it.
    pub fn is_current(&self) -> bool {
        self.alternatives.iter().all(|alternative| alternative.is_current)
    }

    /// Follows the document: bindings of another edit are dropped, and so is that of the document's own method when it
    /// gets other options. Returns whether the running job is no longer wanted.
    pub(super) fn follow(&mut self, document: &Document) -> bool {
        let present = Edit::of(document);
        let mut is_unwanted = matches!(&self.under_way, Some((_, of)) if of.is_other_problem(&present));
        for (number, alternative) in self.alternatives.iter_mut().enumerate() {
            if alternative.follow(document, &present) {
                is_unwanted |= matches!(&self.under_way, Some((under_way, _)) if *under_way == number);
            }
        }
        if is_unwanted {
            self.under_way = None;
        }
        is_unwanted
    }

    /// The power of the ordering that the method whose turn it is still needs.
    pub(super) fn missing_ordering(&self, computed: &Computed) -> Option<u32> {
        let power = self.alternatives[self.turn()?].method.ordering_power()?;
        computed.ordering(power).is_none().then_some(power)
    }

    /// The work of the method whose turn it is; `None` if all are done, or the ordering is missing.
    pub(super) fn next_work(
        &mut self,
        document: &Document,
        computed: &Computed,
        (allowance, clock_ms): (Allowance, fn() -> f64),
    ) -> Option<Work<Box<Compared>>> {
        let number = self.turn()?;
        let work = self.alternatives[number].work(document, computed, allowance, clock_ms)?;
        self.under_way = Some((number, Edit::of(document)));
        self.next = number + 1;
        Some(work)
    }

    /// Stores the result of a job.
    pub(super) fn take(&mut self, outcome: Result<Box<Compared>, Unfinished>) {
        let Some((number, of)) = self.under_way.take() else {
            return;
        };
        self.alternatives[number].take(outcome, of);
    }

    /// Leaves all unfinished methods unchanged until the edit changes.
    pub(super) fn stop(&mut self, document: &Document) {
        self.under_way = None;
        let alternatives = self.alternatives.iter_mut();
        alternatives
            .filter(|alternative| !alternative.is_current)
            .for_each(|alternative| alternative.stop(document));
    }

    /// The next method that is not current: the large one, or the one after the last that had its turn.
    fn turn(&self) -> Option<usize> {
        let count = self.alternatives.len();
        let others = (0..count).map(|step| (self.next + step) % count);
        let mut numbers = self.large.into_iter().chain(others);
        numbers.find(|&number| !self.alternatives[number].is_current)
    }
}
