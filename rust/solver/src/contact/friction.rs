//! Coulomb's friction, smooth around rest.
//!
//! Where a contact has slipped by u (m) across its normal since the step began, and presses with f (N),
//!
//! ```text
//! F = -c u        c = mu f/|u| beyond |u| = e,  mu f (2 - |u|/e)/e below        e = h · 0.1 mm/s   (N/m)
//! ```
//!
//! The slope of F is continuous; a cloth at rest creeps by less than e a step. Newton's iterations take f from the last
//! and c as a constant, so that each is linear and positive.
//!
//! Source: Li et al. 2020 for the smooth law; Alart & Curnier 1991 for lagging.

/// Speed (m/s) below which a contact sticks.
const CREEP: f64 = 1e-4;

/// The most that c is, in units of m/h'²: single precision bears no more of what lasts from step to step. What sticks slips
/// by this part of the way that it would go without friction.
pub(super) const FIRMEST: f64 = 2000.0;

/// The factor c (N/m) of a contact whose friction is of a strength mu f (N) and that slips by so much (m) in a step of h
/// seconds.
#[inline]
pub(super) fn resistance(strength: f64, slip: f64, h: f64) -> f64 {
    let creep = CREEP * h;
    let by_slip = if slip < creep { (2.0 - slip / creep) / creep } else { 1.0 / slip };
    strength * by_slip
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sliding_contact_resists_by_its_strength_and_a_resting_one_by_less() {
        let h = 0.01;
        let at = |slip: f64| slip * resistance(4.0, slip, h);
        assert!((at(1e-3) - 4.0).abs() < 1e-12);
        assert!((at(CREEP * h) - 4.0).abs() < 1e-12);
        assert!((at(0.5 * CREEP * h) - 3.0).abs() < 1e-12);
        assert!(at(0.0) == 0.0);
    }
}
