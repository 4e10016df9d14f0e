//! A simulation as the outside holds it: cloths that move frame by frame.

mod carrying;
mod certifying;
mod contact;
mod forces;
mod holding;
mod interrupt;
mod parting;
mod placing;
mod plan;
mod reading;
mod saved_shape;
mod saved_tears;
mod saving;
mod shape;
mod tearing;
mod tension;

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use boucle_geometry::Vector;
use rayon::ThreadPool;

use crate::awake::with_others_awake;
use crate::certificate::Certificate;
use crate::cloth::{Cloth, placed};
use crate::collider::Collider;
use crate::contact::Contacts;
use crate::digest::digest;
use crate::error::{Error, Result};
use crate::fabric::Crease;
use crate::force::Wind;
use crate::grab::Grab;
use crate::implicit::{Accuracy, Memory};
use crate::interrupter::Interrupter;
use crate::kernel::CHUNK;
use crate::limit::Limit;
use crate::method::Method;
use crate::perturbation::perturb;
use crate::pins::Pins;
use crate::rest::Rest;
use crate::settings::Settings;
use crate::sewing::Seams;
use crate::stability::Spectrum;
use crate::state::State;
use crate::step::Step;
use crate::system::System;
use crate::tear::Split;
use crate::threads;

/// Cloths in motion, at the end of a frame.
pub struct Simulation {
    cloths: Vec<Cloth>,
    colliders: Vec<Collider>,
    /// First particle of each cloth.
    bases: Vec<u32>,
    settings: Settings,
    system: System,
    spectrum: Spectrum,
    digest: u64,
    pins: Pins,
    grab: Grab,
    contacts: Contacts,
    limits: Vec<Limit>,
    /// Of the cloths whose rest lengths change.
    rests: Vec<Option<Box<Rest>>>,
    seams: Seams,
    /// Of the cloths that tear.
    splits: Vec<Option<Box<Split>>>,
    /// As they were given.
    winds: Vec<Wind>,
    state: State,
    /// The state at the start of a frame, to fall back on.
    good: State,
    good_memory: Option<Memory>,
    good_creases: Vec<Crease>,
    method: Method,
    frame: i32,
    accuracy: Accuracy,
    /// Steps that led to the present frame.
    substeps_taken: u32,
    /// Iterations of the linear solver in those.
    iterations_taken: u32,
    /// Vertices cut short in those.
    clipped: u32,
    /// Of the present state, if anything can touch.
    intersections: Option<u64>,
    threads: Arc<ThreadPool>,
    interrupter: Interrupter,
}

/// How a frame went.
enum Outcome {
    Well,
    /// A particle is lost.
    Lost(usize),
    /// Its steps were too long for its contacts.
    TooLong,
    /// It was stopped from outside.
    Interrupted,
}

impl fmt::Debug for Simulation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Simulation of {} particles at frame {}", self.state.len(), self.frame)
    }
}

impl Simulation {
    /// A simulation at its first frame, at rest.
    ///
    /// # Errors
    /// When a cloth, a wind or a setting is not accepted, or no allowed number of substeps is stable.
    pub fn new(cloths: Vec<Cloth>, winds: Vec<Wind>, settings: Settings) -> Result<Self> {
        Self::with_colliders(cloths, Vec::new(), winds, settings)
    }

    /// A simulation at its first frame, at rest, among colliders.
    ///
    /// # Errors
    /// When a cloth, a collider, a wind or a setting is not accepted, or no allowed number of substeps is stable.
    pub fn with_colliders(
        cloths: Vec<Cloth>,
        colliders: Vec<Collider>,
        winds: Vec<Wind>,
        settings: Settings,
    ) -> Result<Self> {
        settings.check()?;
        cloths.iter().try_for_each(Cloth::check)?;
        colliders.iter().try_for_each(Collider::check)?;
        for cloth in &cloths {
            if let Some(collision) = &cloth.collision {
                let others = [colliders.len(), cloths.len()];
                collision.check(&cloth.name, cloth.positions.len(), others)?;
            }
        }
        winds.iter().try_for_each(|wind| wind.check(&cloths))?;
        let digest = digest(&cloths, &colliders, &winds, &settings);
        let threads = threads::take(settings.threads)?;
        let split =
            |cloth: &Cloth| cloth.tear.as_ref().map(|_| Box::new(Split::new(cloth.clone())));
        let splits = cloths.iter().map(split).collect();
        let pool = (threads, Interrupter::default());
        let made = Self::assemble(cloths, (colliders, winds), settings, pool);
        let mut simulation = Self { digest, splits, ..made };
        simulation.shrink_from_the_first()?;
        simulation.crease();
        simulation.intersect();
        simulation.plan()?;
        Ok(simulation)
    }

    /// A simulation of what has been checked.
    fn assemble(
        cloths: Vec<Cloth>,
        (colliders, winds): (Vec<Collider>, Vec<Wind>),
        settings: Settings,
        (threads, interrupter): (Arc<ThreadPool>, Interrupter),
    ) -> Self {
        let bases: Vec<u32> = placed(&cloths).map(|(_, base)| base).collect();
        let positions: Vec<Vector> =
            cloths.iter().flat_map(|cloth| cloth.positions.iter().copied()).collect();
        let state = State::at_rest(&positions);
        let system = System::new(&cloths, winds.clone(), settings.water.clone(), settings.gravity);
        let mut simulation = Self {
            pins: Pins::new(&cloths, &state),
            grab: Grab::default(),
            method: Method::new(&settings, &cloths, &system, &state, &interrupter),
            system,
            spectrum: Spectrum::default(),
            contacts: Contacts::new(&cloths, &colliders, &interrupter),
            limits: Vec::new(),
            rests: cloths.iter().map(|_| None).collect(),
            seams: Seams::new(&cloths),
            splits: cloths.iter().map(|_| None).collect(),
            winds,
            good: state.clone(),
            good_memory: None,
            good_creases: Vec::new(),
            frame: settings.first_frame,
            accuracy: Accuracy {
                tolerance: settings.tolerance,
                size: plan::size_of(&cloths),
                is_in_contact: false,
            },
            substeps_taken: 0,
            iterations_taken: 0,
            clipped: 0,
            intersections: None,
            cloths,
            colliders,
            bases,
            settings,
            digest: 0,
            state,
            threads,
            interrupter,
        };
        simulation.start_holds();
        simulation
    }

    /// The frame that the state belongs to.
    #[must_use]
    pub fn frame(&self) -> i32 {
        self.frame
    }

    /// How many cloths there are.
    #[must_use]
    pub fn cloth_count(&self) -> usize {
        self.cloths.len()
    }

    /// A cloth as it is now: as it was given, or in the pieces that it is torn into.
    ///
    /// # Panics
    /// When there is no cloth of this number; so do the other functions that take one.
    #[must_use]
    pub fn cloth(&self, cloth: usize) -> &Cloth {
        &self.cloths[cloth]
    }

    /// Moves on by one frame.
    ///
    /// # Errors
    /// [`Error::Diverged`] and [`Error::Interrupted`] leave the state of the last good frame;
    /// [`Error::TooManySubsteps`] and [`Error::Unstable`] leave the state as it is.
    pub fn advance(&mut self) -> Result<Certificate> {
        self.gather_goals();
        self.start_flows();
        let mut substeps = self.plan()?;
        self.keep();
        let mut outcome = self.run(substeps, false);
        while let Some(more) = self.plan_again(substeps, &outcome) {
            self.fall_back();
            substeps = more;
            outcome = self.run(substeps, false);
        }
        if matches!(outcome, Outcome::Interrupted) {
            return Err(self.interrupted());
        }
        if let Outcome::Lost(last) = outcome {
            // Once more, looking after each step: what is lost spreads from step to step.
            self.fall_back();
            let first = match self.run(substeps, true) {
                Outcome::Lost(first) => first,
                Outcome::Interrupted => return Err(self.interrupted()),
                _ => last,
            };
            self.fall_back();
            return Err(self.diverged(first));
        }
        self.frame += 1;
        self.end_flows();
        self.end_shape();
        self.end_holds();
        self.contacts.end_frame();
        self.clipped = self.contacts.take_clipped();
        self.iterations_taken = self.method.take_iterations();
        self.substeps_taken = substeps;
        let accuracy = self.accuracy_now();
        if let Some(memory) = self.method.memory_mut() {
            memory.substeps = accuracy.after(substeps, memory.mean_error(substeps));
            memory.error = 0.0;
        }
        let contacts = self.contacts.count();
        if !self.tear() {
            self.intersect();
        }
        Ok(Certificate { contacts, ..self.certificate() })
    }

    /// Keeps the state, to fall back on it.
    fn keep(&mut self) {
        self.good.copy_from(&self.state);
        self.good_creases.clear();
        self.good_creases.extend_from_slice(self.system.fabrics.creases());
        if let Some(memory) = self.method.memory() {
            self.good_memory.get_or_insert_with(|| memory.clone()).copy_from(memory);
        }
    }

    /// Returns to the state that was kept.
    fn fall_back(&mut self) {
        self.method.take_iterations();
        self.contacts.take_clipped();
        self.state.copy_from(&self.good);
        self.shape(0.0, true);
        self.system.fabrics.put_creases(&self.good_creases);
        if self.intersections.is_some_and(|count| count > 0) {
            self.intersect();
        }
        if let (Some(memory), Some(good)) = (self.method.memory_mut(), &self.good_memory) {
            memory.copy_from(good);
        }
    }

    /// Moves on by the steps of a frame, and looks for what is lost at its end; or, if it watches, after each step.
    fn run(&mut self, substeps: u32, watches: bool) -> Outcome {
        let may_shorten = !watches && self.may_shorten(substeps);
        let duration = self.frame_duration();
        let h = duration / f64::from(substeps);
        if self.frame == self.settings.first_frame && self.settings.perturbation > 0.0 {
            perturb(&mut self.state, &self.cloths, self.settings.perturbation);
        }
        self.pins.start(&mut self.state, duration);
        self.system.air.start_steps(h, self.method.is_implicit());
        let stride = plan::stride(&self.method, self.longest_way(), substeps);
        // No pass has work for more.
        let others = self.state.len() / CHUNK;
        let threads = Arc::clone(&self.threads);
        threads.install(|| {
            with_others_awake(others, || {
                let outcome = (1..=substeps).find_map(|substep| {
                    if self.interrupter.take() {
                        return Some(Outcome::Interrupted);
                    }
                    self.shape(f64::from(substep) / f64::from(substeps), false);
                    self.system.goals.start_step(substep, substeps);
                    self.system.air.start_step(f64::from(substep) * h);
                    let Self { system, pins, contacts, limits, state, method, interrupter, .. } =
                        &mut *self;
                    let (number, count, interrupter) = (substep, substeps, &*interrupter);
                    let step = Step { system, pins, h, number, count, stride, interrupter };
                    let is_short = step.run(state, method, contacts, limits);
                    // What stopped half way must not be taken for a step.
                    if interrupter.take() {
                        return Some(Outcome::Interrupted);
                    }
                    self.system.fabrics.give_way(&self.state);
                    let is_seen = watches || substep == substeps;
                    let lost = if is_seen { self.state.first_lost() } else { None };
                    let too_long = (may_shorten && !is_short).then_some(Outcome::TooLong);
                    too_long.or(lost.map(Outcome::Lost))
                });
                outcome.unwrap_or(Outcome::Well)
            })
        })
    }

    fn diverged(&self, particle: usize) -> Error {
        let cloth = self.bases.partition_point(|&base| base as usize <= particle) - 1;
        Error::Diverged {
            frame: self.frame + 1,
            vertex: particle - self.bases[cloth] as usize,
            cloth: self.cloths[cloth].name.clone(),
        }
    }

    fn frame_duration(&self) -> f64 {
        1.0 / self.settings.fps
    }

    fn particles(&self, cloth: usize) -> Range<usize> {
        let base = self.bases[cloth] as usize;
        base..base + self.cloths[cloth].positions.len()
    }
}
