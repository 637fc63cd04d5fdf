"""Tools for drawing the gallery: curves, strokes, contours, and writers of PNG, SVG, OBJ and JSON.

Points are complex numbers x + iy with y up, as everywhere in Morphospace; only the writers of PNG
and SVG flip y. Uses only the standard library.

`Ink` is a signed distance on a grid, negative inside, that grows by strokes of varying thickness.
Strokes join with a fillet, which makes structures look like cast or optimised material. Its zero
contour is fitted with cubic curves for SVG, or antialiased for PNG.
"""

import json
import math
import struct
import zlib


def cubic(a, b, c, d, steps):
    """Points on a cubic Bezier curve, including both ends."""
    out = []
    for i in range(steps + 1):
        t = i / steps
        s = 1 - t
        out.append(s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d)
    return out


def spline(points, steps=16):
    """A Catmull-Rom curve through the points, with `steps` steps between neighbouring points."""
    ends = [2 * points[0] - points[1], *points, 2 * points[-1] - points[-2]]
    out = [points[0]]
    for before, a, b, after in zip(ends, ends[1:], ends[2:], ends[3:]):
        out += cubic(a, a + (b - before) / 6, b - (after - a) / 6, b, steps)[1:]
    return out


def bezier_chain(curves, steps=16):
    """Points along consecutive cubic curves: a start, then triples of control points."""
    out = [curves[0]]
    for i in range(1, len(curves), 3):
        out += cubic(out[-1], *curves[i : i + 3], steps)[1:]
    return out


def at_fractions(chain, fractions):
    """Points of a polyline at fractions of its length, with unit directions."""
    lengths = [0.0]
    for a, b in zip(chain, chain[1:]):
        lengths.append(lengths[-1] + abs(b - a))
    out = []
    for fraction in fractions:
        target = fraction * lengths[-1]
        i = next((i for i in range(1, len(lengths) - 1) if lengths[i] >= target), len(lengths) - 1)
        step = chain[i] - chain[i - 1]
        part = (target - lengths[i - 1]) / abs(step)
        out.append((chain[i - 1] + part * step, step / abs(step)))
    return out


def trimmed(chain, start, end=None):
    """A polyline shortened by the length `start` at its start and `end` at its end.

    A stroke that ends inside a thicker one would make a bump on the far side of that one.
    """
    length = sum(abs(b - a) for a, b in zip(chain, chain[1:]))
    first, last = start / length, 1 - (start if end is None else end) / length
    return [p for p, _ in at_fractions(chain, [first + (last - first) * i / 40 for i in range(41)])]


def between(numbers, fraction):
    """Linear interpolation in a list of evenly spaced numbers."""
    at = fraction * (len(numbers) - 1)
    low = min(int(at), max(len(numbers) - 2, 0))
    high = min(low + 1, len(numbers) - 1)
    return numbers[low] + (numbers[high] - numbers[low]) * (at - low)


class Ink:
    """A signed distance on a grid of square cells, negative inside."""

    def __init__(self, width, height, cell=1.0, fillet=0.0):
        self.cell, self.fillet = cell, fillet
        self.columns, self.rows = round(width / cell), round(height / cell)
        self.values = [1e9] * (self.columns * self.rows)

    def _centre(self, column, row):
        """Centre of a cell."""
        return complex((column + 0.5) * self.cell, (row + 0.5) * self.cell)

    def _span(self, low, high, count):
        """Cells, of `count`, that overlap an interval of coordinates."""
        first = max(0, math.floor(low / self.cell))
        return range(first, min(count, math.ceil(high / self.cell) + 1))

    def carve(self, chain, *thickness):
        """Removes a stroke."""
        solid = self.values
        self.values = [1e9] * len(solid)
        self.stroke(chain, *thickness)
        self.values = [max(a, -b) for a, b in zip(solid, self.values)]

    def stroke(self, chain, *thickness):
        """Adds a stroke along a polyline; its thicknesses are evenly spaced along it."""
        reach = self.fillet + 3 * self.cell
        length = sum(abs(b - a) for a, b in zip(chain, chain[1:]))
        near, travelled = {}, 0.0
        for a, b in zip(chain, chain[1:]):
            step = b - a
            r0 = between(thickness, travelled / length) / 2
            travelled += abs(step)
            r1 = between(thickness, travelled / length) / 2
            pad = max(r0, r1) + reach
            xs = self._span(min(a.real, b.real) - pad, max(a.real, b.real) + pad, self.columns)
            for row in self._span(min(a.imag, b.imag) - pad, max(a.imag, b.imag) + pad, self.rows):
                for column in xs:
                    offset = self._centre(column, row) - a
                    part = (offset * step.conjugate()).real / abs(step) ** 2
                    part = min(1.0, max(0.0, part))
                    distance = abs(offset - part * step) - (r0 + (r1 - r0) * part)
                    key = row * self.columns + column
                    if distance < near.get(key, reach):
                        near[key] = distance
        self._unite(near)

    def polygon(self, corners):
        """Adds a filled polygon with sharp corners."""
        reach = self.fillet + 3 * self.cell
        sides = list(zip(corners, corners[1:] + corners[:1]))
        xs = self._span(
            min(p.real for p in corners) - reach, max(p.real for p in corners) + reach, self.columns
        )
        near = {}
        for row in self._span(
            min(p.imag for p in corners) - reach, max(p.imag for p in corners) + reach, self.rows
        ):
            for column in xs:
                p = self._centre(column, row)
                distance, inside = 1e9, False
                for a, b in sides:
                    step = b - a
                    part = min(1.0, max(0.0, ((p - a) * step.conjugate()).real / abs(step) ** 2))
                    distance = min(distance, abs(p - a - part * step))
                    if (a.imag > p.imag) != (b.imag > p.imag):
                        inside ^= p.real < a.real + step.real * (p.imag - a.imag) / step.imag
                near[row * self.columns + column] = -distance if inside else distance
        self._unite(near)

    def _unite(self, near):
        """Unites with distances by cell, with a fillet: a polynomial smooth minimum."""
        for key, new in near.items():
            old = self.values[key]
            blend = max(self.fillet - abs(old - new), 0.0) / self.fillet if self.fillet else 0.0
            self.values[key] = min(old, new) - blend * blend * self.fillet / 4

    def png(self, path):
        """Writes a black shape on white, antialiased, with one pixel per cell."""
        rows = []
        for row in reversed(range(self.rows)):
            line = self.values[row * self.columns : (row + 1) * self.columns]
            rows.append(bytes(round(255 * min(1, max(0, 0.5 + d / self.cell))) for d in line))
        write_png(path, self.columns, rows)

    def loops(self):
        """The zero contour as closed polylines, with the solid on the left."""
        w, h = self.columns, self.rows

        def value(column, row):
            inside = 0 <= column < w and 0 <= row < h
            return min(self.values[row * w + column], self.cell) if inside else self.cell

        def crossing(a, b):
            va, vb = value(*a), value(*b)
            pa, pb = self._centre(*a), self._centre(*b)
            return pa + (pb - pa) * va / (va - vb)

        next_edge, crossings = {}, {}
        for row in range(-1, h):
            for column in range(-1, w):
                corners = [
                    (column, row),
                    (column + 1, row),
                    (column + 1, row + 1),
                    (column, row + 1),
                ]
                inside = [value(*c) < 0 for c in corners]
                if all(inside) or not any(inside):
                    continue
                leave, enter = [], []
                for i in range(4):
                    a, b = corners[i], corners[(i + 1) % 4]
                    if inside[i] != inside[(i + 1) % 4]:
                        edge = (min(a, b), max(a, b))
                        crossings[edge] = crossing(a, b)
                        (leave if inside[i] else enter).append(edge)
                next_edge.update(zip(leave, enter))
        chains = []
        while next_edge:
            start = edge = next(iter(next_edge))
            chain = []
            while edge in next_edge:
                chain.append(crossings[edge])
                edge = next_edge.pop(edge)
            if edge == start and len(chain) > 8:
                chains.append(chain)
        return chains


def fit(chain, tolerance, closed=True):
    """Cubic curves along a dense polyline, each as long as the tolerance permits."""
    n = len(chain)
    last = n if closed else n - 1
    point = (lambda i: chain[i % n]) if closed else (lambda i: chain[min(max(i, 0), n - 1)])

    def direction(i):
        step = point(i + 2) - point(i - 2)
        return step / abs(step)

    def curve(i, j):
        length = sum(abs(point(k + 1) - point(k)) for k in range(i, j))
        return (
            point(i),
            point(i) + direction(i) * length / 3,
            point(j) - direction(j) * length / 3,
            point(j),
        )

    def close_enough(i, j):
        approximation = cubic(*curve(i, j), 12)
        return all(
            min(abs(point(k) - p) for p in subdivided(approximation)) < tolerance for k in range(i, j)
        )

    def subdivided(approximation):
        for a, b in zip(approximation, approximation[1:]):
            for k in range(4):
                yield a + (b - a) * k / 4
        yield approximation[-1]

    out, i = [], 0
    while i < last:
        j = min(i + 2, last)
        while j < last and j - i < 60 and close_enough(i, min(j + 2, last)):
            j = min(j + 2, last)
        out.append(curve(i, j))
        i = j
    return out


def svg_path(curves):
    """A closed subpath of an SVG path, y up; `svg` flips it."""
    text = "M" + _pair(curves[0][0])
    for _, b, c, d in curves:
        text += f" C{_pair(b)} {_pair(c)} {_pair(d)}"
    return text + " Z"


def _pair(p):
    return f"{p.real:.2f},{p.imag:.2f}".replace(".00,", ",").removesuffix(".00")


def svg(path, width, height, title, subpaths):
    """Writes an SVG file with one filled path; its group flips y."""
    body = "\n   ".join(subpaths)
    path.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}">\n <title>{title}</title>\n'
        f' <g transform="matrix(1 0 0 -1 0 {height})">\n'
        f'  <path fill="#1b3a4b" fill-rule="evenodd" d="{body}"/>\n </g>\n</svg>\n'
    )


def write_png(path, width, rows):
    """Writes an 8-bit grey PNG; the first row is the top one."""

    def chunk(kind, data):
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    head = struct.pack(">IIBBBBB", width, len(rows), 8, 0, 0, 0, 0)
    data = zlib.compress(b"".join(b"\0" + row for row in rows), 9)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", data) + chunk(b"IEND", b"")
    )


def signed_area(points, face):
    """Signed area of a triangle."""
    a, b, c = (points[i] for i in face)
    return ((b - a).conjugate() * (c - a)).imag / 2


def require_positive(name, points, faces):
    """Raises an error unless every face is counter-clockwise."""
    bad = [i for i, face in enumerate(faces) if signed_area(points, face) <= 0]
    if bad:
        raise ValueError(f"{name}: faces {bad} are not counter-clockwise")


def obj(path, comment, points, faces):
    """Writes a flat mesh as Wavefront OBJ."""
    require_positive(path.name, points, faces)
    lines = [f"# {comment}"]
    lines += [f"v {p.real:.6g} {p.imag:.6g} 0" for p in points]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")


def packed(items):
    """JSON items, several per line of at most 80 characters."""
    lines = []
    for item in map(json.dumps, items):
        if lines and len(lines[-1]) + len(item) < 78:
            lines[-1] += ", " + item
        else:
            lines.append("    " + item)
    return ",\n".join(lines)


def truss(path, units, nodes, panels, bars, extra):
    """Writes units, nodes, bars and extra fields as JSON; the panels are only checked."""
    require_positive(path.name, nodes, panels)
    rows = {
        "units": units,
        "nodes": [[round(p.real, 4) + 0.0, round(p.imag, 4) + 0.0] for p in nodes],
        "bars": [list(bar) for bar in bars],
        **extra,
    }
    parts = []
    for key, items in rows.items():
        text = json.dumps(items)
        if len(text) > 76 and isinstance(items, list):
            text = "[\n" + packed(items) + "\n  ]"
        parts.append(f'  "{key}": {text}')
    path.write_text("{\n" + ",\n".join(parts) + "\n}\n")
