//! The frames of a point cache that is read piece by piece: its header says where each frame begins.

use glam::{DVec3, Vec3};

use crate::PointCacheFormat;

/// The bytes of a point: three numbers in single precision.
const POINT: usize = 12;

/// The places of a point cache's frames.
///
/// ```
/// use glam::DVec3;
/// use pliant_io::{CacheFrames, PointCache, PointCacheFormat};
///
/// let mut cache = PointCache::new(PointCacheFormat::Mdd, 2, 1, 24.0);
/// cache.push([DVec3::X]);
/// cache.push([DVec3::Y]);
/// let bytes = cache.into_bytes();
/// let frames = CacheFrames::read(PointCacheFormat::Mdd, &bytes, bytes.len() as u64).unwrap();
/// assert_eq!((frames.frame_count(), frames.point_count()), (2, 1));
/// let second = frames.start() + frames.frame_length();
/// assert_eq!(frames.positions(&bytes[second..]), [DVec3::Y]);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CacheFrames {
    format: PointCacheFormat,
    frames: usize,
    points: usize,
}

impl CacheFrames {
    /// The most bytes that [`CacheFrames::read`] needs.
    pub const HEADER: usize = 32;

    /// Reads a header: the first bytes of a file of `length` bytes.
    ///
    /// # Errors
    /// The fault, as a sentence without its subject, the file.
    pub fn read(format: PointCacheFormat, header: &[u8], length: u64) -> Result<Self, String> {
        let word = |at: usize| -> Option<[u8; 4]> { header.get(at..at + 4)?.try_into().ok() };
        let (is_known, frames, points) = match format {
            PointCacheFormat::Pc2 => (
                header.starts_with(b"POINTCACHE2\0"),
                word(28).map(u32::from_le_bytes),
                word(16).map(u32::from_le_bytes),
            ),
            PointCacheFormat::Mdd => (true, word(0).map(u32::from_be_bytes), word(4).map(u32::from_be_bytes)),
        };
        let (true, Some(frames), Some(points)) = (is_known, frames, points) else {
            return Err("is no point cache: export it again".to_owned());
        };
        if frames == 0 || points == 0 {
            return Err(format!("has {frames} frames of {points} points: export it again"));
        }
        let own = Self {
            format,
            frames: frames as usize,
            points: points as usize,
        };
        let needed = own.start() as u64 + u64::from(frames) * u64::from(points) * POINT as u64;
        if length < needed {
            return Err(format!(
                "has {length} bytes, and its {frames} frames of {points} points take {needed}: it was cut off, so export \
                 it again"
            ));
        }
        Ok(own)
    }

    /// The number of frames, at least 1.
    pub fn frame_count(&self) -> usize {
        self.frames
    }

    /// The number of points, at least 1.
    pub fn point_count(&self) -> usize {
        self.points
    }

    /// The number of bytes before the first frame.
    pub fn start(&self) -> usize {
        match self.format {
            PointCacheFormat::Pc2 => 32,
            // The frames' times come after their number and that of the points.
            PointCacheFormat::Mdd => 8 + 4 * self.frames,
        }
    }

    /// The number of bytes of a frame.
    pub fn frame_length(&self) -> usize {
        POINT * self.points
    }

    /// The positions in a frame, of which `bytes` are the first ones or all.
    pub fn positions(&self, bytes: &[u8]) -> Vec<DVec3> {
        let number = |bytes: &[u8]| {
            let bytes = [bytes[0], bytes[1], bytes[2], bytes[3]];
            match self.format {
                PointCacheFormat::Pc2 => f32::from_le_bytes(bytes),
                PointCacheFormat::Mdd => f32::from_be_bytes(bytes),
            }
        };
        let point = |bytes: &[u8]| Vec3::new(number(bytes), number(&bytes[4..]), number(&bytes[8..])).as_dvec3();
        bytes.chunks_exact(POINT).take(self.points).map(point).collect()
    }

    /// Writes the position of a point into the bytes of a frame.
    pub fn put(&self, bytes: &mut [u8], point: usize, position: DVec3) {
        let own = &mut bytes[POINT * point..POINT * (point + 1)];
        // f32 is the format's precision.
        for (bytes, number) in own.chunks_exact_mut(4).zip(position.as_vec3().to_array()) {
            bytes.copy_from_slice(&match self.format {
                PointCacheFormat::Pc2 => number.to_le_bytes(),
                PointCacheFormat::Mdd => number.to_be_bytes(),
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PointCache;

    #[test]
    fn frames_come_back_and_a_changed_point_changes_its_own_bytes() {
        for format in [PointCacheFormat::Pc2, PointCacheFormat::Mdd] {
            let mut cache = PointCache::new(format, 3, 2, 24.0);
            let frame = |frame: u32| [DVec3::splat(f64::from(frame)), DVec3::new(0.5, -2.0, f64::from(frame))];
            (0..3).for_each(|number| cache.push(frame(number)));
            let bytes = cache.into_bytes();
            let frames = CacheFrames::read(format, &bytes[..CacheFrames::HEADER], bytes.len() as u64)
                .unwrap_or_else(|e| panic!("{e}"));
            let at = |number: usize| frames.start() + number * frames.frame_length();
            assert_eq!(at(3), bytes.len());
            for number in 0..3 {
                assert_eq!(frames.positions(&bytes[at(number)..]), frame(number as u32));
            }
            let mut changed = bytes.clone();
            frames.put(&mut changed[at(1)..], 1, DVec3::X);
            assert_eq!(frames.positions(&changed[at(1)..]), [DVec3::ONE, DVec3::X]);
            let others = changed.iter().zip(&bytes).enumerate().filter(|(_, (a, b))| a != b);
            assert!(
                others
                    .map(|(place, _)| place)
                    .all(|place| (at(1) + 12..at(2)).contains(&place))
            );
        }
    }

    #[test]
    fn caches_that_are_none_or_cut_off_are_refused() {
        let mut cache = PointCache::new(PointCacheFormat::Pc2, 3, 2, 24.0);
        (0..3).for_each(|_| cache.push([DVec3::X, DVec3::Y]));
        let bytes = cache.into_bytes();
        let refused =
            |bytes: &[u8], length: usize| CacheFrames::read(PointCacheFormat::Pc2, bytes, length as u64).err();
        assert_eq!(refused(&bytes, bytes.len()), None);
        assert!(refused(&bytes, bytes.len() - 1).is_some_and(|sentence| sentence.contains("cut off")));
        assert!(refused(b"ply", 3).is_some_and(|sentence| sentence.contains("no point cache")));
        let huge = [&bytes[..28], &u32::MAX.to_le_bytes()].concat();
        assert!(refused(&huge, 100).is_some_and(|sentence| sentence.contains("cut off")));
    }
}
