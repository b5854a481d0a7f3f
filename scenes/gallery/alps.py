#!/usr/bin/env python3
"""Makes alps.hf, the height field of alps.ray:  python3 alps.py > alps.hf

A ridged sum of value noise (F. K. Musgrave, in Ebert et al., Texturing and Modeling, 1994: ridges where noise
changes its sign), with a valley for the lake pressed into it.  The format is that of Rayshade: an int32 n, then
n * n float32, row by row, here little-endian.  No dependencies; the same bytes every time.
SPDX-License-Identifier: BSD-3-Clause
"""
import math
import struct
import sys

SIDE = 145          # samples along a side: 84 KB
OCTAVES = 6


def lattice(x, y, octave):
    """A pseudo-random number in [-1, 1) for a lattice point."""
    h = (x * 374761393 + y * 668265263 + octave * 1274126177) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 1103515245) & 0xFFFFFFFF
    h = ((h ^ (h >> 16)) * 2246822519) & 0xFFFFFFFF
    return ((h ^ (h >> 15)) & 0xFFFFFF) / 0x800000 - 1


def noise(x, y, octave):
    """Value noise, with the fade curve of Perlin's improved noise."""
    i, j = math.floor(x), math.floor(y)
    u, v = x - i, y - j
    u, v = u * u * u * (u * (6 * u - 15) + 10), v * v * v * (v * (6 * v - 15) + 10)
    low = lattice(i, j, octave) * (1 - u) + lattice(i + 1, j, octave) * u
    high = lattice(i, j + 1, octave) * (1 - u) + lattice(i + 1, j + 1, octave) * u
    return low * (1 - v) + high * v


def height(x, y):
    """The height above the lake for x, y in [0, 1]; y is away from the viewer."""
    total, weight, frequency = 0.0, 1.0, 3.2
    for octave in range(OCTAVES):
        ridge = (1 - abs(noise(frequency * x + 9.1 * octave, frequency * y + 4.7 * octave, octave))) ** 2
        total += weight * ridge
        weight *= 0.46 * (0.5 + 0.5 * ridge)   # rough peaks, smooth valleys
        frequency *= 2.1
    shore = 0.30 + 0.10 * noise(3 * x, 0.5, 77)
    rise = max(0.0, min(1.0, (y - shore) / 0.55))
    sides = 0.12 * abs(2 * x - 1) ** 1.6
    return (total - 0.62) * (0.06 + 0.30 * rise * rise * (3 - 2 * rise) + sides) - 0.055 + 0.10 * rise + 0.35 * sides


def main():
    values = [height(k % SIDE / (SIDE - 1), k // SIDE / (SIDE - 1)) for k in range(SIDE * SIDE)]
    sys.stdout.buffer.write(struct.pack("<i%df" % len(values), SIDE, *values))


main()
