# SPDX-License-Identifier: GPL-2.0-or-later
"""Studies as their user runs them, what they leave, and figures that are not saved."""

from usual import *
from masonry.numbers import drawing

HERE = os.path.dirname(os.path.abspath(__file__))
COMMAND = [sys.executable, "-m", "masonry_study"]
ROW = [sys.executable, "-P", "-m", "masonry_study.row"]


def run(*words, **settings):
    words = [*map(str, words)]
    return subprocess.run(words, capture_output=True, text=True, **settings)


def study(*words, **settings):
    return run(*COMMAND, *words, **settings)


def start(*words):
    pipes = dict(stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return subprocess.Popen([*COMMAND, *map(str, words)], **pipes)


def wait(found, seconds):
    end = time.monotonic() + seconds
    while not found():
        assert time.monotonic() < end
        time.sleep(0.05)


def done(*words, **settings):
    """What a study said that ended well."""
    process = study(*words, **settings)
    assert process.returncode == 0, process.stdout + process.stderr
    return process.stdout


def read(out, name="study.csv"):
    return (out / name).read_bytes()


def table(out, name="study.csv"):
    """The rows of a table."""
    return [*csv.DictReader(read(out, name).decode().splitlines())]


def ended(out):
    """The rows that came to their end, in turn, as their scene wrote them."""
    return (out / "ended.txt").read_text().split()


@pytest.fixture
def drawn(monkeypatch):
    """Figures that would be saved, by the name of their file."""
    found = {}
    save = lambda figure, path, dpi: found.update({os.path.basename(path): figure})
    monkeypatch.setattr(drawing, "save", save)
    return found


@pytest.fixture
def slurm():
    """The environment of a cluster of three tasks."""
    import cluster

    if cluster.missing():
        pytest.skip("slurm-wlm and munge are not installed")
    with cluster.cluster(tasks=4) as env:
        yield env
