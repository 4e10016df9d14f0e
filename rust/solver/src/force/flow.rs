//! What a flow of air or water does to a face.
//!
//! A flow of density rho (kg/m³) comes to a face of unit normal n and area A (m²) with w (m/s), its velocity less the face's.
//! With s = w·n, and t = w - s n what goes along the face:
//!
//! ```text
//! pressure     F = 1/2 rho A Cd |s| s n                                       (N)  without a lift coefficient
//! drag, lift   F = 1/2 rho A [ Cd |s| w + Cl s (|w| n - (s/|w|) w) ]               with one
//! friction     F = 1/2 rho A Cf |t| t                                              besides
//! ```
//!
//! Drag goes with the flow, by the area that the flow sees, `A |s|/|w|`. Lift goes across it, towards the normal that leans with the
//! flow: at an angle of attack a it is `1/2 rho A Cl w² sin a cos a`, none face-on and none edge-on. Pressure is the law of a plate
//! that turns all it meets along its normal; face-on both are `1/2 rho Cd A w²`.
//!
//! An implicit step evaluates the force at its end and has a bound of its slope by w in the matrix, the same in all directions.
//!
//! Sources: Ling, Damodaran & Gay 1996 and Keckeisen et al. 2004 (drag and lift by face); Wilson et al. 2014 (coefficients by
//! which artists fly cloth); Hoerner 1965, Fluid-dynamic drag (plates: Cd 1.17 face-on, Cf by their Reynolds number).

use boucle_geometry::Vector;

use crate::error::{Error, Result};
use crate::material::at_least_zero;

/// The largest coefficient.
const MOST: f64 = 1e3;

/// A fluid, and how it pushes faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flow {
    /// Density (kg/m³).
    pub density: f64,
    /// Drag coefficient Cd.
    pub drag: f64,
    /// Lift coefficient Cl; if `None`, the flow presses along the normal alone.
    pub lift: Option<f64>,
    /// Friction coefficient Cf, of both sides together.
    pub friction: f64,
}

impl Flow {
    /// A fluid of a density (kg/m³) that presses on faces with a drag coefficient of 1, without lift and friction.
    #[must_use]
    pub const fn new(density: f64) -> Self {
        Self { density, drag: 1.0, lift: None, friction: 0.0 }
    }

    /// Refuses values outside their domains; `of` names the fluid.
    pub(super) fn check(&self, of: &str) -> Result<()> {
        at_least_zero(&format!("the density of {of} (kg/m³)"), self.density)?;
        let coefficients = [
            ("drag_coefficient", Some(self.drag)),
            ("lift_coefficient", self.lift),
            ("friction_coefficient", Some(self.friction)),
        ];
        for (name, coefficient) in coefficients {
            let Some(value) = coefficient else { continue };
            if !(0.0..=MOST).contains(&value) {
                let quantity = format!("{of}'s {name}");
                return Err(Error::OutOfDomain { quantity, value, domain: "0 to 1000" });
            }
        }
        Ok(())
    }

    /// The force (N) on an area (m²) of a unit normal to which the flow comes with w (m/s).
    pub(super) fn force(&self, area: f64, w: &Vector, normal: &Vector) -> Vector {
        let speed = w.dot(normal);
        let mut force = match self.lift {
            None => {
                let pressure = 0.5 * self.density * self.drag * speed.abs() * speed;
                area * pressure * normal
            }
            Some(lift) => {
                let size = w.norm().max(f64::MIN_POSITIVE);
                let across = size * normal - (speed / size) * w;
                let stress = self.drag * speed.abs() * w + lift * speed * across;
                area * 0.5 * self.density * stress
            }
        };
        if self.friction > 0.0 {
            let along = w - speed * normal;
            force += area * 0.5 * self.density * self.friction * along.norm() * along;
        }
        force
    }

    /// A bound of the slope (N·s/m) of the force by w, on the same. That of `s |w| n - s²/|w| w` is nowhere above |w|.
    pub(super) fn slope(&self, area: f64, w: &Vector, normal: &Vector) -> f64 {
        let speed = w.dot(normal).abs();
        let along = self.friction * (w - w.dot(normal) * normal).norm();
        let slope = match self.lift {
            None => (self.drag * speed).max(along),
            Some(lift) => {
                let size = w.norm();
                let drag = self.drag * 0.25 * (3.0 * speed + size);
                drag + 0.5 * lift * size + along
            }
        };
        area * self.density * slope
    }

    /// The same at most for a speed (m/s), from whatever side it comes; for each m².
    pub(super) fn most_slope(&self, speed: f64) -> f64 {
        let lift = self.lift.map_or(0.0, |lift| 0.5 * lift);
        self.density * speed * (self.drag + lift + self.friction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scatter::scattered;
    use nalgebra::Matrix3;

    fn vectors() -> impl Iterator<Item = [Vector; 2]> {
        let at = |i: u64| Vector::from_fn(|axis, _| scattered(3 * i + axis as u64));
        (0..2000).map(move |i| [3.0 * at(2 * i), at(2 * i + 1).normalize()])
    }

    fn flows() -> [Flow; 4] {
        let plain = Flow { drag: 1.3, ..Flow::new(1.2) };
        [
            plain,
            Flow { friction: 0.2, ..plain },
            Flow { lift: Some(0.9), ..plain },
            Flow { lift: Some(2.0), drag: 0.0, friction: 0.1, ..plain },
        ]
    }

    /// An inclined plate of 0.5 m² that a flow of 6 m/s meets at an angle of attack: both laws' drag and lift by the books.
    #[test]
    fn drag_and_lift_of_an_inclined_plate_are_those_of_the_closed_forms() {
        for degrees in [0.0, 5.0, 20.0, 45.0, 70.0, 90.0_f64] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let (w, normal) = (Vector::x() * 6.0, Vector::new(sin, 0.0, cos));
            let pressure = 0.5 * 1.2 * 0.5 * 36.0;
            let near = |force: Vector, [drag, lift]: [f64; 2]| {
                let error = (force - Vector::new(drag, 0.0, lift) * pressure).norm();
                assert!(error < 1e-12, "{degrees}: {force:?}");
            };
            let plate = |flow: Flow| flow.force(0.5, &w, &normal);
            let pressing = Flow { drag: 1.17, ..Flow::new(1.2) };
            near(plate(pressing), [1.17 * sin.powi(3), 1.17 * sin * sin * cos]);
            let flying = Flow { lift: Some(0.8), ..pressing };
            near(plate(flying), [1.17 * sin, 0.8 * sin * cos]);
            let rough = Flow { drag: 0.0, friction: 0.01, ..Flow::new(1.2) };
            near(plate(rough), [0.01 * cos * cos * cos, -0.01 * cos * cos * sin]);
            assert!((plate(flying) - flying.force(0.5, &w, &-normal)).norm() < 1e-12);
        }
    }

    /// The slope by central differences: its symmetric part has no eigenvalue above the bound, and face-on reaches it.
    #[test]
    fn the_slope_in_the_matrix_bounds_that_of_the_force() {
        const STEP: f64 = 1e-6;
        let slope = |flow: &Flow, w: &Vector, n: &Vector| {
            let columns = [Vector::x(), Vector::y(), Vector::z()].map(|axis| {
                let [ahead, behind] =
                    [STEP, -STEP].map(|step| flow.force(2.0, &(w + step * axis), n));
                (ahead - behind) / (2.0 * STEP)
            });
            Matrix3::from_columns(&columns)
        };
        for flow in &flows() {
            for [w, n] in vectors() {
                let jacobian = slope(flow, &w, &n);
                let symmetric = 0.5 * (jacobian + jacobian.transpose());
                let largest = symmetric.symmetric_eigenvalues().max();
                let bound = flow.slope(2.0, &w, &n);
                assert!(largest <= bound * (1.0 + 1e-3) + 1e-5, "{flow:?}: {largest} > {bound}");
                assert!(bound <= 2.0 * flow.most_slope(w.norm()) * (1.0 + 1e-12));
            }
            let w = Vector::z() * 4.0;
            let face_on = slope(flow, &w, &Vector::z()).symmetric_eigenvalues().max();
            let only_drag = Flow { lift: None, ..*flow };
            assert!((face_on - only_drag.slope(2.0, &w, &Vector::z())).abs() < 1e-5, "{flow:?}");
        }
    }

    #[test]
    fn what_no_flow_has_is_refused() {
        for (flow, said) in [
            (Flow::new(-1.0), "the density of air (kg/m³) is -1"),
            (Flow { drag: f64::NAN, ..Flow::new(1.2) }, "air's drag_coefficient is NaN"),
            (Flow { lift: Some(2e3), ..Flow::new(1.2) }, "air's lift_coefficient is 2000"),
            (Flow { friction: -0.1, ..Flow::new(1.2) }, "air's friction_coefficient is -0.1"),
        ] {
            let refused = flow.check("air").expect_err("out of its domain").to_string();
            assert!(refused.starts_with(said), "{refused}");
        }
        assert_eq!(Flow::new(1.2).check("air"), Ok(()));
    }
}
