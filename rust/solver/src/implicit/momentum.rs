//! The momentum of pieces that hang on nothing.
//!
//! Summed over a piece, inner forces cancel and a step's equations become
//!
//! ```text
//! sum (m/h'² + ka/h') dx = sum r
//! ```
//!
//! Moves in f32 miss it by their rounding; a common shift of the piece makes up for it.

use crate::contact::ContactMatrix;
use crate::law::Spring;
use crate::linear::Field;
use crate::state::Coordinates;

/// The pieces that springs join.
#[derive(Debug)]
pub(super) struct Pieces {
    /// The piece of each particle.
    piece_of: Vec<u32>,
    is_free: Vec<bool>,
}

impl Pieces {
    /// The pieces of springs between particles, none of which is pinned yet.
    pub(super) fn new<'a>(count: usize, springs: impl Iterator<Item = (&'a Spring, u32)>) -> Self {
        let mut root_of: Vec<u32> = (0..count as u32).collect();
        for (spring, base) in springs {
            let [a, b] = spring.ends.map(|end| root(&mut root_of, base + end));
            root_of[a.max(b) as usize] = a.min(b);
        }
        let mut piece_of = vec![0; count];
        let mut piece_count = 0;
        for particle in 0..count {
            let own = root(&mut root_of, particle as u32) as usize;
            // The root of a piece is its first particle.
            piece_of[particle] = if own == particle {
                piece_count += 1;
                piece_count - 1
            } else {
                piece_of[own]
            };
        }
        Self { piece_of, is_free: vec![true; piece_count as usize] }
    }

    /// Takes up which particles are pinned.
    pub(super) fn follow_pins(&mut self, is_pinned: impl Fn(usize) -> bool) {
        self.is_free.fill(true);
        for (particle, &piece) in self.piece_of.iter().enumerate() {
            if is_pinned(particle) {
                self.is_free[piece as usize] = false;
            }
        }
    }

    /// The shift (m) of each particle that makes up for the rounding of moves, given what they were to balance and
    /// the inertia (kg/s²) of each; none if no piece is free. Pieces that touch each other are one, and what is touched by
    /// anything that is held is not free.
    pub(super) fn shifts(
        &self,
        residual: &Coordinates,
        moves: &Field,
        inertia: impl Fn(usize) -> f64,
        contacts: &ContactMatrix,
    ) -> Option<Shifts<'_>> {
        let (whole_of, is_free) = self.in_touch(contacts);
        if !is_free.contains(&true) {
            return None;
        }
        let mut sums = vec![[0.0; 4]; is_free.len()];
        for (particle, &piece) in self.piece_of.iter().enumerate() {
            let sum = &mut sums[whole_of[piece as usize] as usize];
            let weight = inertia(particle);
            sum[3] += weight;
            let axes = residual.0.iter().zip(&moves.0);
            for (sum, (residual, moves)) in sum.iter_mut().zip(axes) {
                *sum += residual[particle] - weight * f64::from(moves[particle]);
            }
        }
        let of_piece = whole_of.iter().map(|&whole| {
            let [x, y, z, weight] = sums[whole as usize];
            let is_free = is_free[whole as usize] && weight > 0.0;
            if is_free { [x, y, z].map(|sum| sum / weight) } else { [0.0; 3] }
        });
        Some(Shifts { piece_of: &self.piece_of, of_piece: of_piece.collect() })
    }

    /// For each piece, the first of those that it touches, and whether all of them are free.
    fn in_touch(&self, contacts: &ContactMatrix) -> (Vec<u32>, Vec<bool>) {
        let mut root_of: Vec<u32> = (0..self.is_free.len() as u32).collect();
        let mut is_free = self.is_free.clone();
        for (particles, is_held) in contacts.joints() {
            let mut pieces = particles.map(|particle| self.piece_of[particle as usize]);
            let Some(first) = pieces.next() else { continue };
            is_free[first as usize] &= !is_held;
            for piece in pieces {
                let [a, b] = [first, piece].map(|piece| root(&mut root_of, piece));
                root_of[a.max(b) as usize] = a.min(b);
            }
        }
        for piece in 0..root_of.len() {
            let whole = root(&mut root_of, piece as u32);
            root_of[piece] = whole;
            is_free[whole as usize] &= is_free[piece];
        }
        (root_of, is_free)
    }
}

/// A common shift for each piece.
pub(super) struct Shifts<'a> {
    piece_of: &'a [u32],
    of_piece: Vec<[f64; 3]>,
}

impl Shifts<'_> {
    pub(super) fn of(&self, particle: usize) -> [f64; 3] {
        self.of_piece[self.piece_of[particle] as usize]
    }
}

/// The first particle of the piece so far, with the way there made shorter.
fn root(root_of: &mut [u32], mut particle: u32) -> u32 {
    while root_of[particle as usize] != particle {
        let next = root_of[root_of[particle as usize] as usize];
        root_of[particle as usize] = next;
        particle = next;
    }
    particle
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::SpringKind;

    fn spring(a: u32, b: u32) -> Spring {
        let kind = SpringKind::Stretch;
        Spring { ends: [a, b], kind, rest_length: 1.0, stiffness: 1.0, damping: 0.0 }
    }

    #[test]
    fn only_free_pieces_are_shifted_and_then_their_moves_balance() {
        let springs = [spring(3, 4), spring(0, 2), spring(2, 3), spring(1, 5)];
        let mut pieces = Pieces::new(6, springs.iter().map(|spring| (spring, 0)));
        assert_eq!(pieces.piece_of, [0, 1, 0, 0, 0, 1]);
        pieces.follow_pins(|particle| particle == 5);
        let mut state = crate::state::State::zeros(6);
        let mut moves = Field::zeros(6);
        for i in 0..6 {
            state.position.0[1][i] = 1.0 + i as f64;
            moves.0[1][i] = 0.1 * i as f32;
        }
        let inertia = |particle: usize| 2.0 + particle as f64;
        let shifts = pieces
            .shifts(&state.position, &moves, inertia, &ContactMatrix::default())
            .expect("a free piece");
        assert!(shifts.of(1).iter().all(|shift| shift.to_bits() == 0));
        let balance: f64 = [0, 2, 3, 4]
            .iter()
            .map(|&i| {
                let moved = f64::from(moves.0[1][i]) + shifts.of(i)[1];
                state.position.0[1][i] - inertia(i) * moved
            })
            .sum();
        assert!(balance.abs() < 1e-12, "{balance}");
        pieces.follow_pins(|particle| particle >= 4);
        assert!(
            pieces.shifts(&state.position, &moves, inertia, &ContactMatrix::default()).is_none()
        );
    }
}
