//! What tears at the end of a frame.

use boucle_geometry::Vector;

use super::Simulation;
use crate::cloth::{Cloth, placed};
use crate::material::SpringKind;
use crate::state::State;
use crate::tear::{Fan, Split, Tear};

/// By how far (m) both sides of a new tear are moved back from it, so that they are apart; and the most, as a part of the way to
/// the middle of their faces.
const APART: f64 = 5e-5;
const MOST_APART: f64 = 0.02;

/// How many other ways apart are tried where the first leads through something.
const ATTEMPTS: usize = 5;

/// A piece of a vertex that has just parted.
struct Parted {
    particle: usize,
    /// The particles of its faces.
    around: Vec<u32>,
    /// Back from the tear, and away from it to its side of the cloth (m).
    inward: Vector,
    across: Vector,
}

impl Parted {
    /// By how much (m) it moves in each attempt.
    fn way(&self, attempt: usize) -> Vector {
        match attempt {
            0 => self.inward,
            1 => 0.1 * self.inward,
            2 => 0.1 * self.inward + self.across,
            3 => 0.1 * self.inward - self.across,
            4 => 0.01 * self.across,
            _ => -0.01 * self.across,
        }
    }
}

/// An edge that is pulled beyond what it bears.
struct Break {
    /// How far beyond, as a factor.
    excess: f64,
    ends: [u32; 2],
}

impl Simulation {
    /// The vertex of each corner of a cloth's faces, in order. Where nothing is torn, as the mesh was given.
    #[must_use]
    pub fn corners(&self, cloth: usize) -> Vec<u32> {
        self.splits[cloth].as_ref().map_or_else(
            || self.cloths[cloth].mesh.faces().flatten().copied().collect(),
            |split| split.corners().to_vec(),
        )
    }

    /// Positions (m) of the corners of a cloth's faces, in order.
    #[must_use]
    pub fn corner_positions(&self, cloth: usize) -> Vec<Vector> {
        let base = self.bases[cloth];
        let corners = self.corners(cloth).into_iter();
        corners.map(|vertex| self.state.position.get((base + vertex) as usize)).collect()
    }

    /// Of each vertex of a cloth, the one that it was as the cloth was given. Those that tearing has added come after all others.
    #[must_use]
    pub fn origins(&self, cloth: usize) -> Vec<u32> {
        self.splits[cloth].as_ref().map_or_else(
            || (0..self.cloths[cloth].positions.len() as u32).collect(),
            |split| split.origins().to_vec(),
        )
    }

    /// The edges of a cloth that are torn, by their ends as given, in the order in which they tore.
    #[must_use]
    pub fn torn_edges(&self, cloth: usize) -> Vec<[u32; 2]> {
        self.splits[cloth].as_ref().map_or_else(Vec::new, |split| split.torn().collect())
    }

    /// The tension (N) of each edge of a cloth's faces, with its ends: of springs their pull, of fabric the stress along the edge
    /// over a width as that of the triangles beside it.
    #[must_use]
    pub fn edge_tension(&self, cloth: usize) -> Vec<([u32; 2], f64)> {
        self.edge_loads(cloth).into_iter().map(|load| (load.ends, load.tension)).collect()
    }

    /// At each corner of a cloth's faces, the tension (N) of the edge from there to the next corner of the face, as
    /// [`Self::edge_tension`] has it: each side of a tear has its own.
    #[must_use]
    pub fn corner_tension(&self, cloth: usize) -> Vec<f32> {
        let loads = self.edge_loads(cloth);
        let faces = self.cloths[cloth].mesh.faces();
        let sides = faces.flat_map(|face| face.iter().zip(face.iter().cycle().skip(1)));
        let tension = sides.map(|(&a, &b)| {
            let place = loads.binary_search_by_key(&[a.min(b), a.max(b)], |load| load.ends);
            place.map_or(0.0, |place| loads[place].tension as f32)
        });
        tension.collect()
    }

    /// A cloth as it was given, whole.
    #[must_use]
    pub fn given(&self, cloth: usize) -> &Cloth {
        self.splits[cloth].as_ref().map_or(&self.cloths[cloth], |split| split.given())
    }

    /// Tears what must tear at the end of a frame. Where crumpled cloth leaves no room for two sides, it waits for the next.
    pub(super) fn tear(&mut self) {
        let mut has_torn = false;
        let before = self.tears();
        for cloth in 0..self.cloths.len() {
            let tear = self.cloths[cloth].tear.clone();
            if let Some(tear) =
                tear.filter(|tear| tear.start.is_none_or(|start| start <= self.frame))
            {
                let edges = self.broken_edges(cloth, &tear);
                let seams = self.broken_seams(cloth, &tear);
                let Some(split) = &mut self.splits[cloth] else { continue };
                for edge in edges {
                    has_torn |= split.tear(edge);
                }
                for seam in seams {
                    split.undo(seam);
                    has_torn = true;
                }
            }
        }
        if !has_torn {
            return;
        }
        let (saved, shape) = (self.saved(), self.saved_shape());
        let told = (self.clipped, self.iterations_taken);
        if !self.follow_tears() && self.tear_alike(&before).is_some() {
            self.take(saved, shape);
            (self.clipped, self.iterations_taken) = told;
        }
        self.good.clone_from(&self.state);
        self.good_memory = self.method.memory().cloned();
    }

    /// The edges to tear, by number as given: of those that are pulled too hard, the hardest pulled first, one in any
    /// neighborhood, as the others bear less once it has given way. And those whose time has come.
    fn broken_edges(&self, cloth: usize, tear: &Tear) -> Vec<u32> {
        let Some(split) = &self.splits[cloth] else { return Vec::new() };
        let opening = tear.openings.iter().filter(|opening| opening.frame <= self.frame);
        let pairs = opening.flat_map(|opening| &opening.pairs);
        let mut edges: Vec<u32> = pairs.filter_map(|pair| split.edge_between(*pair)).collect();
        edges.retain(|&edge| split.holds(edge));
        let mut broken = self.breaks(cloth, tear, split);
        broken.sort_by(|a, b| b.excess.total_cmp(&a.excess).then(a.ends.cmp(&b.ends)));
        let mut is_busy = vec![false; split.origins().len()];
        for Break { ends, .. } in broken {
            if ends.iter().any(|end| is_busy[*end as usize]) {
                continue;
            }
            let Some((spokes, center)) = self.way_across(cloth, split, ends) else { continue };
            is_busy[center as usize] = true;
            for (edge, end) in spokes {
                edges.push(edge);
                is_busy[end as usize] = true;
            }
            for end in ends {
                is_busy[end as usize] = true;
            }
        }
        edges
    }

    /// The edges that are loaded beyond what they bear.
    fn breaks(&self, cloth: usize, tear: &Tear, split: &Split) -> Vec<Break> {
        if !tear.breaks_edges() {
            return Vec::new();
        }
        let loads = self.edge_loads(cloth).into_iter().filter_map(|load| {
            let given = load.ends.map(|end| split.origins()[end as usize]);
            let edge = split.edge_between(given)?;
            let excess = tear.excess(tear.bears(edge as usize, given), &load);
            (excess > 1.0).then_some(Break { excess, ends: load.ends })
        });
        loads.collect()
    }

    /// Where the cloth parts across an edge: the edges that tear, with their far ends, and at which of its ends. Where a tear ends
    /// already, or the cloth, it parts more easily.
    fn way_across(
        &self,
        cloth: usize,
        split: &Split,
        ends: [u32; 2],
    ) -> Option<(Vec<(u32, u32)>, u32)> {
        let base = self.bases[cloth] as usize;
        let place = |vertex: u32| self.state.position.get(base + vertex as usize);
        let [a, b] = ends;
        let mut sides: Vec<(bool, u32, u32, Fan)> = [(a, b), (b, a)]
            .into_iter()
            .filter(|(center, _)| {
                !split.is_whole(*center) && !self.system.is_pinned(base + *center as usize)
            })
            .filter_map(|(center, to)| {
                let fan = Fan::around(split, split.corner_between(center, to)?);
                Some((fan.is_closed(), center, to, fan))
            })
            .collect();
        sides.sort_by_key(|(is_closed, center, ..)| (*is_closed, *center));
        sides.iter().find_map(|(_, center, to, fan)| {
            Some((fan.across(&place(*center), *to, place)?, *center))
        })
    }

    /// The seams that come undone, by number as given.
    fn broken_seams(&self, cloth: usize, tear: &Tear) -> Vec<u32> {
        let Some(split) = &self.splits[cloth] else { return Vec::new() };
        let seams = split.seams();
        let opening = tear.openings.iter().filter(|opening| opening.frame <= self.frame);
        let mut opening: Vec<[u32; 2]> = opening
            .flat_map(|opening| &opening.pairs)
            .map(|&[a, b]| [a.min(b), a.max(b)])
            .collect();
        opening.sort_unstable();
        let base = self.bases[cloth];
        let own = self.cloths[cloth].springs.iter();
        let held = own.filter(|spring| spring.kind == SpringKind::Sewing);
        let broken = held.filter(|seam| {
            let ends = seam.ends.map(|end| base + end);
            let pull = self.seams.pull(ends, &self.state.position);
            opening.binary_search(&seam.ends).is_ok()
                || tear.seam_force.is_some_and(|force| pull > force)
        });
        // Seams are sorted.
        let numbers = broken.filter_map(|seam| seams.binary_search(&seam.ends).ok());
        numbers.map(|number| number as u32).collect()
    }

    /// Goes on with the cloths as they are torn now, and says whether they pass through nothing that they did not before.
    fn follow_tears(&mut self) -> bool {
        let (cloths, from) = self.pieces();
        let before: Vec<usize> = self.cloths.iter().map(|cloth| cloth.positions.len()).collect();
        let was_tangled = self.intersections.is_some_and(|count| count > 0);
        self.become_cloths(cloths, &from);
        let mut parted: Vec<Parted> = before
            .into_iter()
            .enumerate()
            .flat_map(|(cloth, before)| self.parted(cloth, before))
            .collect();
        self.shift(&parted, |one| one.way(0));
        self.intersect();
        // Crumpled cloth may have no room there, but elsewhere.
        for attempt in 1..=ATTEMPTS {
            if parted.is_empty() || was_tangled || self.intersections.is_none_or(|count| count == 0)
            {
                break;
            }
            let stuck: Vec<u32> =
                (0..self.cloths.len()).flat_map(|cloth| self.stuck(cloth)).collect();
            parted
                .retain(|one| one.around.iter().any(|vertex| stuck.binary_search(vertex).is_ok()));
            self.shift(&parted, |one| one.way(attempt) - one.way(attempt - 1));
            self.intersect();
        }
        was_tangled || self.intersections.is_none_or(|count| count == 0)
    }

    /// The cloths as they are torn, and of each of their particles the one that it has been until now.
    pub(super) fn pieces(&self) -> (Vec<Cloth>, Vec<u32>) {
        let mut from = Vec::new();
        let mut cloths = Vec::new();
        for ((cloth, base), split) in placed(&self.cloths).zip(&self.splits) {
            let Some(split) = split else {
                from.extend((0..cloth.positions.len() as u32).map(|vertex| base + vertex));
                cloths.push(self.as_given(cloths.len()));
                continue;
            };
            // A new vertex comes from where a corner of it was.
            let mut own: Vec<u32> = (0..split.origins().len() as u32).collect();
            let old = cloth.mesh.faces().flatten();
            for (&now, &old) in split.corners().iter().zip(old) {
                own[now as usize] = old;
            }
            from.extend(own.into_iter().map(|vertex| base + vertex));
            cloths.push(split.cloth());
        }
        (cloths, from)
    }

    /// A cloth that does not tear, without what has changed since it was given: that is carried over by itself.
    fn as_given(&self, number: usize) -> Cloth {
        let mut cloth = self.cloths[number].clone();
        if let Some(rest) = &self.rests[number] {
            rest.put_given(&mut cloth);
        }
        self.seams.put_given(number, &mut cloth);
        cloth
    }

    /// What has just parted: vertices beyond so many, and those that they were one with.
    fn parted(&self, cloth: usize, before: usize) -> Vec<Parted> {
        let (own, base) = (&self.cloths[cloth], self.bases[cloth]);
        let count = own.positions.len();
        let Some(split) = self.splits[cloth].as_ref().filter(|_| count > before) else {
            return Vec::new();
        };
        let mut is_new = vec![false; split.origins().len()];
        split.origins()[before..].iter().for_each(|origin| is_new[*origin as usize] = true);
        let places = self.positions(cloth);
        let mut sums = vec![(Vector::zeros(), 0.0, Vec::new()); count];
        let mut normals = vec![Vector::zeros(); count];
        for (number, face) in own.mesh.faces().enumerate() {
            let middle: Vector = face.iter().map(|&vertex| places[vertex as usize]).sum();
            let normal = own.mesh.vector_area(number, &places);
            for &vertex in face {
                let (sum, number, around) = &mut sums[vertex as usize];
                *sum += middle / face.len() as f64;
                *number += 1.0;
                around.extend(face.iter().map(|&vertex| base + vertex));
                normals[split.origins()[vertex as usize] as usize] += normal;
            }
        }
        let moves = (0..count).filter(|&vertex| {
            let particle = base as usize + vertex;
            is_new[split.origins()[vertex] as usize] && !self.system.is_pinned(particle)
        });
        let parted = moves.map(|vertex| {
            let origin = split.origins()[vertex] as usize;
            let (sum, number, around) = &sums[vertex];
            let inward = sum / f64::max(*number, 1.0) - places[vertex];
            let size = APART.min(MOST_APART * inward.norm());
            let side = if vertex == origin { 1.0 } else { -1.0 };
            Parted {
                particle: base as usize + vertex,
                around: around.clone(),
                inward: size * inward.try_normalize(0.0).unwrap_or_else(Vector::zeros),
                across: side
                    * size
                    * normals[origin].try_normalize(0.0).unwrap_or_else(Vector::zeros),
            }
        });
        parted.collect()
    }

    /// The particles of a cloth at which things pass through each other, in order.
    fn stuck(&self, cloth: usize) -> Vec<u32> {
        let counts = self.vertex_intersections(cloth);
        let stuck = (self.bases[cloth]..).zip(counts).filter(|(_, count)| *count > 0.0);
        stuck.map(|(particle, _)| particle).collect()
    }

    /// Moves what has parted (m), as if it had always been there.
    fn shift(&mut self, parted: &[Parted], way: impl Fn(&Parted) -> Vector) {
        let shift = |state: &mut State| {
            for one in parted {
                let moved = state.position.get(one.particle) + way(one);
                state.position.set(one.particle, &moved);
            }
        };
        shift(&mut self.state);
        if let Some(memory) = self.method.memory_mut() {
            shift(&mut memory.before);
        }
    }
}
