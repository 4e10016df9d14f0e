"""Rows of the validation report: what this code makes, beside closed forms and numbers that it did not make."""
