//! How many steps a frame takes if nobody says: as the error of the last frame asks for.
//!
//! The error of a step is how far it ends from where the acceleration of the step before would have led. It falls with
//! the third power of the step, so that n steps of error e become
//!
//! ```text
//! n (e / (tolerance · scale · size))^(1/3)
//! ```
//!
//! with the cloths' size (m). Few numbers are used, and fewer steps only if they are clearly enough, because each change
//! of the step factors the matrix anew. A pin that is to change its velocity has an error before the frame begins. A frame
//! in which cloth snaps taut shows it only at its end: if it should have had twice as many steps, it is done once more. So
//! is, with up to twice the steps, a frame whose contacts cut too many ways short.

use crate::contact::LONGEST_WAY;

/// The numbers of steps that are taken.
const COUNTS: [u32; 14] = [2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192];

/// The most that errors ask for; contacts may need more.
const MOST: u32 = 48;

/// Steps of a first frame.
const FIRST: u32 = 4;

/// The error allowed, as a part of tolerance times size: with the default tolerance, a sheet that falls and swings from
/// an edge or two corners takes 4 to 8 steps a frame, which keep it within 1.4 % of its length (root mean square) for a
/// second.
const SCALE: f64 = 0.1;

/// The same for the way that a pin is off its old course after a step: seen in a few vertices only.
const PIN_SCALE: f64 = 10.0;

/// Fewer steps are taken only if this part of them would do.
const CLEARLY: f64 = 0.9;

/// A frame is done once more if it should have had so many times its steps: with fewer, BDF2 loses twice the energy when
/// a swinging sheet snaps taut.
const FAR_TOO_FEW: f64 = 2.0;

/// The most steps of a frame that errors ask for where cloth touches something: what it does then depends on its finest
/// folds, and no number of steps makes it converge.
const MOST_IN_CONTACT: u32 = 6;

/// The fewest: what slides and stops is then right within a percent.
const LEAST_IN_CONTACT: u32 = 4;

/// The most that contacts ask for, but where something comes fast: there, so many times what its way alone asks for.
const MOST_FOR_CONTACTS: u32 = 96;
const MOST_FOR_WAY: f64 = 8.0;

/// What the choice depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Accuracy {
    /// Relative.
    pub(crate) tolerance: f64,
    /// Of the cloths (m): root mean square distance from their middle.
    pub(crate) size: f64,
    /// Whether anything touches.
    pub(crate) is_in_contact: bool,
}

impl Accuracy {
    /// Steps after a frame of so many with a mean error (m).
    pub(crate) fn after(self, substeps: u32, error: f64) -> u32 {
        let wanted = f64::from(substeps) * (error / (SCALE * self.tolerance * self.size)).cbrt();
        let [least, most] = if self.is_in_contact {
            [LEAST_IN_CONTACT, MOST_IN_CONTACT]
        } else {
            [COUNTS[0], MOST]
        };
        let count = at_least(wanted.min(f64::from(most))).max(least);
        if substeps > most {
            // Contact asked for so many: half of them may do now.
            count.max(at_least(0.5 * f64::from(substeps)))
        } else if count < substeps && wanted > CLEARLY * f64::from(count) {
            substeps
        } else {
            count
        }
    }

    /// Steps with which a frame is done once more whose steps were too long for its contacts, if there may be more.
    pub(crate) fn shorter(substeps: u32) -> Option<u32> {
        let count = at_least(2.0 * f64::from(substeps));
        (count > substeps).then_some(count)
    }

    /// The most steps that contacts may ask for in a frame in which colliders and cloth go so far (m) towards each other.
    pub(crate) fn most_for_contacts(way: f64) -> u32 {
        at_least(MOST_FOR_WAY * way / LONGEST_WAY).max(MOST_FOR_CONTACTS)
    }

    /// Steps with which a frame is done once more, if far too few were taken.
    pub(crate) fn again(self, substeps: u32, error: f64) -> Option<u32> {
        let count = self.after(substeps, error);
        (f64::from(count) >= FAR_TOO_FEW * f64::from(substeps)).then_some(count)
    }

    /// Steps for pins whose velocity changes by as much (m/s) as a frame of a duration (s) begins.
    pub(crate) fn for_pins(self, change: f64, duration: f64) -> u32 {
        at_least(0.5 * change * duration / (PIN_SCALE * self.tolerance * self.size))
    }

    /// Steps of a frame, given those that the last one asks for; 0 for none. `way` is how far (m) colliders and cloth go
    /// towards each other at the most.
    pub(crate) fn plan(self, asked: u32, change: f64, way: f64, duration: f64) -> u32 {
        let asked = if asked == 0 { FIRST } else { asked };
        asked.max(self.for_pins(change, duration)).max(at_least(way / LONGEST_WAY))
    }
}

/// The least number of steps taken that is not below a wish.
fn at_least(wanted: f64) -> u32 {
    let most = COUNTS[COUNTS.len() - 1];
    COUNTS.into_iter().find(|&count| f64::from(count) >= wanted).unwrap_or(most)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ACCURACY: Accuracy = Accuracy { tolerance: 5e-3, size: 1.0, is_in_contact: false };

    #[test]
    fn the_error_allowed_keeps_the_number_of_steps() {
        for count in COUNTS.into_iter().filter(|&count| count <= MOST) {
            assert_eq!(ACCURACY.after(count, 0.9 * SCALE * 5e-3), count);
        }
    }

    #[test]
    fn eight_times_the_error_doubles_the_steps_and_no_error_takes_the_fewest() {
        assert_eq!(ACCURACY.after(4, 7.9 * SCALE * 5e-3), 8);
        assert_eq!(ACCURACY.after(48, 0.0), 2);
        assert_eq!(ACCURACY.after(48, f64::INFINITY), 48);
    }

    #[test]
    fn a_frame_is_done_once_more_only_with_twice_the_steps() {
        assert_eq!(ACCURACY.again(4, 7.9 * SCALE * 5e-3), Some(8));
        assert_eq!(ACCURACY.again(4, 3.3 * SCALE * 5e-3), None);
        assert_eq!(ACCURACY.again(48, f64::INFINITY), None);
    }

    #[test]
    fn a_pin_that_jumps_takes_more_steps_and_one_that_rests_none() {
        let duration = 1.0 / 24.0;
        assert_eq!(ACCURACY.plan(0, 0.0, 0.0, duration), FIRST);
        assert_eq!(ACCURACY.plan(3, 0.0, 0.0, duration), 3);
        assert!(ACCURACY.plan(3, 20.0, 0.0, duration) >= 8);
    }

    #[test]
    fn steps_too_long_for_contacts_become_shorter_and_longer_again_by_and_by() {
        assert_eq!(Accuracy::shorter(6), Some(12));
        assert_eq!(Accuracy::shorter(48), Some(96));
        assert_eq!(Accuracy::shorter(96), Some(192));
        assert_eq!(Accuracy::shorter(192), None);
        assert_eq!([0.0, 1.2, 2.5].map(Accuracy::most_for_contacts), [96, 96, 192]);
        let touching = Accuracy { is_in_contact: true, ..ACCURACY };
        for accuracy in [touching, ACCURACY] {
            assert_eq!(accuracy.after(192, f64::INFINITY), 96);
            assert_eq!(accuracy.after(96, 0.0), 48);
        }
        assert_eq!(touching.after(24, f64::INFINITY), 12);
    }

    #[test]
    fn what_comes_fast_takes_more_steps_and_what_touches_no_more_than_a_few() {
        assert_eq!(ACCURACY.plan(3, 0.0, 2.5, 1.0 / 24.0), 24);
        let touching = Accuracy { is_in_contact: true, ..ACCURACY };
        assert_eq!(touching.after(4, f64::INFINITY), MOST_IN_CONTACT);
        assert_eq!(touching.after(4, 0.0), LEAST_IN_CONTACT);
        assert_eq!(touching.again(4, f64::INFINITY), None);
    }
}
