"""OBJ files: the rest mesh beside a PC2, in the same vertex order."""

from __future__ import annotations

from collections.abc import Sequence

from . import whole_file


def write(path: str, name: str, positions: Sequence[float], faces: Sequence[Sequence[int]]) -> None:
    """Replace an OBJ file.

    Args:
        path: The file.
        name: The object's name.
        positions: x, y, z of each vertex (m), flat.
        faces: The vertices of each face, counted from 0.
    """
    lines = [f"o {' '.join(name.split())}"]
    values = [f"{float(value):.9g}" for value in positions]
    lines += [f"v {' '.join(values[k : k + 3])}" for k in range(0, len(values), 3)]
    lines += [f"f {' '.join(str(vertex + 1) for vertex in face)}" for face in faces]
    whole_file.replace(path, ("\n".join(lines) + "\n").encode())
