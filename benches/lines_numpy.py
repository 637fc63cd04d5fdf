"""Times a frame of two pictures warped by pairs of lines in plain NumPy.

    pip install numpy
    LINES_NUMPY=python3 cargo bench --no-default-features --bench lines

The same frame as in benches/lines.rs, which runs this script: Beier, Neely, "Feature-based image
metamorphosis" (1992), at t = 0.5. For every pixel centre of 1024 x 1024, 40 pairs of lines give the
positions in both designs, with b = 2, p = 0.5 and a = 1/100 of the diameter of the frame, which
extends beyond the pictures by 1/50 of their diameter. Both pictures are sampled bilinearly in
linear light, averaged, and encoded as sRGB. The code loops over lines and works on arrays of
pixels; decoding and everything independent of t is done before timing. The pictures are opaque, so
alpha, which the program computes, is omitted.

Prints the best and the median time of 7 runs in milliseconds. The file named by the argument
receives doubles: the positions, x and y in the source and in the target, y up; then red, green and
blue of each pixel.
"""

import math
import statistics
import sys
import time

import numpy as np

SIDE, COUNT, T = 1024, 40, 0.5
B, P = 2.0, 0.5
DIAMETER = math.sqrt(2.0) * SIDE
A = 0.01 * (DIAMETER + 2.0 * math.sqrt(2.0) * 0.02 * DIAMETER)


def pair(i):
    """Line i in both designs: midpoint, angle and length."""
    x = SIDE * math.modf(0.5 + i * 0.7548776662)[0]
    y = SIDE * math.modf(0.5 + i * 0.5698402910)[0]
    angle = 2.4 * i
    length = 60.0 + 240.0 * math.modf(i * 0.6180339887)[0]
    moved = x + 40.0 * math.cos(1.7 * i), y + 40.0 * math.sin(1.3 * i)
    turned = angle + 0.5 * math.sin(i)
    stretched = length * (1.0 + 0.3 * math.cos(2.1 * i))
    return (x, y, angle, length), (*moved, turned, stretched)


def ends(x, y, angle, length):
    """End points of a line."""
    dx, dy = 0.5 * length * math.cos(angle), 0.5 * length * math.sin(angle)
    return (x - dx, y - dy), (x + dx, y + dy)


def warp(x, y, pairs):
    """Positions in a design of the points of the frame; x is a row vector, y a column vector."""
    sum_x, sum_y, total = (np.zeros((y.size, x.size)) for _ in range(3))
    for ((px, py), (qx, qy)), ((rx, ry), (sx, sy)) in pairs:
        dx, dy = qx - px, qy - py
        ex, ey = sx - rx, sy - ry
        length, target_length = math.hypot(dx, dy), math.hypot(ex, ey)
        u = ((x - px) * dx + (y - py) * dy) / length**2
        v = ((y - py) * dx - (x - px) * dy) / length
        beyond = (u - np.clip(u, 0.0, 1.0)) * length
        distance = np.sqrt(beyond**2 + v**2)
        weight = (length**P / (A + distance)) ** B
        sum_x += weight * (rx + u * ex - v * (ey / target_length) - x)
        sum_y += weight * (ry + u * ey + v * (ex / target_length) - y)
        total += weight
    return x + sum_x / total, y + sum_y / total


def picture(shift):
    """A picture of smooth waves in linear light."""
    y, x = np.mgrid[0:SIDE, 0:SIDE]
    waves = [(x, 0), (y, 1), (x + y, 2)]
    levels = [np.abs((z * (k + 1) + shift * 57) % 511 - 255) for z, k in waves]
    encoded = np.stack(levels, axis=-1) / 255.0
    linear = np.where(
        encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4
    )
    return linear.astype(np.float32)


def encoding():
    """Table of sRGB values of 65536 steps of linear light."""
    light = np.arange(65536) / 65535.0
    encoded = np.where(
        light <= 0.0031308, 12.92 * light, 1.055 * light ** (1.0 / 2.4) - 0.055
    )
    return np.round(255.0 * encoded).astype(np.uint8)


def sample(image, x, y):
    """Bilinear interpolation between pixel centres; the edge is extended outwards."""
    column = np.clip(x - 0.5, 0.0, SIDE - 1.0)
    row = np.clip(SIDE - 0.5 - y, 0.0, SIDE - 1.0)
    i = np.minimum(column.astype(np.intp), SIDE - 2)
    j = np.minimum(row.astype(np.intp), SIDE - 2)
    u = (column - i).astype(np.float32)[..., None]
    v = (row - j).astype(np.float32)[..., None]
    upper = image[j, i] + u * (image[j, i + 1] - image[j, i])
    lower = image[j + 1, i] + u * (image[j + 1, i + 1] - image[j + 1, i])
    return upper + v * (lower - upper)


def frame(lines, images, table, t):
    """Positions in both designs, and the blended sRGB image."""
    x = np.arange(SIDE)[None, :] + 0.5
    y = SIDE - np.arange(SIDE)[:, None] - 0.5
    between = [
        ends(*((1.0 - t) * a + t * b for a, b in zip(*line, strict=True)))
        for line in lines
    ]
    places = [
        warp(x, y, [(line_at_t, ends(*line[k])) for line_at_t, line in zip(between, lines)])
        for k in (0, 1)
    ]
    source, target = (sample(image, *position) for image, position in zip(images, places))
    light = source + np.float32(t) * (target - source)
    return places, table[(light * 65535.0 + 0.5).astype(np.uint16)]


def main():
    lines = [pair(i) for i in range(COUNT)]
    images, table = [picture(0), picture(1)], encoding()
    times = []
    for _ in range(7):
        start = time.perf_counter()
        places, colours = frame(lines, images, table, T)
        times.append(1e3 * (time.perf_counter() - start))
    best, median = min(times), statistics.median(times)
    print(f"NumPy {np.__version__}: best {best:.1f} ms, median {median:.1f} ms", flush=True)
    if len(sys.argv) > 1:
        with open(sys.argv[1], "wb") as out:
            for plane in [*places[0], *places[1], colours]:
                out.write(plane.astype("<f8").tobytes())


main()
