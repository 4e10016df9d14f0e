//! Mesh files and point caches.

use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

use boucle_geometry::Mesh;
use boucle_scene::description::UpAxis;
use boucle_scene::{Scene, obj as wavefront, pc2 as cache, source};
use xxhash_rust::xxh3::xxh3_64;

use crate::demands::{accepted, finite};

/// A file in a folder of its own, gone with this.
pub(crate) struct Written {
    folder: tempfile::TempDir,
    pub(crate) path: PathBuf,
}

impl Written {
    pub(crate) fn new(name: &str, bytes: &[u8]) -> Self {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let prefix = format!("boucle-fuzz-{}", COUNT.fetch_add(1, Ordering::Relaxed));
        let folder = tempfile::Builder::new().prefix(&prefix).tempdir().expect("a folder");
        let path = folder.path().join(name);
        fs::write(&path, bytes).expect("there is room");
        Self { folder, path }
    }

    pub(crate) fn folder(&self) -> &std::path::Path {
        self.folder.path()
    }
}

/// An OBJ file: what is read is whole, and writing it keeps every bit.
pub(crate) fn obj(bytes: &[u8]) {
    for up in [UpAxis::Z, UpAxis::Y] {
        let Some(content) = accepted(wavefront::read(bytes, up)) else { return };
        assert_eq!(content.positions.len(), content.mesh.vertex_count());
        for position in &content.positions {
            finite("position", position.as_slice());
        }
        assert!(content.mesh.triangle_count() >= content.mesh.face_count());
        if let Some(uvs) = &content.uvs {
            assert_eq!(uvs.len(), content.mesh.faces().map(<[u32]>::len).sum::<usize>());
            finite("uv", uvs.as_flattened());
        }
        let mut written = Vec::new();
        wavefront::write(&mut written, &content.mesh, &content.positions).expect("memory");
        let again = wavefront::read(&*written, UpAxis::Z).expect("our own file");
        assert_eq!(whole(&content.mesh), whole(&again.mesh));
        let bits = |positions: &[boucle_geometry::Vector]| -> Vec<u64> {
            positions.iter().flatten().map(|number| number.to_bits()).collect()
        };
        assert_eq!(bits(&content.positions), bits(&again.positions));
    }
}

fn whole(mesh: &Mesh) -> (Vec<Vec<u32>>, &[[u32; 2]]) {
    (mesh.faces().map(<[u32]>::to_vec).collect(), mesh.loose_edges())
}

/// A scene of one collider that a point cache moves.
const MOVED: &str = "[[cloth]]\nname = \"sheet\"\ngrid = { size = [1, 1], vertices = [2, 2] }\n\
                     [[collider]]\nname = \"body\"\nmesh = \"body.obj\"\ncache = \"body.pc2\"\n";
const BODY: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A point cache: as the result of a bake, and as what moves a collider.
pub(crate) fn pc2(bytes: &[u8]) {
    let file = Written::new("body.pc2", bytes);
    if let Some((header, numbers)) = accepted(cache::read(&file.path)) {
        let wanted = 3 * u64::from(header.vertex_count) * u64::from(header.sample_count);
        assert_eq!(numbers.len() as u64, wanted);
        assert!(4 * wanted <= bytes.len() as u64);
    }
    // Samples of three points that are as they were written, as far as there are two.
    let hashes = bytes.get(32..).unwrap_or_default().chunks_exact(36).take(2).map(xxh3_64);
    let mut hashes: Vec<u64> = hashes.collect();
    hashes.resize(2, 0);
    if let Some(mut writer) = accepted(cache::Writer::resume(&file.path, 3, 1, &hashes)) {
        writer.append(&[boucle_geometry::Vector::zeros(); 3]).expect("there is room");
        let (header, _) = cache::read(&file.path).expect("a valid prefix");
        assert_eq!(header.sample_count, 3);
        fs::write(&file.path, bytes).expect("there is room");
    }
    fs::write(file.folder().join("body.obj"), BODY).expect("there is room");
    let scene = Scene::from_toml(MOVED, &[]).expect("a scene");
    let Some(colliders) = accepted(source::rest_colliders(&scene, file.folder())) else { return };
    for samples in colliders.iter().filter_map(|collider| collider.samples.as_ref()) {
        for frame in [i32::MIN, -1, 0, 1, 2, 7, i32::MAX] {
            let points = samples.at(frame);
            assert_eq!(points.len(), 3);
            for point in &points {
                finite("point", point.as_slice());
            }
        }
    }
}
