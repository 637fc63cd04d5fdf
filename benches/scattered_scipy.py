"""Radial basis functions of SciPy: reference values for tests, and times.

    pip install numpy scipy
    python3 benches/scattered_scipy.py          # times, to compare with benches/scattered.rs
    python3 benches/scattered_scipy.py table    # writes src/warp/scattered/scipy.csv to stdout

Smoothing has the squared unit of the points, as in SciPy; the unit is 1 here. The points are those
of the benchmark and of the unit tests.
"""

import statistics
import sys
import time

import numpy as np
from scipy.interpolate import RBFInterpolator


def spread(count, shift=0.0):
    """Evenly spread points: the additive recurrence by the plastic number."""
    k = np.arange(1, count + 1)[:, None] + shift
    return (k * np.array([0.7548776662466927, 0.5698402909980532])) % 1.0


def values(points):
    """Targets of points: a smooth function."""
    x, y = points.T
    return np.stack([np.sin(3.0 * x) + y * y, x * np.cos(2.0 * y)], axis=1)


KINDS = [
    dict(kernel="thin_plate_spline"),
    dict(kernel="thin_plate_spline", smoothing=0.01),
    dict(kernel="gaussian", epsilon=4.0, degree=1),
    dict(kernel="gaussian", epsilon=4.0, degree=1, smoothing=0.1),
]


def table():
    """Prints reference values as CSV."""
    centres, queries = spread(12), 1.5 * spread(20, 100.5) - 0.25
    columns = [queries]
    for kind in KINDS:
        columns.append(RBFInterpolator(centres, values(centres), **kind)(queries))
    print("x,y,plate x,plate y,smooth x,smooth y,gauss x,gauss y,smooth gauss x,smooth gauss y")
    for row in np.hstack(columns):
        print(",".join(f"{number:.17g}" for number in row))


def milliseconds(function, runs=5):
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        function()
        times.append(1e3 * (time.perf_counter() - start))
    return f"best {min(times):9.2f}  median {statistics.median(times):9.2f}"


def times():
    """Times frames at t = 0.5: both maps are solved together and evaluated."""
    side = np.arange(512) / 511.0
    raster = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    for count in (50, 200, 500):
        source = spread(count)
        target = values(source)
        halfway = 0.5 * (source + target)
        both = np.hstack([source, target])
        for kind in (KINDS[0], KINDS[2]):
            frame = lambda: RBFInterpolator(halfway, both, **kind)(raster)
            print(f"{kind['kernel']}, {count} pairs: {milliseconds(frame)}")


table() if sys.argv[1:] == ["table"] else times()
