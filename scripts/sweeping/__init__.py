"""Sweeps: one scene or .blend, baked many times with other parameters.

One idea a module: `description` reads a sweep's file, `sampling` makes runs of it, `folder` is the result on disk, `run`
bakes one of them, `local` and `cluster` are where runs are baked, `table` and `contact_sheet` show them all.
"""
