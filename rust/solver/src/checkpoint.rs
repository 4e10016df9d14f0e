//! A simulation's state as bytes: versioned, checksummed, bound to what is simulated.
//!
//! ```text
//! "BOUCLECK" | version u32 | digest u64 | frame i32 | substeps u32 | particles u64
//! | positions and velocities, f64, axis by axis
//! | pins u64 | weight, target, goal of each, f64 | cloths u64 | stiffness of their pins, f64
//! | grabbed u64 | particle, stiffness, damping, goal, target of each, f64
//! | gravity, f64 | winds u64 | velocity and drift of each, f64 | force fields u64 | numbers of each, f64
//! | water u64 | level, current and drift, f64 | wetness of each particle that soaks, f64
//! | points of colliders u64 | their positions, f64, point by point
//! | the same where they are to be next; no points if they stay
//! | numbers of tears u64 | those, f64: of each cloth how many edges are torn, those, how many seams are undone, those
//! | numbers of the shape u64 | those, f64: rest lengths, pressures, welded seams, creases
//! | implicit integrators only: edges u64 | substeps u32 | step f64 | error f64
//! |     positions and velocities before | tension f64 of each edge
//! | XXH3-64 of all before
//! ```
//!
//! All little-endian.

use boucle_geometry::Vector;
use xxhash_rust::xxh3::xxh3_64;

use crate::error::{Error, Result};
use crate::force::{FIELD_NUMBERS, Field};
use crate::goals::Goal;
use crate::grab::Grab;
use crate::implicit::Memory;
use crate::pins::Held;
use crate::settings::MOST_SUBSTEPS;
use crate::state::{LARGEST, State};

const MAGIC: &[u8; 8] = b"BOUCLECK";
const VERSION: u32 = 6;
const HEADER: usize = 36;
/// Far beyond any frame of a program, and far from where counting ends.
const LAST_FRAME: u32 = 1 << 30;

/// What a checkpoint holds.
#[derive(Debug, PartialEq)]
pub(crate) struct Checkpoint {
    /// Hash of everything that does not change.
    pub(crate) digest: u64,
    pub(crate) frame: i32,
    pub(crate) substeps: u32,
    pub(crate) state: State,
    pub(crate) pins: Vec<Held>,
    /// Stiffness (N/m) of each cloth's pins.
    pub(crate) pin_stiffness: Vec<f64>,
    pub(crate) grab: Grab,
    /// (m/s²)
    pub(crate) gravity: Vector,
    /// Velocities (m/s), and how far winds have come (m).
    pub(crate) winds: Vec<[Vector; 2]>,
    pub(crate) fields: Vec<Field>,
    /// Level, current, drift and wetness; nothing without water.
    pub(crate) water: Vec<f64>,
    /// Where the points of colliders are (m), and where they are to be at the end of the next frame.
    pub(crate) colliders: [Vec<Vector>; 2],
    /// Of each cloth the edges that are torn, in that order, and the seams that are undone.
    pub(crate) tears: Vec<f64>,
    /// Rest lengths, pressures, welded seams and creases.
    pub(crate) shape: Vec<f64>,
    pub(crate) memory: Option<Memory>,
}

impl Checkpoint {
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let count = self.state.len();
        let mut bytes = Vec::with_capacity(HEADER + 48 * count + 8);
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&self.digest.to_le_bytes());
        bytes.extend_from_slice(&self.frame.to_le_bytes());
        bytes.extend_from_slice(&self.substeps.to_le_bytes());
        bytes.extend_from_slice(&(count as u64).to_le_bytes());
        write_state(&mut bytes, &self.state);
        self.write_holds(&mut bytes);
        self.write_surroundings(&mut bytes);
        if let Some(memory) = &self.memory {
            bytes.extend_from_slice(&(memory.tensions.len() as u64).to_le_bytes());
            bytes.extend_from_slice(&memory.substeps.to_le_bytes());
            bytes.extend_from_slice(&memory.step.to_le_bytes());
            bytes.extend_from_slice(&memory.error.to_le_bytes());
            write_state(&mut bytes, &memory.before);
            bytes.extend(memory.tensions.iter().flat_map(|value| value.to_le_bytes()));
        }
        let checksum = xxh3_64(&bytes);
        bytes.extend_from_slice(&checksum.to_le_bytes());
        bytes
    }

    fn write_surroundings(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.gravity.iter().flat_map(|number| number.to_le_bytes()));
        let mut write =
            |count, numbers: &mut dyn Iterator<Item = f64>| write(bytes, count, numbers);
        write(self.winds.len(), &mut self.winds.iter().flatten().flatten().copied());
        write(self.fields.len(), &mut self.fields.iter().flat_map(Field::to_numbers));
        write(self.water.len(), &mut self.water.iter().copied());
        let [from, to] = &self.colliders;
        let to = if from == to { &[][..] } else { to };
        for points in [from, to] {
            write(points.len(), &mut points.iter().flatten().copied());
        }
        write(self.tears.len(), &mut self.tears.iter().copied());
        write(self.shape.len(), &mut self.shape.iter().copied());
    }

    fn write_holds(&self, bytes: &mut Vec<u8>) {
        let mut write =
            |count, numbers: &mut dyn Iterator<Item = f64>| write(bytes, count, numbers);
        let pin = |pin: &Held| {
            let ([x, y, z], [gx, gy, gz]) = (pin.target.into(), pin.goal.into());
            [pin.weight, x, y, z, gx, gy, gz]
        };
        write(self.pins.len(), &mut self.pins.iter().flat_map(pin));
        write(self.pin_stiffness.len(), &mut self.pin_stiffness.iter().copied());
        let grabbed = |goal: &Goal| {
            let Goal { particle, stiffness, damping, from, to } = *goal;
            let ([fx, fy, fz], [x, y, z]) = (from.into(), to.into());
            [f64::from(particle), stiffness, damping, fx, fy, fz, x, y, z]
        };
        write(self.grab.goals.len(), &mut self.grab.goals.iter().flat_map(grabbed));
    }

    pub(crate) fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let damaged = || Error::BadCheckpoint("is damaged; accepted: a whole one");
        let (body, checksum) = bytes.split_last_chunk::<8>().ok_or_else(damaged)?;
        if xxh3_64(body) != u64::from_le_bytes(*checksum) {
            return Err(damaged());
        }
        let mut reader = Reader(body);
        if reader.take::<8>() != Some(*MAGIC) {
            return Err(damaged());
        }
        if reader.take().map(u32::from_le_bytes) != Some(VERSION) {
            return Err(Error::BadCheckpoint("is of another version; accepted: version 6"));
        }
        Self::read_body(&mut reader).filter(Self::is_sound).ok_or_else(damaged)
    }

    /// Whether every number is one that a simulation can come to.
    fn is_sound(&self) -> bool {
        let winds = self.winds.iter().flatten().chain([&self.gravity]);
        let vectors = winds.chain(self.colliders.iter().flatten());
        let pins = self.pins.iter().flat_map(|pin| [&pin.target, &pin.goal]);
        let goals = self.grab.goals.iter().flat_map(|goal| [&goal.from, &goal.to]);
        let positive = self.grab.goals.iter().flat_map(|goal| [goal.stiffness, goal.damping]);
        let positive = positive.chain(self.pin_stiffness.iter().copied());
        let numbers = [&self.water, &self.tears, &self.shape].into_iter().flatten().copied();
        let is_number = |number: f64| number.abs() <= LARGEST;
        let remembers_well = |memory: &Memory| {
            let numbers = memory.tensions.iter().chain([&memory.step, &memory.error]);
            numbers.copied().all(is_number)
                && memory.before.first_lost().is_none()
                && memory.substeps <= MOST_SUBSTEPS
        };
        vectors.chain(pins).chain(goals).flatten().copied().chain(numbers).all(is_number)
            && positive.into_iter().all(|number| (0.0..=LARGEST).contains(&number))
            && self.pins.iter().all(|pin| (0.0..=1.0).contains(&pin.weight))
            && self.state.first_lost().is_none()
            && self.memory.as_ref().is_none_or(remembers_well)
            && self.substeps <= MOST_SUBSTEPS
            && self.frame.unsigned_abs() < LAST_FRAME
    }

    fn read_body(reader: &mut Reader<'_>) -> Option<Self> {
        let digest = u64::from_le_bytes(reader.take()?);
        let frame = i32::from_le_bytes(reader.take()?);
        let substeps = u32::from_le_bytes(reader.take()?);
        let count = reader.count()?;
        if reader.0.len() < count.checked_mul(48)? {
            return None;
        }
        let state = reader.state(count)?;
        let pins = reader.rows()?;
        let pins = pins.iter().map(|&[weight, x, y, z, gx, gy, gz]| {
            let (target, goal) = (Vector::new(x, y, z), Vector::new(gx, gy, gz));
            Held { weight, target, goal }
        });
        let pins = pins.collect();
        let pin_stiffness = reader.numbers()?;
        let goals = reader.rows()?;
        let goals = goals.iter().map(|&[particle, stiffness, damping, fx, fy, fz, x, y, z]| {
            let (from, to) = (Vector::new(fx, fy, fz), Vector::new(x, y, z));
            Goal { particle: particle as u32, stiffness, damping, from, to }
        });
        let grab = Grab { goals: goals.collect() };
        let gravity = Vector::from(reader.three()?);
        let winds = reader.rows()?;
        let winds = winds
            .iter()
            .map(|&[x, y, z, dx, dy, dz]| [Vector::new(x, y, z), Vector::new(dx, dy, dz)]);
        let winds = winds.collect();
        let fields = reader.rows::<FIELD_NUMBERS>()?;
        let fields = fields.iter().map(Field::from_numbers).collect::<Option<_>>()?;
        let water = reader.numbers()?;
        let [from, to] = [reader.vectors()?, reader.vectors()?];
        let to = if to.is_empty() { from.clone() } else { to };
        let [tears, shape] = [reader.numbers()?, reader.numbers()?];
        let memory =
            if reader.0.is_empty() { None } else { Some(Self::read_memory(reader, count)?) };
        reader.0.is_empty().then_some(Self {
            digest,
            frame,
            substeps,
            state,
            pins,
            pin_stiffness,
            grab,
            gravity,
            winds,
            fields,
            water,
            colliders: [from, to],
            tears,
            shape,
            memory,
        })
    }

    fn read_memory(reader: &mut Reader<'_>, count: usize) -> Option<Memory> {
        let edge_count = reader.count()?;
        let substeps = u32::from_le_bytes(reader.take()?);
        let [step, error] = [reader.number()?, reader.number()?];
        let bytes = edge_count.checked_mul(8)?.checked_add(count.checked_mul(48)?)?;
        if reader.0.len() != bytes {
            return None;
        }
        let before = reader.state(count)?;
        let tensions = (0..edge_count).map(|_| reader.number()).collect::<Option<_>>()?;
        Some(Memory { before, step, tensions, error, substeps })
    }
}

/// A count, and numbers.
fn write(bytes: &mut Vec<u8>, count: usize, numbers: &mut dyn Iterator<Item = f64>) {
    bytes.extend_from_slice(&(count as u64).to_le_bytes());
    bytes.extend(numbers.flat_map(f64::to_le_bytes));
}

fn write_state(bytes: &mut Vec<u8>, state: &State) {
    for axis in state.position.0.iter().chain(&state.velocity.0) {
        bytes.extend(axis.iter().flat_map(|value| value.to_le_bytes()));
    }
}

struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (taken, rest) = self.0.split_first_chunk::<N>()?;
        self.0 = rest;
        Some(*taken)
    }

    fn number(&mut self) -> Option<f64> {
        self.take().map(f64::from_le_bytes)
    }

    fn three(&mut self) -> Option<[f64; 3]> {
        Some([self.number()?, self.number()?, self.number()?])
    }

    fn count(&mut self) -> Option<usize> {
        usize::try_from(u64::from_le_bytes(self.take()?)).ok()
    }

    /// A count, and so many rows of numbers.
    fn rows<const N: usize>(&mut self) -> Option<Vec<[f64; N]>> {
        let count = self.count()?;
        if self.0.len() < count.checked_mul(8 * N)? {
            return None;
        }
        let mut rows = vec![[0.0; N]; count];
        for number in rows.as_flattened_mut() {
            *number = self.number()?;
        }
        Some(rows)
    }

    fn vectors(&mut self) -> Option<Vec<Vector>> {
        Some(self.rows()?.iter().map(|&[x, y, z]| Vector::new(x, y, z)).collect())
    }

    fn numbers(&mut self) -> Option<Vec<f64>> {
        Some(self.rows()?.iter().map(|&[number]| number).collect())
    }

    fn state(&mut self, count: usize) -> Option<State> {
        let mut state = State::zeros(count);
        for axis in state.position.0.iter_mut().chain(&mut state.velocity.0) {
            for value in axis.iter_mut() {
                *value = self.number()?;
            }
        }
        Some(state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::FieldKind;

    fn checkpoint() -> Checkpoint {
        let state = State::at_rest(&[Vector::new(1.0, -0.0, 3.5), Vector::new(0.1, 1e-300, 7.0)]);
        let mut memory = Memory::new(&state, 3);
        (memory.tensions[1], memory.step, memory.substeps) = (2.5, 0.01, 4);
        let (target, goal) = (Vector::new(1.0, 2.0, 3.0), Vector::new(-1.0, 0.5, 0.0));
        let (pins, pin_stiffness) = (vec![Held { weight: 0.25, target, goal }], vec![30.0]);
        let held = Goal { particle: 1, stiffness: 3.0, damping: 0.5, from: goal, to: target };
        let grab = Grab { goals: vec![held] };
        let points = [0.0, 0.5].map(|z| vec![Vector::new(1.5, -2.0, z)]);
        let (colliders, memory) = (points, Some(memory));
        let fields = vec![Field::new(FieldKind::Drag, 0.5)];
        let (tears, shape) = (vec![1.0, 7.0, 0.0], vec![1.0, 0.25]);
        Checkpoint {
            digest: 7,
            frame: -3,
            substeps: 9,
            state,
            pins,
            pin_stiffness,
            grab,
            gravity: Vector::new(0.5, 0.0, -9.81),
            winds: vec![[Vector::new(0.0, 3.0, -1.0), Vector::new(0.5, 6.0, -2.0)]],
            fields,
            water: vec![0.5, 1.0, 0.25],
            colliders,
            tears,
            shape,
            memory,
        }
    }

    #[test]
    fn a_checkpoint_reads_back_as_it_was_written() {
        for memory in [checkpoint().memory, None] {
            let checkpoint = Checkpoint { memory, ..checkpoint() };
            assert_eq!(Checkpoint::from_bytes(&checkpoint.to_bytes()), Ok(checkpoint));
        }
    }

    /// Whole by its checksum all the same.
    #[test]
    fn what_no_simulation_comes_to_is_refused() {
        let spoils: [fn(&mut Checkpoint); 12] = [
            |bad| bad.state.position.0[1][0] = f64::NAN,
            |bad| bad.state.velocity.0[2][1] = 1e200,
            |bad| bad.frame = i32::MIN,
            |bad| bad.substeps = u32::MAX,
            |bad| bad.pins[0].weight = 1.5,
            |bad| bad.pins[0].target.z = f64::INFINITY,
            |bad| bad.pin_stiffness[0] = -1.0,
            |bad| bad.grab.goals[0].damping = f64::NAN,
            |bad| bad.gravity.x = f64::NAN,
            |bad| bad.colliders[1][0].y = f64::NEG_INFINITY,
            |bad| bad.shape[1] = 1e300,
            |bad| bad.memory.iter_mut().for_each(|memory| memory.step = f64::NAN),
        ];
        for (number, spoil) in spoils.iter().enumerate() {
            let mut bad = checkpoint();
            spoil(&mut bad);
            assert!(Checkpoint::from_bytes(&bad.to_bytes()).is_err(), "{number}");
        }
    }

    #[test]
    fn every_single_damaged_byte_is_noticed() {
        let good = checkpoint().to_bytes();
        for index in 0..good.len() {
            let mut bad = good.clone();
            bad[index] ^= 0x10;
            assert!(Checkpoint::from_bytes(&bad).is_err(), "byte {index}");
            assert!(Checkpoint::from_bytes(&good[..index]).is_err(), "cut at {index}");
        }
    }
}
