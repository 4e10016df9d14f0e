//! Searches for bytes that the target "values" does not bear.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| boucle_fuzz::run("values", bytes));
