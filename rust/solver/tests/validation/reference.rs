//! Tables that no code of this project made.

/// Energy and period of integrators on x'' = -x, from the eigenvalues of their matrices.
pub(crate) const INTEGRATORS: &str = include_str!("reference/integrators_sho.csv");

/// Largest eigenvalues and elastic moduli of spring lattices, from their Fourier symbol and dense matrices.
pub(crate) const LATTICES: &str = include_str!("reference/lattice_stability.csv");

/// Natural frequencies of hanging chains, from dense matrices.
pub(crate) const CHAINS: &str = include_str!("reference/hanging_chain_modes.csv");

/// Droop of a cantilever under its weight, from the boundary value problem of the elastica.
pub(crate) const ELASTICA: &str = include_str!("reference/heavy_elastica_cantilever.csv");

/// A table with named columns.
pub(crate) struct Table {
    names: Vec<&'static str>,
    rows: Vec<Vec<&'static str>>,
}

/// One row of a table.
pub(crate) struct Row<'a> {
    names: &'a [&'static str],
    cells: &'a [&'static str],
}

impl Table {
    pub(crate) fn of(text: &'static str) -> Self {
        let mut lines = text
            .lines()
            .filter(|line| !line.starts_with('#'))
            .map(|line| line.split(',').collect::<Vec<_>>());
        let names = lines.next().expect("a header");
        Self { names, rows: lines.collect() }
    }

    pub(crate) fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|cells| Row { names: &self.names, cells })
    }
}

impl Row<'_> {
    pub(crate) fn text(&self, name: &str) -> &'static str {
        let column = self.names.iter().position(|&other| other == name).expect("a column");
        self.cells[column]
    }

    pub(crate) fn number(&self, name: &str) -> f64 {
        self.text(name).parse().expect("a number")
    }
}
