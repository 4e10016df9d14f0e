//! report.json: what was baked, and the certificate of every frame.
//!
//! Strict JSON (a number that is not finite is null), replaced whole after every frame. The rows are kept as text, so that a
//! long bake does not write its numbers again and again, and a resumed one keeps them to the letter.

use std::ops::Range;
use std::path::Path;

use boucle_solver::{Certificate, Cloth, Simulation};
use serde::Serialize;

use crate::atomic::{self, Durability};
use crate::error::Result;

/// A cloth of the report.
#[derive(Clone, Debug, Serialize)]
pub struct ClothRow {
    /// Its name.
    pub name: String,
    /// How many vertices it has.
    pub vertices: usize,
    /// How many triangles its faces fall into.
    pub triangles: usize,
    /// How many springs hold it.
    pub springs: usize,
}

impl From<&Cloth> for ClothRow {
    fn from(cloth: &Cloth) -> Self {
        Self {
            name: cloth.name.clone(),
            vertices: cloth.mesh.vertex_count(),
            triangles: cloth.mesh.triangle_count(),
            springs: cloth.springs.len(),
        }
    }
}

/// How many overstretched edges a row names.
const MOST_NAMED: usize = 8;

/// An edge that is longer than its cloth allows.
#[derive(Clone, Debug, Serialize)]
pub struct OverstretchedRow {
    /// The name of its cloth.
    pub cloth: String,
    /// Its vertices.
    pub vertices: [u32; 2],
    /// Its elongation `L/L0 - 1`.
    pub strain: f64,
}

/// The certificate of a frame as the report has it.
#[derive(Clone, Debug, Serialize)]
pub struct FrameRow {
    /// The frame.
    pub frame: i32,
    /// Wall-clock time (s) that it took.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// Steps that led here from the frame before.
    pub substeps: u32,
    /// Iterations of the linear solver.
    pub iterations: u32,
    /// Largest elongation `L/L0 - 1` of mesh edges.
    pub max_strain: f64,
    /// 99th percentile of the same.
    pub p99_strain: f64,
    /// Largest elongation of shear springs.
    pub max_shear_strain: f64,
    /// Edge-triangle intersections, exactly: of cloths with themselves, each other and colliders; null if nothing collides.
    pub intersections: Option<u64>,
    /// Vertices whose motion contact cut short, once for each step.
    pub clipped: u32,
    /// Contacts at the end of the frame.
    pub contacts: u32,
    /// Kinetic energy (J).
    pub kinetic_energy: f64,
    /// Energy of springs and of height (J).
    pub potential_energy: f64,
    /// XXH3-64 over all positions (f64), 16 hexadecimal digits.
    pub hash: String,
    /// XXH3-64 over the bytes of the frame's sample in the cache of each cloth, likewise; left out without caches.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sample_hashes: Vec<String>,
    /// How many edges are longer than the deformation rate of their cloth allows; left out if there are none.
    #[serde(skip_serializing_if = "is_none")]
    pub overstretched_count: usize,
    /// The worst of them, the worst first; left out if there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub overstretched: Vec<OverstretchedRow>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks so")]
fn is_none(count: &usize) -> bool {
    *count == 0
}

impl FrameRow {
    /// A row from a certificate and the wall-clock time (s) of its frame.
    #[must_use]
    pub fn new(certificate: &Certificate, seconds: Option<f64>) -> Self {
        Self {
            frame: certificate.frame,
            seconds,
            substeps: certificate.substeps,
            iterations: certificate.iterations,
            max_strain: certificate.max_strain,
            p99_strain: certificate.p99_strain,
            max_shear_strain: certificate.max_shear_strain,
            intersections: certificate.intersections,
            clipped: certificate.clipped,
            contacts: certificate.contacts,
            kinetic_energy: certificate.kinetic_energy,
            potential_energy: certificate.potential_energy,
            hash: format!("{:016x}", certificate.hash),
            sample_hashes: Vec::new(),
            overstretched_count: 0,
            overstretched: Vec::new(),
        }
    }

    /// The same row with the edges that are overstretched at the state which the certificate is of.
    #[must_use]
    pub fn naming_overstretched(self, simulation: &Simulation) -> Self {
        self.naming_overstretched_of(simulation, 0..simulation.cloth_count())
    }

    /// The same of some cloths, of which the certificate is.
    #[must_use]
    pub fn naming_overstretched_of(
        mut self,
        simulation: &Simulation,
        cloths: Range<usize>,
    ) -> Self {
        for index in cloths {
            let cloth = simulation.cloth(index);
            // Mostly there are none, which the certificate knows.
            if self.max_strain <= cloth.material.deformation_rate {
                continue;
            }
            let edges = simulation.overstretched_edges(index);
            self.overstretched_count += edges.len();
            let worst = edges.iter().take(MOST_NAMED).map(|edge| OverstretchedRow {
                cloth: cloth.name.clone(),
                vertices: edge.ends,
                strain: edge.strain,
            });
            self.overstretched.extend(worst);
        }
        self.overstretched.sort_by(|one, other| other.strain.total_cmp(&one.strain));
        self.overstretched.truncate(MOST_NAMED);
        self
    }

    /// The same row with the hashes of the samples that the caches hold of the frame.
    #[must_use]
    pub fn with_samples(mut self, hashes: &[u64]) -> Self {
        self.sample_hashes = hashes.iter().map(|hash| format!("{hash:016x}")).collect();
        self
    }

    /// The row as JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        json(self)
    }
}

/// The hashes of the samples of a frame, from its row as JSON; none if it is no row of a bake.
pub(crate) fn sample_hashes(row: &str) -> Vec<u64> {
    let row: serde_json::Value = serde_json::from_str(row).unwrap_or_default();
    let hashes = row["sample_hashes"].as_array().into_iter().flatten();
    hashes.filter_map(|hash| u64::from_str_radix(hash.as_str()?, 16).ok()).collect()
}

/// The report of a bake.
#[derive(Clone, Debug)]
pub struct Report {
    /// Everything above `frames`, as JSON members.
    head: String,
    rows: Vec<String>,
    total_seconds: f64,
    /// Bytes, when time was last added.
    peak_memory: Option<u64>,
}

/// What stands above the rows.
#[derive(Clone, Debug, Serialize)]
pub struct Head<'a> {
    /// The version of this program.
    pub boucle: &'a str,
    /// The scene file, as it was given.
    pub scene: &'a str,
    /// Worker threads.
    pub threads: usize,
    /// Which rule moved the particles.
    pub integrator: &'a str,
    /// What `hash` is.
    pub hash_algorithm: &'a str,
    /// Every cloth.
    pub cloths: Vec<ClothRow>,
}

impl Report {
    /// A report that goes on after the rows (JSON each) and the time (s) of an earlier part of the bake.
    #[must_use]
    pub fn new(head: &Head<'_>, rows: Vec<String>, total_seconds: f64) -> Self {
        let head = json(head);
        let head = head.strip_suffix('}').unwrap_or(&head).to_owned();
        Self { head, rows, total_seconds, peak_memory: peak_memory_bytes() }
    }

    /// The rows so far, JSON each.
    #[must_use]
    pub fn rows(&self) -> &[String] {
        &self.rows
    }

    /// Wall-clock time (s) so far.
    #[must_use]
    pub fn total_seconds(&self) -> f64 {
        self.total_seconds
    }

    /// Adds a frame.
    pub fn push(&mut self, row: &FrameRow) {
        self.rows.push(row.to_json());
    }

    /// Takes the last frame back.
    pub fn pop(&mut self) {
        self.rows.pop();
    }

    /// Adds wall-clock time (s), and looks at the memory that was needed.
    pub fn spend(&mut self, seconds: f64) {
        self.total_seconds += seconds;
        self.peak_memory = peak_memory_bytes();
    }

    /// The whole report as JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let frames = self.rows.join(",\n");
        let (seconds, memory) = (json(&self.total_seconds), json(&self.peak_memory));
        format!(
            "{},\n\"frames\":[\n{frames}\n],\n\"total_seconds\":{seconds},\
             \"peak_memory_bytes\":{memory}}}\n",
            self.head
        )
    }

    /// Replaces the report on disk.
    ///
    /// # Errors
    /// [`Error::Cache`](crate::Error::Cache) when it cannot be written; the old one is then still there.
    pub fn write(&self, path: &Path) -> Result<()> {
        atomic::replace(path, self.to_json().as_bytes(), Durability::Process)
    }
}

/// JSON of what always has one: the rows above hold only numbers and text.
fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_else(|_| "null".to_owned())
}

/// The most memory (bytes) that this process has held: the system's own figure on Linux, elsewhere what it holds now; null
/// where neither can be asked.
fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kibibytes = peak.and_then(|text| text.trim().strip_suffix(" kB")?.parse::<u64>().ok());
    let now = || memory_stats::memory_stats().map(|memory| memory.physical_mem as u64);
    kibibytes.map(|count| count << 10).or_else(now)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn certificate(frame: i32) -> Certificate {
        Certificate {
            frame,
            substeps: 4,
            iterations: 0,
            max_strain: 0.1,
            p99_strain: f64::NAN,
            max_shear_strain: 0.0,
            intersections: None,
            clipped: 0,
            contacts: 0,
            kinetic_energy: 1.5,
            potential_energy: -2.0,
            hash: 0xab,
        }
    }

    fn report() -> Report {
        let head = Head {
            boucle: "0.1.0",
            scene: "a \"b\".toml",
            threads: 2,
            integrator: "verlet",
            hash_algorithm: "xxh3-64",
            cloths: vec![ClothRow { name: "}".into(), vertices: 4, triangles: 2, springs: 6 }],
        };
        Report::new(&head, Vec::new(), 1.0)
    }

    #[test]
    fn a_report_is_strict_json_with_and_without_frames() {
        let mut report = report();
        for count in 0..3 {
            let value: serde_json::Value =
                serde_json::from_str(&report.to_json()).expect("strict JSON");
            assert_eq!(value["frames"].as_array().map(Vec::len), Some(count));
            assert_eq!(value["cloths"][0]["name"], "}");
            assert_eq!(value["scene"], "a \"b\".toml");
            assert!(value["peak_memory_bytes"].as_u64().is_some_and(|bytes| bytes > 1 << 20));
            report.push(&FrameRow::new(&certificate(1), Some(0.25)));
        }
    }

    #[test]
    fn a_row_has_the_keys_of_the_contract() {
        let row = FrameRow::new(&certificate(7), Some(0.25)).to_json();
        let value: serde_json::Value = serde_json::from_str(&row).expect("strict JSON");
        assert_eq!(value["hash"], "00000000000000ab");
        assert!(value["intersections"].is_null() && value["p99_strain"].is_null());
        let keys: Vec<&str> =
            value.as_object().expect("a row").keys().map(String::as_str).collect();
        let mut expected = [
            "frame",
            "seconds",
            "substeps",
            "iterations",
            "max_strain",
            "p99_strain",
            "max_shear_strain",
            "intersections",
            "clipped",
            "contacts",
            "kinetic_energy",
            "potential_energy",
            "hash",
        ];
        expected.sort_unstable();
        assert_eq!(keys, expected);
        let row = FrameRow::new(&certificate(7), None).to_json();
        assert!(!row.contains("seconds"));
        let row = FrameRow::new(&certificate(7), None).with_samples(&[3, u64::MAX]).to_json();
        assert_eq!(sample_hashes(&row), [3, u64::MAX]);
    }

    #[test]
    fn a_row_tells_how_cloth_touches() {
        let touching =
            Certificate { intersections: Some(0), clipped: 3, contacts: 5, ..certificate(7) };
        let row = FrameRow::new(&touching, None).to_json();
        let value: serde_json::Value = serde_json::from_str(&row).expect("strict JSON");
        let numbers = ["intersections", "clipped", "contacts"].map(|key| value[key].as_u64());
        assert_eq!(numbers, [Some(0), Some(3), Some(5)]);
    }
}
