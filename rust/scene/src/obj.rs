//! Wavefront OBJ: rest meshes in and out.
//!
//! Of the format, vertices (`v x y z`, further numbers ignored), UV coordinates (`vt u v`) and faces (`f`, corners as `v`,
//! `v/vt`, `v//vn`, `v/vt/vn`, counted from 1, or backwards from -1) are read, and lines (`l`), of which those that are no side
//! of a face are loose edges; names, groups, materials, normals and points are passed over; anything else is refused with its
//! line. The order of vertices is the file's.
//!
//! Our own reader, because no crate keeps n-gons and the vertex order and names the line that it refuses.

use std::io::{BufRead, Read, Write};

use boucle_geometry::{Mesh, MeshError, Vector};

use crate::description::UpAxis;
use crate::error::{Error, Result, shorten};
use crate::limits::{MAX_LENGTH, MAX_VERTICES};

/// Longest line (bytes).
const MAX_LINE: u64 = 1 << 20;
/// Most corners of all faces together.
const MAX_CORNERS: usize = 8 * MAX_VERTICES;
/// Statements that say nothing about the shape of the cloth.
const PASSED_OVER: [&str; 12] =
    ["vn", "vp", "g", "o", "s", "mg", "usemtl", "mtllib", "p", "usemap", "maplib", "lod"];

/// What a file holds.
#[derive(Clone, Debug)]
pub struct Content {
    /// Its faces and loose edges.
    pub mesh: Mesh,
    /// Its rest positions (m), Z up.
    pub positions: Vec<Vector>,
    /// (u, v) of each corner of each face, as faces list them, if every corner has one.
    pub uvs: Option<Vec<[f64; 2]>>,
}

/// Where a corner has no UV coordinates.
const NOWHERE: u32 = u32::MAX;

/// Reads a mesh.
///
/// # Errors
/// [`Error::Input`] naming the line, the vertex or the face that is not accepted.
pub fn read(source: impl BufRead, up: UpAxis) -> Result<Content> {
    let mut reader = Reader { face_starts: vec![0], ..Reader::default() };
    let mut lines = Lines { source, number: 0 };
    while let Some(line) = lines.next_statement()? {
        let number = lines.number;
        reader
            .statement(&line, number)
            .map_err(|reason| Error::input(format!("line {number}: {reason}")))?;
    }
    reader.positions.iter_mut().for_each(|v| *v = up.turned(*v));
    reader.finish()
}

/// Writes a mesh so that reading it gives the same bits.
///
/// # Errors
/// Those of the sink.
pub fn write(sink: &mut impl Write, mesh: &Mesh, positions: &[Vector]) -> std::io::Result<()> {
    for v in positions {
        writeln!(sink, "v {} {} {}", v.x, v.y, v.z)?;
    }
    for face in mesh.faces() {
        write!(sink, "f")?;
        for vertex in face {
            write!(sink, " {}", vertex + 1)?;
        }
        writeln!(sink)?;
    }
    for [a, b] in mesh.loose_edges() {
        writeln!(sink, "l {} {}", a + 1, b + 1)?;
    }
    Ok(())
}

/// The lines of a file, each checked for its length and for UTF-8.
struct Lines<S> {
    source: S,
    number: usize,
}

impl<S: BufRead> Lines<S> {
    /// The next line, joined with those it continues on by a backslash at its end.
    fn next_statement(&mut self) -> Result<Option<String>> {
        let mut statement = String::new();
        while let Some(line) = self.next_line()? {
            let line = line.trim_end();
            match line.strip_suffix('\\') {
                Some(part) if statement.len() as u64 <= MAX_LINE => {
                    statement.push_str(part);
                    statement.push(' ');
                }
                _ => {
                    statement.push_str(line);
                    return Ok(Some(statement));
                }
            }
        }
        Ok(if statement.is_empty() { None } else { Some(statement) })
    }

    fn next_line(&mut self) -> Result<Option<String>> {
        let mut bytes = Vec::new();
        self.number += 1;
        let number = self.number;
        let read = self.source.by_ref().take(MAX_LINE + 1).read_until(b'\n', &mut bytes);
        let count = read.map_err(|error| Error::input(format!("line {number}: {error}")))?;
        if count as u64 > MAX_LINE {
            let accepted = format!("at most {MAX_LINE} bytes; is this an OBJ file?");
            return Err(Error::input(format!("line {number} is too long; accepted: {accepted}")));
        }
        if count == 0 {
            return Ok(None);
        }
        let refuse = |_| Error::input(format!("line {number} is not UTF-8; accepted: OBJ text"));
        String::from_utf8(bytes).map(Some).map_err(refuse)
    }
}

/// What has been read so far.
#[derive(Default)]
struct Reader {
    positions: Vec<Vector>,
    /// The line of each vertex.
    lines: Vec<u32>,
    face_starts: Vec<u32>,
    corners: Vec<u32>,
    uvs: Vec<[f64; 2]>,
    /// Of each corner, its number in `uvs`, or `NOWHERE`.
    corner_uvs: Vec<u32>,
    /// The line of each face.
    face_lines: Vec<u32>,
    /// Both vertices of each part of a line, and the line of the file that it stands in.
    loose_edges: Vec<([u32; 2], u32)>,
}

impl Reader {
    fn statement(&mut self, line: &str, number: usize) -> std::result::Result<(), String> {
        let line = line.split('#').next().unwrap_or_default();
        let mut words = line.split_whitespace();
        match words.next() {
            None => Ok(()),
            Some("v") => self.vertex(words, number),
            Some("vt") => self.uv(words),
            Some("f") => self.face(words, number),
            Some("l") => self.line(words, number),
            Some(word) if PASSED_OVER.contains(&word) => Ok(()),
            Some(word) => Err(format!(
                "\"{}\" is no OBJ statement that is accepted (v, f, vt, vn, g, o, s, usemtl, mtllib)",
                shorten(word)
            )),
        }
    }

    fn vertex<'a>(
        &mut self,
        words: impl Iterator<Item = &'a str>,
        number: usize,
    ) -> std::result::Result<(), String> {
        if self.positions.len() == MAX_VERTICES {
            return Err(format!("more than {MAX_VERTICES} vertices; accepted: at most so many"));
        }
        let mut position = [0.0; 3];
        let mut count = 0;
        for word in words {
            let value: f64 =
                word.parse().map_err(|_| format!("\"{}\" is not a number", shorten(word)))?;
            if !(-MAX_LENGTH..=MAX_LENGTH).contains(&value) {
                let accepted = format!("-{MAX_LENGTH:e} to {MAX_LENGTH:e} m");
                return Err(format!("coordinate {}; accepted: {accepted}", shorten(word)));
            }
            if count < 3 {
                position[count] = value;
            }
            count += 1;
        }
        if count < 3 {
            return Err(format!("a vertex with {count} coordinates; accepted: 3"));
        }
        self.positions.push(Vector::from(position));
        self.lines.push(number as u32);
        Ok(())
    }

    fn uv<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> std::result::Result<(), String> {
        if self.uvs.len() == MAX_CORNERS {
            return Err(format!("more than {MAX_CORNERS} vt; accepted: at most so many"));
        }
        let mut uv = [0.0; 2];
        let mut count = 0;
        for word in words {
            let value: Option<f64> = word.parse().ok().filter(|value: &f64| value.is_finite());
            let value = value.ok_or_else(|| format!("\"{}\" is not a number", shorten(word)))?;
            if count < 2 {
                uv[count] = value;
            }
            count += 1;
        }
        if count == 0 {
            return Err("a vt with no numbers; accepted: 2".to_owned());
        }
        self.uvs.push(uv);
        Ok(())
    }

    fn face<'a>(
        &mut self,
        words: impl Iterator<Item = &'a str>,
        number: usize,
    ) -> std::result::Result<(), String> {
        let start = self.corners.len();
        for word in words {
            let (vertex, uv) = self.corner(word)?;
            self.corners.push(vertex);
            self.corner_uvs.push(uv);
        }
        let count = self.corners.len() - start;
        if count < 3 {
            return Err(format!("a face with {count} corners; accepted: 3 or more"));
        }
        if self.corners.len() > MAX_CORNERS {
            return Err(format!("more than {MAX_CORNERS} face corners; accepted: at most so many"));
        }
        self.face_starts.push(self.corners.len() as u32);
        self.face_lines.push(number as u32);
        Ok(())
    }

    fn line<'a>(
        &mut self,
        words: impl Iterator<Item = &'a str>,
        number: usize,
    ) -> std::result::Result<(), String> {
        let vertices: Vec<u32> = words
            .map(|word| Ok(self.corner(word)?.0))
            .collect::<std::result::Result<_, String>>()?;
        if vertices.len() < 2 {
            return Err(format!("a line with {} vertices; accepted: 2 or more", vertices.len()));
        }
        if self.loose_edges.len() + vertices.len() > MAX_CORNERS {
            return Err(format!("more than {MAX_CORNERS} line ends; accepted: at most so many"));
        }
        let pairs = vertices.windows(2).map(|pair| ([pair[0], pair[1]], number as u32));
        self.loose_edges.extend(pairs);
        Ok(())
    }

    /// The vertex and the UV coordinates, from 0, of a corner such as `7`, `-1`, `7/2`, `7//3` or `7/2/3`.
    fn corner(&self, word: &str) -> std::result::Result<(u32, u32), String> {
        let shown = shorten(word);
        let mut parts = word.split('/');
        let index: i64 = parts
            .next()
            .and_then(|part| part.parse().ok())
            .ok_or_else(|| format!("corner \"{shown}\"; accepted: v, v/vt, v//vn or v/vt/vn"))?;
        let others_fit = parts.clone().count() <= 2
            && parts.all(|part| part.is_empty() || part.parse::<i64>().is_ok());
        if !others_fit {
            return Err(format!("corner \"{shown}\"; accepted: v, v/vt, v//vn or v/vt/vn"));
        }
        let count = self.positions.len();
        let uv = word.split('/').nth(1).and_then(|part| place(part.parse().ok()?, self.uvs.len()));
        let uv = uv.filter(|&uv| uv < MAX_CORNERS).map_or(NOWHERE, |uv| uv as u32);
        // Forwards, a vertex may be named before its line; `finish` refuses those that never come.
        match place(index, count) {
            Some(vertex) if vertex < MAX_VERTICES => Ok((vertex as u32, uv)),
            _ => Err(format!(
                "corner \"{shown}\" with {count} vertices before it; accepted: counted from 1, or \
                 from -1 backwards"
            )),
        }
    }

    fn finish(self) -> Result<Content> {
        if self.positions.is_empty() {
            return Err(Error::input("there are no vertices; accepted: an OBJ file with v and f"));
        }
        if self.face_lines.is_empty() {
            return Err(Error::input("there are no faces; accepted: an OBJ file with v and f"));
        }
        let mesh = Mesh::new(self.positions.len(), self.face_starts, self.corners)
            .map_err(|error| bad_face(&error, &self.face_lines))?;
        let count = self.positions.len();
        let is_beyond = |pair: &[u32; 2]| pair[0].max(pair[1]) as usize >= count;
        if let Some((pair, line)) = self.loose_edges.iter().find(|(pair, _)| is_beyond(pair)) {
            let vertex = pair[0].max(pair[1]) + 1;
            return Err(Error::input(format!(
                "line {line}: the line names vertex {vertex}; accepted: 1 to {count}"
            )));
        }
        let mesh = mesh.with_loose_edges(self.loose_edges.iter().map(|(pair, _)| *pair));
        if let Some(&vertex) = mesh.loose_vertices().first() {
            let line = self.lines[vertex as usize];
            return Err(Error::input(format!(
                "vertex {vertex} (from 0; line {line}) is used by no face; accepted: vertices of \
                 faces"
            )));
        }
        let uv = |&number: &u32| self.uvs.get(number as usize).copied();
        let uvs = self.corner_uvs.iter().map(uv).collect();
        Ok(Content { mesh, positions: self.positions, uvs })
    }
}

/// The place, from 0, that a number counts to: from 1 forwards, or from -1 backwards from the last of `count`.
fn place(number: i64, count: usize) -> Option<usize> {
    let distance = usize::try_from(number.unsigned_abs()).unwrap_or(usize::MAX);
    if number < 0 { count.checked_sub(distance) } else { distance.checked_sub(1) }
}

/// A face's refusal, told with its line and counted as the file counts.
fn bad_face(error: &MeshError, lines: &[u32]) -> Error {
    let (face, reason) = match *error {
        MeshError::RepeatedVertex { face, vertex } => {
            let accepted = "accepted: faces without holes or repeated corners";
            (face, format!("the face passes through vertex {} twice; {accepted}", vertex + 1))
        }
        MeshError::VertexOutOfRange { face, vertex, vertex_count } => {
            let accepted = format!("accepted: 1 to {vertex_count}");
            (face, format!("the face names vertex {}; {accepted}", vertex + 1))
        }
        ref other => return Error::input(other),
    };
    Error::input(format!("line {}: {reason}", lines[face]))
}

#[cfg(test)]
mod tests;
