"""results.md: the figures in short, and for each claim of the paper whether these runs bear it out.

The prose stands in README.md of the output and names no figure, so that it stays true when this file is made again.
SPDX-License-Identifier: BSD-3-Clause
"""
import os
import re
import subprocess


def pick(rows, **wanted):
    return [row for row in rows if all(row[name] == value for name, value in wanted.items())]


def one(rows, **wanted):
    return pick(rows, **wanted)[0]


def values(rows, column):
    """The values of a column, each once, in the order of the table."""
    return list(dict.fromkeys(row[column] for row in rows))


def short(value):
    if isinstance(value, str):
        return value
    if value != value:
        return "-"
    if value >= 1e6:
        return f"{value / 1e6:.1f} M"
    if value >= 1e4:
        return f"{value / 1e3:.0f} k"
    return f"{value:.0f}" if value >= 100 or value == int(value) else f"{value:.3g}"


def table(out, head, lines):
    print("| " + " | ".join(head) + " |", file=out)
    print("|---" + "|---:" * (len(head) - 1) + "|", file=out)
    for line in lines:
        print("| " + " | ".join(short(field) for field in line) + " |", file=out)
    print(file=out)


def pivot(out, title, rows, column, lines_by, columns_by):
    """A table with one figure per field."""
    heads = values(rows, columns_by)
    print(f"{title}\n", file=out)
    lines = []
    for line in values(rows, lines_by):
        fields = [pick(rows, **{lines_by: line, columns_by: head}) for head in heads]
        lines.append([line] + [found[0][column] if found else "-" for found in fields])
    table(out, [lines_by] + [short(head) for head in heads], lines)


def claim(out, text, verdicts, figures):
    """One claim: in how many of the scenes it holds, and the figures behind it."""
    held = sum(verdicts)
    word = "holds" if held == len(verdicts) else "does not hold" if held == 0 else "holds in part"
    print(f"- **{text}** - {word}: {held} of {len(verdicts)}. {figures}", file=out)


def pairs(rows, column, first, second, count):
    """The figures of two schedules, scene by scene."""
    at = pick(rows, processors=count)
    return [(scene, one(at, scene=scene, schedule=first)[column], one(at, scene=scene, schedule=second)[column])
            for scene in values(at, "scene")]


def listed(triples):
    return "; ".join(f"{scene} {short(a)} → {short(b)}" for scene, a, b in triples)


def claims(out, found):
    """Each of the paper's claims against the tables."""
    print("## The claims of the paper\n", file=out)
    if "schedules" in found:
        claims_of_schedules(out, found["schedules"])
    if "cache" in found:
        claim_of_cache(out, pick(found["cache"], **{"fetched for": "light pyramids"}))
    if "shading" in found:
        few = pick(found["shading"], placement="static", shadeTasks=1)
        claim(out, "Shading is cheap (less than a tenth of all work)",
              [row["shadingShare"] < 0.1 for row in few],
              "Share: " + "; ".join(f"{row['scene']} {row['shadingShare']:.2f}" for row in few) + ".")
    if "clusters" in found:
        claim_of_clusters(out, pick(found["clusters"], schedule="data"))
    if "split" in found:
        claim_of_split(out, pick(found["split"], voxelsPerTask=1))
    print(file=out)


def claims_of_schedules(out, rows):
    counts = values(rows, "processors")
    most, fewest = max(counts), min(counts)
    print(f"On {most:.0f} processors where nothing else is said; a → b: data driven → hybrid.\n", file=out)
    balance = pairs(rows, "balance", "data", "hybrid", most)
    claim(out, "Hybrid balances better than data driven (as run)", [b < a for _, a, b in balance],
          "Busiest over mean: " + listed(balance) + ".")
    filled = pairs(rows, "balanceFilled", "data", "hybrid", most)
    claim(out, "Hybrid can balance better, its demand-driven work filling the gaps",
          [b < a for _, a, b in filled], "The same: " + listed(filled) + ".")
    sent = pairs(rows, "bytesMean", "data", "hybrid", most)
    claim(out, "Hybrid communicates less", [b < a for _, a, b in sent],
          "Bytes per processor: " + listed(sent) + ".")
    spread = []
    for scene in values(rows, "scene"):
        ends = [one(rows, scene=scene, schedule=name, processors=most) for name in ("data", "hybrid")]
        spread.append((scene, *(row["bytesMax"] / row["bytesMean"] for row in ends)))
    claim(out, "Communication is evenly spread (no processor has twice the mean)",
          [b < 2 for _, _, b in spread], "Most over mean: " + listed(spread) + ".")
    memory = pairs(rows, "modelMax", "data", "hybrid", most)
    claim(out, "Hybrid needs little more memory (less than half as much again on the fullest processor), "
               "with caches of a tenth of the model", [b < 1.5 * a for _, a, b in memory],
          "Objects and caches, bytes: " + listed(memory) + ".")
    growth = []
    for scene in values(rows, "scene"):
        ends = [one(rows, scene=scene, schedule="demand", processors=count) for count in (fewest, most)]
        growth.append((scene, *(row["bytesMean"] * row["processors"] for row in ends)))
    claim(out, "Demand-driven work alone communicates more and more (half as much again)",
          [b > 1.5 * a for _, a, b in growth],
          f"All bytes, {fewest:.0f} → {most:.0f} processors: " + listed(growth) + ".")


def claim_of_cache(out, rows):
    ends = []
    for scene in values(rows, "scene"):
        lines = pick(rows, scene=scene)
        ends.append((scene, min(lines, key=lambda r: r["partOfModel"]), max(lines, key=lambda r: r["partOfModel"])))

    def ratios(column):
        return "; ".join(f"{scene} {a[column]:.3f} → {b[column]:.3f}" for scene, a, b in ends)

    claim(out, "The cache for light pyramids saves nine fetches of ten, as small as it may be",
          [a["noFetchRatio"] > 0.9 for _, a, _ in ends],
          "Look-ups without a fetch, smallest cache → one as large as the model: " + ratios("noFetchRatio") + ".")


def claim_of_clusters(out, rows):
    ends = [(scene, pick(rows, scene=scene)) for scene in values(rows, "scene")]
    claim(out, "Clusters save communication", [lines[-1]["bytes"] < lines[0]["bytes"] for _, lines in ends],
          "All bytes, one cluster → most: " +
          listed([(scene, lines[0]["bytes"], lines[-1]["bytes"]) for scene, lines in ends]) +
          "; objects on the fullest processor, bytes: " +
          listed([(scene, lines[0]["modelMax"], lines[-1]["modelMax"]) for scene, lines in ends]) + ".")


def claim_of_split(out, rows):
    ends = [(scene, one(rows, scene=scene, split="equal"), one(rows, scene=scene, split="cost"))
            for scene in values(rows, "scene")]
    claim(out, "Not in the paper: voxels of equal predicted cost balance better than equal voxels",
          [b["balance"] < a["balance"] for _, a, b in ends],
          "Busiest over mean, equal → cost: " + listed([(s, a["balance"], b["balance"]) for s, a, b in ends]) +
          "; most objects over mean: " +
          listed([(s, a["objectBalance"], b["objectBalance"]) for s, a, b in ends]) + ".")


def short_tables(out, found):
    rows = found.get("schedules", [])
    if not rows:
        return
    most = max(values(rows, "processors"))
    at = pick(rows, processors=most)
    print(f"## The schemes on {most:.0f} processors\n", file=out)
    pivot(out, "Load: busiest processor over the mean, as run", at, "balance", "scene", "schedule")
    pivot(out, "Bytes of a processor, in and out, mean", at, "bytesMean", "scene", "schedule")


def write(file, found):
    commands = [row["command"] for rows in found.values() for row in rows]
    sizes = list(dict.fromkeys(re.search(r"-R (\d+) (\d+)", command).group(1, 2) for command in commands))
    git = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True)
    with open(file, "w") as out:
        print("# Results\n\nMade by `make experiments`; do not edit. Pictures of " +
              " and ".join(f"{width} x {height}" for width, height in sizes) +
              f" pixels with one sample each; {os.cpu_count()} processors in the machine"
              f"{'; commit ' + git.stdout.strip() if git.returncode == 0 else ''}. Every picture had the bits of the "
              "sequential one. All figures with their commands are in the .tsv files, plots of them in the .svg files.\n", file=out)
        claims(out, found)
        short_tables(out, found)
