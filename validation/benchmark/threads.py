# SPDX-License-Identifier: GPL-2.0-or-later
"""What a second thread gives, on an idle machine and on a busy one.

/usr/bin/python3 validation/benchmark/threads.py [ROUNDS]

steps walls of some hundred, of 1,224 (TUD-COMP-4) and of 10,000 half bricks, as laid, on one thread
and on two, one after the other, in so many rounds (default 3): first alone, then beside as many
programs that use a core each as there are cores. It prints the mean cost of a step in the median
round and what two threads gain in it, the same gain in the best tenth of a second of all rounds,
which other guests of the machine disturb least, and how much of a step is outside the loops that
threads share. It takes some four minutes. Run it where nothing else runs.
"""

import json
import math
import os
import statistics
import subprocess
import sys
import time

SIZES = {"100 half bricks": (10, 10), "COMP-4": (36, 34), "10,000": (100, 100)}
SECONDS = 2.0  # of steps in each round
WINDOW = 0.1  # of which the quickest counts, too [s]
BUSY = "while True: pass"


def child(halfUnits, courses):
    """Step a wall, in YADE. Prints a line: microseconds a step, those of them outside loops, half
    bricks, share on two."""
    from masonry import Scene, advance, bricks, materials
    from masonry.model import threads
    from yade import O

    words = "--lean --checkpoint-every 0 --out results/benchmark/threads".split()
    wall = bricks.Wall(0.11 * halfUnits, 0.081 * courses)
    run = Scene("threads", wall, materials.calciumSilicate(), arguments=words)
    run.platen("bottom")
    run.press(run.platen("top", drive="x"), 0.5e6)
    run.begin()
    O.dt = 1e-8  # nothing yields
    advance(10)
    count, best, before = 0, math.inf, threads.used()
    began = time.perf_counter()
    while (took := time.perf_counter() - began) < SECONDS:
        first, start = count, time.perf_counter()
        while (passed := time.perf_counter() - start) < WINDOW:
            advance(10)
            count += 10
        best = min(best, 1e6 * passed / (count - first))
    loops = many = 0
    for old, new in zip(before, threads.used()):
        time_ = lambda one: one["steps"] * (one["microseconds_per_step"] or 0)
        loops += time_(new) - time_(old)
        many += (new["steps"] - old["steps"]) * (new["threads"] > 1)
    step = 1e6 * took / count
    result = dict(
        step=step, best=best, outside=step - loops / count, bodies=len(O.bodies), many=many / count
    )
    print("RESULT " + json.dumps(result), flush=True)
    os._exit(0)  # the scene has no end that would be of use


def step(size, threads):
    """Run a wall in a process of its own. Returns what it printed, as a dict."""
    words = [str(n) for n in SIZES[size]]
    command = ["yade", "-n", f"-j{threads}", "-x", os.path.abspath(__file__), *words]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    line = next(x for x in run.stdout.splitlines() if x.startswith("RESULT "))
    return json.loads(line.removeprefix("RESULT "))


def table(rounds):
    """Step all sizes, and print a line for each."""
    for size in SIZES:
        results = [(step(size, 1), step(size, 2)) for _ in range(rounds)]
        one, two = (statistics.median(r[n]["step"] for r in results) for n in (0, 1))
        quickest = [min(r[n]["best"] for r in results) for n in (0, 1)]
        middle = min(results, key=lambda r: abs(r[1]["step"] - two))[1]
        print(
            (
                f"{size:18}{one:10.1f}{two:10.1f}{one / two:8.2f}{quickest[0] / quickest[1]:8.2f}"
                f"{100 * middle['many']:8.0f} %{middle['outside']:10.1f} µs,"
                f" {100 * middle['outside'] / one:.1f} %"
            ),
            flush=True,
        )


def main(rounds):
    cores = os.cpu_count()
    for busy in (0, cores):
        print(f"\n{cores} cores, {busy} of them used by other programs")
        print(
            f"{'':18}{'one, µs':>10}{'two, µs':>10}{'gain':>8}{'best':>8}{'on two':>10}   outside"
            " the loops, of a step on one"
        )
        others = [subprocess.Popen([sys.executable, "-c", BUSY]) for _ in range(busy)]
        try:
            table(rounds)
        finally:
            for other in others:
                other.kill()
                other.wait()


if __name__ == "__main__":
    arguments = [int(word) for word in sys.argv[1:]]
    child(*arguments) if len(arguments) == 2 else main(*arguments or [3])
