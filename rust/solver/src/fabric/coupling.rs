//! What pairs of a fabric's particles have to do with each other.
//!
//! **In the constant matrix of an implicit step**, one number, the same in all directions. A triangle's tangent is at most,
//! with the stiffest of what acts along each yarn,
//!
//! ```text
//! A ((Y_warp + G) dw dwᵀ + (Y_weft + G) df dfᵀ)
//! ```
//!
//! whose entries off the diagonal are the opposite of the weights. Those of obtuse angles would be negative: they count as 0.
//!
//! **In the tangent**, the part S + T of the triangles beside an edge, S symmetric and T d = t x d; and, where smoothing works
//! with it, a number c for the hinges near by, as if each were alone and resisted in all directions: `-k w_i w_j` of each pair
//! of its corners, whose heights count `w_i` in its angle. So the wings of a hinge are a pair as well.
//!
//! **In the factored Hessian**, which knows no wings, hinges resist at most as the pairs with positive c do together: those that
//! pull apart, the ends of the edge and the wings, are left out.

use pulp::Simd;

use super::compliance::Compliance;
use super::elements::Hinge;
use super::membrane::{MembraneLaw, Triangle};
use super::triangles::SIDE;
use crate::grouped::Grouped;
use crate::linear::{Block, Link};

/// Numbers of an edge: those of the sides, and c.
pub(super) const EDGE: usize = SIDE + 1;

/// The pairs of all fabrics, the smaller particle first.
#[derive(Debug, Default)]
pub(super) struct Couplings {
    /// Sides of triangles.
    pub(super) edges: Vec<[u32; 2]>,
    /// Of each edge, the sides that lie on it: three times the triangle's number, and which of its sides.
    pub(super) sides: Grouped<u32>,
    /// Wings of hinges that are no edge.
    pub(super) wings: Vec<[u32; 2]>,
    /// Of each hinge, its pairs and their `-w_i w_j` (1/m²); wings are numbered after the edges.
    of_hinges: Vec<[(u32, f64); 6]>,
    /// Of each pair: stiffness c (N/m) and damping (N·s/m) of hinges that are alone.
    pub(super) bends: Vec<[f64; 2]>,
    /// Of each edge, the same bounded from above.
    pub(super) most_bends: Vec<[f64; 2]>,
}

impl Couplings {
    pub(super) fn new(triangles: &[Triangle], hinges: &[Hinge]) -> Self {
        let sorted = |a: u32, b: u32| [a.min(b), a.max(b)];
        let side = |number: usize| {
            let corners = triangles[number / 3].corners;
            sorted(corners[number % 3], corners[(number + 1) % 3])
        };
        let mut edges: Vec<[u32; 2]> = (0..3 * triangles.len()).map(side).collect();
        edges.sort_unstable();
        edges.dedup();
        let edge_of = |pair: [u32; 2]| edges.binary_search(&pair);
        let on_edges = (0..3 * triangles.len()).filter_map(|number| {
            edge_of(side(number)).ok().map(|edge| (edge as u32, number as u32))
        });
        let sides = Grouped::new(edges.len(), on_edges);
        let pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
        let ends = |one: &Hinge, (i, j): (usize, usize)| sorted(one.corners[i], one.corners[j]);
        let mut wings: Vec<[u32; 2]> = hinges.iter().map(|one| ends(one, (2, 3))).collect();
        wings.retain(|pair| edge_of(*pair).is_err());
        wings.sort_unstable();
        wings.dedup();
        let of_hinges = hinges.iter().map(|one| {
            pairs.map(|(i, j)| {
                let pair = ends(one, (i, j));
                let number = edge_of(pair)
                    .unwrap_or_else(|_| edges.len() + wings.partition_point(|own| *own < pair));
                (number as u32, -one.weights[i] * one.weights[j])
            })
        });
        let of_hinges = of_hinges.collect();
        let bends = vec![[0.0; 2]; edges.len() + wings.len()];
        let most_bends = vec![[0.0; 2]; edges.len()];
        Self { edges, sides, wings, of_hinges, bends, most_bends }
    }

    /// The weight (N/m) of each edge in the constant matrix, in order, and what of it damps (N·s/m).
    pub(super) fn weights(
        &self,
        triangles: &[Triangle],
        laws: &[MembraneLaw],
    ) -> Vec<([u32; 2], [f64; 2])> {
        let weight = |side: &u32| {
            let [number, i] = [side / 3, side % 3].map(|part| part as usize);
            let triangle = &triangles[number];
            let law = &laws[triangle.law as usize];
            let [stretch, shear] = law.times;
            let products = triangle.gradients.map(|of| -triangle.area * of[i] * of[(i + 1) % 3]);
            let along = |stiffness: [f64; 2], shear: f64| {
                let sum: f64 = products.iter().zip(stiffness).map(|(p, of)| p * (of + shear)).sum();
                sum.max(0.0)
            };
            let stiffness = along(law.stretch, law.shear);
            let damping = along(law.stretch.map(|of| stretch * of), shear * law.shear);
            [stiffness, damping]
        };
        let sum = |edge: usize| {
            let own = self.sides.of(edge).iter().map(weight);
            own.fold([0.0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]])
        };
        self.edges.iter().enumerate().map(|(edge, pair)| (*pair, sum(edge))).collect()
    }

    /// Takes the stiffness of hinges that are alone, and the times (s) by which laws multiply it to damp.
    pub(super) fn follow(&mut self, hinges: &[Hinge], compliance: &Compliance, times: &[f64]) {
        self.bends.fill([0.0; 2]);
        self.most_bends.fill([0.0; 2]);
        for (number, (one, pairs)) in hinges.iter().zip(&self.of_hinges).enumerate() {
            let stiffness = compliance.stiffness_alone(number);
            let add = |[c, damping]: &mut [f64; 2], weight: f64| {
                *c += stiffness * weight;
                *damping += times[one.law as usize] * stiffness * weight;
            };
            for &(pair, weight) in pairs {
                add(&mut self.bends[pair as usize], weight);
                if let Some(most) = self.most_bends.get_mut(pair as usize) {
                    add(most, weight.max(0.0));
                }
            }
        }
    }
}

/// An edge: S, t and c. With `BENDS`, c counts.
pub(super) struct EdgeLink<const BENDS: bool>;

impl<const BENDS: bool> Link<EDGE> for EdgeLink<BENDS> {
    #[inline(always)]
    fn pull<S: Simd>(
        simd: S,
        [xx, yx, yy, zx, zy, zz, tx, ty, tz, c]: [S::f32s; EDGE],
        [dx, dy, dz]: [S::f32s; 3],
    ) -> [[S::f32s; 3]; 2] {
        let times = |a, b| simd.mul_f32s(a, b);
        let plus = |a, b| simd.add_f32s(a, b);
        let minus = |a, b| simd.sub_f32s(a, b);
        let mut even = [
            plus(plus(times(xx, dx), times(yx, dy)), times(zx, dz)),
            plus(plus(times(yx, dx), times(yy, dy)), times(zy, dz)),
            plus(plus(times(zx, dx), times(zy, dy)), times(zz, dz)),
        ];
        if BENDS {
            for (even, d) in even.iter_mut().zip([dx, dy, dz]) {
                *even = plus(*even, times(c, d));
            }
        }
        let odd = [
            minus(times(ty, dz), times(tz, dy)),
            minus(times(tz, dx), times(tx, dz)),
            minus(times(tx, dy), times(ty, dx)),
        ];
        let [x, y, z] = even;
        let [ox, oy, oz] = odd;
        [[plus(x, ox), plus(y, oy), plus(z, oz)], [minus(x, ox), minus(y, oy), minus(z, oz)]]
    }
}

impl Block<EDGE> for EdgeLink<true> {
    #[inline(always)]
    fn block([xx, yx, yy, zx, zy, zz, _, _, _, c]: [f32; EDGE]) -> [f32; 6] {
        [xx + c, yx, yy + c, zx, zy, zz + c]
    }

    #[inline(always)]
    fn turned([xx, yx, yy, zx, zy, zz, tx, ty, tz, c]: [f32; EDGE]) -> [f32; EDGE] {
        [xx, yx, yy, zx, zy, zz, -tx, -ty, -tz, c]
    }
}

/// The wings of hinges: c.
pub(super) struct WingLink;

impl Link<1> for WingLink {
    #[inline(always)]
    fn pull<S: Simd>(simd: S, [c]: [S::f32s; 1], [dx, dy, dz]: [S::f32s; 3]) -> [[S::f32s; 3]; 2] {
        [[simd.mul_f32s(c, dx), simd.mul_f32s(c, dy), simd.mul_f32s(c, dz)]; 2]
    }
}

impl Block<1> for WingLink {
    #[inline(always)]
    fn block([c]: [f32; 1]) -> [f32; 6] {
        [c, 0.0, c, 0.0, 0.0, c]
    }

    #[inline(always)]
    fn turned(numbers: [f32; 1]) -> [f32; 1] {
        numbers
    }
}
