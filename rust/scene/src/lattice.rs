//! A named fabric as springs: what `[cloth.springs] preset` gives to the classic model.
//!
//! On squares of edge h, springs of stiffness s along the edges, d across the faces and b to the vertex after next are the
//! membrane
//!
//! ```text
//! C11 = s + d + 4 b        C12 = C66 = d        Y = C11 - C12²/C11            (N/m)
//! ```
//!
//! where Y is the stiffness of a strip whose sides are free. For a fabric of tensile stiffness Y, the mean of warp and weft,
//! and shear stiffness G that is solved by
//!
//! ```text
//! d = G        C11 = (Y + sqrt(Y² + 4 G²))/2        s = C11 - d - 4 b
//! ```
//!
//! A bend spring over 2 h is straight at rest, so a small curvature does not change its length: it has no bending stiffness of
//! its own. At the radius R it is shorter by h³/(3 R²), and b is chosen so that at R = 2 h, two edges, it holds as much energy
//! as the bending stiffness B (N·m), the mean of warp and weft:
//!
//! ```text
//! b/2 (h/12)² = B/2 h²/(2 h)²        b = 36 B/h²                               (N/m)
//! ```
//!
//! Flatter bends are softer than the fabric's, tighter ones stiffer, and b changes with the mesh. Where the edges are so short
//! that the bend springs would carry more than half of `C11 - d` (from about a millimetre down, half a centimetre for soft
//! knits), b is that half: stretch stays right, bending is too soft.
//!
//! A damping ratio z is that of the fabric: `c = 2 z k/w` for each kind, at w = q sqrt(Y/density), q sqrt(G/density) and
//! q² sqrt(B/density) for a wavelength 2π/q of 0.1 m, along the spring. A flat sheet that bends is hardly damped by that.
//!
//! What is lost besides: warp and weft are alike, and a stretched sheet narrows as the springs do (by d/C11).

use std::f64::consts::TAU;

use crate::preset::FabricPreset;

/// The wavelength (m) at which the damping ratios of fabrics hold.
const DAMPED_WAVELENGTH: f64 = 0.1;

/// Springs in the place of a fabric, by kind: stretch, shear, bend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// N/m, those of the membrane (`stiffness_from = "continuum"`).
    pub stiffness: [f64; 3],
    /// N·s/m, along the spring (`damping_law = "axial"`).
    pub damping: [f64; 3],
}

impl FabricPreset {
    /// The springs of a mesh whose edges are so long (m) in the mean.
    #[must_use]
    pub fn lattice(&self, edge: f64) -> Lattice {
        let tensile = f64::midpoint(self.stretch_warp, self.stretch_weft);
        let bending = f64::midpoint(self.bend_warp, self.bend_weft);
        let across = self.shear;
        let along = f64::midpoint(tensile, (tensile.powi(2) + 4.0 * across.powi(2)).sqrt());
        let bend = (36.0 * bending / edge.powi(2)).min((along - across) / 8.0);
        let stiffness = [along - across - 4.0 * bend, across, bend];
        let q = TAU / DAMPED_WAVELENGTH;
        let speed = |stiffness: f64| (stiffness / self.density).sqrt();
        let frequencies = [q * speed(tensile), q * speed(across), q * q * speed(bending)];
        let damping = |kind: usize| {
            let w = frequencies[kind];
            if w > 0.0 { 2.0 * self.damping_ratio * stiffness[kind] / w } else { 0.0 }
        };
        Lattice { stiffness, damping: [0, 1, 2].map(damping) }
    }
}

#[cfg(test)]
mod tests {
    use crate::fabric_presets;

    #[test]
    fn a_lattice_has_the_tensile_and_the_shear_stiffness_of_its_fabric() {
        for (name, preset) in fabric_presets() {
            for edge in [0.001, 0.01, 0.1] {
                let [s, d, b] = preset.lattice(edge).stiffness;
                assert!(s > 0.0 && d > 0.0 && b > 0.0, "{name}: {s} {d} {b}");
                let along = s + d + 4.0 * b;
                let tensile = f64::midpoint(preset.stretch_warp, preset.stretch_weft);
                assert!(((along - d * d / along) / tensile - 1.0).abs() < 1e-12, "{name}");
                assert!((d / preset.shear - 1.0).abs() < 1e-12, "{name}");
            }
        }
    }

    /// Springs along one direction of a cylinder of two edges' radius hold the energy of the bent plate.
    #[test]
    fn bent_to_a_radius_of_two_edges_a_lattice_holds_the_energy_of_its_fabric() {
        let denim = &fabric_presets()["denim"];
        let edge = 0.02_f64;
        let radius = 2.0 * edge;
        let chord = 2.0 * radius * (edge / radius).sin();
        let of_spring = 0.5 * denim.lattice(edge).stiffness[2] * (2.0 * edge - chord).powi(2);
        let bending = f64::midpoint(denim.bend_warp, denim.bend_weft);
        let of_fabric = 0.5 * bending / radius.powi(2) * edge.powi(2);
        assert!((of_spring / of_fabric - 1.0).abs() < 0.05, "{of_spring} J, {of_fabric} J");
    }

    #[test]
    fn short_edges_leave_stretch_right_and_bending_soft() {
        let rib = &fabric_presets()["rib_knit"];
        let [short, long] = [1e-4, 1.0].map(|edge| rib.lattice(edge).stiffness);
        assert!((short[0] - 4.0 * short[2]).abs() < 1e-9 * short[0], "{short:?}");
        assert!(short[2] < 36.0 * rib.bend_weft / 1e-8);
        assert!((long[2] / (18.0 * (rib.bend_warp + rib.bend_weft)) - 1.0).abs() < 1e-12);
    }
}
