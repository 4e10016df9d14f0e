//! A small vector for each particle, as the linear solver reads it.

/// Single precision, an array an axis.
#[derive(Clone, Debug, Default)]
pub(crate) struct Field(pub(crate) [Vec<f32>; 3]);

impl Field {
    pub(crate) fn zeros(count: usize) -> Self {
        Self(std::array::from_fn(|_| vec![0.0; count]))
    }

    pub(crate) fn copy_from(&mut self, other: &Self) {
        for (axis, source) in self.0.iter_mut().zip(&other.0) {
            axis.copy_from_slice(source);
        }
    }
}
