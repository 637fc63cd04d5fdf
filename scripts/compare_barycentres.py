#!/usr/bin/env python3
"""Four unlike shapes and what lies between them, against Wasserstein barycentres.

    python3 scripts/compare_barycentres.py target/release/morphospace assets/readme/barycentres.png

Needs numpy, Pillow and POT (pip install pot pillow). The shapes are those of the gallery's
four-shapes, drawn for this project after the figure of POT's example "Convolutional
Wasserstein Barycenter"; the method is ot.bregman.convolutional_barycenter2d with the
regularisation of that example, 0.004, on pictures of 200 x 200 pixels, as there. Prints for
each of the three sheets of 5 x 5 the time and what is kept: how wide its edges are, in pixels
of 200; in how many pieces a blend is (above half of its darkest); its area against that of
the shapes, mixed.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import ot
from PIL import Image, ImageDraw, ImageFont

SIDE = 5
PIXELS = 200
CORNERS = {"cross": (0, 0), "duck": (0, 4), "tooth": (4, 4), "heart": (4, 0)}
REGULARISATION = 0.004
GROUND = (247, 245, 240)
ROOT = Path(__file__).resolve().parent.parent


def shape(binary, name, folder):
    """The coverage of a shape, 0 to 1."""
    source = str(ROOT / "assets" / "gallery" / f"shape-{name}.svg")
    out = Path(folder) / f"{name}.png"
    options = ["--source-colour", "#000000", "--ground", "#ffffff", "--paint", "one"]
    size = ["--size", f"{PIXELS}x{PIXELS}", "--at", "0", "--warp", "none", "--content", "field"]
    command = [binary, "render", source, source, "--out", str(out), *size, *options]
    subprocess.run(command, check=True, capture_output=True)
    return 1 - np.asarray(Image.open(out).convert("L"), float) / 255


def weights(row, column):
    """Shares of the corners, bilinear: as natural neighbours have them in a square, nearly."""
    y, x = row / (SIDE - 1), column / (SIDE - 1)
    return {"cross": (1 - x) * (1 - y), "duck": x * (1 - y), "tooth": x * y, "heart": (1 - x) * y}


def barycentres(shapes):
    """A sheet of them, each scaled to its darkest pixel, and the seconds that it took."""
    masses = np.array([shapes[name] / shapes[name].sum() for name in CORNERS])
    sheet, start = [], time.perf_counter()
    for row in range(SIDE):
        for column in range(SIDE):
            share = weights(row, column)
            own = np.array([share[name] for name in CORNERS])
            if own.max() == 1:
                blend = masses[own.argmax()]
            else:
                blend = ot.bregman.convolutional_barycenter2d(masses, REGULARISATION, own)
            sheet.append(blend / blend.max())
    return sheet, time.perf_counter() - start


def ours(binary, content, folder):
    """The same sheet of ours, as coverage, and the seconds from the files to the picture."""
    names = [str(ROOT / "assets" / "gallery" / f"shape-{name}.svg") for name in CORNERS]
    out = Path(folder) / f"{'-'.join(content)}.png"
    side = SIDE * PIXELS
    command = [binary, "render", *names, "--map", f"{SIDE}x{SIDE}", "--sites", "polygon"]
    command += ["--size", f"{side}x{side}", "--out", str(out), *content]
    command += ["--source-colour", "#000000", "--target-colour", "#000000", "--ground", "#ffffff"]
    start = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    seconds = time.perf_counter() - start
    whole = 1 - np.asarray(Image.open(out).convert("L"), float) / 255
    cells = [
        whole[r * PIXELS : (r + 1) * PIXELS, c * PIXELS : (c + 1) * PIXELS].copy()
        for r in range(SIDE)
        for c in range(SIDE)
    ]
    for cell in cells:
        cell[int(0.9 * PIXELS) :] = 0  # the designs' names
    return cells, seconds


def pieces(blend):
    """Connected pieces above half, of more than a thousandth of the picture."""
    inside, seen, count = blend > 0.5, np.zeros(blend.shape, bool), 0
    for start in zip(*np.nonzero(inside)):
        if seen[start]:
            continue
        stack, size = [start], 0
        seen[start] = True
        while stack:
            y, x = stack.pop()
            size += 1
            for ny, nx in ((y + 1, x), (y - 1, x), (y, x + 1), (y, x - 1)):
                if 0 <= ny < PIXELS and 0 <= nx < PIXELS and inside[ny, nx] and not seen[ny, nx]:
                    seen[ny, nx] = True
                    stack.append((ny, nx))
        count += size > PIXELS * PIXELS / 1000
    return count


def edge(blend):
    """The width of its edge: what is neither in nor out, by the length of the boundary."""
    between = np.count_nonzero((blend > 0.1) & (blend < 0.9))
    inside = blend > 0.5
    boundary = np.count_nonzero(inside[1:] != inside[:-1]) + np.count_nonzero(
        inside[:, 1:] != inside[:, :-1]
    )
    return between / max(1, boundary)


def told(name, sheet, seconds):
    corners = {name: sheet[r * SIDE + c].sum() for name, (r, c) in CORNERS.items()}
    off = []
    for row in range(SIDE):
        for column in range(SIDE):
            share = weights(row, column)
            wanted = sum(share[name] * corners[name] for name in CORNERS)
            off.append(abs(np.count_nonzero(sheet[row * SIDE + column] > 0.5) / wanted - 1))
    inner = [k for k in range(SIDE * SIDE) if divmod(k, SIDE) not in CORNERS.values()]
    edges = np.mean([edge(sheet[k]) for k in inner])
    most = max(pieces(sheet[k]) for k in inner)
    print(f"{name:24} {seconds:7.2f} s   edges {edges:5.2f} px   at most {most} pieces   "
          f"area off by {100 * np.mean(off):.1f} % (mean), {100 * max(off):.1f} % (most)")


def picture(sheets, path):
    cell, gap, title = 84, 28, 26
    side = SIDE * cell
    width = len(sheets) * side + (len(sheets) + 1) * gap
    whole = Image.new("RGB", (width, side + title + 2 * gap), GROUND)
    draw = ImageDraw.Draw(whole)
    font = ImageFont.truetype(str(ROOT / "assets" / "fonts" / "Roboto-Bold.ttf"), 16)
    inks = {"cross": (47, 111, 179), "duck": (138, 118, 150), "tooth": (184, 122, 108),
            "heart": (217, 130, 43)}
    for k, (name, sheet) in enumerate(sheets):
        left = gap + k * (side + gap)
        draw.text((left + side / 2, gap / 2 + 8), name, (32, 32, 32), font, anchor="mm")
        for n, blend in enumerate(sheet):
            row, column = divmod(n, SIDE)
            share = weights(row, column)
            ink = sum(share[name] * np.array(inks[name], float) for name in CORNERS)
            alpha = blend[..., None]
            pixels = alpha * ink + (1 - alpha) * np.array(GROUND, float)
            small = Image.fromarray(pixels.round().astype(np.uint8)).resize(
                (cell - 6, cell - 6), Image.Resampling.LANCZOS
            )
            whole.paste(small, (left + column * cell + 3, gap + title - 10 + row * cell))
    whole.save(path, optimize=True)


def main():
    binary, path = sys.argv[1], sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        shapes = {name: shape(binary, name, folder) for name in CORNERS}
        rigid = ours(binary, ["--warp", "arap", "--content", "solid"], folder)
        fields = ours(binary, ["--warp", "none", "--content", "field"], folder)
    transport = barycentres(shapes)
    sheets = [("Rigid parts", rigid), ("Distance fields", fields),
              ("Wasserstein barycentres", transport)]
    for name, (sheet, seconds) in sheets:
        told(name, sheet, seconds)
    picture([(name, sheet) for name, (sheet, _) in sheets], path)


if __name__ == "__main__":
    main()
