//! Scenes as data, the files around them, and the headless bake.
//!
//! ```text
//! SCENE.toml -> description -> assembly -> bake -> NAME.pc2, NAME.obj, report.json, checkpoint
//!     --set ->  (keys typed     (meshes, pins, colliders,
//!               and checked)     simulation)
//! ```
//! Every refusal is an [`Error`] of one line that names the file, the key, the value and what is accepted.
//!
//! In the order in which a bake goes:
//!
//! 1. [`source`] reads the scene file and the meshes that it names ([`obj`], [`grid`]); [`overrides`] change its keys,
//! 2. [`description`] types and checks them, table by table; its pages are the reference of the scene file,
//! 3. [`assembly`] makes the simulation: [`preset`] and [`lattice`] know the named fabrics, [`pins`], [`shape`] and [`collider`] what
//!    moves from frame to frame, [`samples`] what deforms,
//! 4. [`bake`] goes frame by frame and writes [`pc2`], [`report`] and [`mod@checkpoint`], each whole at any moment ([`atomic`]);
//!    [`batch`] runs many scenes without files.
//!
//! [`limits`] says how large anything may be. Nothing here knows Python or Blender.

#![allow(rustdoc::private_intra_doc_links, reason = "the lecture is built with private items")]

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
