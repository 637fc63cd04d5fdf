#!/usr/bin/env python3
"""Compares the structural analysis with PyNite and anaStruct on ten models.

Usage: compare_structure.py [--program PATH]

Prints a table: for each model the largest relative difference of displacements, axial forces and
reactions, and the time of one analysis in each program. Exits with 1 if a difference exceeds 1e-9
(PyNite) or 1e-5 (anaStruct, which adds small stiffnesses). Needs `pip install PyNiteFEA anastruct`.
"""

import argparse
import importlib.metadata
import json
import math
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from anastruct import SystemElements
from Pynite import FEModel3D

GALLERY = Path(__file__).resolve().parent.parent / "assets" / "gallery"
TOLERANCES = {"PyNite": 1e-9, "anaStruct": 1e-5}
GRAVITY = 9.80665
STEEL = {"E": 210e6, "density": 7850.0}


def pins(*nodes):
    return [{"node": node, "fixed": [True, True]} for node in nodes]


def simple(first, last):
    return [*pins(first), {"node": last, "fixed": [False, True]}]


def three_bars():
    return {
        "nodes": [[-3, 4], [0, 4], [3, 4], [0, 0]],
        "bars": [[0, 3], [1, 3], [2, 3]],
        "areas": [2e-3, 1e-3, 1.5e-3],
        "supports": pins(0, 1, 2),
        "loads": [{"node": 3, "force": [30, -100]}],
    }


def ten_bars():
    return {
        "nodes": [[18, 9], [18, 0], [9, 9], [9, 0], [0, 9], [0, 0]],
        "bars": [[4, 2], [2, 0], [5, 3], [3, 1], [2, 3], [0, 1], [4, 3], [5, 2], [2, 1], [3, 0]],
        "areas": [6e-3] * 10,
        "supports": pins(4, 5),
        "loads": [{"node": 1, "force": [0, -450]}, {"node": 3, "force": [0, -450]}],
    }


def portal():
    return {
        "nodes": [[0, 0], [0, 4], [4, 5.5], [8, 4], [8, 0]],
        "bars": [[0, 1], [1, 2], [2, 3], [3, 4]],
        "sections": [
            {"area": 5.38e-3, "second_moment": 8.36e-5},
            {"area": 2.85e-3, "second_moment": 1.943e-5},
        ],
        "bar_sections": [0, 1, 1, 0],
        "fixity": 1,
        "supports": [{"node": 0, "fixed": [True, True, True]}, *pins(4)],
        "load_cases": [
            {
                "name": "all",
                "loads": [{"node": 1, "force": [15, 0]}],
                "line_loads": [{"bars": [1, 2], "force": [0, -12]}],
            }
        ],
    }


def cantilever(members=20):
    return {
        "nodes": [[0.25 * i, 0] for i in range(members + 1)],
        "bars": [[i, i + 1] for i in range(members)],
        "sections": [{"area": 2e-3, "second_moment": 3e-6}],
        "bar_sections": [0] * members,
        "fixity": 1,
        "supports": [{"node": 0, "fixed": [True, True, True]}],
        "loads": [{"node": members, "force": [5, -2], "moment": 1.5}],
    }


def girder(panels=25):
    """A Warren girder with verticals; 25 panels have 101 bars."""
    top = panels + 1
    bars = [[i, i + 1] for i in range(panels)]
    bars += [[top + i, top + i + 1] for i in range(panels)]
    bars += [[i, top + i] for i in range(panels + 1)]
    bars += [[i, top + i + 1] if i % 2 else [i + 1, top + i] for i in range(panels)]
    return {
        "nodes": [[2 * i, y] for y in (0, 2) for i in range(panels + 1)],
        "bars": bars,
        "areas": [4e-3] * len(bars),
        "supports": simple(0, panels),
        "loads": [{"node": i, "force": [0, -20]} for i in range(1, panels)],
    }


def from_gallery(name):
    return lambda: json.loads((GALLERY / f"{name}.json").read_text())


MODELS = {
    "three bars": three_bars,
    "ten bars": ten_bars,
    "portal frame": portal,
    "cantilever of 20 beams": cantilever,
    "girder of 101 bars": girder,
    "gallery: pratt": from_gallery("pratt"),
    "gallery: arch": from_gallery("arch"),
    "gallery: bracket": from_gallery("bracket"),
    "gallery: hall": from_gallery("hall"),
    "gallery: barn": from_gallery("barn"),
}


class Model:
    """Members and loads of a truss file in m and kN, with all load cases combined."""

    def __init__(self, file):
        self.nodes = file["nodes"]
        self.bars = file["bars"]
        sections = file.get("sections", [])
        of_bars = file.get("bar_sections", [])
        areas = file.get("areas") or [sections[s]["area"] for s in of_bars]
        self.areas = areas
        self.moments = []
        for bar, area in enumerate(areas):
            section = sections[of_bars[bar]] if of_bars else {}
            ratio = section.get("shape", {"tube": {"ratio": 20}})
            if "second_moment" in section:
                self.moments.append(section["second_moment"])
            else:
                inner = (1 - 2 / ratio["tube"]["ratio"]) ** 2
                self.moments.append(area * area * (1 + inner) / (4 * math.pi * (1 - inner)))
        self.is_frame = file.get("fixity", 0) == 1
        self.supports = {s["node"]: (*s["fixed"], False)[:3] for s in file["supports"]}
        self.forces = {}
        self.line_loads = [[0.0, 0.0] for _ in self.bars]
        cases = [{"loads": file.get("loads", [])}, *file.get("load_cases", [])]
        for case in cases:
            self.add_case(case, case.get("factor", 1.0))

    def add_case(self, case, factor):
        for load in case.get("loads", []):
            sums = self.forces.setdefault(load["node"], [0.0, 0.0, 0.0])
            for axis, value in enumerate([*load["force"], load.get("moment", 0.0)]):
                sums[axis] += factor * value
        for load in case.get("line_loads", []):
            for bar in load["bars"]:
                (x1, _), (x2, _) = (self.nodes[node] for node in self.bars[bar])
                share = abs(x2 - x1) / self.length(bar) if load.get("in_plan") else 1.0
                for axis in (0, 1):
                    self.line_loads[bar][axis] += factor * share * load["force"][axis]
        if case.get("self_weight"):
            for bar, area in enumerate(self.areas):
                weight = STEEL["density"] * area * GRAVITY / 1e3
                self.line_loads[bar][1] -= factor * weight

    def length(self, bar):
        a, b = (self.nodes[node] for node in self.bars[bar])
        return math.dist(a, b)


def own_results(program, file):
    """Displacements in m, axial forces in the middle in kN, reactions in kN, and seconds."""
    file = {"units": {"length": "m", "force": "kN"}, "materials": [{"name": "S235"}], **file}
    file.setdefault("bar_materials", [0] * len(file["bars"]))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "truss.json"
        path.write_text(json.dumps(file))
        command = [program, "check", path, path, "--structure", "--at", "0", "--json"]
        report = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
    table = report["tables"][0]
    displacements = [
        (n["displacement_x_m"], n["displacement_y_m"], n["rotation_rad"]) for n in table["nodes"]
    ]
    reactions = [
        (n["reaction_x_n"] / 1e3, n["reaction_y_n"] / 1e3, n["reaction_moment_nm"] / 1e3)
        for n in table["nodes"]
    ]
    axial = [bar["mean_axial_n"] / 1e3 for bar in table["bars"]]
    return displacements, axial, reactions, report["seconds"] / len(report["samples"])


def pynite_results(model):
    frame = FEModel3D()
    frame.add_material("steel", STEEL["E"], 80e6, 0.3, STEEL["density"])
    for node, (x, y) in enumerate(model.nodes):
        frame.add_node(str(node), x, y, 0)
        x, y, rotation = model.supports.get(node, (False, False, False))
        # The model is plane. Nodes of a truss have no stiffness against rotation.
        frame.def_support(str(node), x, y, True, True, True, rotation or not model.is_frame)
    for bar, (a, b) in enumerate(model.bars):
        moment = model.moments[bar]
        frame.add_section(str(bar), model.areas[bar], moment, moment, moment)
        frame.add_member(str(bar), str(a), str(b), "steel", str(bar))
        if not model.is_frame:
            frame.def_releases(str(bar), Rzi=True, Rzj=True)
        for axis, load in zip("XY", model.line_loads[bar]):
            if load:
                frame.add_member_dist_load(str(bar), f"F{axis}", load, load)
    for node, forces in model.forces.items():
        for axis, load in zip(("FX", "FY", "MZ"), forces):
            frame.add_node_load(str(node), axis, load)
    start = time.perf_counter()
    frame.analyze_linear(log=False)
    seconds = time.perf_counter() - start
    nodes = [frame.nodes[str(node)] for node in range(len(model.nodes))]
    combo = "Combo 1"
    displacements = [(n.DX[combo], n.DY[combo], n.RZ[combo]) for n in nodes]
    reactions = [(n.RxnFX[combo], n.RxnFY[combo], n.RxnMZ[combo]) for n in nodes]
    # PyNite's axial forces are positive in compression.
    axial = [
        -frame.members[str(bar)].axial(0.5 * model.length(bar), combo)
        for bar in range(len(model.bars))
    ]
    return displacements, axial, reactions, seconds


def anastruct_results(model):
    system = SystemElements()
    for bar, ends in enumerate(model.bars):
        location = [model.nodes[node] for node in ends]
        if model.is_frame:
            stiffness = STEEL["E"] * model.moments[bar]
            system.add_element(location=location, EA=STEEL["E"] * model.areas[bar], EI=stiffness)
        else:
            system.add_truss_element(location=location, EA=STEEL["E"] * model.areas[bar])
    number = [system.find_node_id(place) for place in model.nodes]
    for node, (x, y, rotation) in model.supports.items():
        if rotation:
            system.add_support_fixed(number[node])
        elif x and y:
            system.add_support_hinged(number[node])
        else:
            system.add_support_roll(number[node], direction="x" if y else "y")
    forces = {node: list(values) for node, values in model.forces.items()}
    for bar, load in enumerate(model.line_loads):
        if not any(load):
            continue
        if model.is_frame:
            system.q_load(load[1], bar + 1, direction="y", q_perp=+load[0])
        else:
            # Bars of a truss hand their load to both ends.
            for node in model.bars[bar]:
                sums = forces.setdefault(node, [0.0, 0.0, 0.0])
                for axis in (0, 1):
                    sums[axis] += 0.5 * model.length(bar) * load[axis]
    for node, (x, y, moment) in forces.items():
        system.point_load(number[node], Fx=x, Fy=y)
        if moment:
            system.moment_load(number[node], moment)
    start = time.perf_counter()
    system.solve()
    seconds = time.perf_counter() - start
    displacements = []
    for node in number:
        found = system.get_node_displacements(node)
        displacements.append((found["ux"], found["uy"], -found["phi_z"]))
    axial = []
    for bar in range(len(model.bars)):
        found = system.get_element_results(bar + 1)
        axial.append(0.5 * (found["Nmin"] + found["Nmax"]))
    return displacements, axial, None, seconds


def largest_difference(own, peer, axes):
    """Largest difference of vectors, relative to the largest component."""
    scale = max(abs(item[axis]) for item in own for axis in axes)
    if scale == 0:
        return 0.0
    return max(abs(a[axis] - b[axis]) for a, b in zip(own, peer) for axis in axes) / scale


def compare(own, peer, has_rotations):
    forces = [[[n] for n in results[1]] for results in (own, peer)]
    differences = [
        largest_difference(own[0], peer[0], (0, 1)),
        largest_difference(*forces, (0,)),
    ]
    if has_rotations:
        differences.append(largest_difference(own[0], peer[0], (2,)))
    if peer[2]:
        differences.append(largest_difference(own[2], peer[2], (0, 1)))
    return max(differences)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="target/release/morphospace")
    program = parser.parse_args().program
    versions = {
        "PyNite": importlib.metadata.version("PyNiteFEA"),
        "anaStruct": importlib.metadata.version("anastruct"),
    }
    print(", ".join(f"{name} {version}" for name, version in versions.items()))
    print("| model | bars | PyNite | anaStruct | own ms | PyNite ms | anaStruct ms |")
    print("|---|--:|--:|--:|--:|--:|--:|")
    is_close = True
    for name, make in MODELS.items():
        file = make()
        model = Model(file)
        own = own_results(program, file)
        peers = {"PyNite": pynite_results(model), "anaStruct": anastruct_results(model)}
        differences = {
            peer: compare(own, results, model.is_frame) for peer, results in peers.items()
        }
        is_close &= all(differences[peer] <= limit for peer, limit in TOLERANCES.items())
        cells = [f"{differences[peer]:.1e}" for peer in TOLERANCES]
        times = [own[3], *(peers[peer][3] for peer in TOLERANCES)]
        cells += [f"{1e3 * seconds:.2f}" for seconds in times]
        print(f"| {name} | {len(model.bars)} | " + " | ".join(cells) + " |")
    if not is_close:
        sys.exit("a difference exceeds its limit")


if __name__ == "__main__":
    main()
