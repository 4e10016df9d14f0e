//! How hard a cloth is pulled at each vertex.

use super::Simulation;
use crate::certificate::length;
use crate::law::Spring;
use crate::law::spring::Law;
use crate::material::{SpringKind, StiffnessFrom};
use crate::tear::{Carried, Load};

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
        let pulls = self.pulls(cloth).filter(|(spring, _)| spring.kind != SpringKind::Bend);
        for (spring, pull) in pulls {
            for end in spring.ends {
                let most = &mut tension[end as usize];
                *most = most.max(pull);
            }
        }
        tension.into_iter().map(|tension| tension as f32).collect()
    }

    /// The tension (N) of each stretch, shear and bend spring of a cloth, as [`Self::vertex_tension`] has it.
    fn pulls(&self, cloth: usize) -> impl Iterator<Item = (&Spring, f64)> {
        let (base, particles) = (self.bases[cloth], self.particles(cloth));
        let cloth = &self.cloths[cloth];
        let law = Law::of(cloth);
        let is_ours = move |(ends, _): &([u32; 2], f64)| particles.contains(&(ends[0] as usize));
        let mut held = self.method.held_edges().filter(is_ours);
        let mut next = held.next();
        let counts = |spring: &&Spring| spring.kind != SpringKind::Sewing;
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

    /// How the edges of a cloth's faces are loaded, sorted by their ends: by their own springs and their part of those beside them.
    /// Of fabric, the stress is the largest along the edge of the triangles beside it, and the tension that over a width as that of
    /// their sides, if nothing else holds it.
    pub(super) fn edge_loads(&self, cloth: usize) -> Vec<Load> {
        let (base, own, positions) =
            (self.bases[cloth], &self.cloths[cloth], self.positions(cloth));
        let carried = Carried::new(&own.mesh, own.rest(), &positions, self.pulls(cloth)).tensions();
        let stretch = own.springs.iter().filter(|spring| spring.kind == SpringKind::Stretch);
        // Stretch springs are sorted by their ends.
        let mut loads: Vec<Load> = stretch
            .zip(carried)
            .zip(self.edge_widths(cloth))
            .map(|((spring, tension), width)| {
                let ratio = length(&self.state, spring.ends, base) / spring.rest_length;
                Load {
                    ends: spring.ends,
                    tension,
                    strain: ratio - 1.0,
                    stress: tension / width.max(f64::MIN_POSITIVE),
                }
            })
            .collect();
        for (ends, stress, width) in self.system.fabrics.side_stresses(cloth, &self.state) {
            let ends = ends.map(|end| end - base);
            if let Ok(place) = loads.binary_search_by_key(&ends, |load| load.ends) {
                let load = &mut loads[place];
                load.tension = load.tension.max(stress * width);
                load.stress = load.stress.max(stress);
            }
        }
        loads
    }

    /// The width (m) of cloth that each stretch spring stands for, in their order: of the faces beside the edge, their area over its
    /// length, of which each of two directions of edges has its half in quads. Springs of a membrane at a border are half as stiff as
    /// others and stand for half as much; springs that are all as stiff stand for as much as others.
    fn edge_widths(&self, cloth: usize) -> Vec<f64> {
        let cloth = &self.cloths[cloth];
        let is_alike =
            cloth.fabric.is_none() && cloth.material.stiffness_from == StiffnessFrom::Springs;
        let stretch = || cloth.springs.iter().filter(|spring| spring.kind == SpringKind::Stretch);
        let edges: Vec<[u32; 2]> = stretch().map(|spring| spring.ends).collect();
        let mut sides = vec![(0.0, 0.0); edges.len()];
        for (number, face) in cloth.mesh.faces().enumerate() {
            let area = cloth.mesh.vector_area(number, cloth.rest()).norm();
            let share = area / (face.len() as f64 - 2.0);
            for (&a, &b) in face.iter().zip(face.iter().cycle().skip(1)) {
                if let Ok(place) = edges.binary_search(&[a.min(b), a.max(b)]) {
                    sides[place].0 += share;
                    sides[place].1 += 1.0;
                }
            }
        }
        let widths = stretch().zip(sides).map(|(spring, (area, count))| {
            let whole = if is_alike { 2.0 / f64::max(count, 1.0) } else { 1.0 };
            whole * area / spring.rest_length
        });
        widths.collect()
    }
}
