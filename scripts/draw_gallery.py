#!/usr/bin/env python3
"""Draws the designs in assets/gallery; the .morph files there are written by hand.

    python3 scripts/draw_gallery.py [FOLDER]

All shape parameters of the designs are in this file, so that the gallery can be corrected and drawn
again. Meshes and trusses with a face that is not counter-clockwise in both designs are refused.
"""

import cmath
import math
import sys
from pathlib import Path

import gallery_kit as kit

# Metres and kilonewtons. The numbers of S355 are those of the standard grade.
UNITS = {"length": "m", "force": "kN"}
STEEL = [{"name": "steel S355"}]
TUBE = {"name": "tube", "shape": {"tube": {"ratio": 20}}}
IPE_240 = {"name": "IPE 240", "shape": "i", "second_moment": 3.892e-5, "depth": 0.24}
IPE_300 = {"name": "IPE 300", "area": 5.38e-3, "shape": "i", "second_moment": 8.356e-5, "depth": 0.3}
HEA_240 = {"name": "HEA 240", "area": 7.68e-3, "shape": "i", "second_moment": 7.763e-5, "depth": 0.23}
SELF_WEIGHT = {"name": "self-weight", "self_weight": True}
GALLERY = Path(__file__).resolve().parent.parent / "assets" / "gallery"


def triangles(folder):
    """One triangle; the target is rotated by 150 degrees and stretched 2 : 1."""
    source = [0 + 0j, 2.2 + 0j, 0.5 + 1.5j]
    turn = cmath.exp(1j * math.radians(150))
    target = [complex(7.5, 1.5) + turn * complex(1.5 * p.real, 0.75 * p.imag) for p in source]
    kit.obj(folder / "triangle-source.obj", "one triangle", source, [(0, 1, 2)])
    kit.obj(
        folder / "triangle-target.obj",
        "the same, turned by 150 degrees and stretched",
        target,
        [(0, 1, 2)],
    )


def bracket_and_davit(folder):
    """A wall bracket and a davit: one truss whose base is rotated by 90 degrees."""
    bays = 9
    top = [complex(x, 3.6) for x in range(bays + 1)]
    bottom = [complex(x, 3.6 * (x / bays) ** 0.9) for x in range(bays)]
    spine, heading, place = [], 90.0, 0 + 0j
    for turn in (0, 0, 4, 14, 24, 29, 30, 26, 18, 0):
        spine.append((place, cmath.exp(1j * math.radians(heading - turn / 2))))
        heading -= turn
        place += 1.16 * cmath.exp(1j * math.radians(heading))
    depth = [2.3 * (1 - (bay / bays) ** 1.4) for bay in range(bays + 1)]
    outer = [p + 1j * d * depth[i] * 0.55 for i, (p, d) in enumerate(spine)]
    inner = [p - 1j * d * depth[i] * 0.45 for i, (p, d) in enumerate(spine)][:bays]
    under = [bays + 1 + i for i in range(bays)] + [bays]
    bars = [(i, i + 1) for i in range(bays)] + list(zip(under, under[1:]))
    bars += [(i, under[i]) for i in range(bays)] + [(i, under[i + 1]) for i in range(bays - 1)]
    panels = []
    for i in range(bays):
        panels.append((i, under[i], under[i + 1]))
        if i < bays - 1:
            panels.append((i, under[i + 1], i + 1))
    extra = {
        "supports": [{"node": 0, "fixed": [True, True]}, {"node": under[0], "fixed": [True, True]}],
        "load_cases": [
            {"name": "hoist", "loads": [{"node": bays, "force": [0.0, -60.0]}]},
            SELF_WEIGHT,
        ],
        "areas": [0.003] * (2 * bays) + [0.0015] * (len(bars) - 2 * bays),
        "sections": [TUBE],
        "bar_sections": [0] * len(bars),
        "materials": STEEL,
        "bar_materials": [0] * len(bars),
    }
    kit.truss(folder / "bracket.json", UNITS, top + bottom, panels, bars, extra)
    kit.truss(folder / "davit.json", UNITS, outer + inner, panels, bars, extra)


def girders(folder):
    """A Pratt girder of 61 bars, a crescent arch, and two girders of intermediate shape."""
    bays = 16
    chord = range(bays + 1)
    lower = [complex(2 * i, 0) for i in chord]
    upper = [complex(2 * i, 2.4) for i in range(1, bays)]

    def crescent(i, depth):
        angle = math.radians(90 + 92 * (1 - 2 * i / bays))
        radius = 9.6 + depth * math.sin(math.pi * i / bays) ** 0.75
        return complex(16 + radius * math.cos(angle), 1.25 * radius * math.sin(angle))

    intrados = [crescent(i, 0) for i in chord]
    extrados = [crescent(i, 2.6) for i in range(1, bays)]
    over = {i: bays + i for i in range(1, bays)}
    bars = [(i, i + 1) for i in range(bays)] + [(over[i], over[i + 1]) for i in range(1, bays - 1)]
    bars += [(0, over[1]), (over[bays - 1], bays)] + [(i, over[i]) for i in range(1, bays)]
    panels = [(0, 1, over[1]), (bays - 1, bays, over[bays - 1])]
    for i in range(1, bays - 1):
        if i < bays // 2:
            bars.append((over[i], i + 1))
            panels += [(i, i + 1, over[i]), (i + 1, over[i + 1], over[i])]
        else:
            bars.append((i, over[i + 1]))
            panels += [(i, i + 1, over[i + 1]), (i, over[i + 1], over[i])]
    extra = {
        "supports": [{"node": 0, "fixed": [True, True]}, {"node": bays, "fixed": [False, True]}],
        "load_cases": [
            {"name": "deck", "line_loads": [{"bars": list(range(bays)), "force": [0.0, -15.0]}]},
            SELF_WEIGHT,
        ],
        "areas": [0.006] * (2 * bays) + [0.003] * (len(bars) - 2 * bays),
        "sections": [TUBE],
        "bar_sections": [0] * len(bars),
        "materials": STEEL,
        "bar_materials": [0] * len(bars),
    }
    kit.truss(folder / "girder.json", UNITS, lower + upper, panels, bars, extra)
    kit.truss(folder / "arch.json", UNITS, intrados + extrados, panels, bars, extra)
    sag = [math.sin(math.pi * i / bays) for i in chord]
    camelback = [complex(2 * i, 1.6 + 3.4 * sag[i]) for i in range(1, bays)]
    kit.truss(folder / "camelback.json", UNITS, lower + camelback, panels, bars, extra)
    belly = [complex(2 * i, -4.2 * sag[i]) for i in chord]
    deck = [complex(2 * i, 0.9 * sag[i]) for i in range(1, bays)]
    kit.truss(folder / "fish-belly.json", UNITS, belly + deck, panels, bars, extra)
    print(f"girder, arch, camelback and fish-belly: {len(bars)} bars")


def bowstring(folder):
    """A Pratt girder of 8 panels, and a bowstring: an arch tied by its deck."""
    bays, panel = 8, 3.0
    lower = [complex(panel * i, 0) for i in range(bays + 1)]
    over = {i: bays + i for i in range(1, bays)}
    bars = [(i, i + 1) for i in range(bays)] + [(over[i], over[i + 1]) for i in range(1, bays - 1)]
    bars += [(0, over[1]), (over[bays - 1], bays)] + [(i, over[i]) for i in range(1, bays)]
    chords = len(bars) - (bays - 1)
    panels = [(0, 1, over[1]), (bays - 1, bays, over[bays - 1])]
    for i in range(1, bays - 1):
        first, second = ((over[i], i + 1), (i, over[i + 1]))[:: 1 if i < bays // 2 else -1]
        bars.append(first)
        panels += [(i, i + 1, over[i if first[0] > bays else i + 1])]
        panels += [(i + 1, over[i + 1], over[i]) if first[0] > bays else (i, over[i + 1], over[i])]
    webs = len(bars) - chords
    for name, height, upper_area, web_area in (
        ("pratt", lambda _: 3.0, 0.0048, 0.0024),
        ("bowstring", lambda i: 4.8 * (1 - (2 * i / bays - 1) ** 2), 0.0052, 0.0010),
    ):
        upper = [complex(panel * i, height(i)) for i in range(1, bays)]
        extra = {
            "supports": [
                {"node": 0, "fixed": [True, True]},
                {"node": bays, "fixed": [False, True]},
            ],
            "load_cases": [
                {"name": "deck", "line_loads": [{"bars": list(range(bays)), "force": [0.0, -20.0]}]},
                SELF_WEIGHT,
            ],
            "areas": [0.00391] * bays + [upper_area] * (chords - bays) + [web_area] * webs,
            "sections": [IPE_240, TUBE],
            "bar_sections": [0] * bays + [1] * (len(bars) - bays),
            "materials": STEEL,
            "bar_materials": [0] * len(bars),
        }
        kit.truss(folder / f"{name}.json", UNITS, lower + upper, panels, bars, extra)
    print(f"pratt and bowstring: {len(bars)} bars")


def portal_frames(folder):
    """Two portal frames with rigid corners: a hall on pinned feet, a barn on fixed feet."""
    bars = [(0, 1), (1, 2), (2, 3), (3, 4)]
    for name, half_width, eaves, ridge, is_fixed in (
        ("hall", 8.0, 5.0, 6.2, False),
        ("barn", 6.0, 3.6, 9.0, True),
    ):
        nodes = [-half_width, complex(-half_width, eaves), complex(0, ridge)]
        nodes += [complex(half_width, eaves), half_width]
        foot = [True, True, True] if is_fixed else [True, True]
        extra = {
            "fixity": 1,
            "supports": [{"node": node, "fixed": foot} for node in (0, 4)],
            "load_cases": [
                {
                    "name": "snow",
                    "factor": 1.5,
                    "line_loads": [{"bars": [1, 2], "force": [0.0, -4.0], "in_plan": True}],
                },
                {"name": "wind", "line_loads": [{"bars": [0], "force": [2.0, 0.0]}]},
                {"factor": 1.35, **SELF_WEIGHT},
            ],
            "sections": [HEA_240, IPE_300],
            "bar_sections": [0, 1, 1, 0],
            "materials": STEEL,
            "bar_materials": [0] * len(bars),
        }
        kit.truss(folder / f"{name}.json", UNITS, [complex(p) for p in nodes], [], bars, extra)
    print(f"hall and barn: {len(bars)} members")


def bridges(folder):
    """Two stone bridges with four openings each, hump-backed and level, as grey images."""

    def stone(name, top, soffit, openings):
        ink = kit.Ink(1200, 420)
        ink.polygon([40 + 30j, *soffit, 1160 + 30j, *reversed(top)])
        for chain, thickness in openings:
            ink.carve(chain, thickness)
            ink.carve([complex(1200 - p.real, p.imag) for p in chain], thickness)
        ink.png(folder / f"{name}.png")

    def arc(left, crown):
        half = 600 - left
        radius = (half**2 + (crown - 30) ** 2) / (2 * (crown - 30))
        reach = math.asin(half / radius)
        turns = [reach * (i / 30 - 1) for i in range(61)]
        return [
            complex(600 + radius * math.sin(a), crown - radius + radius * math.cos(a))
            for a in turns
        ]

    hump = [40 + 222j, 180 + 252j, 360 + 318j, 600 + 372j, 840 + 318j, 1020 + 252j, 1160 + 222j]
    round_openings = [([132 + 124j, 132 + 125j], 80), ([262 + 212j, 262 + 213j], 48)]
    stone("bridge-humped", kit.spline(hump), arc(230, 296), round_openings)
    level = [40 + 322j, 320 + 336j, 600 + 341j, 880 + 336j, 1160 + 322j]
    tall_openings = [([128 + 96j, 128 + 162j], 68), ([257 + 204j, 258 + 238j], 42)]
    stone("bridge-level", kit.spline(level), arc(200, 264), tall_openings)


def vessels(folder):
    """A jug and a teapot: one handle, one spout, one opening."""

    def body(ink, profile):
        right = kit.spline(profile)
        ink.polygon(right + [complex(440 - p.real, p.imag) for p in reversed(right)])

    jug = kit.Ink(480, 440, fillet=16)
    body(jug, [292 + 24j, 306 + 60j, 330 + 130j, 318 + 214j, 286 + 290j, 272 + 344j, 284 + 408j])
    jug.stroke(kit.spline([262 + 318j, 336 + 338j, 394 + 298j, 396 + 212j, 318 + 136j]), 42, 40, 34)
    jug.stroke(kit.spline([190 + 372j, 164 + 396j, 134 + 414j]), 44, 14)
    pot = kit.Ink(480, 440, fillet=16)
    body(pot, [286 + 24j, 330 + 60j, 352 + 138j, 334 + 220j, 292 + 294j, 236 + 320j])
    pot.stroke([220 + 304j, 220 + 342j], 30, 46)
    pot.stroke(kit.spline([264 + 310j, 346 + 328j, 406 + 288j, 406 + 196j, 334 + 118j]), 40, 40, 34)
    pot.stroke(kit.spline([112 + 118j, 72 + 170j, 56 + 238j, 22 + 286j]), 76, 46, 34, 26)
    for name, title, ink in (("jug", "Jug", jug), ("teapot", "Teapot", pot)):
        kit.svg(folder / f"{name}.svg", 480, 440, title, outlines(ink, 0.35))


def outlines(ink, tolerance):
    """All outlines of a drawing as SVG subpaths."""
    return [kit.svg_path(kit.fit(loop, tolerance)) for loop in ink.loops()]


def cantilevers(folder):
    """Two cantilevers in the style of Michell structures: loaded at the tip, and below it."""
    tip = kit.Ink(640, 360, fillet=18)
    chord = kit.spline([-12 + 330j, 110 + 334j, 250 + 312j, 400 + 268j, 520 + 222j, 614 + 180j])
    webs = [
        ([-12 + 338j, 70 + 262j, 150 + 160j, 252 + 48j], 24, 16),
        ([250 + 312j, 300 + 252j, 364 + 160j, 432 + 102j], 15, 13),
        ([432 + 258j, 468 + 212j, 506 + 164j, 548 + 148j], 12, 10),
    ]
    for mirror in (False, True):
        flip = (lambda p: complex(p.real, 360 - p.imag)) if mirror else (lambda p: p)
        tip.stroke([flip(p) for p in chord], 32, 17)
        for points, start, end in webs:
            tip.stroke([flip(p) for p in kit.trimmed(kit.spline(points), 6, 11)], start, end)
    tip.stroke([606 + 180j, 624 + 180j], 20)
    low = kit.Ink(640, 360, fillet=18)
    low.stroke(
        kit.spline([-12 + 338j, 110 + 318j, 250 + 262j, 380 + 190j, 500 + 110j, 606 + 34j]), 34, 18
    )
    low.stroke(kit.spline([-12 + 104j, 90 + 58j, 220 + 30j, 400 + 20j, 606 + 28j]), 32, 22)
    for points, start, end in (
        ([-12 + 338j, 40 + 240j, 84 + 140j, 152 + 44j], 22, 15),
        ([-12 + 100j, 70 + 150j, 150 + 220j, 214 + 278j], 20, 14),
        ([214 + 278j, 250 + 190j, 290 + 100j, 344 + 22j], 15, 12),
        ([152 + 44j, 220 + 86j, 300 + 150j, 366 + 198j], 15, 12),
        ([366 + 198j, 396 + 140j, 436 + 70j, 486 + 22j], 12, 10),
        ([344 + 22j, 390 + 48j, 436 + 90j, 482 + 122j], 12, 10),
    ):
        low.stroke(kit.trimmed(kit.spline(points), 8, 11), start, end)
    low.stroke([590 + 31j, 616 + 29j], 27)
    for name, title, ink in (
        ("cantilever-tip", "Loaded at the tip", tip),
        ("cantilever-low", "Loaded below", low),
    ):
        kit.svg(folder / f"{name}.svg", 640, 360, title, outlines(ink, 0.3))


# Control points of the letters, 700 units high. The S is a spine of varying thickness.
D_OUTER = [
    60 + 0j,
    200 + 0j,
    300 + 0j,
    300 + 0j,
    530 + 0j,
    650 + 135j,
    650 + 350j,
    650 + 565j,
    530 + 700j,
    300 + 700j,
    220 + 700j,
    140 + 700j,
    60 + 700j,
]
D_INNER = [
    222 + 142j,
    250 + 142j,
    270 + 142j,
    288 + 142j,
    415 + 142j,
    482 + 222j,
    482 + 350j,
    482 + 478j,
    415 + 558j,
    288 + 558j,
    270 + 558j,
    250 + 558j,
    222 + 558j,
]
S_SPINE = [
    86 + 182j,
    150 + 104j,
    240 + 70j,
    340 + 70j,
    452 + 70j,
    524 + 122j,
    524 + 202j,
    524 + 296j,
    440 + 322j,
    336 + 350j,
    228 + 380j,
    146 + 410j,
    146 + 506j,
    146 + 584j,
    222 + 632j,
    326 + 632j,
    410 + 632j,
    486 + 604j,
    550 + 536j,
]


def s_sides(fractions):
    """Left and right side of the S, from its lower to its upper end."""
    left, right = [], []
    for fraction, (p, d) in zip(fractions, kit.at_fractions(kit.bezier_chain(S_SPINE, 40), fractions)):
        half = 62 + 20 * math.exp(-(((fraction - 0.5) / 0.16) ** 2)) + 8 * (2 * fraction - 1) ** 4
        left.append(p + 1j * d * half)
        right.append(p - 1j * d * half)
    return left, right


def letter_outlines(folder):
    """D with its counter, and S, as filled paths."""

    def path(chain):
        curves = [tuple(chain[i : i + 4]) for i in range(0, len(chain) - 1, 3)]
        return kit.svg_path(curves)

    kit.svg(folder / "letter-d.svg", 710, 700, "D", [path(D_OUTER), path(D_INNER)])
    left, right = s_sides([i / 240 for i in range(241)])
    side = kit.fit(right, 0.6, closed=False)
    back = kit.fit(left[::-1], 0.6, closed=False)

    def joint(a, b):
        return a, a + (b - a) / 3, b - (b - a) / 3, b

    outline = [*side, joint(right[-1], left[-1]), *back, joint(left[0], right[0])]
    kit.svg(folder / "letter-s.svg", 640, 700, "S", [kit.svg_path(outline)])


def letters_by_hand(folder):
    """D and S as meshes of 34 triangles with a deliberately bad match and only positive faces.

    The ring of the D is cut at the right of its bowl, where an S has no end. Its upper half is
    stretched over most of the S and the rest is compressed, and the two sides of the stroke are
    matched with an offset.
    """
    outer = d_stations(D_OUTER, [60 + 700j, 60 + 560j, 60 + 420j, 60 + 280j, 60 + 140j, 60 + 0j])
    inner = d_stations(
        D_INNER, [222 + 558j, 222 + 475j, 222 + 392j, 222 + 308j, 222 + 225j, 222 + 142j]
    )
    last = len(outer) - 1
    fractions = [1 - (1 - i / last) ** 2.1 for i in range(last + 1)]
    left, _ = s_sides(fractions)
    _, right = s_sides([f - 0.16 * f * (1 - f) for f in fractions])
    faces = []
    for i in range(last):
        a, b, c, d = i, i + 1, last + 1 + i, last + 2 + i
        faces += [(a, b, d), (a, d, c)] if i % 2 else [(a, b, c), (b, d, c)]
    kit.obj(folder / "letter-d-by-hand.obj", "D, its ring cut at the right", outer + inner, faces)
    kit.obj(
        folder / "letter-s-by-hand.obj", "S in the same faces, wrongly matched", right + left, faces
    )


def d_stations(loop, stem):
    """Points along one side of the stroke of the D, counter-clockwise from the right of its bowl."""
    upper = kit.cubic(*loop[6:10], 4)
    lower = kit.cubic(*loop[3:7], 4)
    return [*upper, (upper[-1] + stem[0]) / 2, *stem, (stem[-1] + lower[0]) / 2, *lower]


def rotors(folder):
    """Three straight blades on a hub, and the same blades curled into spirals."""
    stations, blades, subdivisions = 62, 3, 4
    hub_radius = 1.0

    def blade(turn_total):
        places, heading, place, step = [], 0.0, complex(hub_radius, 0), 0.155
        for i in range(1, stations + 1):
            s = i / stations
            heading += turn_total * 2.1 * s**1.1 / stations
            place += step * cmath.exp(1j * heading)
            half = 0.7 * (1 - s) ** 0.8 + 0.05
            places.append((place, cmath.exp(1j * heading), half))
        return places

    def rotor(turn_total):
        points = [0 + 0j]
        for k in range(6):
            radius = hub_radius if k % 2 == 0 else 0.78
            points.append(radius * cmath.exp(1j * math.radians(60 * k)))
        for k in range(blades):
            turn = cmath.exp(2j * math.pi * k / blades)
            for p, d, half in blade(turn_total):
                points += [turn * (p - 1j * d * half), turn * p, turn * (p + 1j * d * half)]
        return points

    faces = [(0, 1 + k, 1 + (k + 1) % 6) for k in range(6)]
    for k in range(blades):
        row = [1 + (2 * k - 1) % 6, 1 + 2 * k, 2 + 2 * k]
        for i in range(stations):
            start = 7 + 3 * (k * stations + i)
            new = [start, start + 1, start + 2]
            for (a, b), (c, d) in zip(zip(row, row[1:]), zip(new, new[1:])):
                faces += [(a, c, d), (a, d, b)] if i % 2 else [(a, c, b), (b, c, d)]
            row = new
    straight, curled = rotor(0.0), rotor(math.radians(400))
    kit.obj(folder / "rotor-straight.obj", "a rotor with straight blades", straight, faces)
    kit.obj(folder / "rotor-curled.obj", "the same rotor, its blades curled", curled, faces)
    count = subdivided_count(subdivisions, len(straight), faces)
    print(f"rotors: {len(straight)} vertices, {count} after {subdivisions} subdivisions")


def gecko(folder):
    """One gecko, resting and running: the same limbs in two poses."""

    def pose(spine, legs, toes):
        ink = kit.Ink(640, 480, fillet=14)
        chain = kit.spline(spine, 24)
        # Thickness at the snout, skull, neck, ribs and hips, then along the tail.
        ink.stroke(chain, 22, 52, 64, 40, 58, 66, 56, 46, 30, 22, 15, 9)
        for leg, foot in zip(legs, toes):
            ink.stroke(kit.spline(leg, 12), 30, 20, 17)
            for toe in foot:
                ink.stroke([leg[-1], leg[-1] + toe], 14, 12)
        return ink

    def foot(angle, length=27):
        spread = (-0.95, -0.35, 0.35, 0.95)
        return [length * complex(math.cos(angle + a), math.sin(angle + a)) for a in spread]

    resting = pose(
        [596 + 262j, 548 + 256j, 470 + 240j, 390 + 238j, 318 + 250j, 250 + 262j, 180 + 252j]
        + [118 + 214j, 84 + 156j, 108 + 104j, 160 + 92j],
        [
            [446 + 250j, 452 + 318j, 500 + 350j],
            [446 + 230j, 430 + 166j, 468 + 126j],
            [292 + 262j, 262 + 330j, 216 + 350j],
            [292 + 240j, 288 + 172j, 244 + 140j],
        ],
        [foot(0.5), foot(-0.6), foot(2.7), foot(-2.5)],
    )
    running = pose(
        [592 + 330j, 556 + 296j, 492 + 246j, 420 + 218j, 344 + 224j, 276 + 252j, 206 + 268j]
        + [136 + 250j, 84 + 262j, 46 + 318j, 52 + 376j],
        [
            [462 + 242j, 400 + 304j, 420 + 366j],
            [472 + 222j, 530 + 188j, 588 + 206j],
            [320 + 246j, 352 + 322j, 312 + 376j],
            [308 + 222j, 244 + 180j, 176 + 166j],
        ],
        [foot(1.2), foot(0.1), foot(2.0), foot(-2.9)],
    )
    for name, title, ink in (
        ("gecko-resting", "Gecko, resting", resting),
        ("gecko-running", "Gecko, running", running),
    ):
        kit.svg(folder / f"{name}.svg", 640, 480, title, outlines(ink, 0.35))


def fern(folder):
    """The frond of a fern, coiled and unrolled."""

    def frond(spine, name, title):
        ink = kit.Ink(560, 560, fillet=6)
        ink.stroke(spine, 44, 40, 35, 30, 25, 20, 15, 11)
        kit.svg(folder / f"{name}.svg", 560, 560, title, outlines(ink, 0.3))

    turns, centre = 2.25, 318 + 352j
    coil = []
    for i in range(141):
        fraction = i / 140
        angle = math.pi - turns * math.tau * fraction
        radius = 158 * (1 - fraction) ** 0.8 + 14
        coil.append(centre + radius * complex(math.cos(angle), math.sin(angle)))
    stem = kit.spline([190 + 36j, 178 + 120j, 164 + 230j, coil[0]], 16)
    frond(stem[:-1] + coil, "fern-coiled", "Fern, coiled")
    unrolled = kit.spline([96 + 36j, 130 + 180j, 204 + 316j, 320 + 424j, 470 + 500j], 40)
    frond(unrolled, "fern-unrolled", "Fern, unrolled")


def spectacles(folder):
    """Spectacles with two openings, and a moustache with none."""
    glasses = kit.Ink(640, 300, fillet=10)
    for centre in (196 + 148j, 444 + 148j):
        ring = [
            centre + complex(94 * math.cos(a), 80 * math.sin(a))
            for a in (i * math.tau / 96 for i in range(97))
        ]
        glasses.stroke(ring, 24)
    glasses.stroke(kit.spline([286 + 168j, 320 + 184j, 354 + 168j]), 24, 20, 24)
    for side in (1, -1):
        at = [320 + side * dx + 1j * y for dx, y in ((214, 178), (262, 194), (300, 196))]
        glasses.stroke(kit.spline(at), 26, 22, 20)
    moustache = kit.Ink(640, 300, fillet=14)
    for side in (1, -1):
        at = [
            320 + side * dx + 1j * y
            for dx, y in ((8, 176), (74, 172), (152, 124), (228, 118), (276, 158), (296, 214))
        ]
        moustache.stroke(kit.spline(at, 20), 72, 104, 92, 66, 36, 10)
    for name, title, ink in (
        ("spectacles", "Spectacles", glasses),
        ("moustache", "Moustache", moustache),
    ):
        kit.svg(folder / f"{name}.svg", 640, 300, title, outlines(ink, 0.35))


def lamp(folder):
    """A desk lamp with a gooseneck, bent over its table and stretched to the ceiling."""

    def pose(foot, bend):
        ink = kit.Ink(640, 640, fillet=10)
        ink.stroke([foot - 84, foot + 84], 32)
        steps, neck = 60, [foot]
        for i in range(steps):
            # The ends of the neck are stiff.
            fraction = min(1.0, max(0.0, (i / steps - 0.36) / 0.56))
            heading = math.radians(90 + bend * fraction)
            neck.append(neck[-1] + 470 / steps * cmath.exp(1j * heading))
        ink.stroke(neck, 30, 26, 24, 24)
        along = cmath.exp(1j * math.radians(90 + bend))
        ink.stroke([neck[-1], neck[-1] + 64 * along], 48, 118)
        return ink

    for name, title, ink in (
        ("lamp-bent", "Desk lamp, bent", pose(180 + 40j, -172)),
        ("lamp-stretched", "Desk lamp, stretched", pose(420 + 40j, 52)),
    ):
        kit.svg(folder / f"{name}.svg", 640, 640, title, outlines(ink, 0.3))


def subdivided_count(subdivisions, vertices, faces):
    """Number of vertices after splitting each face into four, `subdivisions` times."""
    edges = len({tuple(sorted(pair)) for a, b, c in faces for pair in ((a, b), (b, c), (c, a))})
    count = len(faces)
    for _ in range(subdivisions):
        vertices, edges, count = vertices + edges, 2 * edges + 3 * count, 4 * count
    return vertices


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else GALLERY
    folder.mkdir(parents=True, exist_ok=True)
    for draw in (
        triangles,
        bracket_and_davit,
        girders,
        bowstring,
        portal_frames,
        bridges,
        vessels,
        cantilevers,
        letter_outlines,
        letters_by_hand,
        rotors,
        gecko,
        fern,
        spectacles,
        lamp,
    ):
        draw(folder)


if __name__ == "__main__":
    main()
