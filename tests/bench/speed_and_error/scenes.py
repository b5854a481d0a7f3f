"""The knobs, and the scenes at which they are turned.

SPDX-License-Identifier: BSD-3-Clause
"""
import dataclasses
import random
import re

from running import ROOT, run

# The default values of the language; every curve turns one knob and leaves the others here.
SAMPLES, CONTRAST, CUTOFF, DEPTH, POINTS = 3, 1.0, 0.002, 5, 2
CONTRAST_RGB = (0.2, 0.15, 0.3)


@dataclasses.dataclass(frozen=True)
class Setting:
    """What the knobs say."""
    samples: int = SAMPLES
    contrast: float = CONTRAST  # times CONTRAST_RGB
    cutoff: float = CUTOFF
    depth: int = DEPTH
    points: int = POINTS  # along each side of an area light
    more: str = ""        # further options

    def options(self):
        contrast = " ".join("%g" % (self.contrast * c) for c in CONTRAST_RGB)
        return f"-S {self.samples} -T {contrast} -C {self.cutoff:g} {self.cutoff:g} {self.cutoff:g} -D {self.depth}" + \
            (f" {self.more}" if self.more else "")


def turned(**knob):
    return dataclasses.replace(Setting(), **knob)


# References are sampled in another way than what they judge.
STRATA = "--sampling strata"

# Curves by name: what a point is called, and its setting.
KNOBS = {
    "samples": [("-S %d" % s, turned(samples=s)) for s in (1, 2, 3, 4, 6)],
    "samples, no test": [("-S %d -T 0 0 0" % s, turned(samples=s, contrast=0)) for s in (1, 2, 3, 4, 6)],
    "samples, crosses": [("-S %d --refine crosses" % s, turned(samples=s, more="--refine crosses")) for s in (1, 2, 3, 4, 6)],
    "samples, strata": [("-S %d --sampling strata" % s, turned(samples=s, more="--sampling strata")) for s in (1, 2, 3, 4, 6)],
    "contrast": [("-T x %g" % k, turned(contrast=k)) for k in (0, 1 / 8, 1 / 4, 1 / 2, 1, 2, 4)],
    "light points": [("%d x %d points" % (n, n), turned(points=n)) for n in (1, 2, 3, 4, 6)],
    "cutoff": [("-C %g" % c, turned(cutoff=c)) for c in (0.3, 0.1, 0.03, 0.01, 0.002, 0.0001)],
    "depth": [("-D %d" % d, turned(depth=d)) for d in (0, 1, 2, 3, 5, 8)],
}


@dataclasses.dataclass
class Scene:
    name: str
    title: str
    size: tuple
    directory: str  # where it is rendered, for the files that it names
    text: object    # a function: points along each side of its area lights -> scene
    knobs: list
    reference: Setting = None  # None: the picture is known
    reference_seeds: int = 0
    area_lights: bool = True
    rivals: bool = False  # spd writes it for others, too


def gallery(name):
    with open(f"{ROOT}/scenes/gallery/{name}.ray") as file:
        text = file.read()
    # light ... area CORNER CORNER nu CORNER nv
    number = r"[-+.\d]+"
    area = re.compile(rf"(\barea(?:\s+{number}){{6}}\s+)\d+((?:\s+{number}){{3}}\s+)\d+")
    return lambda points: area.sub(rf"\g<1>{points}\g<2>{points}", text)


def scenes(bin_directory):
    def balls(_):
        text = run(f"{bin_directory}/spd balls 3", ROOT).output.decode()
        return re.sub(r"(?m)^(sample|cutoff|maxdepth|screen) .*\n", "", text)

    def stars(_):
        dice = random.Random(1987)
        balls = "".join(f"sphere 0.006 {dice.uniform(-4, 4):.4f} {dice.uniform(-4, 4):.4f} 0\n" for _ in range(700))
        return f"eyep 0 0 10 lookp 0 0 0 up 0 1 0 fov 45\nlight 1 ambient\nlist applysurf ambient 1 1 1\n{balls}end\n"

    def area(points):
        return run(f"{ROOT}/tests/bench/area_light scene {points}", ROOT).output.decode()

    return [
        Scene("area-light", "A half shadow of which every pixel is known", (160, 120), ROOT, area,
              ["samples", "samples, no test", "samples, crosses", "samples, strata", "contrast", "light points"]),
        Scene("interior", "A room with two area lights", (64, 40), f"{ROOT}/scenes/gallery", gallery("interior"),
              ["samples", "samples, no test", "samples, crosses", "samples, strata", "contrast", "light points", "depth"],
              Setting(8, 0, 1e-4, 10, 2, STRATA), 24),
        Scene("glass", "Glass and mirrors", (64, 40), f"{ROOT}/scenes/gallery", gallery("glass-and-mirrors"),
              ["samples", "samples, no test", "samples, crosses", "samples, strata", "contrast", "cutoff", "depth"],
              Setting(8, 0, 1e-4, 10, 1, STRATA), 24),
        Scene("balls", "Balls: edges, mirrors and sharp shadows", (96, 96), ROOT, balls,
              ["samples", "samples, no test", "samples, crosses", "samples, strata", "contrast", "cutoff", "depth"],
              Setting(8, 0, 1e-4, 10, POINTS, STRATA), 24, area_lights=False, rivals=True),
        Scene("stars", "Balls of a third of a pixel", (200, 200), ROOT, stars,
              ["samples", "samples, no test", "samples, crosses", "samples, strata"],
              Setting(50, 0, 1e-4, 10, POINTS, STRATA), 4, area_lights=False),
    ]
