//! Marks on edges.

/// Marks on edges, by rank.
#[derive(Debug)]
pub(super) struct BitSet {
    pub(super) words: Vec<u64>,
}

impl BitSet {
    pub(super) fn new(count: usize) -> Self {
        Self { words: vec![0; count.div_ceil(64)] }
    }

    pub(super) fn insert(&mut self, index: usize) {
        self.words[index / 64] |= 1 << (index % 64);
    }

    pub(super) fn clear(&mut self) {
        self.words.fill(0);
    }

    pub(super) fn is_empty(&self) -> bool {
        self.words.iter().all(|&word| word == 0)
    }

    /// The first mark at or after an index.
    pub(super) fn first_from(&self, index: usize) -> Option<usize> {
        let mut word = index / 64;
        let mut bits = self.words.get(word)? & (!0 << (index % 64));
        while bits == 0 {
            word += 1;
            bits = *self.words.get(word)?;
        }
        Some(64 * word + bits.trailing_zeros() as usize)
    }

    /// The last mark before an index.
    pub(super) fn last_before(&self, index: usize) -> Option<usize> {
        let mut word = index / 64;
        let below = !(!0 << (index % 64));
        let mut bits = self.words.get(word).map_or(0, |bits| bits & below);
        while bits == 0 {
            word = word.checked_sub(1)?;
            bits = self.words[word];
        }
        Some(64 * word + 63 - bits.leading_zeros() as usize)
    }

    /// Removes and returns the first mark at or after an index.
    pub(super) fn take_from(&mut self, index: usize) -> Option<usize> {
        let first = self.first_from(index)?;
        self.words[first / 64] &= !(1 << (first % 64));
        Some(first)
    }
}
