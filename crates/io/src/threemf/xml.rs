//! The elements of an XML part, one after another, with the places of their attributes.

use std::borrow::Cow;
use std::ops::Range;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use crate::quote::quoted;

/// A step through a part.
pub(super) enum Step<'a> {
    /// An element begins.
    Open(Element<'a>),
    /// The element with this name, without its prefix, ends.
    Close(Vec<u8>),
}

/// The beginning of an element.
pub(super) struct Element<'a> {
    /// The part's bytes.
    part: &'a [u8],
    /// The place of its `<`.
    pub at: usize,
    start: BytesStart<'a>,
}

/// Calls `visit` with each element's beginning and end.
///
/// # Errors
/// The part is no XML; an error of `visit`.
pub(super) fn walk<'a, E: From<String>>(
    part: &'a [u8],
    mut visit: impl FnMut(Step<'a>) -> Result<(), E>,
) -> Result<(), E> {
    let mut reader = Reader::from_reader(part);
    let mut depth = 0_usize;
    loop {
        let at = reader.buffer_position() as usize;
        let event = reader.read_event();
        match event.map_err(|error| E::from(format!("byte {at} is no XML ({})", quoted(&error.to_string()))))? {
            Event::Start(start) => {
                depth += 1;
                visit(Step::Open(Element { part, at, start }))?;
            }
            Event::Empty(start) => {
                let name = start.local_name().as_ref().to_vec();
                visit(Step::Open(Element { part, at, start }))?;
                visit(Step::Close(name))?;
            }
            Event::End(end) => {
                depth = depth.saturating_sub(1);
                visit(Step::Close(end.local_name().as_ref().to_vec()))?;
            }
            Event::Eof if depth > 0 => return Err(E::from("it ends within an element".to_owned())),
            Event::Eof => return Ok(()),
            _ => {}
        }
    }
}

/// The element that begins at a place where [`walk`] found one.
pub(super) fn element_at(part: &[u8], at: usize) -> Option<Element<'_>> {
    let mut reader = Reader::from_reader(&part[at..]);
    reader.config_mut().check_end_names = false;
    match reader.read_event() {
        Ok(Event::Start(start) | Event::Empty(start)) => Some(Element { part, at, start }),
        _ => None,
    }
}

impl<'a> Element<'a> {
    /// The name without its prefix.
    pub fn name(&self) -> Vec<u8> {
        self.start.local_name().as_ref().to_vec()
    }

    /// The bytes of an attribute's value as they are stored, and their place in the part.
    pub fn raw(&self, name: &str) -> Option<(&'a [u8], Range<usize>)> {
        let mut attributes = self.start.attributes();
        attributes.with_checks(false);
        let found = attributes.filter_map(Result::ok);
        let found = found
            .into_iter()
            .find(|attribute| attribute.key.local_name().as_ref() == name.as_bytes())?;
        // The value is a part of the bytes that were read, so its place follows from its address.
        let start = found.value.as_ptr().addr().checked_sub(self.part.as_ptr().addr())?;
        let range = start..start + found.value.len();
        self.part.get(range.clone()).map(|bytes| (bytes, range))
    }

    /// An attribute's value.
    pub fn text(&self, name: &str) -> Option<String> {
        let (bytes, _) = self.raw(name)?;
        let text = String::from_utf8_lossy(bytes);
        Some(quick_xml::escape::unescape(&text).map_or_else(|_| text.to_string(), Cow::into_owned))
    }

    /// A number, which must be there.
    ///
    /// # Errors
    /// It is missing or no number.
    pub fn real(&self, name: &str) -> Result<f64, String> {
        let (bytes, _) = self.raw(name).ok_or_else(|| self.fault(name, "is missing"))?;
        let text = std::str::from_utf8(bytes).unwrap_or_default().trim();
        text.parse()
            .map_err(|_| self.fault(name, &format!("is {}, no number", quoted(text))))
    }

    /// A whole number, if it is there.
    ///
    /// # Errors
    /// It is no number from 0 to 4294967294.
    pub fn index(&self, name: &str) -> Result<Option<u32>, String> {
        let Some((bytes, _)) = self.raw(name) else {
            return Ok(None);
        };
        let text = std::str::from_utf8(bytes).unwrap_or_default().trim();
        let number = text.parse().ok().filter(|&number| number != u32::MAX);
        number
            .map(Some)
            .ok_or_else(|| self.fault(name, &format!("is {}, no index", quoted(text))))
    }

    /// A whole number, which must be there.
    ///
    /// # Errors
    /// It is missing or no index.
    pub fn wanted_index(&self, name: &str) -> Result<u32, String> {
        self.index(name)?.ok_or_else(|| self.fault(name, "is missing"))
    }

    fn fault(&self, name: &str, what: &str) -> String {
        let element = String::from_utf8_lossy(self.start.local_name().as_ref()).into_owned();
        format!("the `{name}` of the `{}` at byte {} {what}", quoted(&element), self.at)
    }
}
