# SPDX-License-Identifier: GPL-2.0-or-later
"""The Debian package that ``scripts/package.sh`` makes: what is in it, and that a wall runs with
it."""

from usual import *
import glob

import masonry

pytestmark = [mark.long, mark.xdist_group("deb")]  # one worker makes the package


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """The fields of the package, the folder in which its modules are unpacked, and the files."""
    env = {**os.environ, "DEB_BUILD_OPTIONS": "nocheck"}
    subprocess.run(["bash", "scripts/package.sh"], cwd=ROOT, env=env, check=True, timeout=1500)
    files = glob.glob(os.path.join(glob.escape(ROOT), "build", "package", "*.d[es][bc]"))
    (path,) = (path for path in files if path.endswith(".deb"))
    out = tmp_path_factory.mktemp("unpacked")
    subprocess.run(["dpkg-deb", "-x", path, out], check=True)
    said = ran(["dpkg-deb", "-f", path], check=True)
    fields = dict(line.split(": ", 1) for line in said.stdout.splitlines() if ": " in line)
    return fields, out / "usr" / "lib" / "python3" / "dist-packages", files


def test_the_package_is_of_this_version_and_has_each_file(package):
    fields, modules, _ = package
    assert fields["Version"].startswith(masonry.__version__ + "+")
    assert "python3-jinja2" in fields["Depends"] and "yade (= " in fields["Depends"]
    sources = os.path.join(ROOT, "scripts")
    kept = [
        os.path.relpath(path, sources)
        for path in glob.glob(f"{glob.escape(sources)}/masonry*/**/*", recursive=True)
        if os.path.isfile(path) and not path.endswith((".md", ".pyc", ".so"))
    ]
    missing = [one for one in kept if not (modules / one).exists()]
    assert len(kept) > 100 and missing == []


def test_lintian_finds_no_error_and_no_warning(package):
    said = ran(["lintian", "--fail-on", "error,warning", *package[2]])
    assert said.returncode == 0, said.stdout + said.stderr


def test_a_wall_runs_with_the_package_and_has_its_report(package, tmp_path):
    _, modules, _ = package
    env = {**os.environ, "PYTHONPATH": str(modules)}
    runProgram("wall_comp4", "--quick", "--out", tmp_path / "r", env=env)
    assert (tmp_path / "r" / "report.html").stat().st_size > 1e5
