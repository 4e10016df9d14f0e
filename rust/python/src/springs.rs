//! The springs of a cloth as bytes.

use boucle_scene::Assembly;

/// A cloth's springs as native-endian bytes.
pub(crate) fn bytes(assembly: &Assembly, cloth: usize) -> [Vec<u8>; 5] {
    let springs = &assembly.simulation.cloth(cloth).springs;
    let stiffness = assembly.simulation.spring_stiffness(cloth);
    [
        springs.iter().flat_map(|spring| spring.ends).flat_map(u32::to_ne_bytes).collect(),
        springs.iter().map(|spring| spring.kind as u8).collect(),
        springs.iter().flat_map(|spring| spring.rest_length.to_ne_bytes()).collect(),
        stiffness.into_iter().flat_map(f64::to_ne_bytes).collect(),
        springs.iter().flat_map(|spring| spring.damping.to_ne_bytes()).collect(),
    ]
}
