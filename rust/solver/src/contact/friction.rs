//! Coulomb's friction, smooth around rest.
//!
//! Where a contact has slipped by u (m) across its normal since the step began, and presses with f (N),
//!
//! ```text
//! F = -c u        c = mu f/|u| beyond |u| = e,  mu f (2 - |u|/e)/e below        e = h · 0.1 mm/s   (N/m)
//! ```
//!
//! Both u and f are those of the last Newton iteration: each iteration is linear, and a few of them meet. The slope of F
//! is continuous; a cloth at rest creeps by less than e a step.
//!
//! Source: Li et al. 2020 for the smooth law; Alart & Curnier 1991 for lagging.

/// Speed (m/s) below which a contact sticks.
const CREEP: f64 = 1e-4;

/// The factor c (N/m) of a contact with a coefficient of friction that presses with a force (N) and has slipped (m) in a
/// step of h seconds.
#[inline]
pub(super) fn resistance(friction: f64, force: f64, slip: f64, h: f64) -> f64 {
    let creep = CREEP * h;
    let by_slip = if slip < creep { (2.0 - slip / creep) / creep } else { 1.0 / slip };
    friction * force * by_slip
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sliding_contact_resists_by_friction_times_force_and_a_resting_one_by_less() {
        let h = 0.01;
        let at = |slip: f64| slip * resistance(0.5, 8.0, slip, h);
        assert!((at(1e-3) - 4.0).abs() < 1e-12);
        assert!((at(CREEP * h) - 4.0).abs() < 1e-12);
        assert!((at(0.5 * CREEP * h) - 3.0).abs() < 1e-12);
        assert!(at(0.0) == 0.0);
    }
}
