//! What can touch, as it is given. It never changes.
//!
//! Points are the particles of all cloths, then the points of all colliders. They are joined to edges and triangles; a
//! sphere is a lone point with a radius, a capsule a lone edge.

use boucle_geometry::Vector;

use crate::cloth::{Cloth, placed};
use crate::collider::{Collider, Shape};
use crate::collision::Collision;
use crate::material::SpringKind;

use super::candidate::{Candidate, Kind};
use super::cut::MOST;
use super::easing::Easing;
use super::enclosure;
use super::exclusion::Exclusion;
use super::features::Features;
use super::sewn::Sewn;

/// How far points may stray, as a part of the mean edge: with more, all that lies near each other at rest is watched.
const SLACK: f64 = 0.25;

/// The same (m) at the least: some times the gap that must be left.
const LEAST_SLACK: f64 = 4.0 * MOST;

/// What a cloth or a collider is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body {
    /// How far (m) it reaches around its features: nothing may come in there.
    pub(super) radius: f64,
    /// What is kept free (m) around that.
    pub(super) thickness: f64,
    /// How far (m) its points may stray from where they are expected before they are looked at again.
    pub(super) slack: f64,
    pub(super) friction: f64,
    /// 1 if it is a closed mesh whose faces are seen from outside, -1 if from inside, 0 if it is none.
    pub(super) facing: f64,
    /// Whether it collides with itself.
    pub(super) with_self: bool,
}

/// A plane: the space behind it is filled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// Its points: one of the plane, and one in front of it.
    pub(super) points: [u32; 2],
}

/// All that can touch.
#[derive(Debug)]
pub(super) struct Bodies {
    /// Cloths, then colliders.
    pub(super) each: Vec<Body>,
    pub(super) body_of: Vec<u32>,
    /// Points that move by themselves; the others are colliders'.
    pub(super) particle_count: usize,
    pub(super) cloths: Features,
    pub(super) colliders: Features,
    pub(super) planes: Vec<Plane>,
    /// Particles at rest (m), and colliders' points at the first frame.
    pub(super) rest: Vec<Vector>,
    /// By which factor edges at each point are shorter than at rest; empty while none are.
    pub(super) scales: Vec<f64>,
    /// Vertices that count as one.
    sewn: Sewn,
    /// For pairs of a cloth that is thick for its edges.
    pub(super) easing: Option<Easing>,
    /// What does not collide with its own cloth, and with colliders.
    excluded: [Exclusion; 2],
    /// For each cloth, which colliders it meets.
    meets: Vec<Vec<bool>>,
    /// For each cloth, which cloths it meets.
    meets_cloths: Vec<Vec<bool>>,
    /// Whether everything may touch everything.
    all_touch: bool,
}

impl Bodies {
    pub(super) fn new(cloths: &[Cloth], colliders: &[Collider]) -> Self {
        let particle_count = cloths.iter().map(|cloth| cloth.positions.len()).sum();
        let mut bodies = Self {
            each: Vec::new(),
            body_of: Vec::new(),
            particle_count,
            cloths: Features::default(),
            colliders: Features::default(),
            planes: Vec::new(),
            rest: Vec::new(),
            scales: Vec::new(),
            sewn: Sewn::new(cloths),
            easing: None,
            excluded: [(); 2].map(|()| Exclusion::new(particle_count)),
            meets: Vec::new(),
            meets_cloths: Vec::new(),
            all_touch: true,
        };
        bodies.pair(cloths);
        for (cloth, base) in placed(cloths) {
            bodies.add_cloth(cloth, base, colliders.len());
        }
        for collider in colliders {
            bodies.add_collider(collider);
        }
        bodies.all_touch &= bodies.sewn.is_empty();
        bodies.easing = Easing::of(&bodies);
        bodies
    }

    fn add_cloth(&mut self, cloth: &Cloth, base: u32, collider_count: usize) {
        let body = self.each.len() as u32;
        self.rest.extend_from_slice(cloth.rest());
        self.body_of.resize(self.rest.len(), body);
        let nothing =
            Collision { with_self: false, colliders: Some(Vec::new()), ..Collision::default() };
        let collision = cloth.collision.as_ref().unwrap_or(&nothing);
        self.each.push(Body {
            radius: 0.0,
            thickness: collision.thickness,
            slack: collision.thickness.min(SLACK * mean_edge_length(cloth)).max(LEAST_SLACK),
            friction: collision.friction,
            facing: 0.0,
            with_self: collision.with_self,
        });
        let lists = [&collision.excluded_from_self, &collision.excluded_from_colliders];
        for (excluded, vertices) in self.excluded.iter_mut().zip(lists) {
            if !vertices.is_empty() {
                excluded.add(&cloth.mesh, base, vertices);
            }
        }
        let mut meets = vec![collision.colliders.is_none(); collider_count];
        for &collider in collision.colliders.iter().flatten() {
            meets[collider as usize] = true;
        }
        self.all_touch &= collision.with_self
            && !meets.contains(&false)
            && collision.excluded_from_self.is_empty()
            && collision.excluded_from_colliders.is_empty();
        let mut pairs = self.meets_cloths[body as usize].iter().enumerate();
        let meets_another = pairs.any(|(other, meets)| *meets && other != body as usize);
        let meets_any = collision.with_self || meets_another || meets.contains(&true);
        self.meets.push(meets);
        if cloth.collision.is_some() && meets_any {
            self.cloths.add_mesh(&cloth.mesh, base);
        }
    }

    /// Notes which cloths meet: those that name each other, or do not choose.
    fn pair(&mut self, cloths: &[Cloth]) {
        let names = |one: usize, other: usize| {
            let chosen = cloths[one].collision.as_ref().and_then(|chosen| chosen.cloths.as_ref());
            one == other || chosen.is_none_or(|chosen| chosen.contains(&(other as u32)))
        };
        let each = 0..cloths.len();
        let of = |one| each.clone().map(move |other| names(one, other) && names(other, one));
        self.meets_cloths = each.clone().map(|one| of(one).collect()).collect();
        self.all_touch &= !self.meets_cloths.iter().flatten().any(|meets| !meets);
    }

    fn add_collider(&mut self, collider: &Collider) {
        let (body, base) = (self.each.len() as u32, self.rest.len() as u32);
        self.rest.extend_from_slice(&collider.positions);
        self.body_of.resize(self.rest.len(), body);
        let facing = match &collider.shape {
            Shape::Mesh(mesh) => enclosure::facing(mesh, &collider.positions),
            _ => 0.0,
        };
        self.each.push(Body {
            facing,
            radius: collider.shape.radius(),
            thickness: collider.thickness,
            slack: 0.0,
            friction: collider.friction,
            with_self: false,
        });
        match &collider.shape {
            Shape::Plane => self.planes.push(Plane { points: [base, base + 1] }),
            Shape::Sphere { .. } => self.colliders.add_point(base),
            Shape::Capsule { .. } => self.colliders.add_edge([base, base + 1]),
            Shape::Mesh(mesh) => self.colliders.add_mesh(mesh, base),
        }
    }

    pub(super) fn cloth_count(&self) -> usize {
        self.meets.len()
    }

    /// Whether anything can touch at all.
    pub(super) fn is_empty(&self) -> bool {
        self.cloths.triangles.is_empty()
    }

    pub(super) fn is_particle(&self, point: u32) -> bool {
        (point as usize) < self.particle_count
    }

    pub(super) fn body(&self, point: u32) -> &Body {
        &self.each[self.body_of[point as usize] as usize]
    }

    /// Whether two features may touch; the first is one of a cloth.
    #[inline]
    pub(super) fn may_touch(&self, first: &[u32], second: &[u32]) -> bool {
        self.all_touch || self.touch(first, second)
    }

    /// The same for the features of a candidate, in any order.
    #[inline]
    pub(super) fn candidate_may_touch(&self, candidate: &Candidate) -> bool {
        let (first, second) = candidate.points.split_at(candidate.split());
        if self.is_particle(first[0]) {
            self.may_touch(first, second)
        } else {
            self.may_touch(second, first)
        }
    }

    fn touch(&self, first: &[u32], second: &[u32]) -> bool {
        let [one, other] = [first[0], second[0]].map(|point| self.body_of[point as usize]);
        let (kind, meet) = match (other as usize).checked_sub(self.meets.len()) {
            Some(collider) => (1, self.meets[one as usize][collider]),
            None if self.sewn.joins(first, second) => return false,
            None if one == other => (0, self.each[one as usize].with_self),
            None => return self.meets_cloths[one as usize][other as usize],
        };
        meet && self.excluded[kind].keeps(first) && self.excluded[kind].keeps(second)
    }

    /// How far apart (m) the features of a candidate of one cloth are at rest, as it is shrunk now.
    #[inline]
    pub(super) fn rest_distance(&self, candidate: &Candidate) -> f64 {
        let rest = candidate.closest(|point| self.rest[point as usize]).offset.norm();
        if self.scales.is_empty() {
            return rest;
        }
        let scales = candidate.points.iter().map(|&point| self.scales[point as usize]);
        rest * scales.fold(1.0, f64::min)
    }

    /// Whether a candidate speaks for the features that are closest, among those that may touch.
    pub(super) fn speaks_for(&self, candidate: &Candidate, feature: u8) -> bool {
        if self.all_touch {
            return candidate.speaks_for(feature);
        }
        let [one, other] =
            [candidate.points[0], candidate.points[3]].map(|point| self.body_of[point as usize]);
        let speaker = match candidate.kind {
            Kind::PointTriangle => &candidate.points[1..],
            Kind::EdgeEdge => &candidate.points[..2],
        };
        let is_among_colliders = (one.max(other) as usize) >= self.meets.len();
        let owned = match (one == other, is_among_colliders) {
            (true, _) => self.excluded[0].owned(speaker),
            (false, true) => self.excluded[1].owned(speaker),
            (false, false) => None,
        };
        match owned {
            Some(owned) => candidate.speaking_for(owned).speaks_for(feature),
            None => candidate.speaks_for(feature),
        }
    }
}

/// Of the springs along edges (m); without any, infinite.
fn mean_edge_length(cloth: &Cloth) -> f64 {
    let edges = cloth.springs.iter().filter(|spring| spring.kind == SpringKind::Stretch);
    let [count, sum] =
        edges.fold([0.0, 0.0], |[count, sum], spring| [count + 1.0, sum + spring.rest_length]);
    if count > 0.0 { sum / count } else { f64::INFINITY }
}
