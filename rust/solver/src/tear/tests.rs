//! Torn meshes against brute force, and what is kept.

use super::*;
use crate::cloth::Mass;
use crate::material::SpringMaterial;
use boucle_geometry::{Mesh, Vector};

/// A grid of quads over so many vertices, 1 m from one to the next.
fn grid(columns: u32, rows: u32) -> Cloth {
    let faces: Vec<[u32; 4]> = (0..rows - 1)
        .flat_map(|r| (0..columns - 1).map(move |c| r * columns + c))
        .map(|a| [a, a + 1, a + columns + 1, a + columns])
        .collect();
    let count = columns * rows;
    let mesh = Mesh::from_faces(count as usize, &faces).expect("quads");
    let at = |i: u32| Vector::new(f64::from(i % columns), f64::from(i / columns), 0.0);
    let positions = (0..count).map(at).collect();
    let (mass, material) = (Mass::Density(0.2), SpringMaterial::default());
    Cloth::from_mesh("grid", mesh, positions, &mass, material, vec![0]).expect("a cloth")
}

fn torn(cloth: Cloth, edges: &[[u32; 2]]) -> Split {
    let mut split = Split::new(cloth);
    for &pair in edges {
        let edge = split.edge_between(pair).expect("an edge");
        split.tear(edge);
    }
    split
}

/// Into how many parts faces fall that share an edge which holds, and how many vertices the corners of faces around each vertex
/// fall into: by going from face to face.
fn vertices_by_brute_force(cloth: &Cloth, edges: &[[u32; 2]]) -> usize {
    let faces: Vec<&[u32]> = cloth.mesh.faces().collect();
    let has = |face: &[u32], [a, b]: [u32; 2]| {
        (0..face.len()).any(|i| {
            let side = [face[i], face[(i + 1) % face.len()]];
            side == [a, b] || side == [b, a]
        })
    };
    let mut count = 0;
    for vertex in 0..cloth.positions.len() as u32 {
        let own: Vec<usize> = (0..faces.len()).filter(|&f| faces[f].contains(&vertex)).collect();
        if cloth.pins.contains(&vertex) {
            count += 1;
            continue;
        }
        let mut seen = vec![false; own.len()];
        for start in 0..own.len() {
            if seen[start] {
                continue;
            }
            count += 1;
            let mut open = vec![start];
            while let Some(one) = open.pop() {
                seen[one] = true;
                for other in 0..own.len() {
                    let joins = cloth.mesh.edges().into_iter().any(|edge| {
                        edge.contains(&vertex)
                            && !edges.contains(&edge)
                            && has(faces[own[one]], edge)
                            && has(faces[own[other]], edge)
                    });
                    if !seen[other] && joins {
                        open.push(other);
                    }
                }
            }
        }
    }
    count
}

#[test]
fn random_tears_part_what_no_edge_joins_and_lose_nothing() {
    for seed in 0..60_u64 {
        let cloth = grid(5, 4);
        let edges: Vec<[u32; 2]> = (0..)
            .zip(cloth.mesh.edges())
            .filter(|(i, _)| scattered(1000 * seed + i) > 0.9 - 0.03 * seed as f64)
            .map(|(_, edge)| edge)
            .collect();
        let split = torn(cloth.clone(), &edges);
        let after = split.cloth();
        after.check().expect("a cloth that can be simulated");
        assert_eq!(after.positions.len(), vertices_by_brute_force(&cloth, &edges), "{seed}");
        assert_eq!(after.mesh.face_count(), cloth.mesh.face_count());
        let sum = |cloth: &Cloth| cloth.masses.iter().sum::<f64>();
        assert!((sum(&after) - sum(&cloth)).abs() < 1e-12, "{seed}");
        for (before, now) in cloth.mesh.faces().zip(after.mesh.faces()) {
            let origins: Vec<u32> = now.iter().map(|v| after.origins[*v as usize]).collect();
            assert_eq!(before, origins, "{seed}");
        }
        // The first vertices are those that were there.
        assert!((0..20).all(|vertex| after.origins[vertex] == vertex as u32));
        let is_within = |spring: &crate::Spring| {
            let origins = spring.ends.map(|end| after.origins[end as usize]);
            let pair = [origins[0].min(origins[1]), origins[0].max(origins[1])];
            cloth.springs.iter().any(|old| old.kind == spring.kind && old.ends == pair)
        };
        assert!(after.springs.iter().all(is_within), "{seed}");
    }
}

#[test]
fn an_edge_alone_parts_nothing_and_two_part_the_vertex_between() {
    let [one, other] = [[6, 7], [7, 8]];
    assert_eq!(torn(grid(5, 4), &[one]).origins().len(), 20);
    let split = torn(grid(5, 4), &[one, other]);
    assert_eq!(split.origins()[20..], [7]);
    assert_eq!(split.torn().collect::<Vec<_>>(), [one, other]);
    // Faces 2 and 6 are beside the edge from 7 to 8: only one of them goes with the new vertex.
    let corners = split.corners();
    let has_new = |face: usize| corners[4 * face..4 * face + 4].contains(&20);
    assert!(has_new(2) != has_new(6), "{corners:?}");
}

#[test]
fn what_is_pinned_stays_whole() {
    let split = torn(grid(5, 4), &[[0, 1], [0, 5]]);
    assert_eq!(split.origins().len(), 20);
}

#[test]
fn a_tear_runs_straight_across_the_pull() {
    let cloth = grid(5, 5);
    let place = |vertex: u32| Vector::new(f64::from(vertex % 5), f64::from(vertex / 5), 0.0);
    let split = Split::new(cloth.clone());
    let corner = split.corner_between(12, 13).expect("a corner");
    let fan = Fan::around(&split, corner);
    assert!(fan.is_closed());
    let mut ends: Vec<u32> = fan
        .across(&place(12), 13, place)
        .expect("a way across")
        .into_iter()
        .map(|(_, end)| end)
        .collect();
    ends.sort_unstable();
    assert_eq!(ends, [7, 17]);
    // At the end of a tear it goes on.
    let split = torn(cloth, &[[2, 7]]);
    let fan = Fan::around(&split, split.corner_between(7, 8).expect("a corner"));
    let found = fan.across(&place(7), 8, |vertex| place(split.origins()[vertex as usize]));
    assert_eq!(found.expect("a way across")[0].1, 12);
    assert!(!fan.is_closed());
}

#[test]
fn what_a_cloth_cannot_tear_by_is_refused() {
    let with = |tear: Tear| Cloth { tear: Some(tear), ..grid(3, 3) }.check();
    let message = |tear: Tear| with(tear).expect_err("refused").to_string();
    assert!(message(Tear { force: Some(-1.0), ..Tear::default() }).contains("tear force (N)"));
    assert!(message(Tear { noise: 2.0, ..Tear::default() }).contains("noise"));
    assert!(message(Tear { strength: vec![1.0], ..Tear::default() }).contains("1 strengths"));
    let openings = vec![Opening { frame: 3, pairs: vec![[0, 8]] }];
    assert!(message(Tear { openings, ..Tear::default() }).contains("vertices 0 and 8"));
    with(Tear { force: Some(0.0), noise: 1.0, ..Tear::default() }).expect("accepted");
}

/// Three wings that meet in the edges from 0 to 1 and from 1 to 2.
fn joint() -> Cloth {
    let wings = [[3, 4, 5], [6, 7, 8], [9, 10, 11]];
    let faces: Vec<[u32; 4]> =
        wings.iter().flat_map(|w| [[0, 1, w[1], w[0]], [1, 2, w[2], w[1]]]).collect();
    let mesh = Mesh::from_faces(12, &faces).expect("quads");
    let line = (0..3).map(|i| Vector::new(f64::from(i), 0.0, 0.0));
    let out = [Vector::y(), -Vector::y(), Vector::z()];
    let ends =
        out.into_iter().flat_map(|way| (0..3).map(move |i| Vector::x() * f64::from(i) + way));
    let positions = line.chain(ends).collect();
    let (mass, material) = (Mass::Density(0.2), SpringMaterial::default());
    Cloth::from_mesh("joint", mesh, positions, &mass, material, Vec::new()).expect("a cloth")
}

#[test]
fn a_wing_parts_from_the_edges_that_three_faces_share() {
    let cloth = joint();
    let place = |vertex: u32| cloth.positions[vertex as usize];
    let mut split = Split::new(cloth.clone());
    let fan = Fan::around(&split, split.corner_between(1, 10).expect("a corner"));
    let mut spokes = fan.across(&place(1), 10, place).expect("a way across");
    spokes.sort_by_key(|(_, end)| *end);
    assert_eq!(spokes.iter().map(|(_, end)| *end).collect::<Vec<_>>(), [0, 2]);
    for (edge, _) in spokes {
        split.tear(edge);
    }
    // Each wing has its own vertices now, in the middle and at both ends.
    assert_eq!(split.origins()[12..], [0, 0, 1, 1, 2, 2]);
    split.cloth().check().expect("a cloth that can be simulated");
}

/// A disk of very many triangles around one vertex: linear work for each tear.
#[test]
fn a_vertex_of_a_thousand_faces_parts_into_as_many() {
    let count = 1000;
    let faces: Vec<[u32; 3]> = (0..count).map(|i| [0, 1 + i, 1 + (i + 1) % count]).collect();
    let mesh = Mesh::from_faces(count as usize + 1, &faces).expect("a disk");
    let rim =
        (0..count).map(|i| (f64::from(i) * std::f64::consts::TAU / f64::from(count)).sin_cos());
    let places: Vec<Vector> =
        std::iter::once(Vector::zeros()).chain(rim.map(|(y, x)| Vector::new(x, y, 0.0))).collect();
    let (mass, material) = (Mass::Density(0.2), SpringMaterial::default());
    let cloth = Cloth::from_mesh("disk", mesh, places.clone(), &mass, material, Vec::new());
    let mut split = Split::new(cloth.expect("a cloth"));
    let fan = Fan::around(&split, split.corner_between(0, 1).expect("a corner"));
    let across = fan.across(&Vector::zeros(), 1, |vertex| places[vertex as usize]);
    let mut ends: Vec<u32> = across.expect("a way").into_iter().map(|(_, end)| end).collect();
    ends.sort_unstable();
    assert_eq!(ends, [251, 751]);
    for rim in 1..=count {
        let edge = split.edge_between([0, rim]).expect("a spoke");
        assert!(split.tear(edge));
    }
    assert_eq!(split.origins().iter().filter(|origin| **origin == 0).count(), count as usize);
    assert_eq!(split.origins().len(), 3 * count as usize);
}
