//! Finds what touches on the way that the cloth would take.

use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::Contacts;
use super::candidate::Candidate;
use super::contact::{Contact, Near};
use super::pressing::Pressure;
use crate::state::Coordinates;

/// What one detection found, and how long it took.
#[derive(Clone, Copy, Debug)]
pub struct Detection {
    /// Contacts: pairs of features near enough to press each other.
    pub contacts: usize,
    /// Candidates that may meet on ways near those that were expected.
    pub watched: usize,
    /// Time for fitting all boxes.
    pub fit: Duration,
    /// Time for finding the pairs and taking a close look at them.
    pub search: Duration,
    /// Time for all of it, with the matrix of the contacts.
    pub whole: Duration,
}

/// What a task has found.
#[derive(Default)]
struct Found {
    watched: Vec<Candidate>,
    contacts: Vec<Contact>,
}

impl Contacts {
    /// Finds the contacts on the way to these positions (m), in a step of h' seconds, and what to watch there.
    pub(crate) fn detect(
        &mut self,
        ends: &Coordinates,
        inverse_masses: &[f64],
        h: f64,
    ) -> Detection {
        let start = Instant::now();
        self.paths.set_ends(ends);
        self.expected.copy_from_slice(&self.paths.step);
        self.is_safe = false;
        self.fit(|body| body.radius + body.thickness.max(body.slack));
        let fit = start.elapsed();
        let Self { bodies, paths, .. } = &*self;
        let found = self.search(|candidate, found: &mut Found| {
            let near = Near::new(&candidate, bodies, paths);
            let contact = near.contact(&candidate, bodies);
            if contact.is_some() || near.is_to_be_watched() {
                found.watched.push(candidate);
                found.contacts.extend(contact);
            }
        });
        let search = start.elapsed().saturating_sub(fit);
        self.remembered.renew(&self.near, &self.pressures);
        self.take(&found);
        self.near.par_iter_mut().for_each(|contact| contact.stiffen(inverse_masses, h));
        self.matrix.join(&self.near, inverse_masses);
        let Self { near, pressures, remembered, .. } = self;
        pressures.clear();
        pressures.extend(near.iter().map(|contact| Pressure::expected(remembered.of(contact))));
        Detection {
            contacts: self.near.len(),
            watched: self.watched.len(),
            fit,
            search,
            whole: start.elapsed(),
        }
    }

    /// Takes the findings of all tasks for its own, in their order, with what else presses.
    fn take(&mut self, found: &[Found]) {
        self.watched.clear();
        self.near.clear();
        for Found { watched, contacts } in found {
            self.watched.extend_from_slice(watched);
            self.near.extend_from_slice(contacts);
        }
        let mut contacts = std::mem::take(&mut self.near);
        contacts.extend(self.parting());
        self.each_plane(|particle, plane, normal| {
            let points = [particle, plane.points[0]];
            contacts.extend(Contact::with_plane(points, normal, &self.bodies, &self.paths));
        });
        self.near = contacts;
    }
}
