"""A drilled dice of glass: a picture, a pixel explained, and rays through it."""

from __future__ import annotations

import numpy as np

import strahl


def main() -> None:
    """Renders dice.png."""
    dice = strahl.box((-1, 0, -1), (1, 2, 1)) & strahl.sphere((0, 1, 0), 1.35)
    dice = dice - strahl.cylinder((0, 0, 0), (0, 2, 0), 0.6)
    scene = strahl.Scene(
        strahl.plane(material="#aaaaaa"),
        dice.material(strahl.Material.glass(1.5)).named("dice"),
        strahl.point_light((4, 8, 6)),
        strahl.Camera.perspective(eye=(3, 4, 6), look_at=(0, 1, 0)),
        background=strahl.Background.gradient("#445566", "#88aadd"),
    )
    film = scene.render(320, 240)
    film.save("dice.png")

    tree = scene.explain(160, 120, 320, 240)
    for ray in tree.root.walk():
        what = ray.hit.object if ray.hit else "background"
        print("  " * ray.depth, ray.kind, what, np.round(ray.total, 3))

    down = scene.intersect([[x, 5, 0] for x in np.linspace(-1.5, 1.5, 7)], (0, -1, 0))
    print(5 - down.t)


if __name__ == "__main__":
    main()
