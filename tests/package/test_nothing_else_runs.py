# SPDX-License-Identifier: GPL-2.0-or-later
"""Nothing runs that was not asked: files in the present folder, ports of YADE, and what apt-get
would remove."""

from usual import *

#: Modules of Python and of other libraries that the package reads.
PLANTED = "csv token json glob struct zlib base64 numpy matplotlib argparse yade".split()


@pytest.fixture
def planted(tmp_path):
    """A folder whose modules say that they were run."""
    for name in PLANTED:
        (tmp_path / f"{name}.py").write_text("open('ran', 'a').write(__name__)\n")
    return tmp_path


@mark.parametrize(
    "words",
    [
        "masonry_view.measure nowhere",
        "masonry_view.figures nowhere",
        "masonry_view.report nowhere",
        "masonry_study nowhere.py --out out",
    ],
)
def test_programs_of_the_package_run_nothing_of_the_present_folder(planted, words):
    module, *more = words.split()
    command = [sys.executable, "-m", module, *more]
    done = ran(command, cwd=planted)
    assert done.returncode == 2 and "nowhere" in done.stderr
    assert not (planted / "ran").exists()


def test_figures_are_drawn_with_nothing_of_the_present_folder(planted, monkeypatch):
    from masonry.run.drawing_program import DrawingProgram

    monkeypatch.chdir(planted)
    failures = DrawingProgram().draw("nowhere")
    assert failures and all("nowhere" in note for note, _ in failures)
    assert not (planted / "ran").exists()


#: Prints the addresses on which this process listens, before and after the import.
PORTS = """
import os, sys
def listens():
    paths = [f'/proc/self/fd/{n}' for n in os.listdir('/proc/self/fd')]
    own = {os.readlink(path)[8:-1] for path in paths if os.path.lexists(path)}
    lines = [l.split() for f in ('tcp', 'tcp6') for l in open(f'/proc/net/{f}').readlines()[1:]]
    return [l[1] for l in lines if l[3] == '0A' and l[9] in own]
print('before', len(listens()))
import masonry
print('after', len(listens()))
import yade.remote
yade.remote.runServers()
print('again', len(listens()))
masonry.model.ports.close()
print('closed', len(listens()), 'planted', os.path.exists('ran'))
"""


def test_the_import_closes_the_ports_that_yade_opens(planted):
    (planted / "p.py").write_text(PORTS)
    done = runProgram("p.py", cwd=planted, check=False)
    for line in ("before 2", "after 0", "again 2", "closed 0 planted False"):
        assert line in done.stdout, done.stdout + done.stderr


#: Stands in for apt-get and dpkg-query: nothing of this machine is asked or changed.
APT = """#!/bin/bash
echo "$@" >> "$LOG"
[[ " $* " == *" --simulate "* ]] && echo "Inst python3-vtk9 (9.1)" && echo "Remv $REMOVED [5.11]"
[[ "$*" == update || " $* " == *" --simulate "* ]]
"""


@mark.skipif(os.geteuid() != 0, reason="only root installs packages")
@mark.parametrize("removed", ["python3-paraview", ""])
def test_an_installation_that_would_remove_packages_is_refused(tmp_path, removed):
    (tmp_path / "bin").mkdir()
    for name, text in {"apt-get": APT, "dpkg-query": "#!/bin/sh\nexit 1\n"}.items():
        program = tmp_path / "bin" / name
        program.write_text(text if removed else text.replace('echo "Remv', ': "'))
        program.chmod(0o755)
    (tmp_path / "logs").mkdir()
    env = dict(
        os.environ,
        PATH=f"{tmp_path}/bin:/usr/bin:/bin",
        REMOVED=removed,
        LOG=str(tmp_path / "asked"),
        TMPDIR=str(tmp_path / "logs"),
    )
    setup = os.path.join(ROOT, "scripts", "setup.sh")
    done = ran(["bash", setup], env=env)
    assert done.returncode == 100  # tells "no packages" from a plugin that cannot be built
    asked = (tmp_path / "asked").read_text().splitlines()
    assert asked[0] == "update" and "--simulate" in asked[1]
    if removed:
        assert "apt-get would remove python3-paraview. Nothing was changed" in done.stderr
        assert len(asked) == 2
    else:  # the stand-in refuses to install
        assert len(asked) == 3 and "--no-remove" in asked[2]
    assert os.listdir(tmp_path / "logs") == []
