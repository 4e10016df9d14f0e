"""What a compiled Linux library asks of the system: the names in its dynamic section.

Reads 64-bit little-endian ELF files by the System V ABI: program headers give the dynamic segment, whose entries
give the library names as offsets into a string table. Standard library only.
"""

from __future__ import annotations

import struct

PROGRAM_LOAD, PROGRAM_DYNAMIC = 1, 2
DYNAMIC_NEEDED, DYNAMIC_STRINGS = 1, 5


def needed_libraries(data: bytes) -> list[str]:
    """Names of the libraries that an ELF file is linked to, in its own order.

    Raises:
        ValueError: This is not a 64-bit little-endian ELF file with a dynamic section.
    """
    if data[:6] != b"\x7fELF\x02\x01":
        raise ValueError("not a 64-bit little-endian ELF file")
    start, size, count = struct.unpack_from("<Q14xHH", data, 32)
    headers = [struct.unpack_from("<IIQQQQ", data, start + size * i) for i in range(count)]
    dynamic = next((h for h in headers if h[0] == PROGRAM_DYNAMIC), None)
    if dynamic is None:
        raise ValueError("the ELF file has no dynamic section")
    entries = list(struct.iter_unpack("<QQ", data[dynamic[2] : dynamic[2] + dynamic[5]]))
    table = file_offset(headers, next(value for tag, value in entries if tag == DYNAMIC_STRINGS))
    names = [value for tag, value in entries if tag == DYNAMIC_NEEDED]
    return [data[table + n : data.index(b"\0", table + n)].decode() for n in names]


def file_offset(headers: list[tuple[int, ...]], address: int) -> int:
    """Where in the file the byte of a virtual address stands."""
    for kind, _flags, offset, virtual, _physical, size in headers:
        if kind == PROGRAM_LOAD and virtual <= address < virtual + size:
            return offset + address - virtual
    raise ValueError(f"address {address:#x} is in no loaded segment")
