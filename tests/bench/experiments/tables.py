"""Tables of an experiment as tab-separated values: a line of names, then the rows.

SPDX-License-Identifier: BSD-3-Clause
"""


def text(value):
    if isinstance(value, float):
        return f"{value:.0f}" if abs(value) >= 1e5 else f"{value:.4g}"
    return str(value)


def write(file, rows):
    with open(file, "w") as out:
        print(*rows[0], sep="\t", file=out)
        for row in rows:
            print(*map(text, row.values()), sep="\t", file=out)


def number(field):
    try:
        return float(field)
    except ValueError:
        return field


def read(file):
    with open(file) as lines:
        names = next(lines).rstrip("\n").split("\t")
        return [dict(zip(names, map(number, line.rstrip("\n").split("\t")))) for line in lines]
