//! As many numbers as a processor computes at a time.

use std::ops::{Add, Div, Mul, Sub};

use pulp::Simd;

use crate::law::number::Number;

/// Numbers side by side, with the instruction set that computes them.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<S: Simd> {
    simd: S,
    pub(crate) values: S::f64s,
}

impl<S: Simd> Lanes<S> {
    #[inline(always)]
    pub(crate) fn of(simd: S, values: S::f64s) -> Self {
        Self { simd, values }
    }

    #[inline(always)]
    pub(crate) fn splat(simd: S, value: f64) -> Self {
        Self { simd, values: simd.splat_f64s(value) }
    }
}

/// Arithmetic of a type `Lanes<S>` with `simd` and `values`, by functions of the instruction set.
macro_rules! lane_operators {
    ($($operator:ident: $name:ident, $of_lanes:ident;)*) => {$(
        impl<S: Simd> $operator for Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self { values: self.simd.$of_lanes(self.values, other.values), ..self }
            }
        }
    )*};
}
pub(crate) use lane_operators;

lane_operators! {
    Add: add, add_f64s;
    Sub: sub, sub_f64s;
    Mul: mul, mul_f64s;
    Div: div, div_f64s;
}

impl<S: Simd> Number for Lanes<S> {
    #[inline(always)]
    fn all(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self { values: self.simd.sqrt_f64s(self.values), ..self }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self { values: self.simd.min_f64s(self.values, other.values), ..self }
    }

    #[inline(always)]
    fn where_positive(self, sign: Self) -> Self {
        let zero = self.simd.splat_f64s(0.0);
        let is_positive = self.simd.less_than_f64s(zero, sign.values);
        Self { values: self.simd.select_f64s(is_positive, self.values, zero), ..self }
    }

    #[inline(always)]
    fn where_positive_or(self, sign: Self, other: Self) -> Self {
        let is_positive = self.simd.less_than_f64s(self.simd.splat_f64s(0.0), sign.values);
        Self { values: self.simd.select_f64s(is_positive, self.values, other.values), ..self }
    }
}

/// A slice as whole vectors; a rest that fills none is left off.
#[inline(always)]
pub(crate) fn vectors<S: Simd>(slice: &[f64]) -> &[S::f64s] {
    S::as_simd_f64s(slice).0
}

/// A slice as whole vectors; a rest that fills none is left off.
#[inline(always)]
pub(crate) fn vectors_mut<S: Simd>(slice: &mut [f64]) -> &mut [S::f64s] {
    S::as_mut_simd_f64s(slice).0
}

/// `a - b`, axis by axis.
#[inline(always)]
pub(super) fn difference<S: Simd>(simd: S, a: [S::f64s; 3], b: [S::f64s; 3]) -> [Lanes<S>; 3] {
    let [x, y, z] = a;
    let [ox, oy, oz] = b;
    let lanes = [(x, ox), (y, oy), (z, oz)];
    lanes.map(
        #[inline(always)]
        |(a, b)| Lanes::of(simd, a) - Lanes::of(simd, b),
    )
}
