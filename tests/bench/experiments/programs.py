"""Runs the real programs over real PVM and reads what they report.

Every picture is compared with the sequential one by its checksum: a run with another picture is an error, not a result.
Times are seconds of CPU, sizes bytes.
SPDX-License-Identifier: BSD-3-Clause
"""
import os
import shlex
import subprocess
import tempfile

SPD = ["balls", "gears", "tree", "rings", "mount"]
SCENES = SPD + ["interior"]  # interior: lit by area lights


class Run:
    """One rendering by tasks."""

    def __init__(self, command, tasks, facts):
        self.command = command
        self.facts = facts
        self.host = tasks[0]
        self.tasks = tasks[1:]

    def of(self, role):
        return [task for task in self.tasks if task["role"] == role]

    def total(self, column):
        return sum(task[column] for task in [self.host] + self.tasks)


class Laboratory:
    """Scenes, programs and a virtual machine of its own in a directory that goes away.

    The current directory is the root of the repository.
    """

    def __init__(self, binaries, side):
        self.binaries = binaries
        self.side = side  # of the pictures, in pixels
        self.directory = tempfile.TemporaryDirectory(prefix="rayshade-experiments-")
        self.at = self.directory.name
        os.mkdir(os.path.join(self.at, "pvm"))
        self.environment = {name: value for name, value in os.environ.items() if name != "PVMSOCK"}
        self.environment.update(PVM_TMP=os.path.join(self.at, "pvm"), PVM_VMID="experiments")
        self.sequential = {}  # by scene: checksum and CPU seconds
        self.models = {}  # by scene: bytes of its objects and accelerators in one task
        self.runs = 0
        for name in SPD:
            with open(self._file(name), "w") as out:
                subprocess.run([self._program("spd"), name], stdout=out, check=True)

    def _program(self, name):
        return os.path.join(self.binaries, name)

    def _file(self, scene):
        return f"{self.at}/{scene}.ray" if scene in SPD else f"scenes/gallery/{scene}.ray"

    def picture(self, scene):
        """What both programs are told about the picture: one sample per pixel, so that no ray is a guess."""
        size = f"{self.side} {self.side}" if scene in SPD else f"{self.side} {self.side * 5 // 8}"
        return f"-q -S 1 -j -R {size} -O /dev/null"

    def reference(self, scene):
        """Checksum and CPU seconds of the sequential program."""
        if scene not in self.sequential:
            words = [self._program("rayshade"), "-v", *self.picture(scene).split(), self._file(scene)]
            before = os.times()
            done = subprocess.run(words, stderr=subprocess.PIPE, text=True, check=True)
            after = os.times()
            cpu = after.children_user + after.children_system - before.children_user - before.children_system
            line = [line for line in done.stderr.splitlines() if line.startswith("picture checksum")][0]
            self.sequential[scene] = line.split()[-1], cpu
        return self.sequential[scene]

    def model_bytes(self, scene):
        if scene not in self.models:
            self.models[scene] = self.render(scene, "--voxels 1").of("voxel-trace")[0]["modelBytes"]
        return self.models[scene]

    def render(self, scene, options):
        """Renders by tasks with these options of rayshade-host."""
        table = os.path.join(self.at, "table.tsv")
        if os.path.exists(table):
            os.remove(table)
        words = shlex.split(f"{self.picture(scene)} {options} --table {table}") + [self._file(scene)]
        done = subprocess.run([self._program("rayshade-host"), *words], env=self.environment,
                              stderr=subprocess.PIPE, text=True, timeout=600)
        if done.returncode != 0:
            raise RuntimeError(f"rayshade-host {' '.join(words)}: {done.stderr}")
        tasks, facts = read_table(table)
        if facts["checksum"] != self.reference(scene)[0]:
            raise RuntimeError(f"{scene} {options}: the picture is not the sequential one")
        if facts["reissued"] != "0":
            raise RuntimeError(f"{scene} {options}: a task has died")
        self.runs += 1
        command = f"rayshade-host {self.picture(scene)} {options} {os.path.basename(self._file(scene))}"
        return Run(command, tasks, facts)


def read_table(file):
    """The tasks of a table that --table has written, the host first; and the facts about all of them."""
    tasks, facts, names = [], {}, None
    with open(file) as lines:
        for line in lines:
            fields = line.rstrip("\n").split("\t")
            if line.startswith("# "):
                facts[fields[0][2:]] = fields[1]
            elif names is None:
                names = fields
            else:
                task = dict(zip(names, fields))
                for name in names:
                    if name not in ("role", "machine"):
                        task[name] = float(task[name])
                tasks.append(task)
    return tasks, facts
