"""Plots of the tables, as SVG, by gnuplot.

SPDX-License-Identifier: BSD-3-Clause
"""
import shutil
import subprocess

from report import pick, values

COLOURS = ["#1b6ca8", "#d1495b", "#3a7d44", "#e09f3e", "#6c4f9e", "#555555"]


class Panel:
    """One pair of axes and named series of points: curves, or bars side by side."""

    def __init__(self, title, series, x="", y="", log=False, marks=None, low=None, bars=False):
        self.title, self.series, self.x, self.y = title, series, x, y
        self.log, self.marks, self.low, self.bars = log, marks, low, bars

    def script(self):
        lines = [f'set title "{self.title}" noenhanced', f'set xlabel "{self.x}"', f'set ylabel "{self.y}"',
                 "unset logscale", "set xtics auto", f"set yrange [{'*' if self.low is None else self.low}:*]"]
        if self.log:
            lines.append("set logscale x 2")
        if self.marks:
            lines.append("set xtics (" + ", ".join(f'"{name}" {place}' for place, name in self.marks) + ")")
            first, last = self.marks[0][0], self.marks[-1][0]
            low, high = (first * 0.9, last * 1.1) if self.log else (first - 0.5, last + 0.5)
            lines.append(f"set xrange [{low}:{high}]")
        width = 0.8 / len(self.series)
        if self.bars:
            lines += [f"set boxwidth {width}", "set style fill solid"]
        for i, (_, points) in enumerate(self.series):
            move = (i - (len(self.series) - 1) / 2) * width if self.bars else 0
            lines += [f"$data{i} << END", *(f"{x + move} {y}" for x, y in points), "END"]
        style = "boxes" if self.bars else "linespoints lw 1.6 pt 7 ps 0.4"
        drawn = [f'$data{i} with {style} lc rgb "{COLOURS[i % len(COLOURS)]}" title "{name}"'
                 for i, (name, _) in enumerate(self.series)]
        return "\n".join(lines + ["plot " + ", ".join(drawn)])


def figure(file, panels, columns=3):
    rows = -(-len(panels) // columns)
    size = f"{330 * columns},{290 * rows}"
    script = [f'set terminal svg size {size} font "sans,11" background rgb "white"', f'set output "{file}"',
              "set grid lc rgb '#dddddd'",
              "set key outside below center horizontal samplen 1.2 width -1 noenhanced",
              "set border 3", "set tics nomirror out", f"set multiplot layout {rows},{columns}",
              *(panel.script() for panel in panels), "unset multiplot"]
    subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)


def by_schedule(rows, column, unit=1.0):
    """Panels by scene, a curve for each schedule, over the number of processors."""
    counts = values(rows, "processors")
    for scene in values(rows, "scene"):
        series = [(schedule, [(row["processors"], row[column] / unit)
                              for row in pick(rows, scene=scene, schedule=schedule)])
                  for schedule in values(rows, "schedule")]
        yield scene, series, [(count, f"{count:.0f}") for count in counts]


def schedules(output, rows):
    for name, column, unit, label, low in [
            ("balance", "balance", 1, "busiest / mean", 1),
            ("balance-filled", "balanceFilled", 1, "busiest / mean, gaps filled", 1),
            ("messages", "messagesMean", 1e3, "messages of a processor, thousands", 0),
            ("bytes-mean", "bytesMean", 1e6, "MB of a processor, mean", 0),
            ("bytes-most", "bytesMax", 1e6, "MB of a processor, most", 0),
            ("memory", "modelMax", 1e6, "MB of objects and caches, most", 0),
            ("cpu", "cpu", 1, "CPU seconds, all tasks", 0)]:
        figure(f"{output}/schedules-{name}.svg",
               [Panel(scene, series, "processors", label, True, marks, low)
                for scene, series, marks in by_schedule(rows, column, unit)])


def over_categories(rows, category, column, lines_by, unit=1.0):
    names = values(rows, category)
    series = [(f"{line:.0f}" if isinstance(line, float) else line,
               [(names.index(row[category]), row[column] / unit) for row in pick(rows, **{lines_by: line})])
              for line in values(rows, lines_by)]
    return series, [(i, f"{name:.0f}" if isinstance(name, float) else name) for i, name in enumerate(names)]


def cache(output, rows):
    panels = []
    for kind in values(rows, "fetched for"):
        series = [(scene, [(row["partOfModel"], row["noFetchRatio"])
                           for row in pick(rows, scene=scene, **{"fetched for": kind})])
                  for scene in values(rows, "scene")]
        marks = [(part, f"1/{round(1 / part)}" if part < 1 else "1") for part in values(rows, "partOfModel")]
        panels.append(Panel(kind, series, "cache / model", "look-ups without a fetch", True, marks))
    figure(f"{output}/cache.svg", panels)


def horizon(output, rows):
    panels = []
    for column, unit, label in [("bytes", 1e6, "MB in all"), ("forwardedShare", 1, "rays that go on"),
                                ("balance", 1, "busiest / mean")]:
        series, marks = over_categories(rows, "horizon", column, "scene", unit)
        panels.append(Panel(label, series, "cells before the horizon", "", False, marks, 0))
    figure(f"{output}/horizon.svg", panels)


def shading(output, rows):
    panels = []
    for column, unit, label in [("bytesMax", 1e6, "MB of a processor, most"),
                                ("shadeBytesMax", 1e6, "MB of a shade task, most"), ("balance", 1, "busiest / mean")]:
        series = []
        for scene in values(rows, "scene"):
            for placement in values(rows, "placement"):
                series.append((f"{scene}, {placement}", [(row["shadeTasks"], row[column] / unit)
                                                         for row in pick(rows, scene=scene, placement=placement)]))
        marks = [(count, f"{count:.0f}") for count in values(rows, "shadeTasks")]
        panels.append(Panel(label, series, "shade tasks", "", True, marks, 0))
    figure(f"{output}/shading.svg", panels)


def clusters(output, rows):
    panels = []
    for column, unit, label in [("bytes", 1e6, "MB in all"), ("modelMax", 1e6, "MB of objects and caches, most"),
                                ("balance", 1, "busiest / mean")]:
        series = []
        for scene in values(rows, "scene"):
            for schedule in values(rows, "schedule"):
                series.append((f"{scene}, {schedule}", [(row["clusters"], row[column] / unit)
                                                        for row in pick(rows, scene=scene, schedule=schedule)]))
        marks = [(count, f"{count:.0f}") for count in values(rows, "clusters")]
        panels.append(Panel(label, series, "clusters", "", True, marks, 0))
    figure(f"{output}/clusters.svg", panels)


def split(output, rows):
    panels = []
    for column, label in [("balance", "work: busiest / mean"), ("objectBalance", "objects: most / mean"),
                          ("bytes", "MB in all")]:
        names = values(rows, "scene")
        series = [(f"{how}, {per_task:.0f} a task",
                   [(names.index(row["scene"]), row[column] / (1e6 if column == "bytes" else 1))
                    for row in pick(rows, split=how, voxelsPerTask=per_task)])
                  for how in values(rows, "split") for per_task in values(rows, "voxelsPerTask")]
        panels.append(Panel(label, series, "", "", False, list(enumerate(names)), 0, bars=True))
    figure(f"{output}/split.svg", panels)


def draw(output, found):
    """All plots for which there is a table; False: there is no gnuplot."""
    if shutil.which("gnuplot") is None:
        return False
    drawn = {"schedules": schedules, "cache": cache, "horizon": horizon, "shading": shading, "clusters": clusters,
             "split": split}
    for name, plot in drawn.items():
        if name in found:
            plot(output, found[name])
    return True
