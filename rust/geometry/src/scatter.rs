//! Points for tests: scattered, and as degenerate as points can be.

use crate::Vector;

/// Numbers that look random, the same in every run (splitmix64).
pub(crate) struct Scatter(pub(crate) u64);

impl Scatter {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// A number from -1 to 1.
    pub(crate) fn number(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A whole number from `least` to `most`.
    pub(crate) fn whole(&mut self, least: i32, most: i32) -> i32 {
        least + (self.bits() % (most - least + 1) as u64) as i32
    }

    /// A point of the cube from -1 to 1.
    pub(crate) fn point(&mut self) -> Vector {
        Vector::new(self.number(), self.number(), self.number())
    }

    /// A point with whole coordinates from -`reach` to `reach`.
    pub(crate) fn lattice_point(&mut self, reach: i32) -> Vector {
        Vector::from_fn(|_, _| f64::from(self.whole(-reach, reach)))
    }

    /// Four points of a kind that goes round with `index`, and their size: generic, of a lattice (which repeats points,
    /// lines and planes), of a plane, slivers, needles, parallel edges, a point on a triangle, a line, a point on a sliver,
    /// edges that cross at a small angle; each large, tiny, and far from the origin.
    pub(crate) fn four_points(&mut self, index: usize) -> ([Vector; 4], f64) {
        let mut x = [(); 4].map(|()| self.point());
        let thin = 10_f64.powi(-self.whole(4, 16));
        let share = self.number();
        match index % 10 {
            0 => {}
            1 => x = x.map(|_| self.lattice_point(1)),
            2 => x.iter_mut().for_each(|point| point.z = 0.5),
            3 => x[3] = x[1] + (x[2] - x[1]) * share + self.point() * thin,
            4 => x[2] = x[1] + self.point() * thin,
            5 => x[3] = x[2] + (x[1] - x[0]) * share + self.point() * thin,
            6 => x[0] = x[1] * share + x[2] * (0.7 - share) + x[3] * 0.3 + self.point() * thin,
            7 => x = [0.0, 1.0, share, 2.0 * share].map(|t| x[0] + x[1] * t + x[2] * thin),
            8 => {
                x[3] = x[1] + (x[2] - x[1]) * share + self.point() * thin;
                x[0] = x[1] * 0.3 + x[2] * 0.3 + x[3] * 0.4;
            }
            _ => {
                let (middle, along) = ((x[0] + x[1]) * 0.5, (x[1] - x[0]) * share);
                let aslant = along + self.point() * thin;
                (x[2], x[3]) = (middle - aslant, middle + aslant);
            }
        }
        let scale = 10_f64.powi(self.whole(-9, 9));
        let far = if self.whole(0, 3) == 0 { self.point() * 1e3 } else { Vector::zeros() };
        let x = x.map(|point| (point + far) * scale);
        (x, x.iter().fold(0.0, |size: f64, point| size.max(point.amax())))
    }
}
