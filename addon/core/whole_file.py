"""Files replaced as a whole: after a kill at any moment either the old or the new one is there."""

import os
from contextlib import suppress

from .refusal import cannot_write


def replace(path: str, data: bytes) -> None:
    """Put data into the file at path.

    Raises:
        CacheRefusal: The system did not let us; the old file is still there.
    """
    fresh = f"{path}.new"
    try:
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(fresh, "wb") as file:
            file.write(data)
        os.replace(fresh, path)
    except OSError as error:
        with suppress(OSError):  # of half a file there is no use, least of all on a full disk
            os.remove(fresh)
        raise cannot_write(path, error) from error
