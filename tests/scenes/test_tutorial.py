# SPDX-License-Identifier: GPL-2.0-or-later
"""The tutorial: its three notebooks run from top to bottom, and so does every command that they
name."""

from usual import *
import base64


TUTORIAL = os.path.join(ROOT, "scripts", "docs", "tutorial")
NOTEBOOKS = ["1_first_joint.ipynb", "2_wall.ipynb", "3_structures.ipynb"]
LARGEST = 150_000  # bytes of what a cell shows


def read(path):
    with open(path, encoding="utf-8") as f:
        return json.load(f)


def cells(name, kind):
    found = read(os.path.join(TUTORIAL, name))["cells"]
    return ["".join(c["source"]) for c in found if c["cell_type"] == kind]


def test_the_tutorial_is_these_notebooks_without_outputs():
    assert sorted(n for n in os.listdir(TUTORIAL) if n.endswith(".ipynb")) == NOTEBOOKS
    for name in NOTEBOOKS:
        notebook = read(os.path.join(TUTORIAL, name))
        assert notebook["nbformat"] == 4
        assert notebook["metadata"]["kernelspec"]["name"] == "python3"
        for cell in notebook["cells"]:
            assert not cell.get("outputs") and cell.get("execution_count") is None


@mark.parametrize("name", NOTEBOOKS)
def test_a_notebook_runs_from_top_to_bottom(tmp_path, name):
    pytest.importorskip("nbconvert", reason="jupyter-nbconvert is not installed")
    pytest.importorskip("ipykernel", reason="python3-ipykernel is not installed")
    shutil.copy(os.path.join(TUTORIAL, name), tmp_path)
    words = "--to notebook --execute --inplace --ExecutePreprocessor.kernel_name=python3"
    command = [sys.executable, "-m", "nbconvert", *words.split(), name]
    settings = dict(capture_output=True, text=True, timeout=300)
    run = subprocess.run(command, cwd=tmp_path, **settings)
    assert run.returncode == 0, run.stderr[-5000:]
    outputs = [o for c in read(tmp_path / name)["cells"] for o in c.get("outputs", [])]
    pictures = []
    for output in outputs:
        assert output["output_type"] != "error", output
        assert len(json.dumps(output)) < LARGEST, output
        data = output.get("data", {})
        pictures += re.findall(r'base64,([^"]+)"', "".join(data.get("text/html", "")))
        pictures += ["".join(data["image/png"])] if "image/png" in data else []
    assert all(base64.b64decode(p).startswith(b"\x89PNG") for p in pictures)
    assert len(outputs) >= 10 and len(pictures) >= 5
    assert len(os.listdir(tmp_path / "results")) >= 3


def test_every_command_of_the_tutorial(tmp_path):
    for name in ("scripts", "validation"):
        os.symlink(os.path.join(ROOT, name), tmp_path / name)
    texts = "\n".join(text for name in NOTEBOOKS for text in cells(name, "markdown"))
    commands = re.findall(r"(?m)^    ((?:yade|/usr/bin/python3) \S.*)$", texts)
    assert len(commands) == 5
    for command in commands:
        if "view.py" in command:  # tests/view/test_view.py has ParaView
            continue
        words = dict(shell=True, capture_output=True, text=True, timeout=280)
        run = subprocess.run(command, cwd=tmp_path, **words)
        assert run.returncode == 0, command + run.stdout + run.stderr
        assert "rror" not in run.stderr, command + run.stderr
    assert (tmp_path / "results" / "both.png").exists()
