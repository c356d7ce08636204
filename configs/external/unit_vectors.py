#!/usr/bin/env python3
"""Stores random unit vectors in few bits, and says by what angles they come back wrong.

Encodings of Cigolle, Donow, Evangelakos, Mara, McGuire, Meyer: A Survey of Efficient Representations
for Independent Unit Vectors. Journal of Computer Graphics Techniques 3(2), 2014.

unit_vectors.py ENCODING BITS VECTORS SEED     BITS: of a whole vector
"""
import json
import math
import os
import random
import sys


def snorm(x, bits):
    """The nearest of 2^bits − 1 steps from −1 to 1."""
    steps = 2 ** (bits - 1) - 1
    return round(min(max(x, -1.0), 1.0) * steps) / steps


def sign(x):
    return 1.0 if x >= 0.0 else -1.0


def three_components(v, bits):
    """A component each, normalized again."""
    x, y, z = (snorm(c, bits) for c in v)
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


def octahedron(v):
    """The point of a square that a vector has: an octahedron, its lower half folded outwards."""
    x, y, z = v
    size = abs(x) + abs(y) + abs(z)
    x, y = x / size, y / size
    if z < 0.0:
        x, y = (1.0 - abs(y)) * sign(x), (1.0 - abs(x)) * sign(y)
    return x, y


def from_octahedron(x, y):
    z = 1.0 - abs(x) - abs(y)
    if z < 0.0:
        x, y = (1.0 - abs(y)) * sign(x), (1.0 - abs(x)) * sign(y)
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


def oct(v, bits):
    x, y = octahedron(v)
    return from_octahedron(snorm(x, bits), snorm(y, bits))


def oct_precise(v, bits):
    """Of the four codes around the point the one that comes back nearest."""
    steps = 2 ** (bits - 1) - 1
    x, y = (math.floor(c * steps) for c in octahedron(v))
    codes = ((x + i, y + j) for i in (0, 1) for j in (0, 1))
    decoded = (from_octahedron(min(i / steps, 1.0), min(j / steps, 1.0)) for i, j in codes)
    return max(decoded, key=lambda w: sum(a * b for a, b in zip(v, w)))


def angle_deg(v, w):
    """By the chord: the arc cosine of a number near 1 has few digits left."""
    return math.degrees(2.0 * math.asin(0.5 * math.dist(v, w)))


def on_sphere(rng):
    z, phi = rng.uniform(-1.0, 1.0), rng.uniform(0.0, 2.0 * math.pi)
    r = math.sqrt(1.0 - z * z)
    return r * math.cos(phi), r * math.sin(phi), z


components, encode = {"snorm": (3, three_components), "oct": (2, oct), "oct_precise": (2, oct_precise)}[sys.argv[1]]
bits, vectors, seed = (int(a) for a in sys.argv[2:5])
rng = random.Random(seed)
errors = [angle_deg(v, encode(v, bits // components)) for v in (on_sphere(rng) for _ in range(vectors))]

with os.fdopen(int(os.environ.get("GFXREPRO_METRICS_FD", 1)), "w") as out:
    for metric, value in [("mean_deg", sum(errors) / vectors), ("max_deg", max(errors))]:
        print(json.dumps({"metric": metric, "value": value, "unit": "degree"}), file=out)
