#!/usr/bin/env python3
"""Prints hashes of what the program produces, to show that a change of the code
changes no result.

    scripts/pin.py target/release/morphospace DATA > before.txt
    scripts/pin.py target/release/morphospace DATA > after.txt
    diff before.txt after.txt

Three kinds of lines, each `kind name sha256`:

- `frames`: every project of the gallery and neighbouring pairs of `tests/drawings`, in
  every cell of the table of methods, at nine values of t (SVG; PNG for pictures)
- `match`: the cached match (`[found]`) of every pair in DATA/*.csv and
  DATA/trusses/pairs.csv; a pair that is refused counts as refused
- `check`: the numbers of `check --json` for the projects and drawings, without times
  and without sentences

The last line hashes all the others. Needs a build with the feature `cli` only.
"""

import argparse
import concurrent.futures
import csv
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
MOMENTS = "0,0.125,0.25,0.375,0.5,0.625,0.75,0.875,1"
WARPS = ["none", "paths", "arap", "lines", "scattered", "lattice"]
CONTENTS = ["solid", "field", "colours"]


def sha(data):
    return hashlib.sha256(data).hexdigest()[:16]


def run(binary, *arguments):
    command = [binary, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, timeout=600)


def inputs():
    """Name and designs of every gallery project and of pairs of drawings."""
    projects = sorted((ROOT / "assets/gallery").glob("*.morph"))
    yield from ((path.stem, [path]) for path in projects)
    drawings = sorted((ROOT / "tests/drawings").glob("*.svg"))
    for source, target in zip(drawings, drawings[1:]):
        yield f"{source.stem}-{target.stem}", [source, target]


def frames(binary, name, designs, warp, content):
    kind = "png" if content == "colours" else "svg"
    with tempfile.TemporaryDirectory() as folder:
        result = run(
            binary, "render", *designs, "--warp", warp, "--content", content,
            "--at", MOMENTS, "--out", f"{folder}/f-##.{kind}",
        )
        files = sorted(pathlib.Path(folder).iterdir())
        data = b"\0".join(path.read_bytes() for path in files)
    outcome = sha(data) if result.returncode == 0 else f"refused-{result.returncode}"
    return f"frames {name}/{warp}/{content} {outcome}"


def match(binary, folder, row):
    name = f"{row['source']} {row['target']}"
    paths = [row[side] if ":" in row[side] else folder / row[side] for side in ("source", "target")]
    with tempfile.TemporaryDirectory() as out:
        project = pathlib.Path(out) / "x.morph"
        result = run(binary, "new", *paths, "--film", "--out", project)
        if result.returncode:
            return f"match {name} refused-{result.returncode}"
        found = tomllib.loads(project.read_text()).get("found", {})
    return f"match {name} {sha(json.dumps(found, sort_keys=True).encode())}"


def numbers(value):
    """The value without times and without sentences (texts with a space)."""
    if isinstance(value, dict):
        kept = {key: numbers(item) for key, item in value.items() if "seconds" not in key}
        return {key: item for key, item in kept.items() if item is not None}
    if isinstance(value, list):
        return [numbers(item) for item in value]
    return None if isinstance(value, str) and " " in value else value


def check(binary, name, designs):
    result = run(binary, "check", *designs, "--json")
    if result.returncode:
        return f"check {name} refused-{result.returncode}"
    report = json.dumps(numbers(json.loads(result.stdout)), sort_keys=True)
    return f"check {name} {sha(report.encode())}"


def jobs(binary, data, kinds):
    if "frames" in kinds:
        for name, designs in inputs():
            for warp in WARPS:
                for content in CONTENTS:
                    yield frames, binary, name, designs, warp, content
    if "check" in kinds:
        for name, designs in inputs():
            yield check, binary, name, designs
    if "match" in kinds:
        lists = [*sorted(data.glob("*.csv")), data / "trusses/pairs.csv"]
        for path in lists:
            for row in csv.DictReader(path.read_text().splitlines()):
                yield match, binary, path.parent, row


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binary", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--kinds", default="frames,check,match")
    options = parser.parse_args()
    binary = options.binary.resolve()
    todo = list(jobs(binary, options.data.resolve(), options.kinds.split(",")))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        lines = list(pool.map(lambda job: job[0](*job[1:]), todo))
    for line in lines:
        print(line)
    print("all", len(lines), sha("\n".join(lines).encode()), file=sys.stdout)


if __name__ == "__main__":
    main()
