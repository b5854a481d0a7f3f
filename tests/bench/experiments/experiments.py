"""The experiments: what is varied, and what is written into their tables.

Each is a function that takes the laboratory and yields rows (dictionaries); the last column is the command of the row.
SPDX-License-Identifier: BSD-3-Clause
"""
from measures import (balance, balance_filled, hit_ratio, load, mean, model_bytes, no_fetch_ratio, over_mean, processors,
                      traffic)
from programs import SCENES

SCHEDULES = ["data", "hybrid", "pipelined", "demand"]
PROCESSORS = [1, 2, 4, 8, 16]
MANY = 8  # processors, where they are not what is varied
CELLS = 256  # of the bin-tree, where objects are fetched: small ones, since the scenes are small
CACHE = 0.1  # of the model: what a task may hold of others' objects, where it is not what is varied
PYRAMIDS = 1024  # in a picture, whatever its size: so many of 256 samples make one of 512 x 512 pixels


def tasks_for(count, schedule, shades=None):
    """A voxel task and, unless all is data driven, a pyramid task on each processor; equal voxels, as in the paper."""
    pyramids = 0 if schedule == "data" else count
    shades = shades or max(1, count // 4)
    return f"--schedule {schedule} --voxels {count} --pyramids {pyramids} --shades {shades} --split equal"


def fetching(lab, scene, part=CACHE):
    """How objects are fetched, with a cache of this part of the model."""
    size = part * lab.model_bytes(scene)
    return f" --cells {CELLS} --tile {max(1, lab.side ** 2 // PYRAMIDS)} --cache {size / 1e6:.6f}"


def schedules(lab, quick):
    """The schemes against each other, on more and more processors."""
    for scene in SCENES:
        for schedule in SCHEDULES:
            for count in [2, 8] if quick else PROCESSORS:
                run = lab.render(scene, tasks_for(count, schedule) +
                                 ("" if schedule == "data" else fetching(lab, scene)))
                places = processors(run, count)
                _, alone = lab.reference(scene)
                yield {
                    "scene": scene, "schedule": schedule, "processors": count,
                    "cpuSequential": alone, "cpu": run.total("cpuSeconds"),
                    "cpuHost": run.host["cpuSeconds"], "cpuShading": load(run.of("shade")),
                    "balance": balance(run, count), "balanceFilled": balance_filled(run, count),
                    "messagesMean": mean(traffic(p, "messages") for p in places),
                    "messagesMax": max(traffic(p, "messages") for p in places),
                    "bytesMean": mean(traffic(p, "bytes") for p in places),
                    "bytesMax": max(traffic(p, "bytes") for p in places),
                    "bytesHost": traffic([run.host], "bytes"),
                    "modelMean": mean(model_bytes(p) for p in places),
                    "modelMax": max(model_bytes(p) for p in places),
                    "memoryMax": max(task["peakMemory"] for task in run.tasks),
                    "cacheHitRatio": hit_ratio(run.tasks),
                    "command": run.command}


def cache(lab, quick):
    """Smaller and smaller caches: from the whole model to a fortieth of it."""
    kinds = {"light pyramids": f"{tasks_for(MANY, 'data')} --shadows local",
             "primary rays and light pyramids": f"{tasks_for(MANY, 'pipelined')} --shadows local",
             "all rays": tasks_for(MANY, "demand")}
    for scene in ["interior", "balls"] if quick else ["interior", "balls", "gears", "mount"]:
        whole = lab.model_bytes(scene)
        for kind, options in kinds.items():
            for parts in [40, 4, 1] if quick else [40, 20, 10, 5, 2, 1]:
                run = lab.render(scene, options + fetching(lab, scene, 1 / parts))
                yield {
                    "scene": scene, "fetched for": kind, "partOfModel": 1 / parts, "cacheBytes": int(whole / parts),
                    "hitRatio": hit_ratio(run.tasks), "noFetchRatio": no_fetch_ratio(run.tasks),
                    "cellsFetched": sum(task["cacheFetched"] for task in run.tasks),
                    "fetchedBytes": sum(task["cacheFetchedBytes"] for task in run.tasks),
                    "evicted": sum(task["cacheEvicted"] for task in run.tasks),
                    "modelBytes": whole, "cpu": run.total("cpuSeconds"), "command": run.command}


def horizon(lab, quick):
    """Where demand-driven pyramids become data-driven rays."""
    for scene in ["balls"] if quick else ["balls", "gears", "tree"]:
        for cells in ["0c", "4c", "auto"] if quick else ["0c", "1c", "2c", "4c", "8c", "16c", "32c", "64c", "auto"]:
            run = lab.render(scene, f"{tasks_for(MANY, 'hybrid')}{fetching(lab, scene)} --horizon {cells}")
            places = processors(run, MANY)
            pyramids = run.of("pyramid-trace")
            yield {
                "scene": scene, "horizon": cells,
                "forwardedShare": sum(t["forwardedRays"] for t in pyramids) / sum(t["pyramidRays"] for t in pyramids),
                "bytes": sum(task["bytesOut"] for task in [run.host] + run.tasks),
                "fetchedBytes": sum(task["cacheFetchedBytes"] for task in run.tasks),
                "messages": sum(task["messagesOut"] for task in [run.host] + run.tasks),
                "balance": balance(run, MANY), "balanceFilled": balance_filled(run, MANY),
                "modelMax": max(model_bytes(p) for p in places),
                "cpu": run.total("cpuSeconds"), "command": run.command}


def shading(lab, quick):
    """How many shade tasks, and whether they are chosen by how busy they are."""
    for scene in ["gears"] if quick else ["balls", "gears", "interior"]:
        for placement in ["static", "dynamic"]:
            for shades in [1, 4] if quick else [1, 2, 4, 8]:
                dynamic = " --dynamic-shading" if placement == "dynamic" else ""
                run = lab.render(scene, tasks_for(MANY, "data", shades) + dynamic)
                places = processors(run, MANY)
                tasks = run.of("shade")
                yield {
                    "scene": scene, "placement": placement, "shadeTasks": shades,
                    "shadingShare": load(tasks) / run.total("cpuSeconds"),
                    "shadeBalance": over_mean(task["shaded"] for task in tasks),
                    "shadeBytesMax": max(traffic([task], "bytes") for task in tasks),
                    "voxelBytesMax": max(traffic([task], "bytes") for task in run.of("voxel-trace")),
                    "bytesMax": max(traffic(p, "bytes") for p in places),
                    "bytesMean": mean(traffic(p, "bytes") for p in places),
                    "balance": balance(run, MANY), "cpu": run.total("cpuSeconds"), "command": run.command}


def clusters(lab, quick):
    """The model once, twice, four times over the same number of processors."""
    for scene in ["gears"] if quick else ["balls", "gears", "rings"]:
        for schedule in ["data", "hybrid"]:
            for copies in [1, 2, 4]:
                options = (f"--schedule {schedule} --clusters {copies} --voxels {MANY // copies} "
                           f"--pyramids {0 if schedule == 'data' else MANY} --shades {MANY // 4}")
                run = lab.render(scene, options + ("" if schedule == "data" else fetching(lab, scene)))
                places = processors(run, MANY)
                yield {
                    "scene": scene, "schedule": schedule, "clusters": copies,
                    "modelMax": max(model_bytes(p) for p in places),
                    "modelMean": mean(model_bytes(p) for p in places),
                    "messages": sum(task["messagesOut"] for task in [run.host] + run.tasks),
                    "bytes": sum(task["bytesOut"] for task in [run.host] + run.tasks),
                    "balance": balance(run, MANY), "balanceFilled": balance_filled(run, MANY),
                    "cpu": run.total("cpuSeconds"), "command": run.command}


def split(lab, quick):
    """Voxels of equal size, as in the paper, or of equal predicted cost; one for each task, or four."""
    for scene in ["balls", "gears"] if quick else SCENES:
        for how in ["equal", "cost"]:
            for per_task in [1, 4]:
                run = lab.render(scene, f"{tasks_for(MANY, 'data')} --split {how} --voxels-per-task {per_task}")
                voxels = run.of("voxel-trace")
                yield {
                    "scene": scene, "split": how, "voxelsPerTask": per_task,
                    "balance": over_mean(task["cpuSeconds"] for task in voxels),
                    "visitBalance": over_mean(task["visits"] for task in voxels),
                    "hitBalance": over_mean(task["hits"] for task in voxels),
                    "objectBalance": over_mean(task["objects"] for task in voxels),
                    "bytes": sum(task["bytesOut"] for task in [run.host] + run.tasks),
                    "bytesMax": max(traffic([task], "bytes") for task in voxels),
                    "cpu": run.total("cpuSeconds"), "command": run.command}


ALL = {"schedules": schedules, "cache": cache, "horizon": horizon, "shading": shading, "clusters": clusters,
       "split": split}
