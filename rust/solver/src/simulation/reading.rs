//! What a simulation tells of its cloths.

use boucle_geometry::Vector;

use super::Simulation;
use crate::certificate::length;
use crate::law::spring::Law;
use crate::material::SpringKind;
use crate::overstretch::{OverstretchedEdge, overstretched};

impl Simulation {
    /// Positions (m) of a cloth's vertices, world space.
    #[must_use]
    pub fn positions(&self, cloth: usize) -> Vec<Vector> {
        self.particles(cloth).map(|particle| self.state.position.get(particle)).collect()
    }

    /// Velocities (m/s) of a cloth's vertices.
    #[must_use]
    pub fn velocities(&self, cloth: usize) -> Vec<Vector> {
        self.particles(cloth).map(|particle| self.state.velocity.get(particle)).collect()
    }

    /// The largest strain of the edges at each vertex of a cloth.
    #[must_use]
    pub fn vertex_strain(&self, cloth: usize) -> Vec<f32> {
        let (cloth, base) = (&self.cloths[cloth], self.bases[cloth]);
        let mut strain = vec![-1.0_f32; cloth.positions.len()];
        for spring in cloth.springs.iter().filter(|spring| spring.kind == SpringKind::Stretch) {
            let elongation = length(&self.state, spring.ends, base) / spring.rest_length - 1.0;
            for end in spring.ends {
                let most = &mut strain[end as usize];
                *most = most.max(elongation as f32);
            }
        }
        strain
    }

    /// The mesh edges of a cloth that are longer than its deformation rate allows, by more than a tenth of a percent of
    /// their rest length; the worst first. None where no limiter acts ([`Limiter::None`](crate::Limiter::None), or cloth that breaks before it).
    #[must_use]
    pub fn overstretched_edges(&self, cloth: usize) -> Vec<OverstretchedEdge> {
        let is_implicit = self.method.is_implicit();
        overstretched(&self.cloths[cloth], self.bases[cloth], &self.state, is_implicit)
    }

    /// The present stiffness (N/m) of each spring of a cloth: what equation 6 makes of it, if it is the limiter.
    #[must_use]
    pub fn spring_stiffness(&self, cloth: usize) -> Vec<f64> {
        let (cloth, base) = (&self.cloths[cloth], self.bases[cloth]);
        let law = Law::of(cloth);
        let stiffness = cloth.springs.iter().map(|spring| {
            let ratio = length(&self.state, spring.ends, base) / spring.rest_length;
            law.stiffness_at(spring.stiffness, ratio)
        });
        stiffness.collect()
    }
}
