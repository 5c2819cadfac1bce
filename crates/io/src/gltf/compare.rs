//! Compares two glTF part by part: JSON by its values, buffers by their decoded contents.
//!
//! Accessors, meshes and images are compared through the parts that refer to them, so that a part's number, the place
//! of its bytes and the container don't matter. Parts that nothing refers to are compared by their numbers.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::ops::Range;

use crate::difference::{self, Difference, What};
use crate::gltf::document::Document;
use crate::gltf::document::accessor::Layout;
use crate::gltf::document::json::{At, Json};

/// The differences, in the order of the first file's text.
pub(crate) fn differences(a: &Document, b: &Document) -> Vec<Difference> {
    let mut comparison = Comparison {
        a,
        b,
        seen: BTreeSet::new(),
        meshes_seen: BTreeSet::new(),
        images_seen: HashMap::new(),
        out: Vec::new(),
    };
    comparison.objects(a.json.root(), b.json.root(), &mut Vec::new());
    comparison.unnamed_accessors();
    comparison.out
}

struct Comparison<'a> {
    a: &'a Document,
    b: &'a Document,
    /// Pairs of accessors that were compared.
    seen: BTreeSet<(usize, usize)>,
    /// Pairs of meshes that were compared.
    meshes_seen: BTreeSet<(usize, usize)>,
    /// Pairs of images that were compared, by the place of their bytes, and their differences.
    images_seen: HashMap<(Place, Place), Option<What>>,
    out: Vec<Difference>,
}

/// The owner of bytes.
type Place = (usize, Range<usize>);

/// The kind of part that a number in the JSON names.
enum Names {
    Accessor,
    Mesh,
}

/// Sections that are compared through the parts that refer to them, and members that follow from others.
const PLACES: [&str; 3] = ["accessors", "bufferViews", "buffers"];

/// The depth down to which values are compared.
const DEEPEST: usize = 100;

fn names(path: &[String]) -> Option<Names> {
    let path: Vec<&str> = path.iter().map(String::as_str).collect();
    match path[..] {
        ["meshes", _, "primitives", _, "attributes", _]
        | ["meshes", _, "primitives", _, "indices"]
        | ["meshes", _, "primitives", _, "targets", _, _]
        | ["skins", _, "inverseBindMatrices"]
        | ["animations", _, "samplers", _, "input" | "output"] => Some(Names::Accessor),
        ["nodes", _, "mesh"] => Some(Names::Mesh),
        _ => None,
    }
}

impl Comparison<'_> {
    fn say(&mut self, path: &[String], what: What) {
        self.out.push(Difference {
            place: said(path),
            what,
        });
    }

    fn values(&mut self, a: At, b: At, path: &mut Vec<String>) {
        let (json_a, json_b) = (&self.a.json, &self.b.json);
        let (raw_a, raw_b) = (json_a.raw(a), json_b.raw(b));
        if let Some(named) = names(path) {
            let number = |json: &Json, at| json.number(at).map(|number| number as usize);
            let (Some(first), Some(second)) = (number(json_a, a), number(json_b, b)) else {
                return;
            };
            return match named {
                Names::Accessor => self.accessors(first, second, path),
                Names::Mesh if first != second => self.meshes(first, second, path),
                Names::Mesh => {}
            };
        }
        match (raw_a.first(), raw_b.first()) {
            // Below the depth of any glTF, the text itself is compared.
            _ if path.len() > DEEPEST && raw_a == raw_b => {}
            (Some(b'{'), Some(b'{')) if path.len() <= DEEPEST => self.objects(a, b, path),
            (Some(b'['), Some(b'[')) if path.len() <= DEEPEST => self.arrays(a, b, path),
            _ => {
                let is_same = raw_a == raw_b
                    || json_a.number(a).is_some_and(|a| json_b.number(b) == Some(a))
                    || json_a.string(a).is_some_and(|a| json_b.string(b) == Some(a));
                if !is_same {
                    let text = |raw: &[u8]| String::from_utf8_lossy(raw).into_owned();
                    self.say(
                        path,
                        What::Value {
                            first: text(raw_a),
                            second: text(raw_b),
                        },
                    );
                }
            }
        }
    }

    fn objects(&mut self, a: At, b: At, path: &mut Vec<String>) {
        let (json_a, json_b) = (&self.a.json, &self.b.json);
        let keys = |json: &Json, at| -> Vec<(String, At)> {
            json.members(at)
                .filter_map(|(key, value)| Some((json.string(key)?, value)))
                .collect()
        };
        let (of_a, of_b) = (keys(json_a, a), keys(json_b, b));
        let is_image = path.len() == 2 && path[0] == "images";
        if is_image {
            self.images(path);
        }
        let is_root = path.is_empty();
        let is_skipped = |key: &str| {
            (is_root && PLACES.contains(&key)) || (is_image && ["uri", "bufferView", "mimeType"].contains(&key))
        };
        // The first of several members with one name counts.
        let mut first_of_b: HashMap<&str, At> = HashMap::new();
        for (key, at) in &of_b {
            first_of_b.entry(key).or_insert(*at);
        }
        for (key, at) in of_a.iter().filter(|(key, _)| !is_skipped(key)) {
            path.push(key.clone());
            match first_of_b.get(key.as_str()) {
                Some(&other) => self.values(*at, other, path),
                None => self.say(path, What::OnlyInFirst),
            }
            path.pop();
        }
        let keys_of_a: HashSet<&str> = of_a.iter().map(|(key, _)| key.as_str()).collect();
        for (key, _) in of_b.iter().filter(|(key, _)| !is_skipped(key)) {
            if !keys_of_a.contains(key.as_str()) {
                path.push(key.clone());
                self.say(path, What::OnlyInSecond);
                path.pop();
            }
        }
    }

    fn arrays(&mut self, a: At, b: At, path: &mut Vec<String>) {
        let of_a: Vec<At> = self.a.json.elements(a).collect();
        let of_b: Vec<At> = self.b.json.elements(b).collect();
        for (number, (&a, &b)) in of_a.iter().zip(&of_b).enumerate() {
            path.push(number.to_string());
            self.values(a, b, path);
            path.pop();
        }
        for number in of_a.len().min(of_b.len())..of_a.len().max(of_b.len()) {
            path.push(number.to_string());
            let what = if number < of_a.len() {
                What::OnlyInFirst
            } else {
                What::OnlyInSecond
            };
            self.say(path, what);
            path.pop();
        }
    }

    /// A node refers to another mesh: a difference only if that mesh has other contents.
    fn meshes(&mut self, first: usize, second: usize, path: &[String]) {
        let (Some(&a), Some(&b)) = (self.a.meshes_at.get(first), self.b.meshes_at.get(second)) else {
            return self.say(path, What::OnlyInFirst);
        };
        if self.meshes_seen.insert((first, second)) {
            self.objects(a, b, &mut vec!["meshes".to_owned(), second.to_string()]);
        }
    }

    fn images(&mut self, path: &[String]) {
        let Some(number) = path.last().and_then(|number| number.parse().ok()) else {
            return;
        };
        let bytes = |document: &Document| document.image(number).unwrap_or_default();
        let (first, second) = (bytes(self.a), bytes(self.b));
        // Many images may have the same bytes.
        let known = self.images_seen.entry((first.place(), second.place()));
        let what = known.or_insert_with(|| difference::of_bytes(&first, &second).map(|difference| difference.what));
        if let Some(what) = what.clone() {
            self.say(path, what);
        }
    }

    fn accessors(&mut self, first: usize, second: usize, path: &[String]) {
        if !self.seen.insert((first, second)) {
            return;
        }
        let (Some(&at_a), Some(&at_b)) = (self.a.accessors_at.get(first), self.b.accessors_at.get(second)) else {
            return self.say(path, What::OnlyInFirst);
        };
        let layouts = (self.a.layout(first), self.b.layout(second));
        let (Ok(a), Ok(b)) = &layouts else {
            // Data that can't be read is compared as text.
            return self.values(at_a, at_b, &mut path.to_vec());
        };
        if a.lanes != b.lanes || a.count != b.count {
            let (first, second) = (a.count * a.lanes, b.count * b.lanes);
            return self.say(path, What::Count { first, second });
        }
        if (a.component, a.normalized) != (b.component, b.normalized) {
            let told = |layout: &Layout| {
                let normalized = if layout.normalized { "normalised " } else { "" };
                format!("{normalized}{:?}", layout.component)
            };
            let (first, second) = (told(a), told(b));
            self.say(path, What::Stored { first, second });
        }
        if let Some(what) = elements(self.a, a, self.b, b) {
            self.say(path, what);
        }
        let (json_a, json_b) = (&self.a.json, &self.b.json);
        let bounds = |json: &Json, at: At, key: &str| -> Option<Vec<Option<f64>>> {
            let list = json.member(at, key)?;
            Some(json.elements(list).map(|at| json.number(at)).collect())
        };
        if ["min", "max"]
            .iter()
            .any(|key| bounds(json_a, at_a, key) != bounds(json_b, at_b, key))
        {
            self.say(path, What::Bounds);
        }
        for key in ["name", "extras", "extensions"] {
            let mut path = path.to_vec();
            path.push(key.to_owned());
            match (json_a.member(at_a, key), json_b.member(at_b, key)) {
                (None, None) => {}
                (Some(a), Some(b)) => self.values(a, b, &mut path),
                (Some(_), None) => self.say(&path, What::OnlyInFirst),
                (None, Some(_)) => self.say(&path, What::OnlyInSecond),
            }
        }
    }

    /// Accessors without a known reference, such as an extension's, are compared by their numbers.
    fn unnamed_accessors(&mut self) {
        let named: BTreeSet<usize> = self.seen.iter().map(|&(first, _)| first).collect();
        for accessor in (0..self.a.accessors_at.len()).filter(|accessor| !named.contains(accessor)) {
            self.accessors(accessor, accessor, &["accessors".to_owned(), accessor.to_string()]);
        }
    }
}

fn elements(in_a: &Document, a: &Layout, in_b: &Document, b: &Layout) -> Option<What> {
    if let (1, Ok(a), Ok(b)) = (a.lanes, a.indices(in_a), b.indices(in_b)) {
        let numbers = |list: Vec<u32>| list.into_iter().map(|index| [f64::from(index)]);
        return difference::of_elements(numbers(a), numbers(b));
    }
    if a.lanes <= 4 {
        let numbers = |document, layout: &Layout| layout.floats::<4>(document).into_iter().map(|e| e.map(f64::from));
        difference::of_elements(numbers(in_a, a), numbers(in_b, b))
    } else {
        let numbers = |document, layout: &Layout| layout.floats::<16>(document).into_iter().map(|e| e.map(f64::from));
        difference::of_elements(numbers(in_a, a), numbers(in_b, b))
    }
}

/// A path for a person: "mesh 0, primitive 1, POSITION".
fn said(path: &[String]) -> String {
    let is_number = |step: &String| step.bytes().all(|byte| byte.is_ascii_digit());
    let mut parts: Vec<String> = Vec::new();
    for (place, step) in path.iter().enumerate() {
        match parts.last_mut() {
            Some(last) if is_number(step) => {
                let one = match last.as_str() {
                    "meshes" => "mesh",
                    plural => plural.strip_suffix('s').unwrap_or(plural),
                };
                *last = format!("{one} {step}");
            }
            _ if step == "attributes" && place + 1 < path.len() => {}
            _ => parts.push(step.clone()),
        }
    }
    parts.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_read_as_places() {
        let path = |text: &str| said(&text.split('/').map(str::to_owned).collect::<Vec<_>>());
        assert_eq!(
            path("meshes/0/primitives/1/attributes/POSITION"),
            "mesh 0, primitive 1, POSITION"
        );
        assert_eq!(path("nodes/12/translation/0"), "node 12, translation 0");
        assert_eq!(path("asset/version"), "asset, version");
    }
}
