"""Tables, plots and the words between them.

SPDX-License-Identifier: BSD-3-Clause
"""
import math
import os
import shutil
import subprocess

from scenes import POINTS


def curves(points):
    """The points of each curve, fast to slow."""
    found = {}
    for point in points:
        found.setdefault((point.program, point.knob), []).append(point)
    return {key: sorted(curve, key=lambda p: p.mean("seconds")) for key, curve in found.items()}


def slope(curve):
    """Of log error against log time, least squares."""
    x = [math.log(p.mean("seconds")) for p in curve]
    y = [math.log(p.mean("mrse")) for p in curve]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


def crossing(curve, at, of, given):
    """What `of` is where the curve (straight lines between its points, in logarithms) has the value `given` of `at`."""
    for a, b in zip(curve, curve[1:]):
        p, q = a.mean(at), b.mean(at)
        if min(p, q) <= given <= max(p, q) and p != q:
            share = (math.log(given) - math.log(p)) / (math.log(q) - math.log(p))
            return math.exp((1 - share) * math.log(a.mean(of)) + share * math.log(b.mean(of)))
    return None


def better(points, default):
    """Points that are both faster and more exact than the default, by more than the bars; the best of them first."""
    def gain(p):
        return default.mean("seconds") * default.mean("mrse") / (p.mean("seconds") * p.mean("mrse"))
    found = [p for p in points if not p.is_default and p.program == default.program
             and p.interval("seconds")[1] < default.interval("seconds")[0]
             and p.interval("mrse")[1] < default.interval("mrse")[0]]
    return sorted(found, key=gain, reverse=True)


def factor(value, of):
    return "-" if of is None else f"x {value / of:.2g}"


def write_table(name, points):
    columns = ["program", "knob", "value", "default", "seeds"]
    columns += [f"{what}{part}" for what in ("seconds", "mrse", "rmse", "flip") for part in ("", " low", " high")]
    with open(name, "w") as file:
        file.write("\t".join(columns + ["command"]) + "\n")
        for p in points:
            row = [p.program, p.knob, p.value, "yes" if p.is_default else "no", str(len(p.errors))]
            for what in ("seconds", "mrse", "rmse", "flip"):
                row += ["%.4g" % v for v in (p.mean(what), *p.interval(what))]
            file.write("\t".join(row + [p.command]) + "\n")


COLOURS = ["#1f4e9c", "#c0392b", "#1e8449", "#b9770e", "#7d3c98", "#117a8b", "#555555", "#a04000"]


def write_plot(name, scene, points, floor):
    """A plot by gnuplot; false when there is none."""
    if shutil.which("gnuplot") is None:
        return False
    blocks, plots = [], []
    for i, ((program, knob), curve) in enumerate(curves(points).items()):
        rows = "\n".join(" ".join("%.6g" % v for v in (p.mean("seconds"), p.mean("mrse"), *p.interval("seconds"),
                                                     *p.interval("mrse"))) for p in curve)
        blocks.append(f"$curve{i} << END\n{rows}\nEND\n")
        title = knob if program == "rayshade" else f"{program} (its own reference)"
        dash = "" if program == "rayshade" else "dt 2"
        style = f'lc rgb "{COLOURS[i % len(COLOURS)]}"'
        plots.append(f'$curve{i} using 1:2 with lines lw 1.5 {dash} {style} notitle')
        plots.append(f'$curve{i} using 1:2:3:4:5:6 with xyerrorbars pt {i + 4} ps .6 {style} title "{title}"')
    default = next(p for p in points if p.is_default and p.program == "rayshade")
    blocks.append("$default << END\n%.6g %.6g\nEND\n" % (default.mean("seconds"), default.mean("mrse")))
    plots.append('$default using 1:2 with points pt 6 ps 2.2 lw 2 lc rgb "black" title "default"')
    if floor:
        plots.append(f'{floor / 4:.6g} with lines dt 3 lc rgb "#888888" title "error of the reference"')
    script = "".join(blocks) + f"""
set terminal svg size 860,560 font "DejaVu Sans,12" background "white"
set output "{name}"
set title "{scene.title}"
set logscale xy
set format y "%.0e"
set xtics (.005, .01, .02, .05, .1, .2, .5, 1, 2, 5, 10, 20, 50)
set xlabel "processor time, seconds"
set ylabel "error (MRSE)"
set grid lc rgb "#dddddd"
set offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05
set xrange [*:*] noextend
set yrange [*:*] noextend
set key outside right top
plot {", ".join(plots)}
"""
    subprocess.run(["gnuplot"], input=script.encode(), check=True)
    return True


def table_of_points(points):
    lines = ["| knob | value | seconds | MRSE, with 95 % interval | RMSE | FLIP | error in equal time | time for equal error |",
             "|---|---|---:|---|---:|---:|---:|---:|"]
    yardstick = curves(points)["rayshade", "samples"]
    by_command = {}  # a setting may lie on several curves
    for p in points:
        by_command.setdefault(p.command, []).append(p)
    for same in by_command.values():
        p = same[0]
        seconds, mrse = p.mean("seconds"), p.mean("mrse")
        low, high = p.interval("mrse")
        bars = f" ({low:.2e} - {high:.2e})" if len(p.errors) > 1 else ""
        knob = ", ".join(q.knob for q in same) if p.program == "rayshade" else p.program
        value = ", ".join(f"`{q.value}`" for q in same)
        if p.is_default and p.program == "rayshade":
            knob, value = "all", "**default**"
        against = ["", ""]
        if p not in yardstick:
            against = [factor(mrse, crossing(yardstick, "seconds", "mrse", seconds)),
                       factor(seconds, crossing(yardstick, "mrse", "seconds", mrse))]
        lines.append(f"| {knob} | {value} | {seconds:.3f} | {mrse:.2e}{bars} | {p.mean('rmse'):.2e} | "
                     f"{p.mean('flip'):.4f} | {against[0]} | {against[1]} |")
    return "\n".join(lines)


def slopes(points):
    found = [f"{knob} {slope(curve):.2f}" for (program, knob), curve in curves(points).items() if program == "rayshade"]
    return "Slopes: " + ", ".join(found) + "."


def verdict(points, default):
    found = better(points, default)
    if not found:
        return "The default lies on the Pareto front: no measured setting is both faster and more exact beyond the bars."
    best = found[0]
    return (f"The default is not on the Pareto front: {len(found)} of the settings are both faster and more exact, the best "
            f"of them `{best.value}` with {best.mean('seconds') / default.mean('seconds'):.2f} times the time and "
            f"{best.mean('mrse') / default.mean('mrse'):.2f} times the error. It stays where it is: it is what the "
            f"language gives to a scene that says nothing, and such scenes shall look as they did in Rayshade 4.")


def section(scene, points, floor, rivals, plotted):
    default = next(p for p in points if p.is_default and p.program == "rayshade")
    smallest = min(p.mean("mrse") for p in points if p.program == "rayshade")
    text = [f"## {scene.title}", ""]
    if scene.reference is None:
        text.append("Reference: the exact picture, `tests/bench/area_light reference "
                    f"{scene.size[0]} {scene.size[1]}`; the scene: `tests/bench/area_light scene {POINTS}`.")
    else:
        r = scene.reference
        lights = f", area lights of {r.points} x {r.points} points" if scene.area_lights else ""
        text.append(
            f"Reference: the mean of {scene.reference_seeds} pictures `{r.options()}`, seeds 1000 to "
            f"{999 + scene.reference_seeds}{lights}: "
            f"{scene.reference_seeds * r.samples ** 2} samples in a pixel. The means of its halves differ by an MRSE of "
            f"{floor:.1e}, which makes {floor / 4:.1e} the error of the whole; that is 1/{smallest / (floor / 4):.0f} of the "
            f"smallest error below.")
    text += ["", f"{scene.size[0]} x {scene.size[1]} pixels. The default: `{default.command}`.", ""]
    if plotted:
        text += [f"![{scene.title}: error against time](speed-and-error/{scene.name}.svg)", ""]
    text += [verdict(points, default), "", slopes(points), "", table_of_points(points), ""]
    for program, (ways, halves, apart) in rivals.items():
        named = "`; `".join(f"{by} times the size, {options}" for by, options in ways)
        text += [f"{program}: judged against what it converges to itself (two ways to that, `{named}`, differ by {halves:.1e}); our "
                 f"own reference is {apart:.1e} away from that, because shading and highlights are defined differently. 16 bits a "
                 f"channel and cut off at 1; no seeds, so no bars on the error.", ""]
    return "\n".join(text)


HEAD = """# Speed and error

Made by `make bench` ({command}) on {date}, {machine}, {minutes:.0f} minutes.
Do not edit: change tests/bench/speed_and_error/.

Every knob that trades time for error, turned alone with the others at the values that the language gives a scene that says
nothing: `{default}`, area lights of {points} x {points} points (the language has no default for these).

- **Error** is that of sampling, in linear light: MRSE, the mean of (v - r)^2 / (|r| + 0.01)^2 over pixels and channels; beside it
  RMSE and the mean of LDR-FLIP (`rayshade-error reference.pfm picture.pfm`). Geometric errors are another matter: [accuracy.md](accuracy.md).
  Splitting a picture over tasks has no error: the same bits (docs/determinism.md), so what is faster there is faster at equal error.
- **Time** is processor time, user and system, of the whole process, reading the scene included; other work on the machine widens its bars.
  How time is spent: [speed.md](speed.md).
- **Knobs**: *samples* is `-S`; *samples, no test* the same with `-T 0 0 0`, all samples in every pixel that is not uniform; *contrast*
  `-T`, as factors of the default; *light points* those along each side of an area light, in the scene file; *cutoff* `-C`; *depth* `-D`.
- **Points** are means over {seeds} seeds (`--seed 1` to `--seed {seeds}`), bars the 95 % interval of the mean by bootstrap.
- **Slope** is that of log MRSE against log time over a whole curve. Plain Monte Carlo has -1, stratified sampling of
  smooth things is steeper. A curve that flattens has a floor: the bias of the other knobs, or of the one that is turned.
- **Error in equal time, time for equal error**: factors of what the curve *samples* has there, read off it between its points
  in logarithms. Below 1 turning this knob pays more than turning `-S`, above 1 less; `-` where that curve does not reach.

The files speed-and-error/*.tsv hold all figures and the command of each. NAME-N.ray in it is what `tests/bench/speed_and_error/run
--scene NAME N` prints; interior and glass are rendered in scenes/gallery, because they name files there.

"""


def machine():
    model = "unknown processor"
    with open("/proc/cpuinfo") as file:
        for line in file:
            if line.startswith("model name"):
                model = line.split(":", 1)[1].strip()
                break
    return f"{os.cpu_count()} processors, {model}"
