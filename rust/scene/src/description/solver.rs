//! `[solver]`: which rule moves the particles, and in which steps.

use std::fmt;

use boucle_solver::{IntegratorKind, LinearSolver, MOST_SUBSTEPS, StepSize};
use serde::de::{Deserializer, Unexpected, Visitor};
use serde::{Deserialize, Serialize, Serializer};

use super::choice::Choice;
use crate::error::{Error, Result};
use crate::limits;

/// How the scene is stepped.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SolverDescription {
    /// Which rule moves the particles.
    #[serde(deserialize_with = "Choice::read", serialize_with = "Choice::write")]
    pub integrator: IntegratorKind,
    /// Steps a frame.
    pub substeps: Option<Substeps>,
    /// Or the longest step (s); the frame is cut into equal ones.
    pub time_step: Option<f64>,
    /// Takes a step beyond the stability bound as asked.
    pub allow_unstable: bool,
    /// What an implicit integrator may be off in a step, relative to the cloths' size, if substeps is "auto".
    pub tolerance: Option<f64>,
    /// What inverts the constant matrix of an implicit step.
    #[serde(deserialize_with = "Choice::read", serialize_with = "Choice::write")]
    pub linear_solver: LinearSolver,
}

impl SolverDescription {
    /// The step as the solver takes it.
    #[must_use]
    pub fn step_size(&self) -> StepSize {
        match (self.time_step, self.substeps) {
            (Some(seconds), _) => StepSize::Seconds(seconds),
            (None, Some(Substeps::Number(count))) => StepSize::Substeps(count),
            (None, Some(Substeps::Auto) | None) => StepSize::Auto,
        }
    }

    pub(super) fn check(&self, fps: f64) -> Result<()> {
        if let (Some(_), Some(_)) = (self.substeps, self.time_step) {
            let both = "solver: substeps and time_step; accepted: one of the two";
            return Err(Error::input(both));
        }
        if let Some(tolerance) = self.tolerance {
            let accepted = "1e-6 to 1";
            limits::within("solver.tolerance", tolerance, &(1e-6..=1.0), accepted)?;
        }
        let Some(step) = self.time_step else { return Ok(()) };
        limits::above_zero("solver.time_step", step, 1e3, " s")?;
        let shortest = 1.0 / (fps * f64::from(MOST_SUBSTEPS));
        if step < shortest {
            let accepted = format!("at least {shortest:.3e} s ({MOST_SUBSTEPS} substeps a frame)");
            return Err(Error::refuse("solver.time_step", format!("{step:?}"), &accepted));
        }
        Ok(())
    }
}

impl Choice for IntegratorKind {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("bdf2", Self::Bdf2),
        ("implicit_euler", Self::ImplicitEuler),
        ("symplectic_euler", Self::SymplecticEuler),
        ("forward_euler", Self::ForwardEuler),
        ("verlet", Self::Verlet),
        ("leapfrog", Self::Leapfrog),
        ("midpoint", Self::Midpoint),
        ("rk4", Self::Rk4),
    ];
}

impl Choice for LinearSolver {
    const WORDS: &'static [(&'static str, Self)] =
        &[("auto", Self::Auto), ("ldlt", Self::Ldlt), ("multigrid", Self::Multigrid)];
}

/// Steps a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Substeps {
    /// As few as hold the stability bound.
    Auto,
    /// This many.
    Number(u32),
}

impl Serialize for Substeps {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match self {
            Self::Auto => serializer.serialize_str("auto"),
            Self::Number(count) => serializer.serialize_u32(*count),
        }
    }
}

impl<'de> Deserialize<'de> for Substeps {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        deserializer.deserialize_any(SubstepsVisitor)
    }
}

struct SubstepsVisitor;

impl Visitor<'_> for SubstepsVisitor {
    type Value = Substeps;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\"auto\", or a whole number from 1 to {MOST_SUBSTEPS}")
    }

    fn visit_str<E: serde::de::Error>(self, word: &str) -> std::result::Result<Substeps, E> {
        match word {
            "auto" => Ok(Substeps::Auto),
            other => Err(E::invalid_value(Unexpected::Str(other), &self)),
        }
    }

    fn visit_i64<E: serde::de::Error>(self, count: i64) -> std::result::Result<Substeps, E> {
        match u32::try_from(count) {
            Ok(number @ 1..=MOST_SUBSTEPS) => Ok(Substeps::Number(number)),
            _ => Err(E::invalid_value(Unexpected::Signed(count), &self)),
        }
    }
}
