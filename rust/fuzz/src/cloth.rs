//! Cloths that nobody would make: meshes of every bad kind, in any size, of any material.

use arbitrary::{Arbitrary, Unstructured};
use boucle_geometry::{Mesh, Vector};
use boucle_solver::{
    Cloth, Collision, DampingLaw, Fabric, Limiter, Mass, Opening, Sewing, SpringMaterial,
    StiffnessFrom, Tear, Warp, mesh_of,
};

use crate::demands::accepted;

/// A value out of the bytes, or its plainest where they have come to an end.
pub(crate) fn any<'a, T: Arbitrary<'a> + Default>(source: &mut Unstructured<'a>) -> T {
    source.arbitrary().unwrap_or_default()
}

/// One of some values.
pub(crate) fn one_of<T: Copy>(source: &mut Unstructured<'_>, values: &[T]) -> T {
    values[usize::from(any::<u8>(source)) % values.len()]
}

/// Less than a number.
fn below(source: &mut Unstructured<'_>, count: u32) -> u32 {
    u32::from(any::<u16>(source)) % count.max(1)
}

/// What no number should be, and the ends of what some may be.
const ODD: [f64; 14] = [
    0.0,
    -0.0,
    -1.0,
    1.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN_POSITIVE,
    5e-324,
    1e12,
    1e-12,
    1e6,
    -1e6,
];

/// A number of any size between two, and rarely an odd one.
pub(crate) fn number(source: &mut Unstructured<'_>, low: f64, high: f64) -> f64 {
    if any::<u8>(source) < 6 {
        return one_of(source, &ODD);
    }
    let part = f64::from(any::<u16>(source)) / 65535.0;
    (low.ln() + part * (high.ln() - low.ln())).exp()
}

/// A number from 0 to 1, and rarely an odd one.
pub(crate) fn part(source: &mut Unstructured<'_>) -> f64 {
    if any::<u8>(source) < 4 { one_of(source, &ODD) } else { f64::from(any::<u8>(source)) / 255.0 }
}

pub(crate) fn chance(source: &mut Unstructured<'_>, of_256: u8) -> bool {
    any::<u8>(source) < of_256
}

/// A cloth, or nothing where it was refused in one line.
pub(crate) fn cloth(source: &mut Unstructured<'_>) -> Option<Cloth> {
    let (mesh, positions) = mesh(source)?;
    let count = positions.len() as u32;
    let pins = (0..any::<u8>(source) % 4).map(|_| below(source, count)).collect();
    let mass = match any::<u8>(source) % 4 {
        0 => Mass::PerVertex(number(source, 1e-6, 10.0)),
        1 => Mass::Each((0..count).map(|_| number(source, 1e-6, 1.0)).collect()),
        _ => Mass::Density(number(source, 1e-3, 10.0)),
    };
    let start = chance(source, 40).then(|| {
        let factor = number(source, 0.1, 10.0);
        positions.iter().map(|position| position * factor).collect()
    });
    let material = springs(source);
    let mut cloth = accepted(Cloth::from_mesh("sheet", mesh, positions, &mass, material, pins))?;
    if chance(source, 100) {
        let fabric = fabric(source, &cloth);
        cloth = accepted(cloth.of_fabric(fabric))?;
    }
    if let Some(start) = start {
        cloth = accepted(cloth.starting_at(start))?;
    }
    if chance(source, 30) {
        let seams =
            (0..any::<u8>(source) % 5).map(|_| [below(source, count), below(source, count)]);
        let seams = seams.collect();
        let force_max = part(source);
        let weld_distance = number(source, 1e-4, 1.0);
        cloth = accepted(cloth.sewn(Sewing { seams, force_max, weld_distance }))?;
    }
    let pin_weights = if chance(source, 60) {
        cloth.pins.iter().map(|_| part(source)).collect()
    } else {
        Vec::new()
    };
    let tear = chance(source, 50).then(|| tear(source, &cloth));
    let collision = chance(source, 150).then(|| Collision {
        with_self: any(source),
        thickness: number(source, 1e-5, 1.0),
        friction: part(source),
        ..Collision::default()
    });
    Some(Cloth { pin_weights, tear, collision, ..cloth })
}

fn springs(source: &mut Unstructured<'_>) -> SpringMaterial {
    SpringMaterial {
        stiffness: [(); 3].map(|()| number(source, 1e-2, 1e5)),
        stiffness_from: one_of(source, &[StiffnessFrom::Springs, StiffnessFrom::Continuum]),
        damping: [(); 3]
            .map(|()| if chance(source, 128) { number(source, 1e-6, 10.0) } else { 0.0 }),
        damping_law: one_of(source, &[DampingLaw::Relative, DampingLaw::Axial]),
        air_damping: if chance(source, 64) { number(source, 1e-6, 1.0) } else { 0.0 },
        deformation_rate: part(source) * 0.999,
        limiter: one_of(
            source,
            &[Limiter::None, Limiter::Stiffen, Limiter::Provot, Limiter::Project],
        ),
    }
}

fn fabric(source: &mut Unstructured<'_>, cloth: &Cloth) -> Fabric {
    let corners = cloth.mesh.faces().map(<[u32]>::len).sum::<usize>();
    let direction = |source: &mut Unstructured<'_>| f64::from(any::<i8>(source) >> 5);
    Fabric {
        stretch: [(); 2].map(|()| number(source, 1.0, 1e5)),
        compression: [(); 2].map(|()| number(source, 1.0, 1e5)),
        shear: number(source, 1e-1, 1e4),
        bend: [(); 2].map(|()| number(source, 1e-8, 1e-1)),
        yield_curvature: chance(source, 60).then(|| number(source, 1.0, 1e3)),
        hardening: part(source) * 0.99,
        bend_hysteresis: if chance(source, 60) { number(source, 1e-6, 1e-2) } else { 0.0 },
        damping_ratio: [(); 3].map(|()| part(source)),
        warp: if chance(source, 180) {
            Warp::Along(Vector::from_fn(|_, _| direction(source)))
        } else {
            Warp::Mapped((0..corners).map(|_| [(); 2].map(|()| direction(source))).collect())
        },
    }
}

fn tear(source: &mut Unstructured<'_>, cloth: &Cloth) -> Tear {
    let edges = cloth.mesh.edges();
    let pair = |source: &mut Unstructured<'_>| {
        edges.get(below(source, edges.len() as u32) as usize).copied().unwrap_or_default()
    };
    let openings = (0..any::<u8>(source) % 3).map(|_| Opening {
        frame: i32::from(any::<u8>(source) % 4),
        pairs: (0..any::<u8>(source) % 4).map(|_| pair(source)).collect(),
    });
    Tear {
        openings: openings.collect(),
        force: chance(source, 100).then(|| number(source, 1e-4, 10.0)),
        strain: chance(source, 100).then(|| number(source, 1e-4, 1.0)),
        noise: part(source),
        seed: any(source),
        strength: Vec::new(),
        seam_force: chance(source, 60).then(|| number(source, 1e-3, 10.0)),
        stress: chance(source, 60).then(|| number(source, 1e-2, 1000.0)),
        start: chance(source, 60).then(|| i32::from(any::<u8>(source) % 4)),
    }
}

/// Sizes (m) of things, from dust to towns.
const SIZES: [f64; 8] = [1.0, 1.0, 1.0, 0.1, 1e-3, 1e-6, 100.0, 1e4];

/// A mesh and its positions (m), or nothing where it was refused in one line.
pub(crate) fn mesh(source: &mut Unstructured<'_>) -> Option<(Mesh, Vec<Vector>)> {
    let (mut faces, mut positions) = match any::<u8>(source) % 5 {
        0 | 1 => grid(source),
        2 => soup(source),
        3 => book(source),
        _ => pieces(source),
    };
    let size = one_of(source, &SIZES);
    let far = if chance(source, 20) { 1e5 } else { 0.0 };
    for position in &mut positions {
        *position = size * *position + Vector::repeat(far);
    }
    for _ in 0..any::<u8>(source) % 4 {
        spoil(source, &mut faces, &mut positions);
    }
    let mut starts = vec![0];
    for face in &faces {
        starts.push(starts[starts.len() - 1] + face.len() as u32);
    }
    let mesh = accepted(mesh_of("sheet", positions.len(), starts, faces.concat()))?;
    Some((mesh, positions))
}

type Faces = Vec<Vec<u32>>;

/// Quads, uneven.
fn grid(source: &mut Unstructured<'_>) -> (Faces, Vec<Vector>) {
    let [columns, rows] = [2 + below(source, 6), 2 + below(source, 6)];
    let rough = one_of(source, &[0.0, 0.0, 0.05, 0.5]);
    let mut positions = Vec::new();
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let at = [column, row].map(|n| f64::from(n) / f64::from(columns.max(rows) - 1));
        let off = Vector::from_fn(|_, _| rough * f64::from(any::<i8>(source)) / 128.0);
        positions.push(Vector::new(at[0], 0.0, at[1]) + off / f64::from(columns));
    }
    let cuts = any::<bool>(source);
    let mut faces = Vec::new();
    for (row, column) in
        (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| (row, column)))
    {
        let v = row * columns + column;
        if cuts {
            faces.push(vec![v, v + 1, v + columns + 1]);
            faces.push(vec![v, v + columns + 1, v + columns]);
        } else {
            faces.push(vec![v, v + 1, v + columns + 1, v + columns]);
        }
    }
    (faces, positions)
}

/// Any faces over points of a coarse lattice, many of which coincide.
fn soup(source: &mut Unstructured<'_>) -> (Faces, Vec<Vector>) {
    let count = 3 + below(source, 14);
    let positions = (0..count)
        .map(|_| Vector::from_fn(|_, _| f64::from(any::<i8>(source) >> 5) / 4.0))
        .collect();
    let faces = (0..=below(source, 16)).map(|_| {
        let corners = 3 + below(source, 3);
        let first = below(source, count);
        (0..corners).map(|corner| (first + corner * (1 + below(source, 2))) % count).collect()
    });
    (faces.collect(), positions)
}

/// Pages around one edge: no manifold from the third on.
fn book(source: &mut Unstructured<'_>) -> (Faces, Vec<Vector>) {
    let pages = 1 + below(source, 9);
    let mut positions = vec![Vector::zeros(), Vector::z()];
    for page in 0..pages {
        let angle = f64::from(page) * f64::from(any::<u8>(source)) / 40.0;
        let height = f64::from(any::<u8>(source)) / 255.0;
        positions.push(Vector::new(angle.cos(), angle.sin(), height));
    }
    let face = |page: u32| {
        if page.is_multiple_of(2) { vec![0, 1, 2 + page] } else { vec![1, 0, 2 + page] }
    };
    ((0..pages).map(face).collect(), positions)
}

/// Triangles that hang together nowhere, some of them needles.
fn pieces(source: &mut Unstructured<'_>) -> (Faces, Vec<Vector>) {
    let count = 1 + below(source, 10);
    let mut positions = Vec::new();
    for piece in 0..count {
        let thin = one_of(source, &[1.0, 1.0, 1e-3, 1e-7]);
        let at = Vector::new(0.01 * f64::from(piece), 0.003 * f64::from(any::<i8>(source)), 0.0);
        positions
            .extend([Vector::zeros(), Vector::x(), Vector::new(0.5, 0.0, thin)].map(|p| p + at));
    }
    ((0..count).map(|piece| vec![3 * piece, 3 * piece + 1, 3 * piece + 2]).collect(), positions)
}

/// Takes something of a mesh away from what it should be.
fn spoil(source: &mut Unstructured<'_>, faces: &mut Faces, positions: &mut Vec<Vector>) {
    let (face_count, count) = (faces.len() as u32, positions.len() as u32);
    if face_count == 0 {
        return;
    }
    let (face, vertex) = (below(source, face_count) as usize, below(source, count) as usize);
    let other = below(source, count) as usize;
    match any::<u8>(source) % 10 {
        0 => faces[face].reverse(),
        1 => faces.push(faces[face].clone()),
        2 => positions[vertex] = positions[other],
        3 => positions[vertex][below(source, 3) as usize] = number(source, 1e-6, 1e4),
        4 => {
            let corner = below(source, faces[face].len() as u32) as usize;
            faces[face][corner] = below(source, count + 1);
        }
        5 => {
            faces.swap_remove(face);
        }
        6 => positions.push(positions[vertex]),
        7 => {
            // The same once more, joined to itself nowhere.
            let copies = faces.iter().map(|face| face.iter().map(|v| v + count).collect());
            let copies: Faces = copies.collect();
            let off = one_of(source, &[0.0, 1e-9, 1e-3]);
            let again: Vec<Vector> = positions.iter().map(|p| p.add_scalar(off)).collect();
            if count < 60 {
                faces.extend(copies);
                positions.extend(again);
            }
        }
        8 => {
            let thin = one_of(source, &[0.0, 1e-12, 1e-6]);
            for position in positions.iter_mut() {
                position.x *= thin;
            }
        }
        _ => {
            let middle = positions[vertex];
            positions[other] = middle + (positions[other] - middle) * 1e-6;
        }
    }
}
