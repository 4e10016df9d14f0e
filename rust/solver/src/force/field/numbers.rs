//! A field as numbers of a checkpoint, and back.

use boucle_geometry::Vector;

use super::{Falloff, FalloffShape, Field, FieldKind, FieldShape, Range, Side};

/// How many numbers a field is.
pub(crate) const COUNT: usize = 26;

const SHAPES: [FieldShape; 3] = [FieldShape::Point, FieldShape::Line, FieldShape::Plane];
const FALLOFFS: [FalloffShape; 3] = [FalloffShape::Sphere, FalloffShape::Tube, FalloffShape::Cone];
const SIDES: [Side; 3] = [Side::Both, Side::Positive, Side::Negative];

impl Field {
    pub(crate) fn to_numbers(&self) -> [f64; COUNT] {
        let flag = |is_set: bool| f64::from(u8::from(is_set));
        let [kind, first, second] = match self.kind {
            FieldKind::Point { inverse_square } => [0.0, flag(inverse_square), 0.0],
            FieldKind::Wind => [1.0, 0.0, 0.0],
            FieldKind::Vortex => [2.0, 0.0, 0.0],
            FieldKind::Turbulence { size, is_global } => [3.0, size, flag(is_global)],
            FieldKind::Drag => [4.0, 0.0, 0.0],
            FieldKind::Harmonic { rest_length } => [5.0, rest_length, 0.0],
            FieldKind::Magnetic => [6.0, 0.0, 0.0],
        };
        let Falloff { shape, side, distance, radial } = self.falloff;
        // A bound is 0 or more: what is no number is none.
        let range = |range: Range| {
            [range.power, range.min.unwrap_or(f64::NAN), range.max.unwrap_or(f64::NAN)]
        };
        let ([power, min, max], [radial_power, radial_min, radial_max]) =
            (range(distance), range(radial));
        let ([x, y, z], [ax, ay, az]) = (self.location.into(), self.axis.into());
        [
            kind,
            first,
            second,
            self.strength,
            self.pressure,
            self.weight,
            self.damping,
            self.flow,
            self.noise,
            f64::from(self.seed),
            place_of(&SHAPES, &self.shape),
            place_of(&FALLOFFS, &shape),
            place_of(&SIDES, &side),
            power,
            min,
            max,
            radial_power,
            radial_min,
            radial_max,
            self.wind_factor,
            x,
            y,
            z,
            ax,
            ay,
            az,
        ]
    }

    /// The field of such numbers; nothing if they are of none.
    pub(crate) fn from_numbers(numbers: &[f64; COUNT]) -> Option<Self> {
        let [kind, first, second, strength, pressure, weight, damping, flow, noise, ..] = *numbers;
        let kind = match kind as u32 {
            0 => FieldKind::Point { inverse_square: first > 0.0 },
            1 => FieldKind::Wind,
            2 => FieldKind::Vortex,
            3 => FieldKind::Turbulence { size: first, is_global: second > 0.0 },
            4 => FieldKind::Drag,
            5 => FieldKind::Harmonic { rest_length: first },
            6 => FieldKind::Magnetic,
            _ => return None,
        };
        let bound = |number: f64| (!number.is_nan()).then_some(number);
        let range = |first: usize| Range {
            power: numbers[first],
            min: bound(numbers[first + 1]),
            max: bound(numbers[first + 2]),
        };
        let falloff = Falloff {
            shape: *FALLOFFS.get(numbers[11] as usize)?,
            side: *SIDES.get(numbers[12] as usize)?,
            distance: range(13),
            radial: range(16),
        };
        let field = Self {
            kind,
            strength,
            pressure,
            weight,
            damping,
            flow,
            noise,
            seed: numbers[9] as u32,
            shape: *SHAPES.get(numbers[10] as usize)?,
            falloff,
            wind_factor: numbers[19],
            location: Vector::from_column_slice(&numbers[20..23]),
            axis: Vector::from_column_slice(&numbers[23..26]),
        };
        field.check().is_ok().then_some(field)
    }
}

/// Where a word stands among all.
fn place_of<T: PartialEq>(all: &[T], word: &T) -> f64 {
    all.iter().position(|other| other == word).unwrap_or(all.len()) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_reads_back_as_it_was_written() {
        let kinds = [
            FieldKind::Point { inverse_square: true },
            FieldKind::Wind,
            FieldKind::Vortex,
            FieldKind::Turbulence { size: 0.3, is_global: true },
            FieldKind::Drag,
            FieldKind::Harmonic { rest_length: 0.7 },
            FieldKind::Magnetic,
        ];
        for (number, kind) in kinds.into_iter().enumerate() {
            let falloff = Falloff {
                shape: FALLOFFS[number % 3],
                side: SIDES[(number + 1) % 3],
                distance: Range { power: 2.0, min: Some(0.0), max: None },
                radial: Range { power: 0.5, min: None, max: Some(3.0) },
            };
            let field = Field {
                pressure: 0.48,
                weight: 0.25,
                damping: 0.1,
                flow: 0.2,
                noise: -0.3,
                seed: u32::MAX,
                shape: SHAPES[number % 3],
                falloff,
                wind_factor: 0.75,
                location: Vector::new(1.0, -2.0, 3.0),
                axis: Vector::new(0.1, 0.2, -0.3),
                ..Field::new(kind, -7.5)
            };
            assert_eq!(Field::from_numbers(&field.to_numbers()), Some(field));
        }
    }

    #[test]
    fn numbers_of_no_field_are_refused() {
        let good = Field::new(FieldKind::Wind, 1.0).to_numbers();
        for (place, bad) in [(0, 7.0), (3, f64::NAN), (10, 3.0), (11, 9.0), (12, 3.0), (19, 2.0)] {
            let mut numbers = good;
            numbers[place] = bad;
            assert_eq!(Field::from_numbers(&numbers), None, "number {place}");
        }
    }
}
