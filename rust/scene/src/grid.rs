//! Grids of quads: vertex index = row * columns + column, rows growing along the second axis of the plane.
//!
//! ```text
//! top_left  *--*--*--*  top_right      the last row
//!           |  |  |  |
//!           *--*--*--*
//!           |  |  |  |
//! vertex 0  *--*--*--*  bottom_right   the first row
//! ```

use boucle_geometry::{Mesh, MeshError, Vector};

use crate::description::Grid;

/// The names that pins may call the corners and edges of a grid by.
pub const PLACES: [&str; 8] =
    ["top_left", "top_right", "bottom_left", "bottom_right", "top", "bottom", "left", "right"];

impl Grid {
    /// The quads. Each face's normal is the plane's first axis times its second.
    ///
    /// # Errors
    /// None for a grid with at least 2 columns and 2 rows.
    pub fn mesh(&self) -> Result<Mesh, MeshError> {
        let [columns, rows] = self.vertices;
        let mut corners = Vec::with_capacity(4 * ((columns - 1) * (rows - 1)) as usize);
        for row in 0..rows - 1 {
            for column in 0..columns - 1 {
                let vertex = row * columns + column;
                corners.extend([vertex, vertex + 1, vertex + columns + 1, vertex + columns]);
            }
        }
        let face_starts = (0..=corners.len() as u32).step_by(4).collect();
        Mesh::new((columns * rows) as usize, face_starts, corners)
    }

    /// Rest positions (m), before any transform.
    #[must_use]
    pub fn positions(&self) -> Vec<Vector> {
        let [columns, rows] = self.vertices;
        let [across, along] = self.plane.axes();
        let offset = |index: u32, count: u32, size: f64| {
            size * (f64::from(index) / f64::from(count - 1) - 0.5)
        };
        let vertex = |row: u32, column: u32| {
            let mut position = Vector::from(self.center);
            position[across] += offset(column, columns, self.size[0]);
            position[along] += offset(row, rows, self.size[1]);
            position
        };
        (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (row, column)))
            .map(|(row, column)| vertex(row, column))
            .collect()
    }

    /// (u, v) of each corner of each quad: the grid is the unit square, u grows along rows, v along columns.
    #[must_use]
    pub fn uvs(&self) -> Vec<[f64; 2]> {
        let [columns, rows] = self.vertices;
        let [width, height] = [columns - 1, rows - 1].map(f64::from);
        let quad = |row: u32, column: u32| {
            [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[across, along]| {
                [f64::from(column + across) / width, f64::from(row + along) / height]
            })
        };
        (0..rows - 1)
            .flat_map(|row| (0..columns - 1).flat_map(move |column| quad(row, column)))
            .collect()
    }

    /// The vertices of a named corner or edge, in order; `None` for a name not in [`PLACES`].
    #[must_use]
    pub fn place(&self, name: &str) -> Option<Vec<u32>> {
        let [columns, rows] = self.vertices;
        let (last_row, last_column) = ((rows - 1) * columns, columns - 1);
        Some(match name {
            "bottom_left" => vec![0],
            "bottom_right" => vec![last_column],
            "top_left" => vec![last_row],
            "top_right" => vec![last_row + last_column],
            "bottom" => (0..columns).collect(),
            "top" => (last_row..last_row + columns).collect(),
            "left" => (0..rows).map(|row| row * columns).collect(),
            "right" => (0..rows).map(|row| row * columns + last_column).collect(),
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::Plane;

    fn grid() -> Grid {
        Grid { size: [2.0, 4.0], vertices: [3, 2], plane: Plane::Xz, center: [10.0, 20.0, 30.0] }
    }

    #[test]
    fn columns_run_along_the_first_axis_and_rows_along_the_second() {
        let positions = grid().positions();
        assert_eq!(positions[0], Vector::new(9.0, 20.0, 28.0));
        assert_eq!(positions[2], Vector::new(11.0, 20.0, 28.0));
        assert_eq!(positions[3], Vector::new(9.0, 20.0, 32.0));
        assert_eq!(positions.len(), 6);
    }

    #[test]
    fn faces_are_quads_whose_normal_is_the_first_axis_times_the_second() {
        let mesh = grid().mesh().expect("a good grid");
        assert_eq!(mesh.face(1), [1, 2, 5, 4]);
        assert_eq!(mesh.face_count(), 2);
        let area = mesh.vector_area(0, &grid().positions());
        assert_eq!(area, Vector::new(0.0, -4.0, 0.0));
    }

    #[test]
    fn a_grid_is_the_unit_square_of_its_map() {
        let (mesh, uvs) = (grid().mesh().expect("a good grid"), grid().uvs());
        let corners: Vec<u32> = mesh.faces().flatten().copied().collect();
        assert_eq!(corners.len(), uvs.len());
        for (corner, [u, v]) in corners.iter().zip(uvs) {
            let position = grid().positions()[*corner as usize];
            assert!((position.x - 9.0 - 2.0 * u).abs() < 1e-12, "{corner}: {u}");
            assert!((position.z - 28.0 - 4.0 * v).abs() < 1e-12, "{corner}: {v}");
        }
    }

    #[test]
    fn corners_and_edges_have_the_places_that_their_names_say() {
        let places = PLACES.map(|name| grid().place(name).expect(name));
        let expected: [&[u32]; 8] =
            [&[3], &[5], &[0], &[2], &[3, 4, 5], &[0, 1, 2], &[0, 3], &[2, 5]];
        assert_eq!(places.to_vec(), expected);
        assert_eq!(grid().place("middle"), None);
    }
}
