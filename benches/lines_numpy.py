"""The warp by line features in plain NumPy, on the lines of benches/lines.rs.

    pip install numpy
    python3 benches/lines_numpy.py [OUT]

Beier, Neely, "Feature-based image metamorphosis" (1992): a raster of 1024 by
1024 pixel centres through 40 pairs of lines, a = 1 px, b = 2, p = 0.5; arrays
of pixels, a loop over lines. Prints the best and the median of 7 runs in
milliseconds. OUT gets the result as raw little-endian doubles, all x and then
all y, row by row.
"""

import math
import statistics
import sys
import time

import numpy as np

SIDE, COUNT = 1024, 40
A, B, P = 1.0, 2.0, 0.5


def segment(x, y, angle, length):
    dx, dy = 0.5 * length * math.cos(angle), 0.5 * length * math.sin(angle)
    return (x - dx, y - dy), (x + dx, y + dy)


def pair(i):
    """Line i in the frame and in the design."""
    x = SIDE * math.modf(0.5 + i * 0.7548776662)[0]
    y = SIDE * math.modf(0.5 + i * 0.5698402910)[0]
    angle = 2.4 * i
    length = 60.0 + 240.0 * math.modf(i * 0.6180339887)[0]
    moved = x + 40.0 * math.cos(1.7 * i), y + 40.0 * math.sin(1.3 * i)
    turned = angle + 0.5 * math.sin(i)
    stretched = length * (1.0 + 0.3 * math.cos(2.1 * i))
    return segment(x, y, angle, length), segment(*moved, turned, stretched)


def warp(x, y, pairs):
    """Where each place of the frame is looked up; x is a row, y a column."""
    sum_x, sum_y, total = (np.zeros((y.size, x.size)) for _ in range(3))
    for ((px, py), (qx, qy)), ((rx, ry), (sx, sy)) in pairs:
        dx, dy = qx - px, qy - py
        ex, ey = sx - rx, sy - ry
        length, other = math.hypot(dx, dy), math.hypot(ex, ey)
        u = ((x - px) * dx + (y - py) * dy) / length**2
        v = ((y - py) * dx - (x - px) * dy) / length
        beyond = (u - np.clip(u, 0.0, 1.0)) * length
        distance = np.sqrt(beyond**2 + v**2)
        weight = (length**P / (A + distance)) ** B
        sum_x += weight * (rx + u * ex - v * (ey / other) - x)
        sum_y += weight * (ry + u * ey + v * (ex / other) - y)
        total += weight
    return x + sum_x / total, y + sum_y / total


def main():
    x = np.arange(SIDE)[None, :] + 0.5
    y = np.arange(SIDE)[:, None] + 0.5
    pairs = [pair(i) for i in range(COUNT)]
    times = []
    for _ in range(7):
        start = time.perf_counter()
        result = warp(x, y, pairs)
        times.append(1e3 * (time.perf_counter() - start))
    print(f"best {min(times):.1f} ms, median {statistics.median(times):.1f} ms")
    if len(sys.argv) > 1:
        np.stack(result).astype("<f8").tofile(sys.argv[1])


main()
