//! Searches for bytes that the target "pc2" does not bear.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| boucle_fuzz::run("pc2", bytes));
