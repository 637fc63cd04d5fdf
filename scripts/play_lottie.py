#!/usr/bin/env python3
"""Draws frames of a Lottie animation with another player, for tests/motion.

    play_lottie.py rlottie|thorvg FILM.json WIDTH HEIGHT FOLDER FRAME...

Writes FOLDER/0.png, FOLDER/1.png and so on, one for each frame number, with straight alpha on a
transparent background. The exit status is 3 if the player is not installed (PyPI: rlottie-python,
thorvg-python; both need pillow to write PNG).
"""

import sys
from pathlib import Path

NOT_INSTALLED = 3


def with_rlottie(film, size, frames):
    from PIL import Image
    from rlottie_python import LottieAnimation

    def play():
        animation = LottieAnimation.from_data(film)
        for frame in frames:
            pixels = animation.lottie_animation_render(frame, width=size[0], height=size[1])
            # The colours are premultiplied, in the order blue, green, red.
            yield Image.frombuffer("RGBa", size, pixels, "raw", "BGRa").convert("RGBA")

    return play()


def with_thorvg(film, size, frames):
    import PIL.Image  # used by get_pillow
    import thorvg_python as thorvg

    def play():
        engine = thorvg.Engine()
        for frame in frames:
            canvas = thorvg.SwCanvas(engine)
            canvas.set_target(*size, cs=thorvg.Colorspace.ABGR8888S)
            animation = thorvg.Animation(engine)
            picture = animation.get_picture()
            check(thorvg, picture.load_data(film.encode(), "lottie", None, True))
            picture.set_size(*map(float, size))
            # Frame 0 is the current one, and setting it again is refused.
            animation.set_frame(float(frame))
            canvas.add(picture)
            canvas.draw(True)
            canvas.sync()
            yield canvas.get_pillow()

    return play()


def check(thorvg, result):
    if result != thorvg.Result.SUCCESS:
        sys.exit(f"ThorVG refuses the film: {result}")


def main():
    player, path, width, height, folder, *frames = sys.argv[1:]
    play = {"rlottie": with_rlottie, "thorvg": with_thorvg}[player]
    film = Path(path).read_text(encoding="utf-8")
    try:
        # An OSError means that a library of the player is missing.
        pictures = play(film, (int(width), int(height)), map(round, map(float, frames)))
    except (ImportError, OSError) as error:
        print(error, file=sys.stderr)
        sys.exit(NOT_INSTALLED)
    for number, picture in enumerate(pictures):
        picture.save(Path(folder) / f"{number}.png")


if __name__ == "__main__":
    main()
