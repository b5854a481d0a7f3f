"""Tables, plots and the words between them.

SPDX-License-Identifier: BSD-3-Clause
"""
import math
import os
import shutil
import subprocess

from scenes import KNOBS


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
    return "-" if of is None else f"{value / of:.2g}"


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


def time_for_equal_error(point, yardstick):
    """As a factor of the time that turning `samples` takes for the same error; `-` where that curve does not reach."""
    return factor(point.mean("seconds"), crossing(yardstick, "mrse", "seconds", point.mean("mrse")))


def rows(points):
    """The curves but `samples`, each value of a knob with what it is worth; the default is the measure."""
    yardstick = curves(points)["rayshade", "samples"]
    return [((p.program, p.knob, p.value), time_for_equal_error(p, yardstick)) for p in points
            if p not in yardstick and not (p.is_default and p.program == "rayshade")]


def table_of_samples(measured):
    """Time and error of the curve `samples`, scene by scene."""
    lines = ["| scene | " + " | ".join(f"`{value}`" for value, _ in KNOBS["samples"]) + " |",
             "|---|" + "---|" * len(KNOBS["samples"])]
    for scene, points in measured.items():
        by_value = {p.value: p for p in points if p.knob == "samples" and p.program == "rayshade"}
        lines.append(f"| {scene} | " + " | ".join(
            f"{by_value[value].mean('seconds'):.3f} s: {by_value[value].mean('mrse'):.1e}"
            for value, _ in KNOBS["samples"]) + " |")
    return "\n".join(lines)


def table_of_knobs(measured):
    """What each value of each other knob is worth in each scene; without the contrast test `samples` is nearly the same."""
    worth = {scene: dict(rows(points)) for scene, points in measured.items()}
    keys = list(dict.fromkeys(key for scene in worth.values() for key in scene
                              if key[0] == "rayshade" and key[1] != "samples, no test"))
    keys.sort(key=lambda key: list(KNOBS).index(key[1]))
    lines = ["| setting | " + " | ".join(worth) + " |", "|---|" + "---:|" * len(worth)]
    for key in keys:
        lines.append(f"| `{key[2]}` | " + " | ".join(scene.get(key, "") for scene in worth.values()) + " |")
    return "\n".join(lines)


def list_of_rivals(points):
    """Time and error of the other programs, and what they are worth."""
    worth = dict(rows(points))
    return [f"{program}: " + "; ".join(
        f"`{p.value}` {p.mean('seconds'):.3f} s, {p.mean('mrse'):.1e}, {worth[program, p.knob, p.value]}"
        for p in points if p.program == program) + "."
        for program in dict.fromkeys(p.program for p in points if p.program != "rayshade")]


def slopes(points):
    found = [f"{knob} {slope(curve):.2f}" for (program, knob), curve in curves(points).items() if program == "rayshade"]
    return "Slopes: " + ", ".join(found) + "."


def verdict(points, default):
    found = better(points, default)
    if not found:
        return []
    best = found[0]
    return [f"The default is not on the Pareto front: {len(found)} of the settings are both faster and more exact, the best "
            f"of them `{best.value}` with {best.mean('seconds') / default.mean('seconds'):.2f} times the time and "
            f"{best.mean('mrse') / default.mean('mrse'):.2f} times the error. It stays where it is: it is the "
            f"language's default, and scenes without settings shall look as they did in Rayshade 4."]


def section(scene, points, floor, plotted):
    default = next(p for p in points if p.is_default and p.program == "rayshade")
    smallest = min(p.mean("mrse") for p in points if p.program == "rayshade")
    text = [f"## {scene.title}", "", f"{scene.name}, {scene.size[0]} x {scene.size[1]} pixels."]
    if scene.reference is None:
        text.append(f"Reference: the exact picture, `tests/bench/area_light reference {scene.size[0]} {scene.size[1]}`.")
    else:
        r = scene.reference
        text.append(
            f"Reference: the mean of {scene.reference_seeds} pictures `{r.options()}`, seeds from 1000 on; its own error is "
            f"{floor / 4:.1e}, 1/{smallest / (floor / 4):.0f} of the smallest one measured.")
    text += [*verdict(points, default), slopes(points), ""]
    if plotted:
        text += [f"![{scene.title}: error against time](speed-and-error/{scene.name}.svg)", ""]
    return "\n".join(text)


def section_of_rivals(scene, points, rivals):
    if not rivals:
        return ""
    text = [f"## Beside other programs: {scene.name}", "",
            "Each is judged against what it converges to itself, because shading and highlights are defined differently: the error of "
            "sampling alone. Two ways to its reference differ by " +
            ", ".join(f"{halves:.1e} ({program})" for program, (_, halves, _) in rivals.items()) +
            "; our reference is " + ", ".join(f"{apart:.1e} ({program})" for program, (_, _, apart) in rivals.items()) +
            " away. Their pictures have 16 bits a channel and end at 1; they have no seeds. For each setting: time, MRSE, time for "
            "equal error as in the table above.", ""]
    return "\n".join(text + [f"- {line}" for line in list_of_rivals(points)] + [""])


HEAD = """# Speed and error

Made by `make bench` ({command}) on {date}, {machine}, {minutes:.0f} minutes.
Do not edit: change tests/bench/speed_and_error/.

Every knob that trades time for error, turned alone. The others have the default values of the language, `{default}`,
and area lights have {points} x {points} points. All figures, with their commands, are in speed-and-error/*.tsv;
`tests/bench/speed_and_error/run --scene NAME N` prints the scene NAME-N.ray.

- **Error** is that of sampling, in linear light: MRSE, the mean of (v - r)^2 / (|r| + 0.01)^2 over pixels and channels. The .tsv files
  have RMSE and LDR-FLIP, too (`rayshade-error reference.pfm picture.pfm`). Errors of geometry: [accuracy.md](accuracy.md).
- **Time** is processor time of the whole process, the reading of the scene included.
- **Knobs**: *samples* is `-S`; *samples, no test* the same with `-T 0 0 0`, all samples in every pixel; *contrast* is `-T` as a factor of
  the default; *light points* are those of an area light; *cutoff* is `-C`, *depth* is `-D`.
- **Points** are means over {seeds} seeds (`--seed 1` to `--seed {seeds}`); the bars of the plots are the 95 % interval of the mean by bootstrap.
- **The default** of a scene lies on the Pareto front where nothing else is said: no setting is both faster and more exact beyond the
  bars.
- **Slope** is that of log MRSE against log time. Plain Monte Carlo has -1. A curve that flattens has a floor: the bias of a knob.

## Time and error of `-S`

{samples}

## What the other knobs are worth

Time as a factor of that in which *samples* has the same error: below 1 turning this knob pays more than turning `-S`, above 1 less; `-`
where the curve *samples* does not reach.

{knobs}

"""


def machine():
    model = "unknown processor"
    with open("/proc/cpuinfo") as file:
        for line in file:
            if line.startswith("model name"):
                model = line.split(":", 1)[1].strip()
                break
    return f"{os.cpu_count()} processors, {model}"
