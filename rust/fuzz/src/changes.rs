//! Random changes of bytes: what a fuzzer does without looking, the same in every run.

/// Splitmix64.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }
}

/// Bytes that mean something somewhere.
const PIECES: [&[u8]; 16] = [
    b"nan",
    b"inf",
    b"-1",
    b"0",
    b"1e308",
    b"-1e-308",
    b"99999999999999999999",
    b"\"",
    b"[",
    b"]",
    b"\n",
    b"\\\n",
    b"/",
    b"\xff\xff\xff\xff",
    b"\0\0\0\x80",
    b"\0\0\xc0\x7f",
];

/// Some of the bytes, changed in one to eight places; `seed` says how.
#[must_use]
pub fn changed(bytes: &[u8], seed: u64) -> Vec<u8> {
    let (mut dice, mut bytes) = (Dice(seed), bytes.to_vec());
    for _ in 0..=dice.below(8) {
        let (at, end) = (dice.below(bytes.len() + 1), bytes.len());
        let span = at..(at + 1 + dice.below(16)).min(end).max(at);
        match dice.below(6) {
            0 if at < end => bytes[at] ^= 1 << dice.below(8),
            1 if at < end => bytes[at] = dice.next() as u8,
            2 => drop(bytes.drain(span)),
            3 => {
                let copy = bytes[span].to_vec();
                let to = dice.below(bytes.len() + 1);
                drop(bytes.splice(to..to, copy));
            }
            4 => bytes.truncate(at.max(1)),
            _ => {
                let piece = PIECES[dice.below(PIECES.len())].iter().copied();
                let replaced = if dice.below(2) == 0 { at..at } else { span };
                drop(bytes.splice(replaced, piece));
            }
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_seed_makes_the_same_change_and_another_another() {
        let text = b"[[cloth]]\nname = \"sheet\"\n";
        assert_eq!(changed(text, 3), changed(text, 3));
        let others = (0..20).filter(|&seed| changed(text, seed) != changed(text, seed + 1));
        assert!(others.count() > 15);
        for seed in 0..1000 {
            let _ = changed(b"", seed);
        }
    }
}
