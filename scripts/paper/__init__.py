"""The figures of the paper that the project starts from, redone with the compiled module; `figures.py` runs them."""
