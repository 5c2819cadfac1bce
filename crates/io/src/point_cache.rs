//! Point caches: the positions of a mesh's vertices at evenly spaced times, as other programs' modifiers read them.

use glam::DVec3;

/// The kind of a point cache.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum PointCacheFormat {
    /// PC2: little-endian, with a header of 32 bytes.
    Pc2,
    /// MDD: big-endian, with the time of each frame.
    Mdd,
}

impl PointCacheFormat {
    /// The kind of a file's name, by its extension; `None` for other files.
    pub fn of_name(name: &str) -> Option<Self> {
        let (_, extension) = name.rsplit_once('.')?;
        match &*extension.to_ascii_lowercase() {
            "pc2" => Some(Self::Pc2),
            "mdd" => Some(Self::Mdd),
            _ => None,
        }
    }
}

/// A point cache that is being written. Positions are stored in single precision, as both kinds require.
///
/// ```
/// use glam::DVec3;
/// use pliant_io::{PointCache, PointCacheFormat};
///
/// let mut cache = PointCache::new(PointCacheFormat::Pc2, 2, 1, 24.0);
/// cache.push([DVec3::X]);
/// cache.push([DVec3::Y]);
/// assert_eq!(cache.into_bytes().len(), 32 + 2 * 12);
/// ```
#[derive(Clone, Debug)]
pub struct PointCache {
    format: PointCacheFormat,
    bytes: Vec<u8>,
}

impl PointCache {
    /// A cache of so many frames of so many points, at `fps` frames a second.
    pub fn new(format: PointCacheFormat, frames: u32, points: u32, fps: f64) -> Self {
        let mut bytes = Vec::with_capacity(32 + 4 * frames as usize + 12 * frames as usize * points as usize);
        match format {
            PointCacheFormat::Pc2 => {
                bytes.extend(b"POINTCACHE2\0");
                bytes.extend(1_u32.to_le_bytes());
                bytes.extend(points.to_le_bytes());
                // The first frame, and the frames between two samples.
                bytes.extend(0_f32.to_le_bytes());
                bytes.extend(1_f32.to_le_bytes());
                bytes.extend(frames.to_le_bytes());
            }
            PointCacheFormat::Mdd => {
                bytes.extend(frames.to_be_bytes());
                bytes.extend(points.to_be_bytes());
                let times = (0..frames).map(|frame| f64::from(frame) / fps);
                times.for_each(|time| bytes.extend((time as f32).to_be_bytes()));
            }
        }
        Self { format, bytes }
    }

    /// Adds a frame: the position of each point.
    pub fn push(&mut self, positions: impl IntoIterator<Item = DVec3>) {
        for number in positions.into_iter().flat_map(|position| position.to_array()) {
            // f32 is the format's precision.
            let number = number as f32;
            self.bytes.extend(match self.format {
                PointCacheFormat::Pc2 => number.to_le_bytes(),
                PointCacheFormat::Mdd => number.to_be_bytes(),
            });
        }
    }

    /// The file.
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_kinds_have_their_header_and_their_order_of_bytes() {
        let frames = [[DVec3::new(1.0, 2.0, 3.0); 2], [DVec3::new(-1.0, 0.5, 0.25); 2]];
        let bytes = |format| {
            let mut cache = PointCache::new(format, 2, 2, 25.0);
            frames.iter().for_each(|frame| cache.push(*frame));
            cache.into_bytes()
        };
        let word = |bytes: &[u8], at: usize| -> [u8; 4] { std::array::from_fn(|byte| bytes[at + byte]) };
        let pc2 = bytes(PointCacheFormat::Pc2);
        assert_eq!(&pc2[..12], b"POINTCACHE2\0");
        assert_eq!([12, 16, 28].map(|at| u32::from_le_bytes(word(&pc2, at))), [1, 2, 2]);
        assert_eq!([20, 24].map(|at| f32::from_le_bytes(word(&pc2, at))), [0.0, 1.0]);
        assert_eq!(pc2.len(), 32 + 48);
        assert_eq!(f32::from_le_bytes(word(&pc2, 32 + 24)), -1.0);
        let mdd = bytes(PointCacheFormat::Mdd);
        assert_eq!([0, 4].map(|at| u32::from_be_bytes(word(&mdd, at))), [2, 2]);
        assert_eq!([8, 12].map(|at| f32::from_be_bytes(word(&mdd, at))), [0.0, 0.04]);
        assert_eq!(mdd.len(), 16 + 48);
        assert_eq!(f32::from_be_bytes(word(&mdd, 16 + 28)), 0.5);
    }

    #[test]
    fn a_name_tells_its_kind() {
        assert_eq!(PointCacheFormat::of_name("a.b.PC2"), Some(PointCacheFormat::Pc2));
        assert_eq!(PointCacheFormat::of_name("walk.mdd"), Some(PointCacheFormat::Mdd));
        assert_eq!(PointCacheFormat::of_name("pc2"), None);
        assert_eq!(PointCacheFormat::of_name("a.glb"), None);
    }
}
