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
  DATA/trusses/pairs.csv
- `check`: the numbers of `check --json` for the projects and drawings, without times
  and without sentences

Input that the program refuses (exit status 1) is `refused-1` instead of a hash. The last
line hashes all the others. Exits with 1 if a run of the program ended in any other way,
such as a panic or a timeout. Needs a build with the feature `cli` only.
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


KINDS = ["frames", "check", "match"]
SUCCESS = 0
REFUSED = 1
TIMEOUT_S = 600


def sha(data):
    return hashlib.sha256(data).hexdigest()[:16]


class Failed(Exception):
    """The program did not exit with 0 or 1."""


def run(binary, *arguments):
    """Standard output, or None where the program refuses the input."""
    command = [binary, *map(str, arguments)]
    try:
        result = subprocess.run(command, capture_output=True, timeout=TIMEOUT_S)
    except subprocess.TimeoutExpired:
        raise Failed(f"timeout after {TIMEOUT_S} s") from None
    if result.returncode not in (SUCCESS, REFUSED):
        raise Failed(f"status {result.returncode}: {result.stderr.decode(errors='replace')[-200:]}")
    return None if result.returncode == REFUSED else result.stdout


def inputs():
    """Name and designs of every gallery project and of pairs of drawings."""
    projects = sorted((ROOT / "assets/gallery").glob("*.morph"))
    yield from ((path.stem, [path]) for path in projects)
    drawings = sorted((ROOT / "tests/drawings").glob("*.svg"))
    for source, target in zip(drawings, drawings[1:]):
        yield f"{source.stem}-{target.stem}", [source, target]


def frames(binary, designs, warp, content):
    kind = "png" if content == "colours" else "svg"
    with tempfile.TemporaryDirectory() as folder:
        output = run(
            binary, "render", *designs, "--warp", warp, "--content", content,
            "--at", MOMENTS, "--out", f"{folder}/f-##.{kind}",
        )
        files = sorted(pathlib.Path(folder).iterdir())
        return None if output is None else b"\0".join(path.read_bytes() for path in files)


def match(binary, folder, row):
    paths = [row[side] if ":" in row[side] else folder / row[side] for side in ("source", "target")]
    with tempfile.TemporaryDirectory() as out:
        project = pathlib.Path(out) / "x.morph"
        if run(binary, "new", *paths, "--film", "--out", project) is None:
            return None
        found = tomllib.loads(project.read_text()).get("found", {})
    return json.dumps(found, sort_keys=True).encode()


def numbers(value):
    """The value without times and without sentences (texts with a space)."""
    if isinstance(value, dict):
        kept = {key: numbers(item) for key, item in value.items() if "seconds" not in key}
        return {key: item for key, item in kept.items() if item is not None}
    if isinstance(value, list):
        return [numbers(item) for item in value]
    return None if isinstance(value, str) and " " in value else value


def check(binary, designs):
    output = run(binary, "check", *designs, "--json")
    return None if output is None else json.dumps(numbers(json.loads(output)), sort_keys=True).encode()


def jobs(binary, data, kinds):
    """The name of each line with the function that computes its data, and arguments."""
    if "frames" in kinds:
        for name, designs in inputs():
            for warp in WARPS:
                for content in CONTENTS:
                    yield f"frames {name}/{warp}/{content}", frames, binary, designs, warp, content
    if "check" in kinds:
        for name, designs in inputs():
            yield f"check {name}", check, binary, designs
    if "match" in kinds:
        for path in [*sorted(data.glob("*.csv")), data / "trusses/pairs.csv"]:
            for row in csv.DictReader(path.read_text().splitlines()):
                yield f"match {row['source']} {row['target']}", match, binary, path.parent, row


def outcome(job):
    _, compute, *arguments = job
    try:
        data = compute(*arguments)
    except Failed as error:
        return f"failed: {error}"
    return f"refused-{REFUSED}" if data is None else sha(data)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binary", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--kinds", default=",".join(KINDS))
    options = parser.parse_args()
    kinds = options.kinds.split(",")
    if not set(kinds) <= set(KINDS):
        parser.error(f"--kinds takes a list of {', '.join(KINDS)}")
    todo = list(jobs(options.binary.resolve(), options.data.resolve(), kinds))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        outcomes = list(pool.map(outcome, todo))
    lines = [f"{job[0]} {result}" for job, result in zip(todo, outcomes)]
    for line in lines:
        print(line)
    print("all", len(lines), sha("\n".join(lines).encode()))
    refused = outcomes.count(f"refused-{REFUSED}")
    failed = sum(result.startswith("failed") for result in outcomes)
    print(f"{len(lines) - refused - failed} hashes, {refused} refused, {failed} failed", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
