//! The donors of frames for degenerate places of the base.

use std::collections::VecDeque;

/// No place.
pub(crate) const NONE: u32 = u32::MAX;

/// For each place the nearest one that `has` a frame, by edges, itself first; [`NONE`] if none can be reached. Among
/// equally near ones it is the one found first in the order of numbers. `neighbours` visits a place's neighbours.
pub(crate) fn nearest(has: &[bool], neighbours: impl Fn(usize, &mut dyn FnMut(u32))) -> Vec<u32> {
    let mut sources: Vec<u32> = (0..has.len() as u32)
        .map(|place| if has[place as usize] { place } else { NONE })
        .collect();
    if !has.contains(&false) {
        return sources;
    }
    let mut queue: VecDeque<u32> = (0..has.len() as u32).filter(|&place| has[place as usize]).collect();
    while let Some(place) = queue.pop_front() {
        let source = sources[place as usize];
        neighbours(place as usize, &mut |next| {
            if sources[next as usize] == NONE {
                sources[next as usize] = source;
                queue.push_back(next);
            }
        });
    }
    sources
}
