#!/usr/bin/env python3
"""Compares blends of four dissimilar shapes with their Wasserstein barycentres.

    python3 scripts/compare_barycentres.py target/release/morphospace docs/images/barycentres.png

Needs numpy, Pillow and POT (pip install pot pillow). The shapes are those of the gallery project
four-shapes, drawn for this project after the figure of POT's example "Convolutional Wasserstein
Barycenter". The barycentres are computed with ot.bregman.convolutional_barycenter2d on images of
200 x 200 pixels with the regularisation of that example, 0.004.

Prints for each of three sheets of 5 x 5 blends: the time; the width of the edges in pixels; the
maximum number of connected pieces (above half of the darkest pixel); and the deviation of the area
from the weighted mean of the areas of the shapes.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import ot
from PIL import Image, ImageDraw, ImageFont

SIDE = 5  # blends per side of a sheet
PIXELS = 200  # side of a blend in pixels
# Row and column of each shape in a sheet.
CORNERS = {"cross": (0, 0), "duck": (0, 4), "tooth": (4, 4), "heart": (4, 0)}
REGULARISATION = 0.004
GROUND = (247, 245, 240)
ROOT = Path(__file__).resolve().parent.parent


def shape(binary, name, folder):
    """Coverage of a shape by pixel, 0 to 1."""
    source = str(ROOT / "assets" / "gallery" / f"shape-{name}.svg")
    out = Path(folder) / f"{name}.png"
    options = ["--source-colour", "#000000", "--ground", "#ffffff", "--paint", "one"]
    size = ["--size", f"{PIXELS}x{PIXELS}", "--at", "0", "--warp", "none", "--content", "field"]
    command = [binary, "render", source, source, "--out", str(out), *size, *options]
    subprocess.run(command, check=True, capture_output=True)
    return 1 - np.asarray(Image.open(out).convert("L"), float) / 255


def weights(row, column):
    """Bilinear weights of the shapes; close to those of natural neighbours in a square."""
    y, x = row / (SIDE - 1), column / (SIDE - 1)
    return {"cross": (1 - x) * (1 - y), "duck": x * (1 - y), "tooth": x * y, "heart": (1 - x) * y}


def barycentres(shapes):
    """A sheet of barycentres, each scaled to its darkest pixel, and the seconds taken."""
    masses = np.array([shapes[name] / shapes[name].sum() for name in CORNERS])
    sheet, start = [], time.perf_counter()
    for row in range(SIDE):
        for column in range(SIDE):
            shares = weights(row, column)
            shape_weights = np.array([shares[name] for name in CORNERS])
            if shape_weights.max() == 1:
                blend = masses[shape_weights.argmax()]
            else:
                blend = ot.bregman.convolutional_barycenter2d(masses, REGULARISATION, shape_weights)
            sheet.append(blend / blend.max())
    return sheet, time.perf_counter() - start


def morphospace_sheet(binary, content, folder):
    """The same sheet by Morphospace, as coverage, and the seconds from the files to the image."""
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
        cell[int(0.9 * PIXELS) :] = 0  # removes the names of the designs
    return cells, seconds


def pieces(blend):
    """Number of connected pieces above one half, larger than 1/1000 of the image."""
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
    """Mean width of the edge in pixels: area of partial coverage over length of the boundary."""
    partial = np.count_nonzero((blend > 0.1) & (blend < 0.9))
    inside = blend > 0.5
    boundary = np.count_nonzero(inside[1:] != inside[:-1]) + np.count_nonzero(
        inside[:, 1:] != inside[:, :-1]
    )
    return partial / max(1, boundary)


def print_measures(name, sheet, seconds):
    """Prints the time and the measures of a sheet."""
    corners = {name: sheet[r * SIDE + c].sum() for name, (r, c) in CORNERS.items()}
    deviations = []
    for row in range(SIDE):
        for column in range(SIDE):
            shares = weights(row, column)
            expected_area = sum(shares[name] * corners[name] for name in CORNERS)
            deviations.append(abs(np.count_nonzero(sheet[row * SIDE + column] > 0.5) / expected_area - 1))
    inner = [k for k in range(SIDE * SIDE) if divmod(k, SIDE) not in CORNERS.values()]
    edges = np.mean([edge(sheet[k]) for k in inner])
    max_pieces = max(pieces(sheet[k]) for k in inner)
    print(f"{name:24} {seconds:7.2f} s   edges {edges:5.2f} px   at most {max_pieces} pieces   "
          f"area off by {100 * np.mean(deviations):.1f} % (mean), {100 * max(deviations):.1f} % (max)")


def draw_sheets(sheets, path):
    """Draws the sheets side by side, tinted by the weights."""
    cell, gap, title = 84, 28, 26
    side = SIDE * cell
    width = len(sheets) * side + (len(sheets) + 1) * gap
    whole = Image.new("RGB", (width, side + title + 2 * gap), GROUND)
    draw = ImageDraw.Draw(whole)
    font = ImageFont.truetype(str(ROOT / "assets" / "fonts" / "Roboto-Bold.ttf"), 16)
    colours = {"cross": (47, 111, 179), "duck": (138, 118, 150), "tooth": (184, 122, 108),
            "heart": (217, 130, 43)}
    for k, (name, sheet) in enumerate(sheets):
        left = gap + k * (side + gap)
        draw.text((left + side / 2, gap / 2 + 8), name, (32, 32, 32), font, anchor="mm")
        for n, blend in enumerate(sheet):
            row, column = divmod(n, SIDE)
            shares = weights(row, column)
            colour = sum(shares[name] * np.array(colours[name], float) for name in CORNERS)
            alpha = blend[..., None]
            pixels = alpha * colour + (1 - alpha) * np.array(GROUND, float)
            small = Image.fromarray(pixels.round().astype(np.uint8)).resize(
                (cell - 6, cell - 6), Image.Resampling.LANCZOS
            )
            whole.paste(small, (left + column * cell + 3, gap + title - 10 + row * cell))
    whole.save(path, optimize=True)


def main():
    binary, path = sys.argv[1], sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        shapes = {name: shape(binary, name, folder) for name in CORNERS}
        rigid = morphospace_sheet(binary, ["--warp", "arap", "--content", "solid"], folder)
        fields = morphospace_sheet(binary, ["--warp", "none", "--content", "field"], folder)
    transport = barycentres(shapes)
    sheets = [("Rigid parts", rigid), ("Distance fields", fields),
              ("Wasserstein barycentres", transport)]
    for name, (sheet, seconds) in sheets:
        print_measures(name, sheet, seconds)
    draw_sheets([(name, sheet) for name, (sheet, _) in sheets], path)


if __name__ == "__main__":
    main()
