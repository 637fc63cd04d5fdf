#!/usr/bin/env python3
"""Compares the import of SVG drawings with the reference pictures of resvg's tests.

Usage: compare_resvg.py [--program PATH] [--browser] TESTS [FOLDER ...]

TESTS is `crates/resvg/tests/tests` of a copy of resvg (github.com/linebender/resvg). For each folder,
prints how many drawings look the same as their picture, differ with a note of the import, and differ
without one. Both pictures are cropped to their content and reduced to 100 pixels of width; they are
the same if at most 2 % of the pixels differ by more than 64 of 255. `--browser` compares the drawings
that differ without a note with Chromium in the same way. For the same texts, resvg's fonts
(`crates/resvg/tests/fonts`) must be installed. Needs Pillow and NumPy.
"""

import argparse
import subprocess
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from PIL import Image

import compare_browser

FOLDERS = ["shapes", "masking", "painting", "paint-servers", "structure", "text"]
WIDTH_PX = 100
# The edges of the cropped pictures, where rounding differs.
BORDER_PX = 3
MAX_DIFFERENCE = 64
MAX_SHARE = 0.02
MAX_ASPECT = 1.05
TIMEOUT_S = 60


def cropped(picture):
    """Returns a picture without its transparent borders; None if it is empty."""
    picture = picture.convert("RGBA")
    box = picture.getchannel("A").point(lambda alpha: 255 * (alpha > 8)).getbbox()
    return picture.crop(box) if box else None


def on_white(picture, size):
    """Returns the pixels of a picture of a size, drawn on white."""
    pixels = np.asarray(picture.resize(size, Image.BOX)).astype(float)
    alpha = pixels[..., 3:] / 255
    return pixels[..., :3] * alpha + 255 * (1 - alpha)


def is_same(expected, found):
    """Returns whether two cropped pictures look the same."""
    if expected is None or found is None:
        return expected is found
    ratio = (found.width / found.height) / (expected.width / expected.height)
    if not 1 / MAX_ASPECT < ratio < MAX_ASPECT:
        return False
    size = (WIDTH_PX, max(8, round(WIDTH_PX * expected.height / expected.width)))
    difference = np.abs(on_white(expected, size) - on_white(found, size)).max(axis=-1)
    inner = difference[BORDER_PX:-BORDER_PX, BORDER_PX:-BORDER_PX]
    return (inner > MAX_DIFFERENCE).mean() < MAX_SHARE


def agrees_with_browser(program, drawing):
    """Returns whether Chromium draws a drawing as the import does."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            expected, found, _ = compare_browser.pictures(program, drawing, Path(folder))
        except (AttributeError, UnicodeDecodeError, ValueError):
            return False  # the page of the drawing is not found
    if expected is None:
        return False
    drawn = [Image.fromarray(p.astype("uint8")).convert("RGBA") for p in (expected, found)]
    return is_same(*drawn)


def state(program, drawing, uses_browser):
    """Returns how the import of a drawing compares with its picture."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "drawn.png"
        command = [program, "render", drawing, drawing, "--at", "0", "--ground", "transparent"]
        command += ["--size", "400x400", "--quality", "draft", "--out", out]
        run = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S)
        notes = [line for line in run.stderr.splitlines() if not line.startswith("wrote ")]
        expected = cropped(Image.open(drawing.with_suffix(".png")))
        if run.returncode:
            return "same" if expected is None else "refused"
        found = cropped(Image.open(out))
    if is_same(expected, found):
        return "same"
    if notes:
        return "noted"
    if uses_browser and agrees_with_browser(program, drawing):
        return "as Chromium"
    return "silent"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="morphospace")
    parser.add_argument("--browser", action="store_true")
    parser.add_argument("tests", type=Path)
    parser.add_argument("folders", nargs="*", default=FOLDERS)
    arguments = parser.parse_args()
    columns = ["same", "noted", "refused", "as Chromium", "silent"]
    print("| folder | drawings |", " | ".join(columns), "|")
    for folder in arguments.folders:
        drawings = sorted((arguments.tests / folder).rglob("*.svg"))
        with ThreadPoolExecutor(2) as pool:
            states = list(
                pool.map(lambda d: state(arguments.program, d, arguments.browser), drawings)
            )
        counts = Counter(states)
        row = [folder, len(drawings), *(counts[column] for column in columns)]
        print("|", " | ".join(map(str, row)), "|", flush=True)
        for drawing, found in zip(drawings, states):
            if found in ("silent", "as Chromium"):
                print(f"  {found}: {drawing.relative_to(arguments.tests)}", flush=True)


if __name__ == "__main__":
    main()
