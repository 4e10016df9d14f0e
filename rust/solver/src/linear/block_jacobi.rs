//! Block Jacobi: the inverse of the 3 x 3 blocks on a matrix's diagonal.
//!
//! A block B = L Lᵀ is kept as L⁻¹, so that `B⁻¹ r = L⁻ᵀ (L⁻¹ r)` stays positive definite whatever rounding does. Where
//! forces act between pairs of particles only, no eigenvalue of B⁻¹ H is above [`LARGEST`].
//!
//! Source: Saad 2003, section 4.1.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::field::{CHUNK, Field};

/// The largest eigenvalue of B⁻¹ H that there can be: each pair's part of H is at most twice its part of B.
pub(crate) const LARGEST: f32 = 2.0;

/// Entries of a symmetric 3 x 3 matrix, and of a lower triangle, one array each: xx, yx, yy, zx, zy, zz.
pub(crate) type Entries<T> = [T; 6];

/// Inverse blocks, one for each particle.
#[derive(Debug)]
pub(crate) struct BlockJacobi {
    /// L⁻¹; zeros where a particle does not move.
    inverse_roots: Entries<Vec<f32>>,
    arch: Arch,
}

impl BlockJacobi {
    pub(crate) fn new(count: usize) -> Self {
        Self { inverse_roots: std::array::from_fn(|_| vec![0.0; count]), arch: Arch::new() }
    }

    /// Inverts the blocks that `fill` writes for a chunk of particles, given the first of them, in the place of the
    /// inverses; `least` is what each block has at least on its diagonal beside parts that are not negative, 0 for a
    /// particle that does not move.
    pub(crate) fn invert(
        &mut self,
        least: &[f32],
        fill: impl Fn(usize, Entries<&mut [f32]>) + Sync,
    ) {
        let arch = self.arch;
        let [a, b, c, d, e, f] =
            self.inverse_roots.each_mut().map(|entries| entries.par_chunks_mut(CHUNK));
        let chunks = (a, b, c, d, e, f).into_par_iter().zip(least.par_chunks(CHUNK)).enumerate();
        chunks.for_each(|(chunk, ((a, b, c, d, e, f), least))| {
            let mut blocks = [a, b, c, d, e, f];
            fill(chunk * CHUNK, blocks.each_mut().map(|entries| &mut **entries));
            arch.dispatch(Invert { blocks, least });
        });
    }

    /// `step = keep step + gain B⁻¹ r`, and adds the step to `sum`.
    pub(crate) fn relax(
        &self,
        [keep, gain]: [f32; 2],
        r: &Field,
        step: &mut Field,
        sum: &mut Field,
    ) {
        let chunks = r.chunks().zip(step.chunks_mut()).zip(sum.chunks_mut()).enumerate();
        chunks.for_each(|(chunk, ((r, step), sum))| {
            let own = chunk * CHUNK..chunk * CHUNK + r[0].len();
            let inverse_roots = self.inverse_roots.each_ref().map(|entries| &entries[own.clone()]);
            self.arch.dispatch(Relax { inverse_roots, keep, gain, r, step, sum });
        });
    }
}

/// Cholesky factors of blocks, inverted in place.
struct Invert<'a> {
    blocks: Entries<&'a mut [f32]>,
    least: &'a [f32],
}

impl WithSimd for Invert<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let count = self.least.len();
        let [xx, yx, yy, zx, zy, zz] = self.blocks.map(|entries| &mut entries[..count]);
        for i in 0..count {
            // Rounding must not take a pivot below the part that is on the diagonal alone.
            let least = self.least[i];
            let moves = least > 0.0;
            let least = least.max(f32::MIN_POSITIVE);
            let x = 1.0 / xx[i].max(least).sqrt();
            let (lyx, lzx) = (yx[i] * x, zx[i] * x);
            let y = 1.0 / (yy[i] - lyx * lyx).max(least).sqrt();
            let lzy = (zy[i] - lzx * lyx) * y;
            let z = 1.0 / (zz[i] - lzx * lzx - lzy * lzy).max(least).sqrt();
            let inverse_yx = -lyx * x * y;
            let inverse_zx = -(lzx * x + lzy * inverse_yx) * z;
            let roots = [x, inverse_yx, y, inverse_zx, -lzy * y * z, z];
            let [x, yx_root, y, zx_root, zy_root, z] = if moves { roots } else { [0.0; 6] };
            [xx[i], yx[i], yy[i]] = [x, yx_root, y];
            [zx[i], zy[i], zz[i]] = [zx_root, zy_root, z];
        }
    }
}

/// One chunk of [`BlockJacobi::relax`].
struct Relax<'a> {
    inverse_roots: Entries<&'a [f32]>,
    keep: f32,
    gain: f32,
    r: [&'a [f32]; 3],
    step: [&'a mut [f32]; 3],
    sum: [&'a mut [f32]; 3],
}

impl WithSimd for Relax<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let count = self.r[0].len();
        let [xx, yx, yy, zx, zy, zz] = self.inverse_roots.map(|entries| &entries[..count]);
        let [rx, ry, rz] = self.r.map(|axis| &axis[..count]);
        let [dx, dy, dz] = self.step.map(|axis| &mut axis[..count]);
        let [sx, sy, sz] = self.sum.map(|axis| &mut axis[..count]);
        let (keep, gain) = (self.keep, self.gain);
        if keep == 0.0 {
            // Whatever stood there, if it was no number.
            for axis in [&mut *dx, &mut *dy, &mut *dz] {
                axis.fill(0.0);
            }
        }
        for i in 0..count {
            let x = xx[i] * rx[i];
            let y = yx[i] * rx[i] + yy[i] * ry[i];
            let z = zx[i] * rx[i] + zy[i] * ry[i] + zz[i] * rz[i];
            dx[i] = keep * dx[i] + gain * (xx[i] * x + yx[i] * y + zx[i] * z);
            dy[i] = keep * dy[i] + gain * (yy[i] * y + zy[i] * z);
            dz[i] = keep * dz[i] + gain * (zz[i] * z);
            sx[i] += dx[i];
            sy[i] += dy[i];
            sz[i] += dz[i];
        }
    }
}
