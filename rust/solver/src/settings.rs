//! How a simulation is stepped, in the words of the scene file.

use boucle_geometry::Vector;

use crate::error::{Error, Result};
use crate::force::Water;

/// Most substeps a frame may take.
pub const MOST_SUBSTEPS: u32 = 200_000;

/// Which rule moves the particles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum IntegratorKind {
    /// `x += h v` with the old velocity, then `v += h a`.
    ForwardEuler,
    /// `v += h a`, then `x += h v` with the new velocity (the paper).
    SymplecticEuler,
    /// Velocity Verlet: half a kick, a drift, half a kick.
    Verlet,
    /// Leapfrog: half a drift, a kick, half a drift.
    Leapfrog,
    /// Runge-Kutta of order 2, by the midpoint.
    Midpoint,
    /// The classic Runge-Kutta of order 4.
    Rk4,
    /// Implicit Euler, linearised: stable at any step, damps.
    ImplicitEuler,
    /// BDF2, linearised: stable at any step, damps far less.
    #[default]
    Bdf2,
}

impl IntegratorKind {
    /// Every integrator.
    pub const ALL: [Self; 8] = [
        Self::ForwardEuler,
        Self::SymplecticEuler,
        Self::Verlet,
        Self::Leapfrog,
        Self::Midpoint,
        Self::Rk4,
        Self::ImplicitEuler,
        Self::Bdf2,
    ];

    /// The explicit ones.
    pub const EXPLICIT: [Self; 6] = [
        Self::ForwardEuler,
        Self::SymplecticEuler,
        Self::Verlet,
        Self::Leapfrog,
        Self::Midpoint,
        Self::Rk4,
    ];

    /// The name in scene files and panels.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ForwardEuler => "forward_euler",
            Self::SymplecticEuler => "symplectic_euler",
            Self::Verlet => "verlet",
            Self::Leapfrog => "leapfrog",
            Self::Midpoint => "midpoint",
            Self::Rk4 => "rk4",
            Self::ImplicitEuler => "implicit_euler",
            Self::Bdf2 => "bdf2",
        }
    }
}

/// What inverts the matrix that stands for that of an implicit step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinearSolver {
    /// Up to 20 000 particles with fabric among them, the step's own matrix, eliminated in each iteration; else the constant
    /// one, by the number of particles.
    #[default]
    Auto,
    /// The constant one, exactly, by elimination.
    Ldlt,
    /// The constant one, nearly, by a cycle over coarser and coarser matrices.
    Multigrid,
}

/// How a frame is cut into steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum StepSize {
    /// As few as hold the stability bound, or, for implicit integrators, the tolerance.
    #[default]
    Auto,
    /// This many a frame.
    Substeps(u32),
    /// Equal steps of at most this many seconds.
    Seconds(f64),
}

/// What holds for every cloth of a simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Acceleration of gravity (m/s²).
    pub gravity: Vector,
    /// Frames a second.
    pub fps: f64,
    /// The frame at which the cloths are at rest.
    pub first_frame: i32,
    /// The water, if there is any.
    pub water: Option<Water>,
    /// Which rule moves the particles.
    pub integrator: IntegratorKind,
    /// How a frame is cut into steps.
    pub step_size: StepSize,
    /// How exact an implicit integrator is where `Auto` picks the steps: ten times what a step may be off, relative to the
    /// cloths' size.
    pub tolerance: f64,
    /// What inverts the matrix that stands for that of an implicit step.
    pub linear_solver: LinearSolver,
    /// Height of the unevenness given to a sheet as the first step starts, as a part of its mean edge; 1e-6 lets a
    /// flat sheet in a symmetric scene buckle, 0 leaves it as it is.
    pub perturbation: f64,
    /// Takes a step beyond the stability bound as asked, to show the breakdown.
    pub allow_unstable: bool,
    /// Worker threads; 0 takes every core. The result does not depend on it.
    pub threads: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            gravity: Vector::new(0.0, 0.0, -9.81),
            fps: 24.0,
            first_frame: 1,
            water: None,
            integrator: IntegratorKind::default(),
            step_size: StepSize::default(),
            tolerance: 5e-3,
            linear_solver: LinearSolver::default(),
            perturbation: 0.0,
            allow_unstable: false,
            threads: 0,
        }
    }
}

impl Settings {
    /// Refuses values outside their domains.
    ///
    /// # Errors
    /// [`Error::OutOfDomain`] for the first value that is not accepted.
    pub fn check(&self) -> Result<()> {
        let within = |quantity: &str, value: f64, domain: &'static str, is_accepted: bool| {
            if is_accepted {
                return Ok(());
            }
            Err(Error::OutOfDomain { quantity: quantity.to_owned(), value, domain })
        };
        for value in &self.gravity {
            within("gravity (m/s²)", *value, "-1e6 to 1e6", value.abs() <= 1e6)?;
        }
        let is_rate = (0.01..=1e6).contains(&self.fps);
        within("fps (1/s)", self.fps, "0.01 to 1e6", is_rate)?;
        let is_small = (0.0..=0.01).contains(&self.perturbation);
        within("perturbation", self.perturbation, "0 to 0.01", is_small)?;
        let is_tolerance = (1e-6..=1.0).contains(&self.tolerance);
        within("tolerance", self.tolerance, "1e-6 to 1", is_tolerance)?;
        self.water.as_ref().map_or(Ok(()), Water::check)?;
        match self.step_size {
            StepSize::Auto => Ok(()),
            StepSize::Substeps(count) => {
                within("substeps", f64::from(count), "\"auto\", or 1 or more", count > 0)
            }
            StepSize::Seconds(step) => {
                within("time_step (s)", step, "1e-9 to 1000", (1e-9..=1e3).contains(&step))
            }
        }
    }
}
