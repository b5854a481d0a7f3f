"""Points: what a setting costs and how far its pictures are from the truth.

SPDX-License-Identifier: BSD-3-Clause
"""
import concurrent.futures
import dataclasses
import json
import os
import random
import shutil

from running import ROOT, run, write_mean, write_smaller
from scenes import KNOBS, Setting


@dataclasses.dataclass
class Point:
    program: str
    knob: str
    value: str
    command: str
    is_default: bool
    seconds: list = dataclasses.field(default_factory=list)  # one per seed
    errors: list = dataclasses.field(default_factory=list)   # what rayshade-error says

    def mean(self, what):
        values = self.seconds if what == "seconds" else [e[what] for e in self.errors]
        return sum(values) / len(values)

    def interval(self, what):
        """95 % of the means of samples drawn from the values again, with replacement."""
        values = self.seconds if what == "seconds" else [e[what] for e in self.errors]
        dice = random.Random(1995)
        means = sorted(sum(dice.choices(values, k=len(values))) / len(values) for _ in range(1000))
        return means[25], means[974]


class Bench:
    def __init__(self, arguments, scratch):
        self.bin = os.path.abspath(arguments.bin)
        self.seeds = arguments.seeds
        self.scratch = scratch
        self.pool = concurrent.futures.ThreadPoolExecutor(arguments.jobs)

    def file(self, name):
        return f"{self.scratch}/{name}"

    def error(self, reference, picture):
        return json.loads(run(f"{self.bin}/rayshade-error --json {reference} {picture}", ROOT).output)

    def scene_file(self, scene, points):
        name = self.file(f"{scene.name}-{points}.ray")
        if not os.path.exists(name):
            with open(name, "w") as file:
                file.write(scene.text(points))
        return name

    def shown(self, scene, setting):
        """The command as one types it; the scene stands for the text that the program made."""
        return f"rayshade -q -R {scene.size[0]} {scene.size[1]} {setting.options()} {scene.name}-{setting.points}.ray"

    def render(self, scene, setting, seed, picture):
        source = self.scene_file(scene, setting.points)
        width, height = scene.size
        return run(f"{self.bin}/rayshade -q -R {width} {height} {setting.options()} --seed {seed} -O {picture} {source}",
                   scene.directory).seconds

    def reference(self, scene):
        """Writes the reference; returns its name and how far its two halves are from each other."""
        name = self.file(f"{scene.name}-reference.pfm")
        if scene.reference is None:
            with open(name, "wb") as file:
                file.write(run(f"{ROOT}/tests/bench/area_light reference {scene.size[0]} {scene.size[1]}", ROOT).output)
            return name, None
        pictures = [self.file(f"{scene.name}-reference-{i}.pfm") for i in range(scene.reference_seeds)]
        self.scene_file(scene, scene.reference.points)
        list(self.pool.map(lambda i: self.render(scene, scene.reference, 1000 + i, pictures[i]), range(len(pictures))))
        halves = [self.file(f"{scene.name}-half-{i}.pfm") for i in (0, 1)]
        for i in (0, 1):
            write_mean(halves[i], pictures[i::2])
        write_mean(name, pictures)
        return name, self.error(*halves)["mrse"]

    def points(self, scene, reference):
        settings = {}
        for knob in scene.knobs:
            for value, setting in KNOBS[knob]:
                settings.setdefault(setting, []).append((knob, value))
                self.scene_file(scene, setting.points)

        def measure(job):
            number, (setting, seed) = job
            picture = self.file(f"{scene.name}-{number}.pfm")
            seconds = self.render(scene, setting, seed, picture)
            error = self.error(reference, picture)
            os.remove(picture)
            return setting, seconds, error

        # Seed by seed, so that a spell in which the machine is slow meets all settings alike.
        jobs = [(setting, seed) for seed in range(1, self.seeds + 1) for setting in settings]
        measured = {setting: ([], []) for setting in settings}
        for setting, seconds, error in self.pool.map(measure, enumerate(jobs)):
            measured[setting][0].append(seconds)
            measured[setting][1].append(error)
        return [Point("rayshade", knob, value, self.shown(scene, setting), setting == Setting(), *measured[setting])
                for setting, names in settings.items() for knob, value in names]

    # Other programs are judged each against what it converges to itself: their shading differs, so that what is left is the
    # error of sampling alone.  They have no seeds.

    def rival_points(self, scene, program, suffix, settings, command, fine):
        """`command`: scene, size, options, picture -> command line; `fine`: two ways to a reference, each with how many times
        the size it has and its options."""
        if shutil.which(program) is None:
            return [], None
        source = self.file(f"{scene.name}.{suffix}")
        with open(source, "wb") as file:
            file.write(run(f"{self.bin}/spd balls 3 --format {suffix}", ROOT).output)

        def render(size, options, picture):
            return run(command(source, size, options, picture), self.scratch).seconds

        def half(way):
            by, options = fine[way]
            picture, small = self.file(f"{program}-{way}.ppm"), self.file(f"{program}-{way}.pfm")
            render([by * side for side in scene.size], options, picture)
            write_smaller(small, picture, by)
            return small

        halves = list(self.pool.map(half, (0, 1)))
        reference = self.file(f"{program}-reference.pfm")
        write_mean(reference, halves)

        def measure(setting):
            value, options, is_default = setting
            picture = self.file(f"{program}-{value}.ppm".replace(" ", ""))
            seconds = [render(scene.size, options, picture) for _ in range(3)]
            shown = command(os.path.basename(source), scene.size, options, "out.ppm")
            return Point(program, "samples", value, shown, is_default, seconds, [self.error(reference, picture)])

        return list(self.pool.map(measure, settings)), (reference, fine, self.error(*halves)["mrse"])

    def povray(self, scene):
        settings = [("-A", "-A", True)]
        settings += [("+A0.3 +R3", "+A0.3 +AM1 +R3", False), ("+A0.1 +R3", "+A0.1 +AM1 +R3", False)]
        settings += [(f"+A0.0 +R{r}", f"+A0.0 +AM1 +R{r}", False) for r in (2, 3, 4, 6)]
        return self.rival_points(
            scene, "povray", "pov", settings,
            lambda source, size, options, picture:
                f"povray +I{source} +O{picture} +FP16 +W{size[0]} +H{size[1]} -D -GA +WT1 File_Gamma=1 {options}",
            [(2, "+A0.0 +AM1 +R5"), (3, "+A0.0 +AM1 +R5")])

    def tachyon(self, scene):
        settings = [(f"-aasamples {n}", f"-aasamples {n}", n == 0) for n in (0, 1, 3, 8, 15, 35)]
        return self.rival_points(
            scene, "tachyon", "tachyon", settings,
            lambda source, size, options, picture:
                f"tachyon {source} -res {size[0]} {size[1]} {options} -numthreads 1 -format PPM48 -o {picture}",
            [(1, "-aasamples 150"), (1, "-aasamples 300")])
