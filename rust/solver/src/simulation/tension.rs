//! How hard a cloth is pulled at each vertex.

use super::Simulation;
use crate::certificate::length;
use crate::law::Spring;
use crate::law::spring::Law;
use crate::material::SpringKind;

impl Simulation {
    /// The largest tension (N) at each vertex of a cloth, 0 where all is slack: the pull of its stretch and shear springs
    /// without their damping, and of an edge that an implicit step holds at its allowed length also what holds it there.
    /// What a limiter corrects after a step has no force and does not count. Of fabric, the largest stress of the triangles at a
    /// vertex, over a width as that of their sides.
    #[must_use]
    pub fn vertex_tension(&self, cloth: usize) -> Vec<f32> {
        let base = self.bases[cloth];
        let particles = self.particles(cloth);
        let mut tension = vec![0.0_f64; self.cloths[cloth].positions.len()];
        for (corners, pull) in self.system.fabrics.tensions(cloth, &self.state) {
            for corner in corners {
                let most = &mut tension[(corner - base) as usize];
                *most = most.max(pull);
            }
        }
        let cloth = &self.cloths[cloth];
        let law = Law::of(cloth);
        let is_ours = |(ends, _): &([u32; 2], f64)| particles.contains(&(ends[0] as usize));
        let mut held = self.method.held_edges().filter(is_ours);
        let mut next = held.next();
        let counts =
            |spring: &&Spring| matches!(spring.kind, SpringKind::Stretch | SpringKind::Shear);
        for spring in cloth.springs.iter().filter(counts) {
            let ratio = length(&self.state, spring.ends, base) / spring.rest_length;
            let stiffness = law.stiffness_at(spring.stiffness, ratio);
            let mut pull = stiffness * (ratio - 1.0) * spring.rest_length;
            if let Some((ends, force)) = next
                && spring.kind == SpringKind::Stretch
                && ends == spring.ends.map(|end| base + end)
            {
                pull += force;
                next = held.next();
            }
            for end in spring.ends {
                let most = &mut tension[end as usize];
                *most = most.max(pull);
            }
        }
        tension.into_iter().map(|tension| tension as f32).collect()
    }
}
