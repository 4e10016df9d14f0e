//! Scenes as data, the files around them, and the headless bake.
//!
//! ```text
//! SCENE.toml -> description -> assembly -> bake -> NAME.pc2, NAME.obj, report.json, checkpoint
//!     --set ->  (keys typed     (meshes, pins, colliders,
//!               and checked)     simulation)
//! ```
//! Every refusal is an [`Error`] of one line that names the file, the key, the value and what is accepted.

pub mod assembly;
mod atomic;
pub mod bake;
pub mod batch;
pub mod checkpoint;
mod collider;
pub mod description;
mod error;
mod grid;
mod lattice;
pub mod limits;
pub mod obj;
mod overrides;
pub mod pc2;
mod pins;
mod preset;
pub mod report;
mod samples;
mod shape;
pub mod source;
pub mod transform;

pub use assembly::{Assembly, RestMesh};
pub use collider::RestCollider;
pub use description::Scene;
pub use error::{Error, Result};
pub use grid::PLACES;
pub use lattice::Lattice;
pub use preset::{FabricPreset, fabric_presets, fabric_presets_json, fabric_springs_json};
pub use samples::Samples;

/// The version of Boucle, as reports name it.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
