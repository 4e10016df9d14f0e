//! The cloth that a torn one is.

use boucle_geometry::Vector;

use super::Split;
use crate::cloth::Cloth;
use crate::collision::Collision;
use crate::fabric::edges;
use crate::force::Pressure;
use crate::law::{Spring, springs_of_mesh};
use crate::material::{SpringKind, StiffnessFrom};
use crate::tailoring::{Sewing, Tailoring};

/// What is given for each vertex as given, for each of its pieces, of which those are told; nothing if nothing is.
pub(crate) fn spread<T: Clone>(origins: &[u32], values: &[T]) -> Vec<T> {
    if values.is_empty() {
        return Vec::new();
    }
    origins.iter().map(|&origin| values[origin as usize].clone()).collect()
}

/// All pieces of some vertices as given, in order.
pub(crate) fn pieces(origins: &[u32], vertices: &[u32]) -> Vec<u32> {
    let count = origins.iter().max().map_or(0, |last| *last as usize + 1);
    let mut is_chosen = vec![false; count];
    for &vertex in vertices {
        is_chosen[vertex as usize] = true;
    }
    let pieces = (0..).zip(origins).filter(|(_, origin)| is_chosen[**origin as usize]);
    pieces.map(|(piece, _)| piece).collect()
}

impl Split {
    /// The cloth as it is torn: whatever it was given for a vertex, all of its pieces have; masses are shared by area.
    pub(crate) fn cloth(&self) -> Cloth {
        let given = &self.given;
        let mesh = self.mesh();
        let positions = self.spread(&given.positions);
        let rest_positions = given.tailoring.rest_positions.as_ref().map(|rest| self.spread(rest));
        let rest = rest_positions.as_ref().unwrap_or(&positions);
        let springs = match given.fabric {
            Some(_) => edges(&mesh, rest),
            None => springs_of_mesh(&mesh, rest, &given.material),
        };
        let sewing = self.sewing();
        let springs = self.kept(springs, sewing.as_ref());
        let (pins, pin_weights) = self.pins();
        Cloth {
            name: given.name.clone(),
            masses: self.masses(&mesh),
            springs,
            pins,
            pin_weights,
            pin_material: given.pin_material.clone(),
            material: given.material.clone(),
            fabric: given.fabric.clone(),
            collision: given.collision.as_ref().map(|collision| self.collision(collision)),
            tailoring: Tailoring {
                shrink: self.spread(&given.tailoring.shrink),
                rest_positions,
                sewing,
            },
            pressure: given.pressure.as_ref().map(|pressure| Pressure {
                weights: self.spread(&pressure.weights),
                ..pressure.clone()
            }),
            bulk: given.bulk.clone(),
            tear: given.tear.clone(),
            origins: self.origins.clone(),
            mesh,
            positions,
        }
    }

    fn spread<T: Clone>(&self, values: &[T]) -> Vec<T> {
        spread(&self.origins, values)
    }

    fn pins(&self) -> (Vec<u32>, Vec<f64>) {
        let Cloth { pins, pin_weights, positions, .. } = &*self.given;
        let mut weight_of = vec![None; positions.len()];
        for (i, &pin) in pins.iter().enumerate() {
            weight_of[pin as usize] = Some(pin_weights.get(i).copied().unwrap_or(1.0));
        }
        let pieces = (0..).zip(&self.origins);
        pieces.filter_map(|(piece, &of)| weight_of[of as usize].map(|w| (piece, w))).unzip()
    }

    fn collision(&self, given: &Collision) -> Collision {
        Collision {
            excluded_from_self: pieces(&self.origins, &given.excluded_from_self),
            excluded_from_colliders: pieces(&self.origins, &given.excluded_from_colliders),
            ..given.clone()
        }
    }

    /// The seams that hold; each stays with the pieces that have the old numbers of its ends.
    fn sewing(&self) -> Option<Sewing> {
        let sewing = self.given.tailoring.sewing.as_ref()?;
        let seams = (0..).zip(&sewing.seams);
        let seams = seams.filter(|(number, _)| self.undone.binary_search(number).is_err());
        Some(Sewing { seams: seams.map(|(_, seam)| *seam).collect(), ..sewing.clone() })
    }

    /// Masses (kg): each vertex's, shared among its pieces by the area of their faces.
    fn masses(&self, mesh: &boucle_geometry::Mesh) -> Vec<f64> {
        let mut areas = vec![0.0; self.origins.len()];
        let rest: Vec<Vector> = self.spread(self.given.rest());
        for (face, corners) in mesh.faces().enumerate() {
            let share = mesh.vector_area(face, &rest).norm() / corners.len() as f64;
            for &corner in corners {
                areas[corner as usize] += share;
            }
        }
        let mut sums = vec![0.0; self.given.positions.len()];
        for (area, &origin) in areas.iter().zip(&self.origins) {
            sums[origin as usize] += area;
        }
        let shares = areas.iter().zip(&self.origins);
        shares
            .map(|(area, &origin)| {
                self.given.masses[origin as usize] * (area / sums[origin as usize])
            })
            .collect()
    }

    /// Of the springs of the torn mesh, those that the cloth as given had, as stiff as they were: of a membrane, what an edge
    /// resisted is shared by its two sides. Then the seams that hold.
    fn kept(&self, springs: Vec<Spring>, sewing: Option<&Sewing>) -> Vec<Spring> {
        let key = |spring: &Spring| (spring.kind as u32, spring.ends);
        let mut given: Vec<&Spring> = self.given.springs.iter().collect();
        given.sort_by_key(|spring| key(spring));
        let origin = |ends: [u32; 2]| {
            let [a, b] = ends.map(|end| self.origins[end as usize]);
            [a.min(b), a.max(b)]
        };
        let find = |kind: SpringKind, ends: [u32; 2]| {
            let place = given.binary_search_by_key(&(kind as u32, ends), |spring| key(spring));
            place.ok().map(|place| given[place])
        };
        let copies = self.copies();
        let shares = self.given.material.stiffness_from == StiffnessFrom::Continuum;
        let mut kept: Vec<Spring> = springs
            .into_iter()
            .filter_map(|spring| {
                let ends = origin(spring.ends);
                let old = find(spring.kind, ends)?;
                let edge = self.edge_between(ends).filter(|_| shares);
                let count = edge.map_or(1, |edge| copies[edge as usize].max(1));
                let part = 1.0 / f64::from(count);
                Some(Spring {
                    ends: spring.ends,
                    stiffness: part * old.stiffness,
                    damping: part * old.damping,
                    ..*old
                })
            })
            .collect();
        for seam in sewing.iter().flat_map(|sewing| &sewing.seams) {
            kept.extend(find(SpringKind::Sewing, *seam).copied());
        }
        kept
    }

    /// How many edges each torn edge has become; 0 for the others.
    fn copies(&self) -> Vec<u32> {
        let torn = (0..).zip(&self.sides).filter(|(_, edge)| self.is_torn[**edge as usize]);
        let mut now: Vec<(u32, [u32; 2])> = torn
            .map(|(corner, &edge)| {
                let [a, b] = [self.vertex_of[corner as usize], self.along(corner, edge)];
                (edge, [a.min(b), a.max(b)])
            })
            .collect();
        now.sort_unstable();
        now.dedup();
        let mut copies = vec![0; self.edges.len()];
        for (edge, _) in now {
            copies[edge as usize] += 1;
        }
        copies
    }
}
