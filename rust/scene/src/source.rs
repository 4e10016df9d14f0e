//! Scene files and the mesh files beside them.

use std::fs::{self, File};
use std::io::{BufReader, Read};
use std::path::{Component, Path};

use boucle_geometry::{Mesh, Vector};

use crate::assembly::RestMesh;
use crate::collider::RestCollider;
use crate::description::{ClothDescription, ColliderDescription, Scene};
use crate::error::{Error, Result};
use crate::limits;
use crate::obj::{self, Content};
use crate::samples::Samples;

/// Reads a scene file, changed by overrides (`key.path=value`).
///
/// # Errors
/// [`Error::Input`] naming the file, the key and the value.
pub fn read_scene(path: &Path, overrides: &[String]) -> Result<Scene> {
    let place = path.display().to_string();
    let text = read_text(path).map_err(|error| error.within(&place))?;
    Scene::from_toml(&text, overrides).map_err(|error| error.within(&place))
}

/// Reads or makes the rest mesh of every cloth; mesh files are looked for in `folder`, that of the scene file.
///
/// # Errors
/// [`Error::Input`] naming the key, the file and the line.
pub fn rest_meshes(scene: &Scene, folder: &Path) -> Result<Vec<RestMesh>> {
    let grids = scene.cloth.iter().filter_map(|cloth| cloth.grid.as_ref());
    let mut count =
        grids.map(|grid| u64::from(grid.vertices[0]) * u64::from(grid.vertices[1])).sum();
    limits::vertices("the grids together", count)?;
    let mut meshes = Vec::with_capacity(scene.cloth.len());
    for cloth in &scene.cloth {
        let mut rest = rest_mesh(cloth, folder)?;
        if rest.grid.is_none() {
            count += rest.positions.len() as u64;
            limits::vertices("the cloths together", count)?;
        }
        cloth.transform.place(&mut rest.positions);
        rest.rest = rest_shape(cloth, &rest.mesh, folder)?;
        meshes.push(rest);
    }
    Ok(meshes)
}

fn rest_mesh(cloth: &ClothDescription, folder: &Path) -> Result<RestMesh> {
    let at = format!("cloth.{}", cloth.name);
    if let Some(grid) = &cloth.grid {
        let mesh = grid.mesh().map_err(|error| Error::input(format!("{at}.grid: {error}")))?;
        let uvs = cloth.is_mapped().then(|| grid.uvs());
        let (positions, grid) = (grid.positions(), Some(grid.clone()));
        return Ok(RestMesh { mesh, positions, rest: None, uvs, grid });
    }
    let Some(name) = &cloth.mesh else {
        return Err(Error::input(format!("{at}.grid is missing; accepted: it or mesh")));
    };
    let place = format!("{at}.mesh = \"{name}\"");
    let file = open_beside(folder, name).map_err(|error| error.within(&place))?;
    let Content { mesh, positions, uvs } =
        obj::read(BufReader::new(file), cloth.up).map_err(|error| error.within(&place))?;
    Ok(RestMesh { mesh, positions, rest: None, uvs, grid: None })
}

/// Reads the rest shape (m) of a cloth that starts from another: a mesh file with the same faces, put where the cloth is.
fn rest_shape(cloth: &ClothDescription, mesh: &Mesh, folder: &Path) -> Result<Option<Vec<Vector>>> {
    let Some(name) = &cloth.rest else { return Ok(None) };
    let place = format!("cloth.{}.rest = \"{name}\"", cloth.name);
    let file = open_beside(folder, name).map_err(|error| error.within(&place))?;
    let Content { mesh: other, mut positions, .. } =
        obj::read(BufReader::new(file), cloth.up).map_err(|error| error.within(&place))?;
    let [one, two] = [mesh, &other].map(|mesh| (mesh.vertex_count(), mesh.face_count()));
    if one != two {
        let given = format!("it has {} vertices and {} faces", two.0, two.1);
        let accepted = format!("{} and {}, as the cloth has", one.0, one.1);
        return Err(Error::input(format!("{given}; accepted: {accepted}")).within(&place));
    }
    if let Some(face) = mesh.faces().zip(other.faces()).position(|(one, two)| one != two) {
        let reason = format!("its face {face} (from 0) joins other vertices than the cloth's");
        let accepted = "accepted: the same faces in the same order";
        return Err(Error::input(format!("{reason}; {accepted}")).within(&place));
    }
    cloth.transform.place(&mut positions);
    Ok(Some(positions))
}

/// Reads or makes the shape of every collider; mesh files and caches are looked for in `folder`, that of the scene file.
///
/// # Errors
/// [`Error::Input`] naming the key, the file and the line.
pub fn rest_colliders(scene: &Scene, folder: &Path) -> Result<Vec<RestCollider>> {
    let mut count = 0;
    let mut colliders = Vec::with_capacity(scene.collider.len());
    for collider in &scene.collider {
        let rest = rest_collider(collider, folder)?;
        count += rest.positions.len() as u64;
        limits::vertices("the colliders together", count)?;
        colliders.push(rest);
    }
    Ok(colliders)
}

fn rest_collider(collider: &ColliderDescription, folder: &Path) -> Result<RestCollider> {
    let at = format!("collider.{}", collider.name);
    if let Some(rest) = RestCollider::of_numbers(collider) {
        return Ok(rest);
    }
    let Some(name) = &collider.mesh else {
        let accepted = "one of sphere, plane, box, capsule, mesh";
        return Err(Error::input(format!("{at} has no shape; accepted: {accepted}")));
    };
    let place = format!("{at}.mesh = \"{name}\"");
    let file = open_beside(folder, name).map_err(|error| error.within(&place))?;
    let Content { mesh, positions, .. } =
        obj::read(BufReader::new(file), collider.up).map_err(|error| error.within(&place))?;
    let mut rest = RestCollider::of_mesh(mesh, positions, collider)?;
    if let Some(name) = &collider.cache {
        let read = |file| {
            let count = rest.positions.len();
            Samples::read(BufReader::new(file), count, collider.up, &collider.transform)
        };
        let samples = open_beside(folder, name).and_then(read);
        rest.samples =
            Some(samples.map_err(|error| error.within(&format!("{at}.cache = \"{name}\"")))?);
    }
    Ok(rest)
}

/// Opens a file that a scene names: in the scene's folder or below, or at an absolute path.
fn open_beside(folder: &Path, name: &str) -> Result<File> {
    if leads_out(Path::new(name)) {
        return Err(Error::input(
            "it leads out of the scene's folder; accepted: a file in that folder or below, or an \
             absolute path",
        ));
    }
    let path = folder.join(name);
    // To open what is no file, such as a pipe that nobody writes to, may take for ever.
    if fs::metadata(&path).is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir()) {
        return Err(unreadable("it is no file"));
    }
    open(&path)
}

/// Whether a relative path may lead out of the folder that it starts from.
fn leads_out(path: &Path) -> bool {
    let depths = path.components().scan(0_i32, |depth, part| {
        match part {
            Component::Normal(_) => *depth += 1,
            Component::CurDir => {}
            // Of a drive of its own, or from the top of this one: relative all the same, on Windows.
            Component::ParentDir | Component::Prefix(_) | Component::RootDir => *depth -= 1,
        }
        Some(*depth)
    });
    !path.is_absolute() && depths.min().is_some_and(|least| least < 0)
}

/// Opens a file that is to be read; a folder is refused.
fn open(path: &Path) -> Result<File> {
    let file = File::open(path).map_err(|error| unreadable(&error.to_string()))?;
    let metadata = file.metadata().map_err(|error| unreadable(&error.to_string()))?;
    if metadata.is_dir() { Err(unreadable("it is a folder")) } else { Ok(file) }
}

fn unreadable(reason: &str) -> Error {
    let accepted = "accepted: the path of a file that can be read";
    Error::input(format!("it cannot be read: {reason}; {accepted}"))
}

fn read_text(path: &Path) -> Result<String> {
    let mut bytes = Vec::new();
    open(path)?
        .take(limits::MAX_SCENE_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| Error::input(format!("it cannot be read: {error}")))?;
    if bytes.len() as u64 > limits::MAX_SCENE_BYTES {
        let accepted = format!("at most {} bytes", limits::MAX_SCENE_BYTES);
        return Err(Error::input(format!("it is too long; accepted: {accepted}")));
    }
    String::from_utf8(bytes).map_err(|error| {
        let start = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..start].split(|&byte| byte == b'\n').count();
        Error::input(format!("line {line} is not UTF-8; accepted: TOML text"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_an_absolute_path_leads_out_of_the_folder() {
        for inside in ["a.obj", "./a.obj", "sub/a.obj", "sub/../a.obj", "a..b", "...", ""] {
            assert!(!leads_out(Path::new(inside)), "{inside}");
        }
        for outside in ["..", "../a.obj", "sub/../../a.obj", "./../sub/a.obj"] {
            assert!(leads_out(Path::new(outside)), "{outside}");
        }
        assert!(!leads_out(&std::env::temp_dir().join("../a.obj")));
    }
}
