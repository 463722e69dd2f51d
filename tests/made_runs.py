# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs that are made up for tests of what reads them."""

import json
import os


def writeRun(folder, columns, rows, **message):
    """Write curve.csv and run.json of a run that was made up, and return its folder."""
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "curve.csv"), "w") as f:
        f.write(",".join(columns) + "\r\n")
        f.writelines(",".join("%.9g" % v for v in row) + "\r\n" for row in rows)
    with open(os.path.join(folder, "run.json"), "w") as f:
        json.dump({"title": "a run", **message}, f)
    return str(folder)


def axis(column, label=None):
    """An axis of the entry ``figure`` of run.json."""
    return {"column": column, "label": label or column}
