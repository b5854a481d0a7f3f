"""Programs and pictures.

SPDX-License-Identifier: BSD-3-Clause
"""
import array
import dataclasses
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.abspath(f"{os.path.dirname(__file__)}/../../..")


@dataclasses.dataclass
class Run:
    output: bytes
    seconds: float  # of processor time


def run(command, directory, standard_input=None):
    """Runs a command (words without blanks in them); ends the program when it fails."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(command.split(), cwd=directory, stdin=standard_input or subprocess.DEVNULL,
                                   stdout=out, stderr=errors)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            errors.seek(0)
            sys.exit(f"{command}: exit status {process.returncode}\n{errors.read().decode(errors='replace')}")
        out.seek(0)
        return Run(out.read(), usage.ru_utime + usage.ru_stime)


def read_pfm(name):
    with open(name, "rb") as file:
        if file.readline() != b"PF\n":
            sys.exit(f"{name}: not a PFM of three channels")
        width, height = map(int, file.readline().split())
        scale = float(file.readline())
        values = array.array("f", file.read())
    if (scale < 0) != (sys.byteorder == "little"):
        values.byteswap()
    return width, height, values


def write_pfm(name, width, height, values):
    values = array.array("f", values)
    if sys.byteorder != "little":
        values.byteswap()
    with open(name, "wb") as file:
        file.write(b"PF\n%d %d\n-1\n" % (width, height))
        file.write(values.tobytes())


def write_mean(name, pictures):
    width, height, total = read_pfm(pictures[0])
    total = [float(v) for v in total]
    for picture in pictures[1:]:
        for i, value in enumerate(read_pfm(picture)[2]):
            total[i] += value
    write_pfm(name, width, height, (v / len(pictures) for v in total))


def read_ppm16(name):
    """Rows from the top, values 0..1."""
    with open(name, "rb") as file:
        data = file.read()
    header = re.match(rb"P6\s(?:#.*\n)*\s*(\d+)\s(?:#.*\n)*\s*(\d+)\s(?:#.*\n)*\s*(\d+)\s", data)
    width, height, most = (int(g) for g in header.groups())
    values = array.array("H" if most > 255 else "B", data[header.end():])
    if most > 255 and sys.byteorder == "little":
        values.byteswap()
    return width, height, values, most


def write_smaller(name, source, by):
    """A PPM of `by` times the size to a PFM, each pixel the mean of a square."""
    width, height, values, most = read_ppm16(source)
    small = []
    for y in reversed(range(height // by)):
        for x in range(width // by):
            for c in range(3):
                square = (values[((y * by + j) * width + x * by + i) * 3 + c] for j in range(by) for i in range(by))
                small.append(sum(square) / (by * by * most))
    write_pfm(name, width // by, height // by, small)
