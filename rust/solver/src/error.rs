//! Every refusal of the solver, one sentence each.

use std::fmt;

use boucle_geometry::MeshError;

/// What the solver's functions return.
pub type Result<T> = std::result::Result<T, Error>;

/// A refusal. The message names the thing, its value and what would be accepted.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A material, step or scene value outside its domain.
    OutOfDomain {
        /// What the value is, in the words of the scene file.
        quantity: String,
        /// The value.
        value: f64,
        /// What would be accepted.
        domain: &'static str,
    },
    /// A cloth whose mesh or positions cannot be simulated.
    BadCloth {
        /// The cloth's name.
        cloth: String,
        /// What is wrong and what would be accepted.
        reason: String,
    },
    /// A collider that cloth cannot collide with.
    BadCollider {
        /// The collider's name.
        collider: String,
        /// What is wrong and what would be accepted.
        reason: String,
    },
    /// A step beyond what the springs bear.
    Unstable {
        /// The step asked for (s).
        step: f64,
        /// The largest stable step (s); 0 if there is none.
        bound: f64,
        /// Steps a frame that would hold the bound.
        substeps: u64,
    },
    /// Holding the stability bound would take more steps a frame than are allowed.
    TooManySubsteps {
        /// Steps a frame that would hold the bound.
        substeps: f64,
        /// The largest number allowed.
        limit: u32,
        /// The integrator's name.
        integrator: &'static str,
    },
    /// A position left the finite numbers.
    Diverged {
        /// The frame that could not be reached.
        frame: i32,
        /// The first such vertex, in its cloth's numbering.
        vertex: usize,
        /// The cloth's name.
        cloth: String,
    },
    /// A frame was stopped from outside; the state is that of the frame before it.
    Interrupted {
        /// The frame that was not reached.
        frame: i32,
    },
    /// The system has no such number of threads to give.
    Threads(usize),
    /// A checkpoint that is damaged, of another version, or of another scene.
    BadCheckpoint(&'static str),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfDomain { quantity, value, domain } => {
                write!(f, "{quantity} is {value}; accepted: {domain}")
            }
            Self::BadCloth { cloth, reason } => write!(f, "cloth \"{cloth}\": {reason}"),
            Self::BadCollider { collider, reason } => {
                write!(f, "collider \"{collider}\": {reason}")
            }
            Self::Unstable { step, bound, substeps } if *bound > 0.0 => write!(
                f,
                "the step of {step:.3e} s is beyond the stability bound of {bound:.3e} s; accepted: \
                 at least {substeps} substeps, substeps = \"auto\", or allow_unstable = true"
            ),
            Self::Unstable { step, .. } => write!(
                f,
                "the step of {step:.3e} s is not stable and no other is with this integrator and \
                 damping; accepted: more damping, another integrator, or allow_unstable = true"
            ),
            Self::TooManySubsteps { substeps, limit, integrator } => write!(
                f,
                "{integrator} needs {substeps:.3e} substeps a frame to stay stable; accepted: at \
                 most {limit}; lower the stiffness, raise the mass, change the integrator, or set \
                 a step with allow_unstable = true"
            ),
            Self::Diverged { frame, vertex, cloth } => {
                write!(f, "diverged at frame {frame}, vertex {vertex} of cloth \"{cloth}\"")
            }
            Self::Interrupted { frame } => write!(f, "frame {frame} was interrupted"),
            Self::Threads(count) => {
                write!(f, "threads is {count}; accepted: as many as the system can start")
            }
            Self::BadCheckpoint(reason) => write!(f, "the checkpoint {reason}"),
        }
    }
}

impl std::error::Error for Error {}

/// A mesh's refusal, told of the cloth it belongs to.
pub(crate) fn bad_mesh(cloth: &str, error: &MeshError) -> Error {
    Error::BadCloth { cloth: cloth.to_owned(), reason: error.to_string() }
}
