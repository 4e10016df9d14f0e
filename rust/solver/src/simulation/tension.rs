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
        let mut tension = vec![0.0_f64; self.cloths[cloth].positions.len()];
        for (corners, pull) in self.system.fabrics.tensions(cloth, &self.state) {
            for corner in corners {
                let most = &mut tension[(corner - base) as usize];
                *most = most.max(pull);
            }
        }
        for (spring, pull) in self.pulls(cloth) {
            for end in spring.ends {
                let most = &mut tension[end as usize];
                *most = most.max(pull);
            }
        }
        tension.into_iter().map(|tension| tension as f32).collect()
    }

    /// The tension (N) of each stretch and shear spring of a cloth, as [`Self::vertex_tension`] has it.
    fn pulls(&self, cloth: usize) -> impl Iterator<Item = (&Spring, f64)> {
        let (base, particles) = (self.bases[cloth], self.particles(cloth));
        let cloth = &self.cloths[cloth];
        let law = Law::of(cloth);
        let is_ours = move |(ends, _): &([u32; 2], f64)| particles.contains(&(ends[0] as usize));
        let mut held = self.method.held_edges().filter(is_ours);
        let mut next = held.next();
        let counts =
            |spring: &&Spring| matches!(spring.kind, SpringKind::Stretch | SpringKind::Shear);
        cloth.springs.iter().filter(counts).map(move |spring| {
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
            (spring, pull)
        })
    }

    /// The edges of a cloth's faces: their ends, tension (N) and strain. Of fabric, the tension is the largest stress along the edge of
    /// the triangles beside it, over a width as that of their sides, if nothing else holds it.
    pub(super) fn edge_loads(&self, cloth: usize) -> Vec<([u32; 2], f64, f64)> {
        let base = self.bases[cloth];
        let stretch = self.pulls(cloth).filter(|(spring, _)| spring.kind == SpringKind::Stretch);
        let mut loads: Vec<([u32; 2], f64, f64)> = stretch
            .map(|(spring, pull)| {
                let ratio = length(&self.state, spring.ends, base) / spring.rest_length;
                (spring.ends, pull, ratio - 1.0)
            })
            .collect();
        // Stretch springs are sorted by their ends.
        for (ends, pull) in self.system.fabrics.side_tensions(cloth, &self.state) {
            let ends = ends.map(|end| end - base);
            if let Ok(place) = loads.binary_search_by_key(&ends, |load| load.0) {
                loads[place].1 = loads[place].1.max(pull);
            }
        }
        loads
    }
}
