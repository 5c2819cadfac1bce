//! Fetching the data of buffers and images: within the JSON, and in files beside this one.

use super::Document;
use super::fault::Fault;
use super::origin::{Buffer, ImageFile};
use super::uri::{self, Address};
use crate::quote::quoted;
use crate::source::Source;

impl Document {
    pub(super) fn fetch_buffers(&mut self, source: &Source<'_>) -> Result<(), Fault> {
        for (number, &at) in self.buffers_at.iter().enumerate() {
            source.cancel.check()?;
            let uri = self.json.member(at, "uri").and_then(|at| self.json.string(at));
            let bin = self.container.as_ref().and_then(|parts| parts.bin.clone());
            let buffer = match (uri, bin) {
                (None, Some(bin)) if number == 0 => Buffer::Bin(bin),
                (None, _) => Buffer::Absent,
                (Some(uri), _) => match uri::address(&uri).map_err(|reason| format!("buffer {number} is {reason}"))? {
                    Address::Data(bytes) => Buffer::Data(bytes.into()),
                    Address::Neighbour(path) => match source.resolver.read(&path) {
                        Ok(bytes) => {
                            self.notes
                                .add("buffers of other folders", outside_note("Buffer", &path));
                            Buffer::Neighbour { path, bytes }
                        }
                        Err(reason) => return Err(Fault::Neighbour { uri, reason }),
                    },
                    Address::Elsewhere => {
                        let reason = "it is not the address of a file".to_owned();
                        return Err(Fault::Neighbour { uri, reason });
                    }
                },
            };
            self.buffers.push(buffer);
        }
        Ok(())
    }

    pub(super) fn fetch_images(&mut self, source: &Source<'_>) -> Result<(), Fault> {
        for (number, &at) in self.images_at.iter().enumerate() {
            source.cancel.check()?;
            let uri = self.json.member(at, "uri").and_then(|at| self.json.string(at));
            let view = self.index(at, "bufferView", self.views.len(), || format!("image {number}"))?;
            let image = match (view, uri.as_deref().map(uri::address)) {
                (Some(view), _) => ImageFile::View(view),
                (None, Some(Ok(Address::Data(bytes)))) => ImageFile::Data(bytes.into()),
                (None, Some(Ok(Address::Neighbour(path)))) => {
                    let bytes = match source.resolver.read(&path) {
                        Ok(bytes) => {
                            self.notes.add("images of other folders", outside_note("Image", &path));
                            Some(bytes)
                        }
                        Err(reason) => {
                            let path = quoted(&path);
                            let note = format!("Image {path} is not shown, because it could not be read ({reason}).");
                            self.notes.add("images", Some(note));
                            None
                        }
                    };
                    ImageFile::Neighbour { path, bytes }
                }
                (None, _) => {
                    let note = format!("Image {number} is not shown, because it has neither bytes nor a file name.");
                    self.notes.add("images", Some(note));
                    ImageFile::Absent
                }
            };
            self.images.push(image);
        }
        Ok(())
    }
}

/// A sentence about a neighbour outside the file's folder.
fn outside_note(what: &str, path: &str) -> Option<String> {
    uri::inside(path)
        .is_none()
        .then(|| format!("{what} {} was read from outside the file's own folder.", quoted(path)))
}
