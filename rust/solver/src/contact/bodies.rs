//! What can touch, as it is given: points, and patches of up to three of them. It never changes.
//!
//! Points are the particles of all cloths, then the points of all colliders. A patch is a triangle, or a lone edge or
//! point with a radius. Every point and every edge is owned by one of the patches that share it, so that pairs of
//! patches lead to each pair of a point and a triangle, and of two edges, once.
//!
//! Source: Curtis, Tamstorf & Manocha 2008 for owned features.

use boucle_geometry::{Mesh, Vector};

use crate::cloth::{Cloth, placed};
use crate::collider::{Collider, Shape};
use crate::collision::Collision;

/// Points joined to a triangle, an edge (the last two are the same) or a point (all are).
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    pub(super) points: [u32; 3],
    /// How many of them differ.
    pub(super) size: u8,
    /// Bit i for point i, bit 3 + i for the edge from point i to the next.
    pub(super) owned: u8,
    pub(super) body: u32,
}

/// What a cloth or a collider is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body {
    /// How far (m) it reaches around its patches: nothing may come in there.
    pub(super) radius: f64,
    /// What is kept free (m) around that.
    pub(super) thickness: f64,
    pub(super) friction: f64,
    /// Whether it collides with itself.
    with_self: bool,
}

/// A plane: the space behind it is filled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// Its points: one of the plane, and one in front of it.
    pub(super) points: [u32; 2],
    pub(super) body: u32,
}

/// All that can touch.
#[derive(Debug)]
pub(super) struct Bodies {
    /// Cloths, then colliders.
    pub(super) bodies: Vec<Body>,
    pub(super) body_of: Vec<u32>,
    /// Points that move by themselves; the others are colliders'.
    pub(super) particle_count: usize,
    pub(super) cloth_patches: Vec<Patch>,
    pub(super) collider_patches: Vec<Patch>,
    pub(super) planes: Vec<Plane>,
    /// Particles at rest (m), and colliders' points at the first frame.
    pub(super) rest: Vec<Vector>,
    /// Which vertices do not collide with their own cloth, and with colliders.
    excluded: Vec<[bool; 2]>,
    /// For each cloth, which colliders it meets.
    meets: Vec<Vec<bool>>,
}

impl Bodies {
    pub(super) fn new(cloths: &[Cloth], colliders: &[Collider]) -> Self {
        let particle_count = cloths.iter().map(|cloth| cloth.positions.len()).sum();
        let mut bodies = Self {
            bodies: Vec::new(),
            body_of: Vec::new(),
            particle_count,
            cloth_patches: Vec::new(),
            collider_patches: Vec::new(),
            planes: Vec::new(),
            rest: Vec::new(),
            excluded: vec![[false; 2]; particle_count],
            meets: Vec::new(),
        };
        for (cloth, base) in placed(cloths) {
            bodies.add_cloth(cloth, base, colliders.len());
        }
        for collider in colliders {
            bodies.add_collider(collider);
        }
        bodies
    }

    fn add_cloth(&mut self, cloth: &Cloth, base: u32, collider_count: usize) {
        let body = self.bodies.len() as u32;
        self.rest.extend_from_slice(&cloth.positions);
        self.body_of.resize(self.rest.len(), body);
        let nothing =
            Collision { with_self: false, colliders: Some(Vec::new()), ..Collision::default() };
        let collision = cloth.collision.as_ref().unwrap_or(&nothing);
        self.bodies.push(Body {
            radius: 0.0,
            thickness: collision.thickness,
            friction: collision.friction,
            with_self: collision.with_self,
        });
        for (kind, vertices) in
            [&collision.excluded_from_self, &collision.excluded_from_colliders].iter().enumerate()
        {
            for vertex in *vertices {
                self.excluded[(base + vertex) as usize][kind] = true;
            }
        }
        let mut meets = vec![collision.colliders.is_none(); collider_count];
        for &collider in collision.colliders.iter().flatten() {
            meets[collider as usize] = true;
        }
        self.meets.push(meets);
        if cloth.collision.is_some() {
            self.cloth_patches.extend(triangles(&cloth.mesh, base, body));
        }
    }

    fn add_collider(&mut self, collider: &Collider) {
        let (body, base) = (self.bodies.len() as u32, self.rest.len() as u32);
        self.rest.extend_from_slice(&collider.positions);
        self.body_of.resize(self.rest.len(), body);
        self.bodies.push(Body {
            radius: collider.shape.radius(),
            thickness: collider.thickness,
            friction: collider.friction,
            with_self: false,
        });
        match &collider.shape {
            Shape::Plane => self.planes.push(Plane { points: [base, base + 1], body }),
            Shape::Sphere { .. } => {
                let points = [base; 3];
                self.collider_patches.push(Patch { points, size: 1, owned: 0b1, body });
            }
            Shape::Capsule { .. } => {
                let points = [base, base + 1, base + 1];
                self.collider_patches.push(Patch { points, size: 2, owned: 0b1011, body });
            }
            Shape::Mesh(mesh) => self.collider_patches.extend(triangles(mesh, base, body)),
        }
    }

    /// Whether anything can touch at all.
    pub(super) fn is_empty(&self) -> bool {
        self.cloth_patches.is_empty()
    }

    pub(super) fn is_particle(&self, point: u32) -> bool {
        (point as usize) < self.particle_count
    }

    pub(super) fn body(&self, point: u32) -> &Body {
        &self.bodies[self.body_of[point as usize] as usize]
    }

    /// Whether two bodies collide, of which the first is a cloth.
    pub(super) fn may_touch(&self, cloth: u32, other: u32) -> bool {
        match (other as usize).checked_sub(self.meets.len()) {
            Some(collider) => self.meets[cloth as usize][collider],
            None => cloth != other || self.bodies[cloth as usize].with_self,
        }
    }

    /// Whether a vertex of a cloth may touch another body.
    pub(super) fn is_included(&self, point: u32, cloth: u32, other: u32) -> bool {
        let [from_self, from_colliders] = self.excluded[point as usize];
        if cloth == other {
            !from_self
        } else {
            other < self.meets.len() as u32 || !from_colliders
        }
    }
}

/// The triangles of a mesh as patches: faces as fans around their first corners.
fn triangles(mesh: &Mesh, base: u32, body: u32) -> Vec<Patch> {
    let fans = mesh.faces().flat_map(|corners| {
        let first = corners[0];
        corners[1..].windows(2).map(move |pair| [first, pair[0], pair[1]])
    });
    let mut patches: Vec<Patch> = fans
        .map(|points| Patch {
            points: points.map(|point| base + point),
            size: 3,
            owned: 0,
            body,
        })
        .collect();
    let mut is_owned = vec![false; mesh.vertex_count()];
    let mut edges = Vec::with_capacity(3 * patches.len());
    for (place, patch) in patches.iter_mut().enumerate() {
        for i in 0..3 {
            let [a, b] = [patch.points[i], patch.points[(i + 1) % 3]];
            edges.push(([a.min(b), a.max(b)], place, i));
            let is_owned = &mut is_owned[(a - base) as usize];
            if !*is_owned {
                patch.owned |= 1 << i;
                *is_owned = true;
            }
        }
    }
    edges.sort_unstable();
    edges.dedup_by_key(|&mut (ends, ..)| ends);
    for (_, place, i) in edges {
        patches[place].owned |= 1 << (3 + i);
    }
    patches
}
