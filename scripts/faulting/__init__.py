"""Faults that are done to a bake: what is baked, what is done to it, and what must be left.

`subject` is a bake with its undisturbed result, `addon_bake` the add-on's own bake without Blender; `shim` lets a process die
at a chosen operation on its files, run out of disk, or see clocks jump. The faults are in `kills`, `disk`, `damage` and
`surroundings`.
"""
