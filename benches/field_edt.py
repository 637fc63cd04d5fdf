"""Times the signed distance transform edt.sdf (PyPI: edt, numpy) on the masks of benches/field.rs.

    pip install edt numpy
    python3 benches/field_edt.py

Prints the best and the median time of 15 runs, in milliseconds, for one and two threads.
"""

import statistics
import time

import edt
import numpy as np


def gear(side):
    half = side // 2
    y, x = np.mgrid[0:side, 0:side] - float(half)
    radius = np.hypot(x, y) / half
    tooth = np.sin(24.0 * np.arctan2(y, x)) >= 0.0
    return (radius > 0.3) & (radius < np.where(tooth, 0.76, 0.6))


def noise(side):
    y, x = np.mgrid[0:side, 0:side].astype(np.uint32)
    value = (x + np.uint32(side) * y) * np.uint32(2_654_435_761)
    return ((value ^ (value >> np.uint32(15))) * np.uint32(2_246_822_519)) >> np.uint32(31) == 1


def milliseconds(mask, threads, runs=15):
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        edt.sdf(mask, parallel=threads)
        times.append(1e3 * (time.perf_counter() - start))
    return min(times), statistics.median(times)


for side in (512, 1024, 2048):
    for name, make_mask in (("gear", gear), ("noise", noise)):
        mask = make_mask(side)
        for kind in (np.uint8, bool):
            for threads in (1, 2):
                best, median = milliseconds(mask.astype(kind), threads)
                label = f"{name}/{threads} thread/{side} ({np.dtype(kind).name})"
                print(f"{label:40} best {best:7.2f}  median {median:7.2f}")
