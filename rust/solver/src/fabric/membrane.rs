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

use super::material::Fabric;

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

    /// U and V, of positions or of velocities.
    pub(super) fn frame(&self, of: impl Fn(u32) -> Vector) -> [Vector; 2] {
        let [a, b, c] = self.corners.map(of);
        self.gradients.map(|[da, db, dc]| da * a + db * b + dc * c)
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

/// What a triangle does in one state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strained {
    pub(super) frame: [Vector; 2],
    /// Present stiffness (N/m) along warp and weft: that of tension or of compression.
    pub(super) stiffness: [f64; 2],
    /// `s_ww, s_ff, s_wf` (N/m) without damping.
    pub(super) stress: [f64; 3],
    /// J/m²
    pub(super) energy: f64,
}

impl MembraneLaw {
    pub(super) fn new(fabric: &Fabric, times: [f64; 2]) -> Self {
        let Fabric { stretch, compression, shear, .. } = *fabric;
        Self { stretch, compression, shear, times }
    }

    pub(super) fn strained(&self, frame: [Vector; 2]) -> Strained {
        let strain = frame.map(|axis| 0.5 * (axis.norm_squared() - 1.0));
        let slide = frame[0].dot(&frame[1]);
        let of =
            [0, 1].map(|i| if strain[i] < 0.0 { self.compression[i] } else { self.stretch[i] });
        let stress = [of[0] * strain[0], of[1] * strain[1], self.shear * slide];
        let energy = 0.5 * (stress[0] * strain[0] + stress[1] * strain[1] + stress[2] * slide);
        Strained { frame, stiffness: of, stress, energy }
    }

    /// `s_ww, s_ff, s_wf` (N/m) with damping, for a frame that changes at `rates` (1/s).
    pub(super) fn damped(&self, strained: &Strained, rates: [Vector; 2]) -> [f64; 3] {
        let Strained { frame: [u, v], stiffness, stress, .. } = strained;
        let [du, dv] = rates;
        let [stretch, shear] = self.times;
        [
            stress[0] + stretch * stiffness[0] * u.dot(&du),
            stress[1] + stretch * stiffness[1] * v.dot(&dv),
            stress[2] + shear * self.shear * (u.dot(&dv) + v.dot(&du)),
        ]
    }
}

/// The largest eigenvalue of a symmetric 2 x 2 matrix: xx, yy, xy.
pub(super) fn largest([xx, yy, xy]: [f64; 3]) -> f64 {
    0.5 * (xx + yy) + (0.5 * (xx - yy)).hypot(xy)
}

/// The positive part of a symmetric 2 x 2 matrix: xx, yy, xy.
pub(super) fn positive_part([xx, yy, xy]: [f64; 3]) -> [f64; 3] {
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let radius = half.hypot(xy);
    let (low, high) = (mean - radius, mean + radius);
    if low >= 0.0 {
        return [xx, yy, xy];
    }
    if high <= 0.0 {
        return [0.0; 3];
    }
    // high times the projection onto its direction, (I + R/radius)/2 with R = [half, xy; xy, -half].
    let [c, s] = [half / radius, xy / radius];
    [0.5 * high * (1.0 + c), 0.5 * high * (1.0 - c), 0.5 * high * s]
}
