//! What fills one cloth: its pressure at a volume, and the shares of its faces.

use boucle_geometry::Vector;

/// Volume never counts as less than this part of the one at which pressures balance.
pub(super) const LEAST_VOLUME: f64 = 0.01;

/// `uniform`, `factor` and V0 of a pressure at one time.
pub(crate) type Level = [f64; 3];

/// The pressure of one cloth.
#[derive(Debug)]
pub(super) struct Filling {
    pub(super) cloth: usize,
    pub(super) first: usize,
    pub(super) count: usize,
    /// Its faces among all, and those that count for the volume.
    pub(super) faces: std::ops::Range<usize>,
    pub(super) counts: Vec<bool>,
    /// For each of its particles.
    pub(super) weights: Vec<f64>,
    /// Volume (m³) of the rest shape.
    pub(super) rest_volume: f64,
    /// As the frame begins, as it ends, and now.
    pub(super) from: Level,
    pub(super) to: Level,
    pub(super) now: Level,
}

impl Filling {
    pub(super) fn level(&self, uniform: f64, factor: f64, target: Option<f64>) -> Level {
        [uniform, factor, target.unwrap_or(self.rest_volume)]
    }

    /// p (N/m²) and `-dp/dV` (N/m⁵) at a volume (m³).
    pub(super) fn at(&self, volume: f64) -> [f64; 2] {
        Self::pressure(self.now, volume)
    }

    /// The largest sizes of both within the frame. Each is a product of values that change evenly: it is largest where every one
    /// of them is at an end of the frame.
    pub(super) fn most_at(&self, volume: f64) -> [f64; 2] {
        let corners = (0..8_u8).map(|corner| {
            let end = |i: usize| if corner >> i & 1 == 0 { self.from[i] } else { self.to[i] };
            Self::pressure(std::array::from_fn(end), volume)
        });
        corners.fold([0.0; 2], |[p, slope], at| [f64::max(p, at[0].abs()), f64::max(slope, at[1])])
    }

    fn pressure([uniform, factor, balance]: Level, volume: f64) -> [f64; 2] {
        if balance <= 0.0 || factor == 0.0 {
            return [uniform, 0.0];
        }
        let volume = volume.max(LEAST_VOLUME * balance);
        [uniform + factor * (balance / volume - 1.0), factor * balance / (volume * volume)]
    }

    /// The volume (m³) within the faces that count.
    pub(super) fn volume<'a, F: Iterator<Item = u32> + Clone>(
        &self,
        corners_of_face: impl Fn(usize) -> F,
        at: impl Fn(u32) -> Vector,
        all: impl ExactSizeIterator<Item = &'a Vector>,
    ) -> f64 {
        let count = all.len() as f64;
        let middle = all.sum::<Vector>() / count;
        let counted = self.faces.clone().zip(&self.counts).filter(|(_, counts)| **counts);
        let each = counted.map(|(face, _)| {
            let corners: Vec<Vector> = corners_of_face(face).map(|v| at(v) - middle).collect();
            let next = corners.iter().cycle().skip(1);
            let area: Vector = corners.iter().zip(next).map(|(a, b)| 0.5 * a.cross(b)).sum();
            corners.iter().sum::<Vector>().dot(&area) / corners.len() as f64
        });
        each.sum::<f64>() / 3.0
    }
}

/// Shares the vector area (m²) of a face out among its corners.
pub(super) fn share_out(corners: &[Vector], shares: &mut [Vector]) {
    let n = corners.len();
    if let ([a, b, c], [x, y, z]) = (corners, &mut *shares) {
        let third = (b - a).cross(&(c - a)) / 6.0;
        (*x, *y, *z) = (third, third, third);
        return;
    }
    let middle = corners.iter().sum::<Vector>() / n as f64;
    let side = |i: usize| {
        let [a, b] = [corners[i] - middle, corners[(i + 1) % n] - middle];
        0.5 * a.cross(&b)
    };
    let whole: Vector = (0..n).map(side).sum();
    for (i, share) in shares.iter_mut().enumerate() {
        *share = (side(i) + side((i + n - 1) % n)) / 3.0 + whole / (3.0 * n as f64);
    }
}
