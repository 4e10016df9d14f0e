//! The Python module `boucle_core`: translation only, no physics.
//!
//! - `boundary`: the one place where errors, panics and threads meet the interpreter
//! - `buffers`: arrays in and out, by the buffer protocol
//! - `meshes`: meshes of cloths and colliders out of such arrays
//! - `simulation`: the class `Simulation`; `access`: what is inside it; `springs`, `corner_numbers`: its longer answers
//! - `interrupter`: the class `Interrupter`
//! - `bake`: the function `bake`; `batch`: the function `run_batch`
//! - `presets`: the functions `fabric_presets` and `fabric_springs`
//! - `geometry`: distances, collisions and intersections of many features at once, for tests
//! - `faults`: a fault on purpose, for tests
//!
//! The surface is written down in `boucle_core.pyi`. Where the environment holds `BOUCLE_TEST_HOOKS` when the module is
//! imported, it has one function more, `_panic_for_tests(simulation=None)`, which panics inside the boundary as a fault of
//! our own would: tests show with it what becomes of a panic.

mod access;
mod bake;
mod batch;
mod boundary;
mod buffers;
mod corner_numbers;
mod faults;
mod geometry;
mod interrupter;
mod meshes;
mod presets;
mod simulation;
mod springs;

use pyo3::prelude::*;

#[pymodule]
fn boucle_core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    boundary::keep_panics_quiet();
    module.add("__version__", boucle_scene::VERSION)?;
    boundary::add_exceptions(module)?;
    module.add_class::<simulation::Simulation>()?;
    module.add_class::<interrupter::Interrupter>()?;
    module.add_function(wrap_pyfunction!(bake::bake, module)?)?;
    module.add_function(wrap_pyfunction!(batch::run_batch, module)?)?;
    module.add_function(wrap_pyfunction!(presets::fabric_presets, module)?)?;
    module.add_function(wrap_pyfunction!(presets::fabric_springs, module)?)?;
    module.add_function(wrap_pyfunction!(geometry::point_triangle_distance, module)?)?;
    module.add_function(wrap_pyfunction!(geometry::edge_edge_distance, module)?)?;
    module.add_function(wrap_pyfunction!(geometry::point_triangle_impact, module)?)?;
    module.add_function(wrap_pyfunction!(geometry::edge_edge_impact, module)?)?;
    module.add_function(wrap_pyfunction!(geometry::edge_crosses_triangle, module)?)?;
    if std::env::var_os("BOUCLE_TEST_HOOKS").is_some() {
        module.add_function(wrap_pyfunction!(faults::panic_for_tests, module)?)?;
    }
    Ok(())
}
