//! Numbers that look random and are always the same.

/// A number in -1 to 1 that looks random and is always the same.
pub(crate) fn scattered(index: u64) -> f64 {
    (mixed(index) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// 64 bits that look random and are always the same (splitmix64).
pub(crate) fn mixed(index: u64) -> u64 {
    let mut mixed = index.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    mixed ^ (mixed >> 31)
}
