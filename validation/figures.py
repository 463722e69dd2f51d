# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of the walls' cases and of the couplets, drawn from the results of validate.py into the
folder of the case, and the table of their numbers, printed.

/usr/bin/python3 validation/figures.py CASE
"""

import math
import os
import shutil
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import studies
from masonry.numbers.files import readCurve
from masonry_view.measure import measure
from studies import HERE, RESULTS, readCase
from validate import bounds

STYLES = {"rigid": "-", "deformable": "--"}
#: Numbers of walls that are shown whether they have limits or not, and how; others have three
#: digits.
FORMATS = {
    "peak_base_shear_kN": ".1f",
    "peak_at_both_ends_kN": ".1f",
    "displacement_at_peak_mm": ".1f",
    "base_shear_end_kN": ".1f",
    "push_work_J": ".0f",
    "initial_stiffness_kN_per_mm": ".1f",
    "top_less_base_shear_kN": ".1f",
    "balance_error": ".0e",
}


def folder(case, run):
    return os.path.join(RESULTS, "validation", case, run)


def table(case, formats):
    """Markdown: numbers of the runs of a case, a column a run; one that misses its limits is
    bold. Numbers of ``formats`` are shown, and all that have limits."""
    runs = {name: run["limits"] for name, run in readCase(case).items() if name != "quick"}
    found = {name: measure(folder(case, name)) for name in runs}
    rows = []
    for number in dict.fromkeys([*formats, *(n for limits in runs.values() for n in limits)]):
        pair = next((limits[number] for limits in runs.values() if number in limits), ())
        cells = []
        for name, limits in runs.items():
            value = found[name].get(number, math.nan)
            text = "none" if math.isnan(value) else format(value, formats.get(number, ".3g"))
            text = "0.0" if text == "-0.0" else text
            other = lambda case: measure(folder(case, name))
            if number in limits:
                low, high = bounds(limits[number], number, other)
                text = text if low <= value <= high else f"**{text}**"
            cells.append(text)
        rows.append([f"`{number}`", _interval(*pair) if pair else "", *cells])
    return studies.table(["number", "limits", *runs], rows)


def _interval(low, high):
    if low is None:
        return f"≤ {high}"
    return f"≥ {low}" if high is None else f"{low}–{high}"


def save(figure, case, name):
    figure.tight_layout()
    figure.savefig(os.path.join(HERE, case, name), dpi=90)


def wall(case):
    """curve.png: all runs over the window of the peak; cracks_RUN.png: the crack pattern of
    each."""
    print(table(case, FORMATS))
    runs = {name: folder(case, name) for name in readCase(case) if name != "quick"}
    figure, axes = plt.subplots(figsize=(7, 4.2))
    low, high = readCase(case)["rigid"]["limits"]["peak_base_shear_kN"]
    axes.axhspan(low, high, color="0.88", label="window of the peak")
    for name, own in runs.items():
        curve = readCurve(own)
        axes.plot(curve["displacement_mm"], curve["base_shear_kN"], lw=1, label=name)
        picture = os.path.join(own, "cracks.png")
        shutil.copy(picture, os.path.join(HERE, case, f"cracks_{name}.png"))
    axes.set_xlim(0)
    axes.set_ylim(0)
    axes.set_xlabel("displacement at the top of the masonry [mm]")
    axes.set_ylabel("base shear [kN]")
    axes.grid(alpha=0.3)
    axes.legend()
    save(figure, case, "curve.png")


def paths(case):
    """Print the numbers of the couplets: a row a path and number, a column a block model."""
    runs, rows = readCase(case), []
    for name in runs:
        path, _, blocks = name.rpartition("-")
        if blocks == "rigid":
            pair = [measure(folder(case, f"{path}-{blocks}")) for blocks in STYLES]
            for number, limits in runs[name]["limits"].items():
                digits = ".0e" if number == "balance_error" else ".5g"
                cells = [format(found[number], digits) for found in pair]
                rows.append([path, f"`{number}`", _interval(*limits), *cells])
    print(studies.table(["path", "number", "limits", *STYLES], rows))


def couplet(case):
    """curves.png: the four paths, both block models, over the closed forms of a joint alone:
    yade_plugin/law/README.md."""
    paths(case)
    kn, ks, ft, cp, mu = 3.352e11, 1.445e11, 0.1e6, 0.11e6, 0.43
    GfI, GfII = 16 - ft**2 / (2 * kn), 160 - cp**2 / (2 * ks)  # after the peak
    fcp, fel, fcr, Gc = 7.55e6, 0.3 * 7.55e6, 0.2 * 7.55e6, 15000
    ucp, uel, fcm = 68.5 * fcp / kn, fel / kn, 0.5 * (fcp + fcr)
    kappa, xi = ucp * fcp, ucp * fcr
    m = Gc - fcp**2 / (18 * kn) - 0.65 * (ucp - uel) * fcp + 0.75 * kappa + 0.25 * xi
    ucm = m / (kappa + xi) * ucp
    alpha = 2 * (fcm - fcp) / (ucm - ucp)
    figure, axes = plt.subplots(2, 2, figsize=(10, 7.5))
    (opening, shear), (closure, cap) = axes
    closed = dict(color="black", lw=3, alpha=0.25)

    u = np.linspace(0, 1e-3, 500)
    opening.plot(1e3 * u, 1e-6 * ft * np.exp(-ft / GfI * u), **closed)
    s = np.linspace(0, 60e-3, 500)
    for sigma in (-0.1e6, -0.5e6, -1.0e6):
        peak = cp - mu * sigma
        above = cp * np.exp(-(cp**2) / (GfII * peak) * s)
        shear.plot(1e3 * s, 1e-6 * (above - mu * sigma), **closed)
    u = np.linspace(0, 4e-3, 1000)
    x = np.clip((u - uel) / (ucp - uel), 0, 1)
    rising = np.minimum(kn * u, fel + (fcp - fel) * np.sqrt(2 * x - x**2))
    falling = fcp + (fcm - fcp) * ((u - ucp) / (ucm - ucp)) ** 2
    tail = np.exp(np.minimum(0, alpha * (u - ucm) / (fcm - fcr)))
    last = fcr + (fcm - fcr) * tail
    strength = np.where(u < ucp, rising, np.where(u < ucm, falling, last))
    closure.plot(1e3 * u, 1e-6 * strength, **closed, label="closed form")
    sigma = np.linspace(-fcp, 0, 500)
    cap.plot(1e-6 * sigma, 1e-6 * np.sqrt((fcp**2 - sigma**2) / 9), **closed)
    cap.plot(1e-6 * sigma, 1e-6 * (cp - mu * sigma), **closed)

    for blocks, style in STYLES.items():
        line = dict(ls=style, lw=1.2, color="tab:red" if style == "-" else "tab:blue")
        read = lambda run: readCurve(folder(case, f"{run}-{blocks}"))
        path = read("opening")
        opening.plot(path["opening_mm"], path["normal_stress_MPa"], **line)
        for stress in ("0.1", "0.5", "1.0"):
            path = read("shear-" + stress)
            shear.plot(path["slide_mm"], path["shear_stress_MPa"], **line)
        path = {k: np.array(v) for k, v in read("closure").items()}
        closure.plot(-path["opening_mm"], -path["normal_stress_MPa"], **line, label=blocks)
        path = read("closure-shear")
        cap.plot(path["normal_stress_MPa"], path["shear_stress_MPa"], **line)
    for axis, title, x, y in (
        (opening, "opening", "opening [mm]", "normal stress [MPa]"),
        (shear, "shear at −0.1, −0.5, −1 MPa", "slide [mm]", "shear stress [MPa]"),
        (closure, "closure", "closure [mm]", "compressive stress [MPa]"),
        (cap, "closure, then shear", "normal stress [MPa]", "shear stress [MPa]"),
    ):
        axis.set(title=title, xlabel=x, ylabel=y)
        axis.grid(alpha=0.3)
    opening.set_xlim(-0.02, 1)
    closure.legend()
    save(figure, case, "curves.png")


if __name__ == "__main__":
    case = sys.argv[1]
    couplet(case) if case == "couplet" else wall(case)
