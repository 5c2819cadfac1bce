//! The vertices of a glTF while its animation of morph targets plays, computed from the file's JSON and bytes alone, as
//! another program would.

use glam::DVec3;
use serde_json::Value;

/// A GLB: its JSON and its bytes.
pub struct Glb {
    pub json: Value,
    bin: Vec<u8>,
}

impl Glb {
    /// Splits a GLB's bytes.
    pub fn of(bytes: &[u8]) -> Self {
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let json = 20..20 + word(12);
        let bin = json.end + 8;
        Self {
            json: serde_json::from_slice(&bytes[json]).unwrap(),
            bin: bytes.get(bin..).unwrap_or_default().to_vec(),
        }
    }

    /// The numbers of an accessor of floats, sparse or not.
    pub fn floats(&self, accessor: &Value) -> Vec<f64> {
        let accessor = &self.json["accessors"][index(accessor)];
        assert_eq!(accessor["componentType"], 5126);
        let lanes = if accessor["type"] == "VEC3" { 3 } else { 1 };
        let count = index(&accessor["count"]);
        let mut numbers = match &accessor["bufferView"] {
            Value::Null => vec![0.0; count * lanes],
            view => self.of_view(view, offset(accessor), count * lanes),
        };
        if let Some(sparse) = accessor.get("sparse") {
            let count = index(&sparse["count"]);
            let values = self.of_view(
                &sparse["values"]["bufferView"],
                offset(&sparse["values"]),
                count * lanes,
            );
            for (place, element) in self.indices(&sparse["indices"], count).into_iter().enumerate() {
                let from = &values[place * lanes..(place + 1) * lanes];
                numbers[element * lanes..(element + 1) * lanes].copy_from_slice(from);
            }
        }
        numbers
    }

    fn of_view(&self, view: &Value, offset_in_view: usize, count: usize) -> Vec<f64> {
        let view = &self.json["bufferViews"][index(view)];
        assert!(view.get("byteStride").is_none(), "numbers one after the other");
        let start = offset(view) + offset_in_view;
        let bytes = self.bin[start..start + 4 * count].chunks(4);
        bytes
            .map(|number| f64::from(f32::from_le_bytes(number.try_into().unwrap())))
            .collect()
    }

    fn indices(&self, indices: &Value, count: usize) -> Vec<usize> {
        let view = &self.json["bufferViews"][index(&indices["bufferView"])];
        let size = match index(&indices["componentType"]) {
            5121 => 1,
            5123 => 2,
            _ => 4,
        };
        let start = offset(view) + offset(indices);
        let element = |bytes: &[u8]| bytes.iter().rev().fold(0, |sum, byte| sum << 8 | usize::from(*byte));
        self.bin[start..start + size * count]
            .chunks(size)
            .map(element)
            .collect()
    }

    /// The position of each vertex of the first primitive at a time of the last animation, in the mesh's own space.
    pub fn positions_at(&self, time: f64) -> Vec<DVec3> {
        let primitive = &self.json["meshes"][0]["primitives"][0];
        let vectors =
            |accessor: &Value| -> Vec<DVec3> { self.floats(accessor).chunks(3).map(DVec3::from_slice).collect() };
        let mut positions = vectors(&primitive["attributes"]["POSITION"]);
        let targets = primitive["targets"].as_array().unwrap();
        let last = self.json["animations"].as_array().unwrap().len() - 1;
        for (target, weight) in targets.iter().zip(self.weights_at(last, time)) {
            let ways = positions.iter_mut().zip(vectors(&target["POSITION"]));
            ways.for_each(|(position, way)| *position += way * weight);
        }
        positions
    }

    /// The weights of the targets at a time of an animation, which has one channel.
    pub fn weights_at(&self, animation: usize, time: f64) -> Vec<f64> {
        let animation = &self.json["animations"][animation];
        assert_eq!(animation["channels"][0]["target"]["path"], "weights");
        let sampler = &animation["samplers"][index(&animation["channels"][0]["sampler"])];
        let (times, all) = (self.floats(&sampler["input"]), self.floats(&sampler["output"]));
        let rows: Vec<&[f64]> = all.chunks(all.len() / times.len()).collect();
        let next = times.partition_point(|own| *own <= time);
        if next == 0 || next == times.len() {
            return rows[next.saturating_sub(1)].to_vec();
        }
        let share = (time - times[next - 1]) / (times[next] - times[next - 1]);
        let pairs = rows[next - 1].iter().zip(rows[next]);
        pairs.map(|(from, to)| from + (to - from) * share).collect()
    }
}

fn index(value: &Value) -> usize {
    value.as_u64().unwrap() as usize
}

fn offset(value: &Value) -> usize {
    value.get("byteOffset").map_or(0, index)
}
