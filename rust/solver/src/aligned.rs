//! Arrays of numbers that begin on a line of the cache.

use std::ops::{Deref, DerefMut};

/// Numbers in a line of the cache.
pub(crate) const LINE: usize = 8;

/// Lines by which arrays of one state are moved apart: arrays of a page's multiple would all fall on the same lines.
const APART: usize = 11;

/// As many numbers as it was made for; vectors of them load without crossing a line of the cache.
#[derive(Debug)]
pub(crate) struct Aligned {
    padded: Vec<f64>,
    start: usize,
    len: usize,
    /// Which of the arrays that are read together.
    which: usize,
}

impl Aligned {
    /// Zeros; `which` tells arrays apart that are read together.
    pub(crate) fn zeros(len: usize, which: usize) -> Self {
        let padded = vec![0.0; len + LINE * (1 + APART * which)];
        let first = padded.as_ptr().align_offset(LINE * size_of::<f64>()).min(LINE);
        Self { padded, start: first + LINE * APART * which, len, which }
    }
}

impl Deref for Aligned {
    type Target = [f64];

    #[inline(always)]
    fn deref(&self) -> &[f64] {
        &self.padded[self.start..][..self.len]
    }
}

impl DerefMut for Aligned {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.padded[self.start..][..self.len]
    }
}

impl Clone for Aligned {
    fn clone(&self) -> Self {
        let mut copy = Self::zeros(self.len, self.which);
        copy.copy_from_slice(self);
        copy
    }
}

impl PartialEq for Aligned {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_and_their_copies_begin_on_a_line() {
        for len in [0, 1, 7, 1000] {
            for which in 0..6 {
                let mut array = Aligned::zeros(len, which);
                for (i, value) in array.iter_mut().enumerate() {
                    *value = i as f64;
                }
                for array in [array.clone(), array] {
                    assert_eq!(array.as_ptr().align_offset(64), 0);
                    assert!(array.iter().enumerate().all(|(i, &value)| value as usize == i));
                    assert_eq!(array.len(), len);
                }
            }
        }
    }
}
