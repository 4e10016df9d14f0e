//! Searches for bytes that the target "bake" does not bear.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| boucle_fuzz::run("bake", bytes));
