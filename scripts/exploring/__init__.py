"""Which steps, stiffnesses, masses and dampings are stable and good: runs, theory, pictures, ranges."""
