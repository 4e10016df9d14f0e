//! Meshes of cloths and colliders, from Python's arrays.

use boucle_geometry::{Mesh, Vector};
use boucle_scene::{Error, RestCollider, RestMesh, Scene};
use pyo3::prelude::*;

use crate::boundary::{compute, refuse};
use crate::buffers;

/// One mesh as Python gives it: positions, face starts, corners.
pub(crate) type MeshArrays<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyAny>);

/// The rest meshes of a scene's cloths, each put where its `transform` says.
pub(crate) fn of_cloths(
    py: Python<'_>,
    scene: &Scene,
    meshes: &[MeshArrays<'_>],
    [rests, uvs]: [&[Option<Bound<'_, PyAny>>]; 2],
) -> PyResult<Vec<RestMesh>> {
    if meshes.len() != scene.cloth.len() {
        let (given, wanted) = (meshes.len(), scene.cloth.len());
        return Err(refuse(py, format!("meshes holds {given}; accepted: {wanted}, one a cloth")));
    }
    for (name, given) in [("rests", rests.len()), ("uvs", uvs.len())] {
        if given > meshes.len() {
            let wanted = meshes.len();
            return Err(refuse(
                py,
                format!("{name} holds {given}; accepted: {wanted}, one a cloth"),
            ));
        }
    }
    let mut rest_meshes = Vec::with_capacity(meshes.len());
    for (number, (cloth, arrays)) in scene.cloth.iter().zip(meshes).enumerate() {
        if cloth.grid.is_some() || cloth.mesh.is_some() || cloth.rest.is_some() {
            let message =
                "grid, mesh or rest; accepted: none, as the mesh is given beside the scene";
            return Err(refuse(py, format!("cloth.{}: {message}", cloth.name)));
        }
        let (mesh, mut positions) = mesh(py, &format!("cloth \"{}\"", cloth.name), arrays)?;
        cloth.transform.place(&mut positions);
        let rest = match rests.get(number) {
            Some(Some(shape)) => {
                let what = format!("rest positions of cloth \"{}\"", cloth.name);
                let mut shape = buffers::positions(shape, &what, Some(positions.len()))?;
                cloth.transform.place(&mut shape);
                Some(shape)
            }
            _ => None,
        };
        let uvs = match uvs.get(number) {
            Some(Some(uvs)) => {
                let what = format!("UV coordinates of cloth \"{}\"", cloth.name);
                let count = mesh.faces().map(<[u32]>::len).sum();
                Some(buffers::uvs(uvs, &what, count)?)
            }
            _ => None,
        };
        rest_meshes.push(RestMesh { mesh, positions, rest, uvs, grid: None });
    }
    Ok(rest_meshes)
}

/// The colliders of a scene: those that are no sphere, plane, box or capsule have their meshes in `given`.
pub(crate) fn of_colliders(
    py: Python<'_>,
    scene: &Scene,
    given: &[MeshArrays<'_>],
) -> PyResult<Vec<RestCollider>> {
    let wanted = scene.collider.iter().filter(|collider| collider.shapes().is_empty()).count();
    let mut given_colliders = given.iter();
    let mut colliders = Vec::with_capacity(scene.collider.len());
    for description in &scene.collider {
        if description.mesh.is_some() {
            let message = "mesh; accepted: none, as the mesh is given beside the scene";
            return Err(refuse(py, format!("collider.{}: {message}", description.name)));
        }
        if let Some(rest) = RestCollider::of_numbers(description) {
            colliders.push(rest);
        } else if let Some(arrays) = given_colliders.next() {
            let owner = format!("collider \"{}\"", description.name);
            let (mesh, positions) = mesh(py, &owner, arrays)?;
            let rest = compute(py, || RestCollider::of_mesh(mesh, positions, description))?;
            colliders.push(rest);
        }
    }
    if given.len() == wanted {
        return Ok(colliders);
    }
    let accepted =
        format!("accepted: {wanted}, one for each collider of the scene without a shape");
    Err(refuse(py, format!("colliders holds {}; {accepted}", given.len())))
}

/// One mesh and its positions (m); `owner` is what refusals call it.
fn mesh(
    py: Python<'_>,
    owner: &str,
    (positions, starts, corners): &MeshArrays<'_>,
) -> PyResult<(Mesh, Vec<Vector>)> {
    let at = |what: &str| format!("{what} of {owner}");
    let positions: Vec<Vector> = buffers::positions(positions, &at("positions"), None)?;
    let mut starts = buffers::indices(starts, &at("face starts"))?;
    let corners = buffers::indices(corners, &at("face corners"))?;
    // The end of the last face may be left out.
    if starts.last().is_none_or(|&last| (last as usize) < corners.len()) {
        starts.push(corners.len() as u32);
    }
    let count = positions.len();
    let mesh = compute(py, || {
        Mesh::new(count, starts, corners).map_err(|error| Error::Input(format!("{owner}: {error}")))
    })?;
    Ok((mesh, positions))
}
