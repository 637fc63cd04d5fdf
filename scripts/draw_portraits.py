#!/usr/bin/env python3
"""Draws the portraits of the gallery and prints the pairs of lines between consecutive ones.

    python3 scripts/draw_portraits.py assets/gallery

Needs only Python. Each shape is a signed distance, shaded and antialiased over one pixel. The lines
are the features by which the faces were drawn, in the units of the pictures (pixels, y up).
"""

import math
import struct
import sys
import zlib

WIDTH, HEIGHT = 360, 450


class Portrait:
    """Parameters of a face; lengths in pixels, y down."""

    def __init__(self, **parameters):
        self.__dict__.update(parameters)


ADA = Portrait(
    name="portrait-ada",
    sky=((236, 214, 178), (196, 140, 104)),
    middle=(172, 232), radii=(92, 118), tilt=-0.10, jaw=0.80,
    skin=(226, 178, 146), shade=(176, 112, 92), cheek=(222, 128, 108),
    hair=(58, 36, 34), fringe=0.34, bun=True,
    eye=40, eye_y=-14, eye_size=(17, 9), iris=(64, 92, 72),
    brow=-40, brow_tilt=-0.16, nose=34, mouth_y=64, mouth=30, smile=10,
    lips=(168, 70, 72), coat=(62, 88, 110),
)
MAX = Portrait(
    name="portrait-max",
    sky=((168, 190, 196), (78, 104, 124)),
    middle=(194, 214), radii=(106, 128), tilt=0.12, jaw=1.06,
    skin=(206, 160, 128), shade=(140, 92, 76), cheek=(190, 116, 96),
    hair=(168, 158, 148), fringe=0.16, bun=False,
    eye=46, eye_y=-10, eye_size=(15, 7), iris=(58, 70, 96),
    brow=-34, brow_tilt=0.10, nose=44, mouth_y=74, mouth=36, smile=-4,
    lips=(150, 82, 76), coat=(92, 46, 44),
)

NOOR = Portrait(
    name="portrait-noor",
    sky=((206, 196, 222), (112, 96, 150)),
    middle=(182, 222), radii=(84, 124), tilt=-0.02, jaw=0.72,
    skin=(168, 116, 84), shade=(104, 64, 54), cheek=(178, 98, 84),
    hair=(26, 22, 28), fringe=0.24, bun=True,
    eye=37, eye_y=-18, eye_size=(18, 10), iris=(70, 48, 32),
    brow=-46, brow_tilt=-0.06, nose=38, mouth_y=72, mouth=28, smile=4,
    lips=(138, 54, 66), coat=(150, 96, 40),
)


def mix(a, b, fraction):
    """Linear interpolation of two colours; `fraction` of b, clamped to 0 to 1."""
    fraction = min(1.0, max(0.0, fraction))
    return tuple(x + fraction * (y - x) for x, y in zip(a, b))


def ellipse(x, y, rx, ry):
    """Approximate signed distance to an ellipse, negative inside."""
    k = math.hypot(x / rx, y / ry)
    slope = math.hypot(x / rx ** 2, y / ry ** 2)
    return k * (k - 1) / slope if slope > 1e-9 else -min(rx, ry)


def segment_distance(x, y, ax, ay, bx, by):
    """Distance to a line segment."""
    dx, dy = bx - ax, by - ay
    t = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)
    t = min(1.0, max(0.0, t))
    return math.hypot(x - ax - t * dx, y - ay - t * dy)


def cover(distance, soft=1.0):
    """Coverage of a pixel at a signed distance from an edge of width `soft`."""
    return min(1.0, max(0.0, 0.5 - distance / soft))


def head_from_picture(face, x, y):
    """Picture coordinates to the axes of the head."""
    c, s = math.cos(face.tilt), math.sin(face.tilt)
    x, y = x - face.middle[0], y - face.middle[1]
    return c * x + s * y, c * y - s * x


def picture_from_head(face, x, y):
    """Axes of the head to picture coordinates."""
    c, s = math.cos(face.tilt), math.sin(face.tilt)
    return face.middle[0] + c * x - s * y, face.middle[1] + s * x + c * y


def shoulder(face):
    """Horizontal position of the centre between the shoulders."""
    return face.middle[0] * 0.7 + 54


def colour(face, px, py):
    """Colour of the picture at a point, painted from back to front."""
    x, y = head_from_picture(face, px, py)
    rx, ry = face.radii
    light = 0.5 + 0.5 * math.tanh((-(px - 180) * 0.6 - (py - 210)) / 180)
    paint = mix(face.sky[0], face.sky[1], py / HEIGHT + 0.10 * math.sin(px / 57 + py / 91))

    # The neck, then a coat with an open collar.
    neck = max(abs(x) - 0.42 * rx, -y, y - 1.9 * ry)
    neck_ground = mix(paint, mix(face.shade, face.skin, 0.2), cover(neck, 3))
    sx, sy = px - shoulder(face), py - 470
    coat = max(ellipse(sx, sy, 168, 108), 30 - math.hypot(px - picture_from_head(face, 0, 1.30 * ry)[0], 0.8 * (py - 372)))
    paint = mix(neck_ground, mix(face.coat, (16, 18, 24), 0.9 - light), cover(coat, 1.5))

    # Hair behind the head.
    hair = ellipse(x, y + 0.16 * ry, 1.16 * rx, 1.10 * ry)
    if face.bun:
        hair = min(hair, ellipse(x, y + 1.16 * ry, 0.42 * rx, 0.34 * ry))
        hair = min(hair, max(abs(x) - 1.12 * rx, -y, y - 0.95 * ry))
    else:
        hair = max(hair, y - 0.12 * ry)
    strands = 0.16 * math.sin(0.19 * x + 2.2 * math.sin(0.021 * y))
    paint = mix(paint, mix(face.hair, (250, 240, 226), 0.20 * light + strands * 0.5), cover(hair, 2))

    # The head, which narrows towards the chin.
    narrow = 1.0 if y < 0 else 1.0 - (1 - 0.86 * face.jaw) * min(1.0, y / ry) ** 2
    head = ellipse(x / narrow, y, rx, ry)
    skin = mix(face.shade, face.skin, 0.35 + 0.75 * light - 0.25 * (x / rx) ** 2)
    for side in (-1, 1):
        glow = math.exp(-((x - side * 0.52 * rx) ** 2 + (y - 0.30 * ry) ** 2) / 620)
        skin = mix(skin, face.cheek, 0.45 * glow)
        socket = math.exp(-((x - side * face.eye) ** 2 / 500 + (y - face.eye_y) ** 2 / 220))
        skin = mix(skin, face.shade, 0.30 * socket)
    paint = mix(paint, skin, cover(head, 1.5))

    # The fringe.
    edge = -ry * (0.92 - face.fringe) + 12 * math.sin(x / 31 + 1) - 0.0016 * x * x * (1 if face.bun else -1.2)
    if head < 0 or hair < 0:
        hairline = max(ellipse(x, y + 0.10 * ry, 1.06 * rx, 1.02 * ry), y - edge)
        tint = mix(face.hair, (250, 240, 226), 0.24 * light + strands * 0.4)
        paint = mix(paint, tint, cover(hairline, 3))

    # Eyes, brows.
    for side in (-1, 1):
        ex, ey = x - side * face.eye, y - face.eye_y
        w, h = face.eye_size
        lens = max(ellipse(ex, ey + 0.5 * h, w * 1.05, 1.5 * h), ellipse(ex, ey - 0.5 * h, w * 1.05, 1.5 * h))
        paint = mix(paint, (243, 238, 230), cover(lens, 1.2))
        iris = max(math.hypot(ex, ey) - 0.92 * h, lens)
        paint = mix(paint, face.iris, cover(iris, 1.2))
        paint = mix(paint, (18, 16, 20), cover(max(math.hypot(ex, ey) - 0.45 * h, lens), 1.2))
        paint = mix(paint, (255, 255, 255), cover(math.hypot(ex + 2.4, ey + 2.4) - 1.5, 1.2))
        lid = abs(ellipse(ex, ey - 0.5 * h, w * 1.05, 1.5 * h)) + max(0.0, ey - 0.1 * h)
        paint = mix(paint, mix(face.hair, (0, 0, 0), 0.4), cover(lid - 1.4, 1.4))
        by = face.brow
        brow = segment_distance(x, y, side * (face.eye - 19), by, side * (face.eye + 20), by + 90 * face.brow_tilt * 0.5)
        paint = mix(paint, mix(face.hair, (0, 0, 0), 0.25), cover(brow - 3.6, 2))

    # Nose, mouth.
    ridge = segment_distance(x, y, -4, face.brow + 16, -9, face.nose)
    paint = mix(paint, mix(skin, (255, 240, 220), 0.5), 0.5 * cover(ridge - 2.5, 7))
    wing = abs(ellipse(x, y - face.nose, 17, 11)) + max(0.0, face.nose - y)
    paint = mix(paint, face.shade, 0.85 * cover(wing - 1.5, 2.5))
    bend = face.smile * ((x / face.mouth) ** 2 - 0.3)
    mx, my = x, y - face.mouth_y + bend
    lips = ellipse(mx, my, face.mouth, 10)
    paint = mix(paint, mix(face.lips, (255, 220, 210), 0.18 * light + (0.12 if my > 0 else 0)), cover(lips, 1.5))
    if abs(mx) < face.mouth:
        paint = mix(paint, mix(face.lips, (20, 0, 0), 0.7), cover(abs(my) - 1.1, 1.4) * cover(lips, 2))

    # Grain, so that the picture is not a smooth gradient.
    grain = math.sin(px * 12.9898 + py * 78.233) * 43758.5453
    grain = (grain - math.floor(grain) - 0.5) * 7
    return tuple(min(255, max(0, round(c + grain))) for c in paint)


def lines(face):
    """Lines of the features of a face, y up."""
    rx, ry = face.radii
    jaw = 0.86 * face.jaw
    ends = [
        # head: crown, sides, jaw
        ((-0.7 * rx, -0.86 * ry), (0.7 * rx, -0.86 * ry)),
        ((-rx, -0.25 * ry), (-0.93 * rx, 0.35 * ry)),
        ((rx, -0.25 * ry), (0.93 * rx, 0.35 * ry)),
        ((-0.72 * jaw * rx, 0.72 * ry), (-0.16 * rx, 0.99 * ry)),
        ((0.72 * jaw * rx, 0.72 * ry), (0.16 * rx, 0.99 * ry)),
    ]
    for side in (-1, 1):
        w = face.eye_size[0]
        ends.append(((side * (face.eye - w), face.eye_y), (side * (face.eye + w), face.eye_y)))
        ends.append(((side * (face.eye - 19), face.brow), (side * (face.eye + 20), face.brow + 45 * face.brow_tilt)))
    ends.append(((-4, face.brow + 16), (-9, face.nose)))
    ends.append(((-17, face.nose + 4), (17, face.nose + 4)))
    ends.append(((-face.mouth, face.mouth_y - 0.7 * face.smile), (0, face.mouth_y + 0.3 * face.smile)))
    ends.append(((0, face.mouth_y + 0.3 * face.smile), (face.mouth, face.mouth_y - 0.7 * face.smile)))
    middle = shoulder(face)
    slopes = [((middle - 152, 424), (middle - 78, 374)), ((middle + 78, 374), (middle + 152, 424))]
    up = lambda p: [round(p[0], 1), round(HEIGHT - p[1], 1)]
    heads = [[up(picture_from_head(face, *a)), up(picture_from_head(face, *b))] for a, b in ends]
    return heads + [[up(a), up(b)] for a, b in slopes]


def png(face):
    """The picture as a PNG file."""
    rows = b"".join(
        b"\0" + bytes(c for px in range(WIDTH) for c in colour(face, px + 0.5, py + 0.5))
        for py in range(HEIGHT)
    )
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))
    header = struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
    )


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else "."
    faces = (ADA, MAX, NOOR)
    for face in faces:
        with open(f"{folder}/{face.name}.png", "wb") as file:
            file.write(png(face))
    for one, other in zip(faces, faces[1:]):
        print(f"# {one.name} to {other.name}\n")
        for source, target in zip(lines(one), lines(other)):
            print(f"[[match.lines]]\nsource = {source}\ntarget = {target}\n")


main()
