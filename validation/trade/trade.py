# SPDX-License-Identifier: GPL-2.0-or-later
"""The price of speed: errors of the four walls against time, one knob at a time, and the presets.

/usr/bin/python3 validation/trade/trade.py [--draw | --time-only] [--jobs N] [--walls WALL ...]

Runs what is missing in results/trade, times what is not timed yet, prints the table and writes
table.md, trade.json and figures beside itself: one a wall, and one of the worst wall. --draw runs
nothing; --time-only measures all times anew, for an idle machine.
"""

import argparse
import glob
import json
import os
import resource
import sys
import time

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from masonry.numbers.curves import dynamicImbalance
from masonry.numbers.cracks import CRACK, layOut
from masonry.numbers.frames import readFrame
from masonry.run.option_table import USUAL, asOption
from masonry.run.presets import PRESETS
from masonry.numbers.files import readCurve, readRun

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import studies
from studies import run, runMissing, table
from scipy.integrate import trapezoid

RESULTS = os.path.join(studies.RESULTS, "trade")

#: Walls and how far they are pushed [mm].
WALLS = {"wall_comp0a": 30, "wall_comp1": 30, "wall_comp4": 12, "wall_comp6": 16}

SOFT = "--blocks deformable"
#: With masses that are scaled as far as the joints allow.
QUICK = f"{SOFT} --mass-scaling auto"


def asOptions(preset):
    """Options of a preset as words, without those that are defaults."""
    return " ".join(
        f"{asOption(name)} {str(value).removesuffix('.0')}"
        for name, value in PRESETS[preset].items()
        if value != USUAL[name]
    )


#: What is varied, and its runs: options of a scene, all others at their defaults.
RUNS = {
    "reference": [f"{QUICK} --divisions 3 --rate 20"],
    "rigid": [""],
    "rigid: rate": [f"--rate {v}" for v in (50, 100, 200)],
    "rigid: points": [f"--points {n}" for n in ("3", "5", "12", "12,12")],
    "rigid: cyclic law": ["--joints cyclic"],
    "rigid: density scaling": ["--density-scaling 25"],
    "rigid: damping": ["--damping 0.4"],
    "rigid: local damping": ["--damping-kind local --rate 50"],
    "rigid: time step": ["--dt-fraction 0.95"],
    "rigid: no crack surfaces": ["--crack-surfaces off"],
    "deformable": [f"{QUICK} --rate 50"],
    "deformable: rate": [f"{QUICK} --rate 100"],
    "deformable: mesh and rate": [f"{QUICK} --divisions 2 --rate {v}" for v in (50, 100)],
    "deformable: true masses": [f"{SOFT} --divisions 2 --rate 50"],
    "deformable: mass scaling": [f"{SOFT} --mass-scaling 5 --divisions 2 --rate 50"],
    **{f"preset {name}": [asOptions(name)] for name in PRESETS},
}

#: Series whose runs are repeated with these time steps, which differ only to see what is chance.
REPEATED = ["rigid", "preset fast"]
AGAIN = (0.78, 0.79)

#: Limit analysis alone: a bound of the peak, without a run.
BOUND = "--preset bound"

#: Patches for the pattern of cracks: half units by courses, 0.22 × 0.24 m.
PATCH = (2, 3)

#: What makes a step cheap or dear, of run.json's options; and the short run that times such a step.
KINDS = (
    "blocks",
    "divisions",
    "points",
    "crack_surfaces",
    "damping_kind",
    "mass_scaling",
)
STRETCH = {"rigid": "--until 3 --rate 50", "deformable": "--until 3 --rate 100"}
THREADS = (1, 2)


def folder(wall, options):
    """Folder of a run; the order of its options does not matter."""
    words = sorted("_".join(word.split()) for word in options.split("--")[1:])
    return os.path.join(RESULTS, wall, "_".join(words) or "default")


def done(wall, options):
    """Whether a run is there and went to its end."""
    return studies.done(folder(wall, options))


def repeats(series):
    """All runs of a series that is repeated: its own and those with other time steps."""
    return RUNS[series] + [f"{o} --dt-fraction {f}" for o in RUNS[series] for f in AGAIN]


def allRuns():
    """Options of all runs, each once, repetitions last."""
    own = [options for series in RUNS.values() for options in series]
    return list(dict.fromkeys(own + [o for s in REPEATED for o in repeats(s)]))


def runAll(walls, jobs):
    """Run what has no results yet; frames of the start and of the end only."""
    words = lambda wall, o: f"--until {WALLS[wall]} --vtk-every 1000 {o}".split()
    runs = [(wall, options) for wall in walls for options in [BOUND, *allRuns()]]
    runMissing([(w, words(w, o), folder(w, o)) for w, o in runs], jobs)


# -- what a run says -------------------------------------------------------------------------------


def pattern(directory):
    """Where a wall is cracked: crack volumes [m³] of its patches.

    The crack volume of a joint is its opening and slide, where that is more than CRACK, times its
    area.
    """
    entry = readRun(directory)["wall"]
    half, thickness, height = entry["unit_m"][0] / 2, *entry["unit_m"][1:]
    bed, upright = layOut(readFrame(directory, "joints"), entry)
    patches = np.zeros((-(-entry["courses"] // PATCH[1]), -(-entry["half_units"] // PATCH[0])))
    for joints, area in ((bed, half * thickness), (upright, height * thickness)):
        moved = joints["opening"] + joints["slide"]
        rows, columns = np.indices(moved.shape)
        place = rows // PATCH[1], columns // PATCH[0]
        np.add.at(patches, place, area * np.where(moved > CRACK, moved, 0))
    return patches


def numbers(wall, options):
    """Peak and force at the end [kN], initial stiffness [kN/mm], work of the push and what joints
    dissipated [J]."""
    directory = folder(wall, options)
    entry, curve = readRun(directory), readCurve(directory)
    lost = [c for name, c in curve.items() if name.startswith("dissipated_")]
    return {
        "peak": entry["peak_base_shear_kN"],
        "work": float(trapezoid(curve["base_shear_kN"], curve["displacement_mm"])),
        "end": entry["base_shear_end_kN"],
        "stiffness": entry["initial_stiffness_kN_per_mm"],
        "dissipated": sum(c[-1] - c[0] for c in lost),
    }


def errors(wall, runs):
    """Signed errors [-] of runs against the mean of the reference runs, a dict of lists.

    ``pattern`` is the share of the crack volume that lies in other patches than those of the first
    reference run: 0 is the same pattern, 1 has nothing in common. ``imbalance`` is the dynamic
    imbalance of run.json.
    """
    references = [numbers(wall, r) for r in RUNS["reference"]]
    mean = {name: np.mean([r[name] for r in references]) for name in references[0]}
    mine = [numbers(wall, r) for r in runs]
    result = {name: [m[name] / mean[name] - 1 for m in mine] for name in mean}
    share = lambda volumes: volumes / max(volumes.sum(), 1e-30)
    aim = share(pattern(folder(wall, RUNS["reference"][0])))
    shares = [share(pattern(folder(wall, r))) for r in runs]
    result["pattern"] = [0.5 * float(np.abs(s - aim).sum()) for s in shares]
    curves = [readCurve(folder(wall, r)) for r in runs]
    result["imbalance"] = [dynamicImbalance(c["top_shear_kN"], c["base_shear_kN"]) for c in curves]
    return result


# -- what a run costs ------------------------------------------------------------------------------


def kind(wall, options):
    """What makes the step of a run as dear as it is: options of a scene that has such steps."""
    chosen = readRun(folder(wall, options))["options"]
    chosen = {name: chosen[name] for name in KINDS if chosen[name] is not None}
    rigid = chosen["blocks"] == "rigid"
    for name in ("divisions", "mass_scaling") if rigid else ("points",):
        chosen.pop(name, None)
    return " ".join(f"{asOption(n)} {v}" for n, v in chosen.items())


def timeOne(wall, kind, threads):
    """Run a short stretch; seconds of a step, a row, a frame, and of all that does not grow with
    the run."""
    out = os.path.join(RESULTS, "times", wall)
    words = STRETCH[kind.split()[1]].split() + kind.split()
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    run(wall, words, out, threads, quiet=True)
    wallClock = time.perf_counter() - began
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    entry, seconds = readRun(out), readRun(out)["seconds"]
    parts = {name: seconds[name] for name in ("steps", "rows", "frames")}
    return {
        "step": parts["steps"] / entry["steps"],
        "row": parts["rows"] / len(readCurve(out)["time_s"]),
        "frame": parts["frames"] / len(glob.glob(os.path.join(out, "joints_*"))),
        "rest": wallClock - sum(parts.values()),
        "cpu": cpu / wallClock,
    }


def timeBound(wall):
    """Wall-clock time [s] of the bound of a wall, as a user starts it."""
    began = time.perf_counter()
    run(wall, BOUND.split(), os.path.join(RESULTS, "times", wall), quiet=True)
    return time.perf_counter() - began


def readTimes():
    path = os.path.join(RESULTS, "times.json")
    if not os.path.exists(path):
        return {}
    with open(path) as f:
        return json.load(f)


def timeAll(walls, anew):
    """Time every distinct step, once with one thread and once with two; those that are known only
    if ``anew``."""
    times = readTimes()

    def keep(key, measure):
        if not anew and key in times:
            return
        print("timing", key, flush=True)
        times[key] = measure()
        with open(os.path.join(RESULTS, "times.json"), "w") as f:
            json.dump(times, f, indent=1)

    for wall in walls:
        keep(f"{wall} {BOUND}", lambda: timeBound(wall))
        kinds = [kind(wall, o) for o in allRuns() if done(wall, o)]
        for one in dict.fromkeys(kinds):
            for threads in THREADS:
                keep(f"{wall} {one} {threads}", lambda: timeOne(wall, one, threads))


def cost(wall, options, threads):
    """Wall-clock time [s] and CPU time [s] of a run as a user starts it, with a frame every
    millimetre.

    A step that was not timed counts as it did in the run itself, on one core of a machine that may
    have been busy.
    """
    entry, curve = readRun(folder(wall, options)), readCurve(folder(wall, options))
    time = readTimes().get(f"{wall} {kind(wall, options)} {threads}")
    if not time:
        return entry["wall_clock_s"], entry["wall_clock_s"]
    spent = entry["steps"] * time["step"] + len(curve["time_s"]) * time["row"]
    spent += time["rest"] + (WALLS[wall] + 2) * time["frame"]
    return spent, spent * time["cpu"]


# -- what comes out --------------------------------------------------------------------------------


def bounds(walls):
    """The bound of the peak of every wall that has one: how far it is above the reference's [-],
    and its time [s]."""
    found, times = {}, readTimes()
    for wall in [w for w in walls if done(w, BOUND)]:
        peak = np.mean([numbers(wall, r)["peak"] for r in RUNS["reference"]])
        run = readRun(folder(wall, BOUND))
        spent = times.get(f"{wall} {BOUND}", run["wall_clock_s"])
        found[wall] = {
            "peak": run["bound_base_shear_kN"] / peak - 1,
            "seconds": spent,
        }
    if len(found) == len(walls) > 1:
        found["all_walls"] = {
            "peak": max(e["peak"] for e in found.values()),
            "seconds": sum(e["seconds"] for e in found.values()),
        }
    return found


ERRORS = ["peak", "work", "end", "stiffness", "dissipated", "pattern", "imbalance"]


def study(walls):
    """Everything that is known, as trade.json has it: list of runs with options, errors, steps and
    times.

    A run that was repeated has the error that is largest in magnitude, and in ``spread`` half the
    range of each.
    """
    again = {RUNS[s][0]: repeats(s) for s in REPEATED}
    found = []
    for wall in walls:
        for title, series in RUNS.items():
            for options in series:
                runs = [r for r in again.get(options, [options]) if done(wall, r)]
                if not done(wall, options):
                    continue
                values = errors(wall, runs)
                seconds = {n: cost(wall, options, n) for n in THREADS}
                found.append(
                    {
                        "wall": wall,
                        "series": title,
                        "options": options,
                        **{name: max(v, key=abs) for name, v in values.items()},
                        "spread": {n: (max(v) - min(v)) / 2 for n, v in values.items()},
                        "repetitions": len(runs),
                        "steps": readRun(folder(wall, options))["steps"],
                        "seconds": {n: round(s[0], 1) for n, s in seconds.items()},
                        "cpu_seconds": {n: round(s[1], 1) for n, s in seconds.items()},
                    }
                )
    return found


def worst(found):
    """Runs that all walls have, as if of one wall: errors that are largest in magnitude, times
    together."""
    walls = {e["wall"] for e in found}
    groups = {}
    for e in found:
        groups.setdefault((e["series"], e["options"]), []).append(e)
    return [
        {
            "wall": "all_walls",
            "series": series,
            "options": options,
            **{name: max((e[name] for e in group), key=abs) for name in ERRORS},
            "seconds": {n: sum(e["seconds"][n] for e in group) for n in THREADS},
        }
        for (series, options), group in groups.items()
        if {e["wall"] for e in group} == walls
    ]


def percent(entry, name):
    """An error in percent as text, with half the range of its repetitions."""
    signed = "" if name in ("pattern", "imbalance") else "+"
    text = format(100 * entry[name], signed + ".1f")
    chance = 100 * entry["spread"][name]
    return text + (f" ± {chance:.1f}" if entry["repetitions"] > 1 else "")


def summary(found):
    """Markdown: a row a run, its errors of peak and work and its time on two cores for every
    wall."""
    walls = list(dict.fromkeys(e["wall"] for e in found))
    heads = ["series", "options"]
    heads += [f"{w[5:]}: peak, work %; s" for w in walls]
    rows = []
    for series in RUNS:
        for options in RUNS[series]:
            cells = [series, f"`{options}`" if options else ""]
            for wall in walls:
                mine = [
                    e
                    for e in found
                    if (e["wall"], e["series"], e["options"]) == (wall, series, options)
                ]
                cells += [
                    f"{percent(e, 'peak')}, {percent(e, 'work')}; {e['seconds'][THREADS[-1]]:.0f}"
                    for e in mine
                ] or [""]
            rows.append(cells)
    return table(heads, rows)


def details(found):
    """Markdown: a row a run of each wall, with everything."""
    heads = ["wall", "series", "options"] + [name + " %" for name in ERRORS]
    timed = bool(readTimes())
    times = ["s, one core", "s, two cores", "CPU s, two cores"]
    heads += ["steps", *(times if timed else ["s, beside another run"])]
    rows = []
    for e in found:
        cells = [
            e["wall"][5:],
            e["series"],
            f"`{e['options']}`" if e["options"] else "",
        ]
        cells += [percent(e, name) for name in ERRORS]
        cells += [f"{e['steps'] / 1000:.0f}k"]
        cells += [f"{e['seconds'][n]:.0f}" for n in (THREADS if timed else THREADS[:1])]
        cells += [f"{e['cpu_seconds'][THREADS[-1]]:.0f}"] if timed else []
        rows.append(cells)
    return table(heads, rows)


FLOOR = 2e-4  # errors below are drawn here
MARKS = {"rigid": ("o", "tab:orange"), "deformable": ("s", "tab:blue")}


def front(points):
    """Of (time, error) points those that no other beats in both, as indices in order of time."""
    best, kept = np.inf, []
    for i in sorted(range(len(points)), key=lambda i: points[i]):
        if points[i][1] < best:
            best = points[i][1]
            kept.append(i)
    return kept


def draw(found, wall, bound):
    """WALL.png: time against the errors of the peak and of the work; the front is numbered, its
    runs listed below.

    :param bound: the wall's entry of :func:`bounds`, or None
    """
    entries = [e for e in found if e["wall"] == wall and e["series"] != "reference"]
    reference = next(e for e in found if e["wall"] == wall and e["series"] == "reference")
    named = list(dict.fromkeys(e["options"] for e in entries))
    entries = [next(e for e in entries if e["options"] == o) for o in named]
    presets = {asOptions(name): name for name in PRESETS}
    label = "time of the run, beside another one [s]"
    if readTimes():
        label = "time on two cores [s]"
    figure, axes = plt.subplots(1, 2, figsize=(10, 5.6), sharex=True, sharey=True)
    listed = []
    for axis, name in zip(axes, ("peak", "work")):
        points = [(e["seconds"][THREADS[-1]], max(FLOOR, min(1, abs(e[name])))) for e in entries]
        for (x, y), e in zip(points, entries):
            soft = SOFT in e["options"]
            mark, color = MARKS["deformable" if soft else "rigid"]
            fine = "--divisions" in e["options"]
            local = "local" in e["options"]
            axis.plot(
                x,
                100 * y,
                "^" if fine else mark,
                color=color,
                mfc="white" if local else color,
                ms=6,
            )
            if e["options"] in presets:
                axis.plot(x, 100 * y, "o", ms=14, mfc="none", color="black")
        if bound and name == "peak":
            axis.plot(bound["seconds"], 100 * bound["peak"], "D", color="tab:green")
        best = front(points)
        axis.step(
            [points[i][0] for i in best],
            [100 * points[i][1] for i in best],
            where="post",
            color="0.6",
            lw=1,
            zorder=0,
        )
        for i in best:
            listed += [] if entries[i]["options"] in listed else [entries[i]["options"]]
        axis.axvline(reference["seconds"][THREADS[-1]], color="0.8", ls="--", zorder=0)
        axis.set(xscale="log", yscale="log", xlabel=label)
        axis.set_title(f"error of the {name} [%]", fontsize=10)
        axis.grid(alpha=0.3, which="both", lw=0.4)
        for i in best:
            axis.annotate(
                str(listed.index(entries[i]["options"]) + 1),
                (points[i][0], 100 * points[i][1]),
                textcoords="offset points",
                xytext=(-7, -12),
                fontsize=8,
            )
    lines = []
    for n, options in enumerate(listed, 1):
        preset = f" = preset {presets[options]}" if options in presets else ""
        lines.append(f"{n}: {options.replace('--', '') or 'all defaults'}{preset}")
    columns = [lines[i::2] for i in range(2)]
    for i, column in enumerate(columns):
        figure.text(0.02 + 0.5 * i, 0.01, "\n".join(column), fontsize=7.5, va="bottom")
    figure.suptitle(
        (
            f"{wall}: circles rigid, squares deformable, triangles with two by two cells; white"
            " with local damping;\nringed presets; diamond the bound; dashed the reference's time"
        ),
        fontsize=9,
    )
    figure.tight_layout(rect=(0, 0.03 * len(columns[0]) + 0.02, 1, 1))
    figure.savefig(os.path.join(HERE, wall + ".png"), dpi=80)
    plt.close(figure)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--walls", nargs="+", choices=list(WALLS), default=list(WALLS))
    arguments.add_argument("--jobs", type=int, default=1, help="runs at a time")
    arguments.add_argument("--draw", action="store_true", help="run nothing")
    arguments.add_argument("--time-only", action="store_true", help="measure times anew")
    args = arguments.parse_args()
    if not args.draw:
        if not args.time_only:
            runAll(args.walls, args.jobs)
        timeAll(args.walls, args.time_only)
    walls = [w for w in args.walls if done(w, RUNS["reference"][0])]
    found, limits = study(walls), bounds(walls)
    with open(os.path.join(HERE, "trade.json"), "w") as f:
        json.dump(found, f, indent=1)
        f.write("\n")
    with open(os.path.join(HERE, "table.md"), "w") as f:
        f.write(f"{summary(found)}\n\n{details(found)}\n")
    print(details(found))
    heads = ["wall", "bound over the reference's peak", "s"]
    of = [[w, f"{e['peak']:+.1%}", f"{e['seconds']:.1f}"] for w, e in limits.items()]
    print(table(heads, of))
    if len(walls) > 1:
        found += worst(found)
    for wall in dict.fromkeys(e["wall"] for e in found):
        draw(found, wall, limits.get(wall))


if __name__ == "__main__":
    main()
