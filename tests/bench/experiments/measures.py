"""From the table of a run to the figures of an experiment.

The paper gives each processor a voxel task, some of them a pyramid task or a shade task too (figure 6).  This machine has
fewer processors than that, so the load of a processor is added up: processor i has voxel task i, pyramid task i, and
shade tasks at equal distances.  CPU seconds do not depend on how many others want the machine (not much, at least).
SPDX-License-Identifier: BSD-3-Clause
"""


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else 0.0


def over_mean(values):
    """The largest over the mean: 1 is perfect balance."""
    values = list(values)
    return max(values) / mean(values) if values and mean(values) > 0 else 1.0


def processors(run, count):
    """The tasks of each processor."""
    places = [[] for _ in range(count)]
    for role in ("voxel-trace", "pyramid-trace"):
        for i, task in enumerate(run.of(role)):
            places[i % count].append(task)
    shades = run.of("shade")
    for i, task in enumerate(shades):
        places[i * count // len(shades)].append(task)
    return places


def load(tasks):
    return sum(task["cpuSeconds"] for task in tasks)


def balance(run, count):
    """Busiest processor over the mean."""
    return over_mean(load(tasks) for tasks in processors(run, count))


def balance_filled(run, count):
    """The same if pyramid tasks had taken their work only where a processor is idle: what demand-driven work is for.

    On this machine all tasks share two processors, so a pyramid task cannot tell that its own would be busy.
    """
    places = processors(run, count)
    all_work = mean(load(tasks) for tasks in places)
    fixed = max(load(t for t in tasks if t["role"] != "pyramid-trace") for tasks in places)
    return max(1.0, fixed / all_work) if run.of("pyramid-trace") else balance(run, count)


def traffic(tasks, unit):
    return sum(task[unit + "In"] + task[unit + "Out"] for task in tasks)


def model_bytes(tasks):
    """Objects of voxels, with accelerators, and what the caches held at most."""
    return sum(task["cachePeakBytes"] if task["role"] == "pyramid-trace" else task["modelBytes"] + task["cachePeakBytes"]
               for task in tasks)


def hit_ratio(tasks):
    """Look-ups that found the cell in the cache.  A ray that asks for a cell that is on its way has not found it."""
    asked = sum(task["cacheAsked"] for task in tasks)
    return sum(task["cacheHits"] for task in tasks) / asked if asked else float("nan")


def no_fetch_ratio(tasks):
    """Look-ups that caused no message: the cell was there, or on its way for somebody else."""
    asked = sum(task["cacheAsked"] for task in tasks)
    return 1 - sum(task["cacheFetched"] for task in tasks) / asked if asked else float("nan")
