//! What a law of force is written in: a number, or several side by side.

use std::ops::{Add, Div, Mul, Sub};

/// Numbers with IEEE 754's basic operations, all rounded to nearest: the same bits however many lie side by side.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// This value wherever `self` has a number.
    fn all(self, value: f64) -> Self;

    fn sqrt(self) -> Self;

    /// The lesser of the two; neither is NaN.
    fn min(self, other: Self) -> Self;

    /// `self` where `sign` is above 0, else 0.
    fn where_positive(self, sign: Self) -> Self;

    /// `self` where `sign` is above 0, else the other.
    fn where_positive_or(self, sign: Self, other: Self) -> Self;

    /// The greater of the two; neither is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.where_positive_or(self - other, other)
    }
}

impl Number for f64 {
    #[inline(always)]
    fn all(self, value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    #[inline(always)]
    fn where_positive(self, sign: Self) -> Self {
        if sign > 0.0 { self } else { 0.0 }
    }

    #[inline(always)]
    fn where_positive_or(self, sign: Self, other: Self) -> Self {
        if sign > 0.0 { self } else { other }
    }
}
