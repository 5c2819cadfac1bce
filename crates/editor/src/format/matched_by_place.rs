//! What an edit's places found on another mesh.

use serde::Serialize;

/// The sentence names no more handles than this, those of which the least was found.
const MOST_NAMED: usize = 4;

/// How much of an edit's sets another mesh has.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct MatchedByPlace {
    /// The distance within which a place counts as found, in world units.
    pub within: f64,
    /// The sets with recorded places: the handles in their order, then the free region.
    pub found: Vec<FoundPlaces>,
    /// True if the mesh' triangles face the other way than those that the edit was made on. The edit is matched as if
    /// they were turned.
    pub turned: bool,
    /// Sentences about parts of the edit that stay behind.
    pub left_out: Vec<String>,
}

/// How much of a set was found.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct FoundPlaces {
    /// The handle's name, or "the free region".
    pub set: String,
    /// The share of its places that have a partner, 0 to 1.
    pub share: f64,
}

impl MatchedByPlace {
    /// The sentence for a person.
    pub fn sentence(&self) -> String {
        let mut found: Vec<&FoundPlaces> = self.found.iter().collect();
        if found.len() > MOST_NAMED + 1 {
            found.sort_by(|a, b| a.share.total_cmp(&b.share));
            found.truncate(MOST_NAMED);
        }
        let parts: Vec<String> = found
            .iter()
            .map(|found| format!("{} of {}", percent(found.share), found.set))
            .collect();
        let others = match self.found.len() > parts.len() {
            true => ", more of the others",
            false => "",
        };
        let mut sentence = format!(
            "the edit was made on another mesh and is matched by place: within {} it finds {}{others}",
            rounded(self.within),
            parts.join(", ")
        );
        if self.turned {
            sentence.push_str("; its triangles face the other way, which makes no difference");
        }
        for left_out in &self.left_out {
            sentence = format!("{sentence}; {left_out}");
        }
        sentence
    }
}

pub(super) fn percent(share: f64) -> String {
    format!("{:.0}%", (100.0 * share).floor())
}

/// Two digits of a length.
pub(super) fn rounded(length: f64) -> String {
    let digits = (1.0 - length.log10().floor()).clamp(0.0, 12.0);
    format!("{length:.*}", digits as usize)
}
