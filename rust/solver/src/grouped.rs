//! Values by number, in one array.

/// For each number below a count, the values that were given for it, in the order in which they came.
#[derive(Clone, Debug, Default)]
pub(crate) struct Grouped<T> {
    /// Where each number's values begin, and the end of the last.
    starts: Vec<u32>,
    values: Vec<T>,
}

impl<T: Copy + Default> Grouped<T> {
    /// Goes through the pairs of number and value twice.
    pub(crate) fn new(count: usize, pairs: impl Iterator<Item = (u32, T)> + Clone) -> Self {
        let mut starts = vec![0; count + 1];
        for (number, _) in pairs.clone() {
            starts[number as usize + 1] += 1;
        }
        for i in 0..count {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut values = vec![T::default(); starts[count] as usize];
        for (number, value) in pairs {
            let place = &mut next[number as usize];
            values[*place as usize] = value;
            *place += 1;
        }
        Self { starts, values }
    }

    pub(crate) fn of(&self, number: usize) -> &[T] {
        &self.values[self.starts[number] as usize..self.starts[number + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_found_by_number_in_the_order_in_which_they_came() {
        let grouped = Grouped::new(3, [(2, 5), (0, 7), (2, 1)].into_iter());
        assert_eq!([grouped.of(0), grouped.of(1), grouped.of(2)], [&[7][..], &[], &[5, 1]]);
    }
}
