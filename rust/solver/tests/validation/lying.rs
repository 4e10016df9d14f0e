//! The sheet of the implicit tests: it lies flat, falls, and swings from what holds it.

use boucle_solver::{Cloth, IntegratorKind, Mass, Settings, SpringMaterial};

use crate::sheets::{grid_mesh, grid_positions};

/// What is promised over the rate at a frame's end: 0.1 percentage points.
pub(crate) const PROMISE: f64 = 1e-3;

/// How a sheet hangs.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Hung {
    Corner,
    Corners,
    Edge,
}

/// 2 m x 2 m and 0.2 kg/m², lying flat before it falls.
pub(crate) fn lying_sheet(side: u32, hung: Hung, material: SpringMaterial) -> Cloth {
    let positions = grid_positions(side, side, 2.0 / f64::from(side - 1));
    let corner = side * side - side;
    let pins = match hung {
        Hung::Corner => vec![corner],
        Hung::Corners => vec![corner, side * side - 1],
        Hung::Edge => (corner..side * side).collect(),
    };
    let mesh = grid_mesh(side, side);
    Cloth::from_mesh("lying", mesh, positions, &Mass::Density(0.2), material, pins)
        .expect("a sheet")
}

pub(crate) fn settings(integrator: IntegratorKind) -> Settings {
    Settings { integrator, perturbation: 1e-6, ..Settings::default() }
}

pub(crate) fn limited(rate: f64) -> SpringMaterial {
    SpringMaterial { deformation_rate: rate, ..SpringMaterial::default() }
}
