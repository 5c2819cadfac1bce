//! An edit on another mesh than the one that it was made on.

use pliant_mesh::Model;

use super::attachment::AttachmentEntry;
use super::edit_error::EditError;
use super::edit_file::EditFile;
use super::examples::ExampleSource;
use super::field::FieldEntry;
use super::matched_by_place::MatchedByPlace;
use super::other_mesh::{Other, Scale};
use super::places::Places;
use super::selector::Selector;

/// An edit by the numbers of the mesh on which it is used.
#[derive(Clone, Debug)]
pub struct Placed {
    /// The edit, without places.
    pub edit: EditFile,
    /// What was found.
    pub matched: MatchedByPlace,
}

impl EditFile {
    /// The edit by the numbers of `model`, if that is another mesh than the one that the edit was made on; `None` if it
    /// is the same, or if the edit has no places, so that its numbers count as they are.
    ///
    /// # Errors
    /// A handle of which less than half is found, examples by numbers, and numbers that do not fit the places.
    pub fn placed(&self, model: &Model) -> Result<Option<Placed>, EditError> {
        let Some(places) = self.places.as_ref().filter(|places| !places.are_of(model)) else {
            return Ok(None);
        };
        let recorded = places.recorded()?;
        self.refuse_numbered_examples(places)?;
        let mut other = Other::of(places, &recorded, model);
        let mut matched = other.found(self)?;
        let field = |entries: &[FieldEntry], member: &str, scale: Scale| -> Result<Vec<FieldEntry>, EditError> {
            let each = entries.iter().enumerate();
            each.map(|(index, entry)| other.field(entry, &format!("{member}[{index}]"), scale))
                .collect()
        };
        let mut handles = self.handles.clone();
        for (index, handle) in handles.iter_mut().enumerate() {
            let select = handle.select.as_ref();
            let select = select.map(|select| other.selected(select, &format!("handles[{index}].select")));
            handle.select = select.transpose()?;
        }
        let loose_parts = self.loose_parts.iter().enumerate();
        let loose_parts = loose_parts.map(|(index, (select, loose))| {
            let parts = other.whole_parts(select, &format!("loose[{}].select", index + 1))?;
            Ok((parts, *loose))
        });
        let kept = match &self.kept {
            Some(kept) => other.kept(kept, &self.handles, &mut matched.left_out)?,
            None => None,
        };
        let edit = Self {
            places: None,
            region: other.selected(&self.region, "region")?,
            fixed: other.selected(&self.fixed, "fixed")?,
            handles,
            stiffness: field(&self.stiffness, "stiffness", Scale::Logarithmic)?,
            continuity: field(&self.continuity, "continuity", Scale::Linear)?,
            loose_parts: loose_parts.collect::<Result<_, EditError>>()?,
            // Parts that the first mesh had inside out face outwards on a mesh that faces the other way.
            inside_out: match other.is_turned() {
                true => Selector::None,
                false => other.whole_parts(&self.inside_out, "inside_out")?,
            },
            kept,
            ..self.clone()
        };
        Ok(Some(Placed { edit, matched }))
    }

    /// Refuses examples that are numbers for each vertex.
    fn refuse_numbered_examples(&self, places: &Places) -> Result<(), EditError> {
        for (name, entry) in &self.attachments {
            let AttachmentEntry::Examples(examples) = entry else {
                continue;
            };
            let numbered = |source: &ExampleSource| matches!(source, ExampleSource::PerVertex(_));
            if let Some(index) = examples.iter().position(|example| numbered(&example.source)) {
                return Err(EditError::Other {
                    place: format!("method.{name}[{index}]"),
                    sentence: format!(
                        "is a shape of the mesh with {} vertices that the edit was made on, and examples are not matched \
                         by place: give the example as a `file` with this mesh' vertices, or choose another method",
                        places.vertex_count()
                    ),
                });
            }
        }
        Ok(())
    }
}
