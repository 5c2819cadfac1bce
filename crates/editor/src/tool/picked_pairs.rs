//! Pairs of places on borders that are clicked in turn, and belong together in a merge.

use pliant_mesh::SurfaceVertex;

use super::rim::RimUse;
use super::settings::ToolSettings;
use crate::view::Readout;
use crate::workspace::Workspace;

impl ToolSettings {
    /// Takes a place on a border: the first of a pair, or the one that belongs to it.
    pub(super) fn pick_for_pair(&mut self, first: Option<SurfaceVertex>, place: SurfaceVertex) {
        match first {
            None => self.wants_rim = Some(RimUse::Merge { first: Some(place) }),
            Some(first) => {
                self.picked_pairs.push([first, place]);
                self.wants_rim = Some(RimUse::Merge { first: None });
            }
        }
    }

    /// Takes the last place back; false if there is none.
    pub(crate) fn take_back_pick(&mut self) -> bool {
        let first = match self.wants_rim {
            Some(RimUse::Merge { first: Some(_) }) => None,
            Some(RimUse::Merge { first: None }) => match self.picked_pairs.pop() {
                Some([first, _]) => Some(first),
                None => return false,
            },
            _ => return false,
        };
        self.wants_rim = Some(RimUse::Merge { first });
        true
    }

    /// The pairs to merge at, if any are picked. They stay until the mesh changes, so that a refused merge can be mended.
    pub(crate) fn pairs(&self) -> Option<&[[SurfaceVertex; 2]]> {
        let is_wanted = matches!(self.wants_rim, Some(RimUse::Merge { .. }));
        (is_wanted && !self.picked_pairs.is_empty()).then_some(&*self.picked_pairs)
    }

    /// The number of its pair at each place.
    pub(crate) fn pair_numbers(&self, workspace: &Workspace) -> Vec<Readout> {
        let first = match self.wants_rim {
            Some(RimUse::Merge { first }) => first,
            _ => return Vec::new(),
        };
        let pairs = self.picked_pairs.iter().map(|pair| pair.as_slice());
        let numbered = pairs.chain([first.as_slice()]).zip(1..);
        let mark = |(places, number): (&[SurfaceVertex], u32)| -> Vec<Readout> {
            let at = |place: &SurfaceVertex| Readout {
                at: workspace.position(*place),
                text: number.to_string(),
            };
            places.iter().map(at).collect()
        };
        numbered.flat_map(mark).collect()
    }
}
