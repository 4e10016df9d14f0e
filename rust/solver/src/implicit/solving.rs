//! How the equations of a step are solved, and how far.

use crate::cloth::Cloth;
use crate::linear::Stop;
use crate::material::SpringKind;
use crate::settings::LinearSolver;
use crate::system::System;
use crate::tear::Tear;

/// When iterations end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solving {
    /// Conjugate gradients.
    pub(super) stop: Stop,
    /// Iterations of Newton at the most, without contact.
    pub(super) newton: usize,
    /// Newton, once one gains no more than the square of this part of all.
    pub(super) left: f64,
    /// Conjugate gradients of a whole step, beyond which twice as many steps are asked for.
    most_iterations: u32,
    /// Whether the Hessian itself is factored in the place of P.
    pub(super) is_factored: bool,
    /// Whether edges break by what a frame ends with.
    tears: bool,
}

impl Solving {
    /// For cloths: as far as the one asks that is hardest to solve.
    pub(super) fn of(cloths: &[Cloth], choice: LinearSolver) -> Self {
        let tears = cloths.iter().filter_map(|cloth| cloth.tear.as_ref()).any(Tear::breaks_edges);
        Self { tears, ..Self::for_materials(cloths, choice) }
    }

    fn for_materials(cloths: &[Cloth], choice: LinearSolver) -> Self {
        let particle_count: usize = cloths.iter().map(|cloth| cloth.positions.len()).sum();
        let is_fabric = cloths.iter().any(|cloth| cloth.fabric.is_some());
        if is_fabric && choice == LinearSolver::Auto && particle_count <= MOST_FACTORED {
            if cloths.iter().any(|cloth| speed(cloth) > SWIFT) {
                OF_SWIFT_FABRIC
            } else {
                OF_FABRIC
            }
        } else if is_fabric || cloths.iter().any(|cloth| contrast(cloth) >= WOVEN) {
            OF_WOVEN
        } else {
            OF_SPRINGS
        }
    }

    /// The same in a system: in water further, whose drag at the speed of free fall, with which a step begins, is many times the
    /// weight of cloth. With the limits of springs a sheet sinks 1 % too fast, and a raft floats 2 % too high.
    pub(super) fn within(self, system: &System) -> Self {
        if system.air.sea.is_none() {
            return self;
        }
        let stop = Stop { tolerance: self.stop.tolerance.min(0.005), ..self.stop };
        Self { stop, newton: self.newton.max(8), left: self.left.min(0.02), ..self }
    }

    /// The same for the last step of a frame: where edges break, their loads are read from what it leaves. With the limits of fabric
    /// these are up to three times as large beside pins as they should be. Solved further in all steps, a frame of fabric takes six
    /// times as long, in the last alone half as long again.
    pub(super) fn at_end(self) -> Self {
        if !self.tears {
            return self;
        }
        let stop = Stop { tolerance: 0.002 * self.stop.tolerance, ..self.stop };
        Self { stop, newton: 12, left: 0.005, most_iterations: u32::MAX, ..self }
    }

    /// What the error of a step counts for that took so many iterations; steps grow by its cube root.
    pub(super) fn weight_of_error(&self, iterations: u32) -> f64 {
        if iterations > self.most_iterations { 8.0 } else { 1.0 }
    }
}

/// Iterations of Newton at the most; the limiters mend what a snap leaves after them.
const NEWTON: usize = 3;

/// Conjugate gradients stop early, where the error of the step is larger than theirs. With 0.15 a strip of 256 rows that
/// falls and swings is 44 mm (root mean square) off a fine reference after a second, with this 25 mm, with 0.02 19 mm; and
/// what they leave looks like an error of the step, and asks for more of them.
const STOP: Stop = Stop { tolerance: 0.06, least_iterations: 1, most_iterations: 200 };

/// No more Newton iterations once one gains no more than the square of this part of all.
const LEFT: f64 = 0.2;

const OF_SPRINGS: Solving = Solving {
    stop: STOP,
    newton: NEWTON,
    left: LEFT,
    most_iterations: u32::MAX,
    is_factored: false,
    tears: false,
};

/// Woven cloth is a hundred times as stiff along its yarns as across them. What a step leaves of the strain comes back in
/// the prediction of the next, several times as large: with the limits of springs, 64 x 64 vertices of poplin that hang by two
/// corners shake within ten frames until the limiter stops them. With these they hang still, in a third of the steps. What is
/// left looks like weight, too, where hinges bend. Ripstop nylon, lighter and stiffer, hangs still in 24 steps of 20 iterations
/// a frame, but not in 12 of 110.
const OF_WOVEN: Solving = Solving {
    stop: Stop { tolerance: 0.005, ..STOP },
    newton: 5,
    left: 0.05,
    most_iterations: 20,
    is_factored: false,
    tears: false,
};

/// With the Hessian's factor. What the factor does not know of hinges, at long waves, comes last: with 0.005 a cantilever stops
/// 4 % short of where it hangs. No iterations ask for more steps.
const OF_FABRIC: Solving =
    Solving { stop: Stop { tolerance: 0.001, ..STOP }, is_factored: true, ..OF_SPRINGS };

/// The same for light and stiff fabric, in which waves cross more of the cloth in a step, and come back larger: ripstop nylon
/// hangs still in 4 steps a frame, and takes 9 with the limits of springs. Denim takes 5 with either.
const OF_SWIFT_FABRIC: Solving =
    Solving { newton: OF_WOVEN.newton, left: OF_WOVEN.left, ..OF_FABRIC };

/// Speed (m/s) of waves along the yarns above which fabric counts as swift: wool suiting has 220, linen 340.
const SWIFT: f64 = 250.0;

/// Particles up to which the Hessian is factored. Its factor grows with their number to the power of 1.5: 5 ms for 4 000, 36
/// for 16 000, on one thread.
const MOST_FACTORED: usize = 20_000;

/// Springs so many times as stiff along edges as across faces are as hard to solve as fabric.
const WOVEN: f64 = 20.0;

/// By how much the stiffest stretch spring is stiffer than the softest shear spring; 0 where there are none.
fn contrast(cloth: &Cloth) -> f64 {
    let of = |kind: SpringKind| {
        let springs = cloth.springs.iter().filter(move |spring| spring.kind == kind);
        springs.map(|spring| spring.stiffness).filter(|stiffness| *stiffness > 0.0)
    };
    let stiffest = of(SpringKind::Stretch).fold(0.0, f64::max);
    of(SpringKind::Shear).reduce(f64::min).map_or(0.0, |softest| stiffest / softest)
}

/// Speed (m/s) of waves along the stiffer yarn of fabric; 0 of springs.
fn speed(cloth: &Cloth) -> f64 {
    let Some(fabric) = &cloth.fabric else { return 0.0 };
    let stiffest = fabric.stretch[0].max(fabric.stretch[1]);
    (stiffest * cloth.area() / cloth.masses.iter().sum::<f64>()).sqrt()
}
