//! Notes for a person on how a file was read: sentences, kept few because a broken file could cause a million.

/// The number of sentences of each kind that are kept; the others are only counted.
const MOST_OF_A_KIND: usize = 12;

/// Sentences, grouped by kind.
#[derive(Clone, Debug, Default)]
pub(crate) struct Notes {
    kinds: Vec<(&'static str, Vec<String>, usize)>,
}

impl Notes {
    /// Adds a sentence, if there is one. `kind` is its subject, in the plural.
    pub fn add(&mut self, kind: &'static str, sentence: Option<String>) {
        let Some(sentence) = sentence else { return };
        let known = self.kinds.iter().position(|(other, ..)| *other == kind);
        let place = known.unwrap_or_else(|| {
            self.kinds.push((kind, Vec::new(), 0));
            self.kinds.len() - 1
        });
        let (_, sentences, further) = &mut self.kinds[place];
        if sentences.len() < MOST_OF_A_KIND {
            sentences.push(sentence);
        } else {
            *further += 1;
        }
    }

    /// All sentences, and then the number of those of each kind that were left out.
    pub fn sentences(self) -> Vec<String> {
        let mut out = Vec::new();
        for (kind, sentences, further) in self.kinds {
            out.extend(sentences);
            if further > 0 {
                out.push(format!("The same applies to {further} further {kind}."));
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_sentences_become_a_dozen_and_a_count() {
        let mut notes = Notes::default();
        notes.add("nodes", None);
        (0..1_000_000).for_each(|k| notes.add("images", Some(format!("Image {k} is missing."))));
        notes.add("nodes", Some("Node 1 is flat.".to_owned()));
        let sentences = notes.sentences();
        assert_eq!(sentences.len(), MOST_OF_A_KIND + 2);
        assert_eq!(sentences[MOST_OF_A_KIND], "The same applies to 999988 further images.");
    }
}
