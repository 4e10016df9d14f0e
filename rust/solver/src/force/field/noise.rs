//! Numbers that look random: smooth from place to place for turbulence, and one for each vertex and frame.
//!
//! Turbulence is gradient noise in three octaves, each half as large and half as strong as the one before, with a field of
//! its own for each axis. It is not Blender's noise, but has its spread and its correlation length.
//!
//! Source: Perlin 2002 (gradients to the middles of a cube's edges, blended by a polynomial of degree 5).

use boucle_geometry::Vector;

use crate::scatter::{mixed, scattered};

/// Octaves, and the sum of their strengths.
const OCTAVES: i32 = 3;
const SUM: f64 = 1.75;

/// The mean of Blender's random numbers and their spread as its cloth averages them, for a noise of 1: by measurement.
const MEAN: f64 = 0.17;
const HALF_WIDTH: f64 = 0.35;

/// A number for a vertex at a frame, as large as the noise of a strength is.
pub(in crate::force) fn draw(seed: u32, frame: i32, particle: usize) -> f64 {
    let place = (u64::from(seed) << 32) ^ u64::from(frame.cast_unsigned());
    MEAN + HALF_WIDTH * scattered(mixed(place).wrapping_add(particle as u64))
}

/// Turbulence at a place (m): three components within -1 to 1.
pub(in crate::force) fn turbulence(place: &Vector, size: f64) -> Vector {
    let place = if size > 0.0 { place / size } else { *place };
    let mut sum = Vector::zeros();
    for octave in 0..OCTAVES {
        let scale = 2f64.powi(octave);
        sum += gradient_noise(&(place * scale), octave as u64) / scale;
    }
    sum / SUM
}

/// Smooth noise that is 0 on whole numbers, a field for each axis, within -1 to 1.
fn gradient_noise(place: &Vector, salt: u64) -> Vector {
    let cell = place.map(f64::floor);
    let inside = place - cell;
    let blend = inside.map(|t| t * t * t * (t * (6.0 * t - 15.0) + 10.0));
    let mut sum = Vector::zeros();
    for corner in 0..8_u8 {
        let at = Vector::from_fn(|axis, _| f64::from(corner >> axis & 1));
        let part = |axis: usize| if at[axis] > 0.0 { blend[axis] } else { 1.0 - blend[axis] };
        let bits = bits_at(&(cell + at), salt);
        let weight = part(0) * part(1) * part(2);
        sum += weight * Vector::from_fn(|axis, _| slope(bits >> (21 * axis), &(inside - at)));
    }
    sum
}

/// Random bits of a corner.
fn bits_at(corner: &Vector, salt: u64) -> u64 {
    const FACTORS: [u64; 3] = [0x9E37_79B9_7F4A_7C15, 0xC2B2_AE3D_27D4_EB4F, 0x1656_67B1_9E37_79F9];
    let whole = |axis: usize| (corner[axis] as i64).cast_unsigned().wrapping_mul(FACTORS[axis]);
    mixed(whole(0) ^ whole(1) ^ whole(2) ^ (salt << 60))
}

/// How far `way` goes along one of the twelve ways from the middle of a cube to the middles of its edges, which 21 bits
/// choose.
fn slope(bits: u64, way: &Vector) -> f64 {
    let choice = ((bits & 0x1F_FFFF) * 12) >> 21;
    let (one, other) = match choice >> 2 {
        0 => (way.y, way.z),
        1 => (way.z, way.x),
        _ => (way.x, way.y),
    };
    (if choice & 1 == 0 { one } else { -one }) + (if choice & 2 == 0 { other } else { -other })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places() -> impl Iterator<Item = Vector> {
        (0..20_000_u64).map(|i| Vector::from_fn(|axis, _| 50.0 * scattered(3 * i + axis as u64)))
    }

    /// The same law with other random numbers, in numpy: 0.177, and 0.44 of the correlation left at 0.39 m. That this is
    /// what Blender's cloth feels is in `tests/blender/test_fields.py`.
    #[test]
    fn turbulence_has_blenders_spread_and_correlation_length() {
        let shift = Vector::new(0.24, 0.24, 0.2);
        let (mut mean, mut square, mut product) = (0.0, 0.0, 0.0);
        for place in places() {
            let [here, there] = [place, place + shift].map(|place| turbulence(&place, 1.0));
            assert!(here.amax() <= 1.0);
            mean += here.x;
            square += here.norm_squared();
            product += here.dot(&there);
        }
        let rms = (square / 60_000.0).sqrt();
        assert!((rms / 0.177 - 1.0).abs() < 0.05, "{rms}");
        assert!((mean / 20_000.0).abs() < 0.01, "{mean}");
        let correlation = product / square;
        assert!((correlation - 0.44).abs() < 0.05, "{correlation}");
    }

    #[test]
    fn turbulence_is_smooth_and_stretches_with_its_size() {
        for place in places().take(500) {
            let step = 1e-5 * Vector::new(1.0, -2.0, 0.5);
            let [a, b] = [place, place + step].map(|place| turbulence(&place, 2.0));
            assert!((a - b).norm() < 1e-4);
            assert!((turbulence(&(2.0 * place), 2.0) - turbulence(&place, 1.0)).norm() < 1e-9);
        }
    }

    /// Blender's numbers have a mean of 0.17 and, after its cloth has averaged them over neighbours, a spread of 0.2.
    #[test]
    fn random_numbers_have_blenders_mean_and_spread_and_change_with_all_that_they_are_of() {
        let numbers: Vec<f64> = (0..10_000).map(|particle| draw(5, 7, particle)).collect();
        let mean = numbers.iter().sum::<f64>() / 1e4;
        let spread = (numbers.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 1e4).sqrt();
        assert!((mean - 0.17).abs() < 0.01, "{mean}");
        assert!((spread - 0.2).abs() < 0.01, "{spread}");
        let one = draw(5, 7, 9).to_bits();
        assert!([draw(6, 7, 9), draw(5, 8, 9), draw(5, 7, 8)].iter().all(|x| x.to_bits() != one));
        assert_eq!(draw(5, 7, 9).to_bits(), one);
    }
}
