//! What tears at the end of a frame.

use boucle_geometry::Vector;

use super::Simulation;
use super::parting::ATTEMPTS;
use crate::cloth::{Cloth, placed};
use crate::material::SpringKind;
use crate::tear::{Fan, Split, Tear};

/// How often tears are tried that find no room, each time without those that are stuck.
const ROUNDS: usize = 4;

/// What of a cloth is to part: edges by number as given, with their ends, and seams.
#[derive(Default)]
struct Breaking {
    edges: Vec<(u32, [u32; 2])>,
    seams: Vec<u32>,
}

impl Breaking {
    /// Leaves out the edges at some vertices as given, which are sorted.
    fn wait(&mut self, stuck: &[u32]) {
        self.edges.retain(|(_, ends)| ends.iter().all(|end| stuck.binary_search(end).is_err()));
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

    /// Tears what must tear at the end of a frame, and says whether anything has; intersections are then counted. What has no room
    /// for two sides in crumpled cloth waits for the next frame.
    pub(super) fn tear(&mut self) -> bool {
        let mut breaking: Vec<Breaking> =
            (0..self.cloths.len()).map(|cloth| self.breaking(cloth)).collect();
        for _ in 0..ROUNDS {
            let splits = self.splits.clone();
            if !self.split(&breaking) {
                return false;
            }
            let (whole, stuck) = self.follow_tears();
            let Some(stuck) = stuck else {
                self.good.clone_from(&self.state);
                self.good_memory = self.method.memory().cloned();
                return true;
            };
            *self = Self { splits, ..whole };
            for (breaking, stuck) in breaking.iter_mut().zip(&stuck) {
                breaking.wait(stuck);
            }
        }
        false
    }

    /// What of a cloth is to part.
    fn breaking(&self, cloth: usize) -> Breaking {
        let tear = self.cloths[cloth].tear.as_ref();
        let begun = tear.filter(|tear| tear.start.is_none_or(|start| start <= self.frame));
        let (Some(tear), Some(split)) = (begun, &self.splits[cloth]) else {
            return Breaking::default();
        };
        let edges = self.broken_edges(cloth, tear);
        let edges = edges.into_iter().map(|edge| (edge, split.ends(edge))).collect();
        Breaking { edges, seams: self.broken_seams(cloth, tear) }
    }

    /// Splits cloths, and says whether that changes any.
    fn split(&mut self, breaking: &[Breaking]) -> bool {
        let mut has_torn = false;
        for (split, Breaking { edges, seams }) in self.splits.iter_mut().zip(breaking) {
            let Some(split) = split else { continue };
            for &(edge, _) in edges {
                has_torn |= split.tear(edge);
            }
            for &seam in seams {
                split.undo(seam);
            }
            has_torn |= !seams.is_empty();
        }
        has_torn
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

    /// Goes on with the cloths as they are torn now. Returns what it was; and where they pass through something that they did not
    /// pass through before: of each cloth, the vertices as given.
    fn follow_tears(&mut self) -> (Self, Option<Vec<Vec<u32>>>) {
        let (cloths, from) = self.pieces();
        let before: Vec<usize> = self.cloths.iter().map(|cloth| cloth.positions.len()).collect();
        let was_tangled = self.intersections.is_some_and(|count| count > 0);
        let whole = self.become_cloths(cloths, &from);
        let parted = before.into_iter().enumerate();
        let parted = parted.flat_map(|(cloth, before)| self.parted(cloth, before)).collect();
        let is_free = self.draw_apart(parted, if was_tangled { 0 } else { ATTEMPTS });
        if was_tangled || is_free {
            return (whole, None);
        }
        let stuck = (0..self.cloths.len()).map(|cloth| {
            let mut stuck = self.stuck(cloth);
            for particle in &mut stuck {
                let vertex = *particle - self.bases[cloth];
                *particle = self.cloths[cloth].as_given(vertex).unwrap_or(vertex);
            }
            stuck.sort_unstable();
            stuck
        });
        let stuck = stuck.collect();
        (whole, Some(stuck))
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
}
