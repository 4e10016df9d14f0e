//! Where a point cache puts the points of a deforming collider, at any frame.
//!
//! A POINTCACHE2 file holds samples from a first frame on, one every so many frames, both as its header says. Between two
//! samples points go in straight lines; before the first and after the last they rest.

use std::io::Read;

use boucle_geometry::Vector;
use xxhash_rust::xxh3::Xxh3;

use crate::description::{Transform, UpAxis};
use crate::error::{Error, Result};
use crate::limits::MAX_LENGTH;
use crate::pc2::MAGIC;

/// The samples of a point cache.
#[derive(Clone, Debug)]
pub struct Samples {
    /// The frame of the first.
    first: f64,
    /// Frames from one to the next.
    rate: f64,
    point_count: usize,
    /// x, y, z (m) of every point, sample after sample, as in the file.
    numbers: Vec<f32>,
    up: UpAxis,
    transform: Transform,
}

impl Samples {
    /// Reads a cache of so many points, which are turned and put as their mesh is.
    ///
    /// # Errors
    /// [`Error::Input`] when it is no POINTCACHE2, is of other points, ends early, or holds what is no place in space.
    pub(crate) fn read(
        mut source: impl Read,
        point_count: usize,
        up: UpAxis,
        transform: &Transform,
    ) -> Result<Self> {
        let mut header = [0; 32];
        source.read_exact(&mut header).map_err(|_| not_a_cache())?;
        let field = |at: usize| [header[at], header[at + 1], header[at + 2], header[at + 3]];
        let whole = |at| u32::from_le_bytes(field(at));
        let real = |at| f64::from(f32::from_le_bytes(field(at)));
        if &header[..12] != MAGIC || whole(12) != 1 {
            return Err(not_a_cache());
        }
        let (points, first, rate, samples) = (whole(16), real(20), real(24), whole(28));
        if points as usize != point_count {
            let accepted = format!("{point_count}, as many as the mesh has");
            return Err(Error::input(format!("it holds {points} points; accepted: {accepted}")));
        }
        if !(first.abs() <= 1e9 && rate > 0.0 && rate <= 1e9 && samples > 0) {
            return Err(Error::input(format!(
                "it holds {samples} samples from frame {first:?} on, one every {rate:?} frames; \
                 accepted: at least one, at frames that go forward"
            )));
        }
        let wanted = 12 * u64::from(points) * u64::from(samples);
        let mut bytes = Vec::new();
        let read = source.take(wanted).read_to_end(&mut bytes);
        read.map_err(|error| Error::input(format!("it cannot be read: {error}")))?;
        if (bytes.len() as u64) < wanted {
            let missing = "it ends before its last sample; accepted: as many as its header says";
            return Err(Error::input(missing));
        }
        let number = |four: &[u8]| f32::from_le_bytes([four[0], four[1], four[2], four[3]]);
        let numbers: Vec<f32> = bytes.chunks_exact(4).map(number).collect();
        check_places(&numbers, point_count)?;
        Ok(Self { first, rate, point_count, numbers, up, transform: transform.clone() })
    }

    /// Where the points are at a frame (m), world space.
    #[must_use]
    pub fn at(&self, frame: i32) -> Vec<Vector> {
        let count = self.numbers.len() / (3 * self.point_count);
        let last = (count - 1) as f64;
        let place = ((f64::from(frame) - self.first) / self.rate).clamp(0.0, last);
        let before = place.floor();
        let (share, after) = (place - before, (before + 1.0).min(last));
        let sample = |index: f64| &self.numbers[3 * self.point_count * index as usize..];
        let point = |(from, to): (&[f32], &[f32])| {
            let mix = |axis: usize| {
                let (from, to) = (f64::from(from[axis]), f64::from(to[axis]));
                from + share * (to - from)
            };
            self.up.turned(Vector::new(mix(0), mix(1), mix(2)))
        };
        let pairs = sample(before).chunks_exact(3).zip(sample(after).chunks_exact(3));
        let mut points: Vec<Vector> = pairs.take(self.point_count).map(point).collect();
        self.transform.place(&mut points);
        points
    }

    /// Adds what the file holds to a digest.
    pub(crate) fn feed(&self, hash: &mut Xxh3) {
        for number in [self.first, self.rate] {
            hash.update(&number.to_le_bytes());
        }
        for number in &self.numbers {
            hash.update(&number.to_le_bytes());
        }
    }
}

fn not_a_cache() -> Error {
    Error::input("it is no point cache; accepted: a POINTCACHE2 file of version 1")
}

fn check_places(numbers: &[f32], point_count: usize) -> Result<()> {
    let is_bad = |&number: &f32| !(f64::from(number).abs() <= MAX_LENGTH);
    let Some(index) = numbers.iter().position(is_bad) else { return Ok(()) };
    let (sample, point) = (index / 3 / point_count, index / 3 % point_count);
    let number = numbers[index];
    Err(Error::input(format!(
        "point {point} of sample {sample} is at {number:?} m; accepted: -1e6 to 1e6 m"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cache of one point that is at these heights (m).
    fn cache(first: f32, rate: f32, heights: &[f32]) -> Vec<u8> {
        let mut bytes = b"POINTCACHE2\0".to_vec();
        bytes.extend(1_u32.to_le_bytes());
        bytes.extend(1_u32.to_le_bytes());
        bytes.extend(first.to_le_bytes());
        bytes.extend(rate.to_le_bytes());
        bytes.extend((heights.len() as u32).to_le_bytes());
        bytes.extend(heights.iter().flat_map(|&z| [1.0, 0.0, z]).flat_map(f32::to_le_bytes));
        bytes
    }

    fn read(bytes: &[u8], point_count: usize) -> Result<Samples> {
        Samples::read(bytes, point_count, UpAxis::Z, &Transform::default())
    }

    #[test]
    fn points_go_straight_between_samples_and_rest_before_and_after_them() {
        let samples = read(&cache(10.0, 2.0, &[1.0, 3.0, 2.0]), 1).expect("a good cache");
        let expected = [(0, 1.0), (10, 1.0), (11, 2.0), (12, 3.0), (13, 2.5), (14, 2.0), (99, 2.0)];
        for (frame, height) in expected {
            assert_eq!(samples.at(frame), [Vector::new(1.0, 0.0, height)], "frame {frame}");
        }
        let single = read(&cache(1.0, 1.0, &[5.0]), 1).expect("a good cache");
        assert_eq!(single.at(7), [Vector::new(1.0, 0.0, 5.0)]);
    }

    #[test]
    fn points_are_turned_and_put_as_their_mesh_is() {
        let transform = Transform { location: [0.0, 0.0, 7.0], scale: 2.0, ..Transform::default() };
        let bytes = cache(1.0, 1.0, &[3.0]);
        let samples = Samples::read(&bytes[..], 1, UpAxis::Y, &transform).expect("a good cache");
        assert_eq!(samples.at(1), [Vector::new(2.0, -6.0, 7.0)]);
    }

    #[test]
    fn what_is_no_cache_of_the_mesh_is_refused() {
        let good = cache(1.0, 1.0, &[0.0, 1.0]);
        for (bytes, points, expected) in [
            (&b"POINTCACHE1"[..], 1, "it is no point cache; accepted: a POINTCACHE2"),
            (&[0; 50][..], 1, "it is no point cache"),
            (&good[..], 2, "it holds 1 points; accepted: 2, as many as the mesh has"),
            (&good[..good.len() - 1], 1, "it ends before its last sample"),
            (
                &cache(1.0, 0.0, &[0.0])[..],
                1,
                "it holds 1 samples from frame 1.0 on, one every 0.0",
            ),
            (&cache(f32::NAN, 1.0, &[0.0])[..], 1, "it holds 1 samples from frame NaN on"),
            (&cache(1.0, 1.0, &[])[..], 1, "it holds 0 samples"),
            (
                &cache(1.0, 1.0, &[0.0, f32::NAN])[..],
                1,
                "point 0 of sample 1 is at NaN m; accepted",
            ),
            (&cache(1.0, 1.0, &[1e9])[..], 1, "point 0 of sample 0 is at 1000000000.0 m"),
        ] {
            let error = read(bytes, points).expect_err(expected);
            assert!(error.to_string().starts_with(expected), "{error}");
            assert_eq!(error.exit_code(), 2);
        }
    }
}
