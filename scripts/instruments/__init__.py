"""A fabric lab in numbers: instruments that measure what a fabric of the solver does, as a lab measures cloth."""
