//! Frames whose ends start the descents of their neighbours.
//!
//! A method that descends from rest needs hundreds of steps in every frame, and the ends of neighbouring frames are
//! close. So one frame of every [`BLOCK`] leads: it begins at rest, and the others begin at its end. Which frame leads
//! depends on its number alone, so a frame's result depends neither on the number of threads nor on other blocks.

use std::ops::Range;

use rayon::prelude::*;

use super::bent::Bent;

/// The number of frames that one leads. On a walking horse whose head is turned by 40°, ten frames up to eight frames from a
/// leader took 55% of the steps that they take from rest.
const BLOCK: usize = 8;

/// The bent leaders of some blocks.
#[derive(Default)]
pub(super) struct Leaders {
    /// The number of frames of the sequence.
    count: usize,
    /// Each with its frame; a frame in which nothing moves, or which can't be bent, leads none.
    bent: Vec<(usize, Bent)>,
}

impl Leaders {
    /// The number of frames that `leaders` lead together.
    pub fn span(leaders: usize) -> usize {
        BLOCK * leaders
    }

    /// Bends the leaders of these frames of `count`, side by side.
    pub fn of(frames: Range<usize>, count: usize, bend: impl Fn(usize) -> Option<Bent> + Sync) -> Self {
        let mut leaders: Vec<usize> = frames.map(|frame| leader(frame, count)).collect();
        leaders.dedup();
        let bent = leaders.into_par_iter().map(|frame| (frame, bend(frame)));
        let bent: Vec<(usize, Option<Bent>)> = bent.collect();
        let bent = bent.into_iter().filter_map(|(frame, bent)| Some((frame, bent?)));
        Self {
            count,
            bent: bent.collect(),
        }
    }

    /// The end of this frame, if it is a leader.
    pub fn end(&self, frame: usize) -> Option<&Bent> {
        let mut bent = self.bent.iter();
        bent.find(|(own, _)| *own == frame).map(|(_, bent)| bent)
    }

    /// The end of the leader of this frame.
    pub fn start(&self, frame: usize) -> Option<&Bent> {
        self.end(leader(frame, self.count))
    }
}

/// The leader of a frame: the middle one of its block.
fn leader(frame: usize, count: usize) -> usize {
    let block = frame / BLOCK * BLOCK;
    (block + BLOCK / 2).min(count.saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::{BLOCK, leader};

    #[test]
    fn each_frame_has_a_leader_in_its_own_block_which_leads_itself() {
        for count in [1, 3, BLOCK, BLOCK + 1, 3 * BLOCK + 2] {
            for frame in 0..count {
                let own = leader(frame, count);
                assert!(own < count, "frame {frame} of {count}");
                assert_eq!(own / BLOCK, frame / BLOCK, "frame {frame} of {count}");
                assert_eq!(leader(own, count), own, "frame {frame} of {count}");
            }
        }
    }
}
