#!/usr/bin/env python3
"""Compares the import of SVG drawings with Chromium.

Usage: compare_browser.py [--program PATH] [--out FOLDER] FILE.svg ...

Each drawing is imported and written as SVG by `morphospace render --at 0`. Chromium draws that file
and the original. Marks in the corners of the page, which are added to both, align the two pictures.
For each drawing, prints the share of pixels in which a channel differs by more than 16 of 255, and
the notes of the import. Exits with 1 if a drawing differs in more than 0.5 % of its pixels without
a note. Needs Chromium, Pillow and NumPy.
"""

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

WIDTH_PX = 600
MAX_DIFFERENCE = 16
MAX_SHARE = 0.005
MARK = "#123456"


def with_marks(text):
    """Returns a drawing with marks in the corners of its page, and the size of the page."""
    box = re.search(r"<svg[^>]*\sviewBox\s*=\s*[\"']([^\"']+)", text).group(1)
    x, y, width, height = map(float, re.split(r"[ ,]+", box.strip()))
    side = width / 100
    corners = [(x + i * (width - side), y + j * (height - side)) for i in (0, 1) for j in (0, 1)]
    data = "".join(f"M{u} {v}h{side}v{side}h{-side}z" for u, v in corners)
    end = text.rindex("</svg>")
    mark = f'<path style="fill:{MARK}!important;stroke:none!important" d="{data}"/>'
    return text[:end] + mark + text[end:], (width, height)


def cut_to_marks(text):
    """Returns an exported drawing whose view box is the box of the marks."""
    points = []
    for path in re.findall(rf'<path[^>]*fill="{MARK}"[^>]*/>', text):
        data = re.search(r'\sd="([^"]+)"', path).group(1)
        points += [tuple(map(float, p)) for p in re.findall(r"(-?[\d.]+)[ ,](-?[\d.]+)", data)]
    xs, ys = zip(*points)
    box = f"{min(xs)} {min(ys)} {max(xs) - min(xs)} {max(ys) - min(ys)}"
    return re.sub(r'viewBox="[^"]+"', f'viewBox="{box}" preserveAspectRatio="none"', text, count=1)


def screenshot(drawing, page_size, folder):
    """Returns the pixels of a drawing as Chromium shows it on white. The drawing has the size of its
    page, to which units like `vw` refer, and is then enlarged."""
    page, picture = folder / "page.html", folder / "page.png"
    (width, height), scale = page_size, WIDTH_PX / page_size[0]
    height_px = round(scale * height)
    style = f"display:block;width:{width}px;height:{height}px"
    style += f";transform-origin:0 0;transform:scale({scale})"
    image = f'<img src="{drawing.as_uri()}" style="{style}">'
    page.write_text(f'<body style="margin:0;background:#fff;overflow:hidden">{image}</body>')
    command = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"]
    command += ["--allow-file-access-from-files", f"--user-data-dir={folder / 'profile'}"]
    command += [f"--window-size={WIDTH_PX},{height_px + 200}", f"--screenshot={picture}", page.as_uri()]
    subprocess.run(command, capture_output=True, timeout=120, check=True)
    pixels = Image.open(picture).convert("RGB").crop((0, 0, WIDTH_PX, height_px))
    return np.asarray(pixels).astype(int)


def pictures(program, path, folder):
    """Returns the pixels of a drawing in Chromium, those of its import, and the notes of the import.
    Both pictures are None if the drawing was refused."""
    text, page_size = with_marks(path.read_text(encoding="utf-8"))
    original, imported = folder / "original.svg", folder / "imported.svg"
    original.write_text(text, encoding="utf-8")
    command = [program, "render", original, original, "--at", "0", "--quality", "draft"]
    command += ["--ground", "#ffffff", "--out", imported]
    run = subprocess.run(command, capture_output=True, text=True, timeout=300)
    notes = [line for line in run.stderr.splitlines() if not line.startswith("wrote ")]
    notes = [line.removeprefix("original: ") for line in notes]
    if run.returncode:
        return None, None, notes
    imported.write_text(cut_to_marks(imported.read_text()))
    expected, found = (screenshot(file, page_size, folder) for file in (original, imported))
    return expected, found, notes


def compare(program, path, folder, out):
    """Returns the share of differing pixels (None if the drawing was refused) and the messages."""
    expected, found, notes = pictures(program, path, folder)
    if expected is None:
        return None, notes
    if out:
        both = np.concatenate([expected, found], axis=1).astype("uint8")
        Image.fromarray(both).save(out / f"{path.stem}.png")
    differs = np.abs(expected - found).max(axis=-1) > MAX_DIFFERENCE
    return differs.mean(), notes


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="morphospace")
    parser.add_argument("--out", type=Path, help="folder for pictures of both, side by side")
    parser.add_argument("files", type=Path, nargs="+")
    arguments = parser.parse_args()
    if arguments.out:
        arguments.out.mkdir(parents=True, exist_ok=True)
    silent = 0
    for path in arguments.files:
        with tempfile.TemporaryDirectory() as folder:
            share, notes = compare(arguments.program, path, Path(folder), arguments.out)
        is_same = share is not None and share <= MAX_SHARE
        silent += not is_same and not notes
        state = "same" if is_same else "reported" if notes else "DIFFERS"
        shown = "refused" if share is None else f"{100 * share:.2f} %"
        print(f"{state} {path.stem}: {shown} {' / '.join(notes)}".rstrip(), flush=True)
    sys.exit(1 if silent else 0)


if __name__ == "__main__":
    main()
