//! The membrane of a fabric: one triangle, whose strain is the same everywhere in it.
//!
//! With the rest triangle in its plane, coordinates w along the warp and f along the weft, and the gradients of its corners'
//! weights there, the positions `x_i` span
//!
//! ```text
//! U = sum dw_i x_i        V = sum df_i x_i                      (what a metre of warp and of weft has become)
//! E_ww = (U·U - 1)/2      E_ff = (V·V - 1)/2      g = U·V       (Green strain; g = 2 E_wf)
//! s_ww = Y E_ww + Y t dE_ww/dt      ...           s_wf = G g + G t dg/dt       (N/m)
//! F_i = -A (dw_i (s_ww U + s_wf V) + df_i (s_wf U + s_ff V))                   (N)
//! ```
//!
//! with the area A at rest and the times t by which damping is proportional to stiffness.
//!
//! The tangent is that of F, less what would not be positive: the stress counts as far as it pulls.
//!
//! ```text
//! K_ij = A [Y a_i a_jᵀ + Y b_i b_jᵀ + G c_i c_jᵀ + (dw_i, df_i) S₊ (dw_j, df_j)ᵀ I]
//! a_i = dw_i U      b_i = df_i V      c_i = dw_i V + df_i U
//! ```
//!
//! Source: Volino, Magnenat-Thalmann & Faure 2009.

use boucle_geometry::Vector;

use super::hinge::{Point, dot, plus, scaled};
use super::material::Fabric;
use crate::law::number::Number;

/// One triangle at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Triangle {
    /// Particles.
    pub(crate) corners: [u32; 3],
    /// Gradients (1/m) of the corners' weights along the warp and along the weft.
    pub(crate) gradients: [[f64; 3]; 2],
    /// m²
    pub(crate) area: f64,
    /// Which of the laws holds.
    pub(crate) law: u32,
}

impl Triangle {
    /// The triangle whose corners are at `flat` (m), in coordinates of warp and weft.
    pub(super) fn new(corners: [u32; 3], flat: [[f64; 2]; 3], law: u32) -> Self {
        let [a, b, c] = flat;
        let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let along =
            |from: [f64; 2], to: [f64; 2]| [(from[1] - to[1]) / twice, (to[0] - from[0]) / twice];
        let each = [along(b, c), along(c, a), along(a, b)];
        let gradients = [0, 1].map(|axis| each.map(|gradient| gradient[axis]));
        Self { corners, gradients, area: 0.5 * twice.abs(), law }
    }

    /// U and V, of positions.
    pub(super) fn frame(&self, of: impl Fn(u32) -> Vector) -> Frame<f64> {
        let [a, b, c] = self.corners.map(of);
        self.gradients.map(|[_, db, dc]| (db * (b - a) + dc * (c - a)).into())
    }
}

/// The numbers of one fabric that triangles share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MembraneLaw {
    pub(crate) stretch: [f64; 2],
    pub(crate) compression: [f64; 2],
    pub(crate) shear: f64,
    /// Damping as a time (s) by which stiffness is multiplied, of stretch and shear.
    pub(crate) times: [f64; 2],
}

/// U and V.
pub(super) type Frame<N> = [Point<N>; 2];

/// What a triangle does in one state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strained<N> {
    pub(super) frame: Frame<N>,
    /// Present stiffness (N/m) along warp and weft: that of tension or of compression.
    pub(super) stiffness: [N; 2],
    /// `E_ww, E_ff, g`.
    pub(super) strain: [N; 3],
    /// `s_ww, s_ff, s_wf` (N/m) without damping.
    pub(super) stress: [N; 3],
}

impl Strained<f64> {
    /// How hard (N/m) it pulls along a way in the plane at rest, as a force over the width at rest across it.
    pub(super) fn pull_along(&self, [w, f]: [f64; 2]) -> f64 {
        let sum = |[along, across]: Frame<f64>| plus(scaled(w, along), scaled(f, across));
        let way = sum(self.frame);
        let squared = dot(way, way) * (w * w + f * f);
        let pull = dot(sum(flows(self.stress, self.frame)), way);
        if squared > 0.0 { pull / squared.sqrt() } else { 0.0 }
    }

    /// J/m²
    pub(super) fn energy(&self) -> f64 {
        0.5 * self
            .stress
            .iter()
            .zip(&self.strain)
            .map(|(stress, strain)| stress * strain)
            .sum::<f64>()
    }
}

impl MembraneLaw {
    pub(super) fn new(fabric: &Fabric, times: [f64; 2]) -> Self {
        let Fabric { stretch, compression, shear, .. } = *fabric;
        Self { stretch, compression, shear, times }
    }

    #[inline(always)]
    pub(super) fn strained<N: Number>(&self, frame: Frame<N>) -> Strained<N> {
        let [u, v] = frame;
        let one = u[0].all(1.0);
        let half = u[0].all(0.5);
        let strain = [half * (dot(u, u) - one), half * (dot(v, v) - one), dot(u, v)];
        let of = |axis: usize| {
            let pressed = one.all(self.compression[axis]);
            pressed.where_positive_or(one.all(0.0) - strain[axis], one.all(self.stretch[axis]))
        };
        let stiffness = [of(0), of(1)];
        let stress =
            [stiffness[0] * strain[0], stiffness[1] * strain[1], one.all(self.shear) * strain[2]];
        Strained { frame, stiffness, strain, stress }
    }

    pub(super) fn is_damped(&self) -> bool {
        self.times.iter().any(|time| *time > 0.0)
    }

    /// `s_ww, s_ff, s_wf` (N/m) with damping, for a frame that changes at `rates` (1/s).
    #[inline(always)]
    pub(super) fn damped<N: Number>(&self, strained: &Strained<N>, rates: Frame<N>) -> [N; 3] {
        let Strained { frame: [u, v], stiffness, stress, .. } = *strained;
        let [du, dv] = rates;
        let all = |value: f64| u[0].all(value);
        let [stretch, shear] = self.times;
        [
            stress[0] + all(stretch) * stiffness[0] * dot(u, du),
            stress[1] + all(stretch) * stiffness[1] * dot(v, dv),
            stress[2] + all(shear * self.shear) * (dot(u, dv) + dot(v, du)),
        ]
    }
}

/// What pulls at the frame: `s_ww U + s_wf V` and `s_wf U + s_ff V`.
#[inline(always)]
pub(super) fn flows<N: Number>([ww, ff, wf]: [N; 3], [u, v]: Frame<N>) -> [Point<N>; 2] {
    [plus(scaled(ww, u), scaled(wf, v)), plus(scaled(wf, u), scaled(ff, v))]
}

/// The largest eigenvalue of a symmetric 2 x 2 matrix: xx, yy, xy.
pub(super) fn largest([xx, yy, xy]: [f64; 3]) -> f64 {
    0.5 * (xx + yy) + (0.5 * (xx - yy)).hypot(xy)
}

/// The positive part of a symmetric 2 x 2 matrix: xx, yy, xy.
#[inline(always)]
pub(super) fn positive_part<N: Number>([xx, yy, xy]: [N; 3]) -> [N; 3] {
    let (zero, half) = (xx.all(0.0), xx.all(0.5));
    let (mean, apart) = (half * (xx + yy), half * (xx - yy));
    let radius = (apart * apart + xy * xy).sqrt();
    let (low, high) = (mean - radius, mean + radius);
    // high times the projection onto its direction, (I + R/radius)/2 with R = [apart, xy; xy, -apart].
    let by_radius = half * high / radius.max(xx.all(f64::MIN_POSITIVE));
    let (even, along, across) = (half * high, by_radius * apart, by_radius * xy);
    let pulls = |value: N| value.where_positive(high);
    let own = |whole: N, part: N| pulls(part).where_positive_or(zero - low, whole);
    [own(xx, even + along), own(yy, even - along), own(xy, across)]
}
