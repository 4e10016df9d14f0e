//! Rows of sparse matrices, those of eight hinges side by side.

use std::ops::{Add, AddAssign, Mul, Sub};

use super::packs::{LANES, Places};

/// A number that moments and angles are computed in.
pub(super) trait Number:
    Copy
    + Default
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + AddAssign
{
    fn of(value: f32) -> Self;
}

impl Number for f32 {
    fn of(value: f32) -> Self {
        value
    }
}

impl Number for f64 {
    fn of(value: f32) -> Self {
        value.into()
    }
}

/// At most `N` entries in each row.
#[derive(Clone, Debug)]
pub(super) struct Rows<const N: usize> {
    places: [Places; N],
    values: [[f32; LANES]; N],
}

impl<const N: usize> Rows<N> {
    /// All rows in packs, given the entries of each and what rows and columns are multiplied by.
    pub(super) fn all(entries: &[Vec<(u32, f64)>], scale: &[f64]) -> Vec<Self> {
        let last = entries.len().saturating_sub(1);
        let pack = |first: usize| {
            let entry = |lane: usize, place: usize| {
                let row = first + lane;
                let own = entries.get(row).and_then(|own| own.get(place));
                // What lacks is the hinge itself, times 0.
                own.map_or((row.min(last) as u32, 0.0), |&(column, value)| {
                    (column, value * scale[row] * scale[column as usize])
                })
            };
            Self {
                places: std::array::from_fn(|place| {
                    Places::new(LANES, |lane| entry(lane, place).0)
                }),
                values: std::array::from_fn(|place| {
                    std::array::from_fn(|lane| entry(lane, place).1 as f32)
                }),
            }
        };
        (0..entries.len()).step_by(LANES).map(pack).collect()
    }

    /// Adds the products of the rows with a vector.
    #[inline(always)]
    pub(super) fn add<T: Number>(&self, vector: &[T], sums: &mut [T; LANES]) {
        for (places, values) in self.places.iter().zip(&self.values) {
            let others = places.load(vector);
            for lane in 0..LANES {
                sums[lane] += T::of(values[lane]) * others[lane];
            }
        }
    }
}
