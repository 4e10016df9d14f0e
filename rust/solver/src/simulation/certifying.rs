//! Certificates of the present state.

use std::ops::Range;

use super::Simulation;
use crate::certificate::{Certificate, certify};

impl Simulation {
    /// The certificate of the present state.
    #[must_use]
    pub fn certificate(&self) -> Certificate {
        self.certificate_of(0..self.cloths.len())
    }

    /// The certificate of some cloths: strain, energies and hash are theirs, all else is the whole simulation's.
    #[must_use]
    pub fn certificate_of(&self, cloths: Range<usize>) -> Certificate {
        let of_pressure = self.system.air.pressures.energy(cloths.clone(), &self.state);
        let goals = &self.system.goals;
        let of_goals: f64 =
            cloths.clone().map(|cloth| goals.energy(self.particles(cloth), &self.state)).sum();
        let of_fabrics = self.system.fabrics.energy(cloths.clone(), &self.state);
        let of_water = self.system.air.sea.as_ref().map_or(0.0, |sea| {
            cloths.clone().map(|cloth| sea.energy(self.particles(cloth), &self.state)).sum()
        });
        let cloths = self.cloths[cloths.clone()].iter().zip(self.bases[cloths].iter().copied());
        let certificate =
            certify(cloths, &self.state, &self.system, self.frame, self.substeps_taken);
        Certificate {
            potential_energy: certificate.potential_energy
                + of_pressure
                + of_goals
                + of_fabrics
                + of_water,
            iterations: self.iterations_taken,
            intersections: self.intersections,
            clipped: self.clipped,
            contacts: self.contacts.count(),
            ..certificate
        }
    }
}
