"""PNG files of 8-bit RGB, as far as the tests of the report need them."""

import struct
import zlib


def write(file, width, height, colour):
    """`colour(x, y)` gives (r, g, b)."""
    rows = b"".join(b"\0" + bytes(v for x in range(width) for v in colour(x, y)) for y in range(height))
    chunk = lambda name, data: struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def read(file):
    """(width, height, at) with at(x, y) → (r, g, b); RGB and RGBA without interlace."""
    data = file.read_bytes()
    at, compressed = 8, b""
    while at < len(data):
        size, name = struct.unpack(">I4s", data[at:at + 8])
        if name == b"IHDR":
            width, height, depth, kind = struct.unpack(">IIBB", data[at + 8:at + 18])
        if name == b"IDAT":
            compressed += data[at + 8:at + 8 + size]
        at += 12 + size
    assert depth == 8 and kind in (2, 6), (depth, kind)
    step = 3 if kind == 2 else 4
    raw, stride, rows = zlib.decompress(compressed), width * step, []
    for y in range(height):
        mode, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        above = rows[-1] if rows else bytes(stride)
        for i in range(stride):
            left = line[i - step] if i >= step else 0
            corner = above[i - step] if i >= step else 0
            line[i] = (line[i] + (0, left, above[i], (left + above[i]) // 2, _paeth(left, above[i], corner))[mode]) & 255
        rows.append(bytes(line))
    return width, height, lambda x, y: tuple(rows[y][x * step:x * step + 3])


def _paeth(a, b, c):
    p = a + b - c
    return min((a, b, c), key=lambda v: abs(p - v))
