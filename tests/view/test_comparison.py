# SPDX-License-Identifier: GPL-2.0-or-later
"""Curves over each other, and rows for yade.plot."""

from usual import *
from masonry_view import comparison
from masonry.numbers import drawing
from made_runs import axis, writeRun

FIGURE = {"x": axis("u_mm", "moved [mm]"), "y": [axis("f_kN")], "y_label": "force [kN]"}


@pytest.fixture
def drawn(monkeypatch):
    found = []
    monkeypatch.setattr(drawing, "save", lambda figure, *_: found.append(figure))
    return found


def lines(figure):
    found = {line.get_label(): line for line in figure.axes[0].lines}
    return {name: line.get_xydata() for name, line in found.items() if name[0] != "_"}


def test_runs_and_measured_curves_lie_over_each_other(tmp_path, drawn):
    loop = np.array([(0, 0), (2, 5), (-2, -5), (0, 0)])
    writeRun(tmp_path / "one" / "out", ["u_mm", "f_kN"], loop, figure=FIGURE)
    writeRun(tmp_path / "two" / "out", ["f_kN", "u_mm"], loop[:2, ::-1], figure=FIGURE)
    test = tmp_path / "test.csv"
    test.write_text("# a test\nstep;d;F\n1;0;0\n2;1.5;4\n3;;\n4;3;2\n")
    folders = [str(tmp_path / name / "out") for name in ("one", "two")]
    path = str(tmp_path / "p.png")
    measured = [f"{test}:d:F", f"{test}:2:1"]
    assert comparison.compare(folders, measured, labels=["first"], out=path) == path
    (figure,) = drawn
    shown = lines(figure)
    assert set(shown) == {"first", "two/out", "test.csv, F", "test.csv, 1"}
    assert shown["first"] == approx(loop)
    assert shown["two/out"] == approx(loop[:2])
    assert shown["test.csv, F"] == approx(np.array([(0, 0), (1.5, 4), (3, 2)]))
    assert shown["test.csv, 1"][:, 1] == approx([1, 2, 4])
    axes = figure.axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("moved [mm]", "force [kN]")
    assert axes.get_ylim()[0] < -5


def test_curves_have_the_axes_of_engineers(tmp_path, drawn):
    """3 and 6 mm over 2 m are 0.15 and 0.3 %; 10 kN over 40 kN, which are there when the push
    begins, are 0.25."""
    heads = ["displacement_mm", "base_shear_kN", "base_N_kN", "time_s"]
    push = {"stage": "push", "first_row": 1, "load": ["push", "top along x", ""]}
    rows = [(0, 0, -1, 0), (0, 0, -40, 1), (3, 10, -41, 2), (6, 8, -42, 3)]
    entries = dict(stages=[{"stage": "settle", "first_row": 0}, push], figure=FIGURE)
    folder = writeRun(tmp_path / "run", heads, rows, drift_height_m=2.0, **entries)
    for x, label, values in (
        ("drift_percent", "drift [%]", [0, 0, 0.15, 0.3]),
        ("displacement_over_height", "displacement over height [-]", [0, 0, 1.5e-3, 3e-3]),
    ):
        out = str(tmp_path / "p.png")
        comparison.main([folder, "--x", x, "--y", "force_over_weight", "--out", out])
        axes = drawn.pop().axes[0]
        assert (axes.get_xlabel(), axes.get_ylabel()) == (label, "force over weight [-]")
        assert axes.lines[0].get_xdata() == approx(values)
        assert axes.lines[0].get_ydata() == approx([0, 0, 0.25, 0.2])
    folder = writeRun(tmp_path / "other", heads[:2], [(0, 0), (1, 2)], figure=FIGURE)
    for name, message in (("drift_percent", "drift_height_m"), ("force_over_weight", "base_N_kN")):
        with raises(Refused, match=message):
            comparison.compare([folder], x=name, y=name)


def test_two_runs_stand_in_one_table_with_their_changes(tmp_path, drawn, capsys):
    """The peak grows from 10 to 15 kN, by 50 %, and a tie that only the second run has, has no
    change."""
    heads = ["displacement_mm", "base_shear_kN", "top_shear_kN", "time_s"]
    push = {"stage": "push", "first_row": 0, "load": ["push", "top along x", ""]}
    said = lambda name, value: {"stage": "grow", "name": name, "unit": "kN", "value": value}
    folders = []
    for name, force, answers in (
        ("before", 10, [said("factor_held", 4.0)]),
        ("after", 15, [said("factor_held", 5.0), said("tie_force", 2.0)]),
    ):
        rows = [(0, 0, 0, 0), (1, force, force, 1), (2, 5, 5, 2)]
        entries = dict(stages=[push], figure=FIGURE, answers=answers)
        entries["peak_base_shear_kN"] = force
        folders.append(writeRun(tmp_path / name, heads, rows, **entries))
    table, out = tmp_path / "t.csv", str(tmp_path / "p.png")
    axes = ["--x", heads[0], "--y", heads[1]]
    assert comparison.main([*folders, *axes, "--out", out, "--table", str(table)]) == 0
    with open(table, newline="") as file:
        head, *rows = csv.reader(file)
    assert head == ["number", "unit", "before", "after", "after change %"]
    found = {row[0]: row[1:] for row in rows}
    assert found["grow: factor held"] == ["kN", "4", "5", "25"]
    assert found["grow: tie force"] == ["kN", "", "2", ""]
    assert ["kN", "10", "15", "50"] in found.values()
    assert "grow: factor held" in capsys.readouterr().out
    assert comparison.main([folders[0], *axes, "--out", out, "--table", str(table)]) == 2


@mark.parametrize(
    "text, x, y",
    [
        ("d;F\n0,0;0,0\n0,5;10,2\n1,0;15,3\n", [0, 0.5, 1], [0, 10.2, 15.3]),
        ("d,F\n0,0\n1,5\nNaN,NaN\n-1,-5\n", [0, 1, -1], [0, 5, -5]),
        (
            "Test unit,WS1\nReference,Somebody (2009)\nd,F\n[mm],[kN]\n"
            "0,0\n1.2,25\nNaN,NaN\n-1.1,2\n",
            [0, 1.2, -1.1],
            [0, 25, 2],
        ),
    ],
)
def test_measured_curves_as_people_have_them(tmp_path, text, x, y):
    (tmp_path / "test.csv").write_text(text)
    found = comparison.readMeasured(f"{tmp_path / 'test.csv'}:d:F")
    assert (found[0].tolist(), found[1].tolist(), found[2]) == (x, y, ["d", "F"])


@mark.parametrize("peak, warned", [(50.9, False), (-51.1, True)])
def test_a_test_that_carries_more_than_its_vertical_load_can_give(
    tmp_path, drawn, capsys, peak, warned
):
    # N L/(2 H0) = 100 * 1 / (2 * 1) = 50 kN, with H0 = M/V = 40/40
    columns = ["u_mm", "base_shear_kN", "base_N_kN", "base_V_x_kN", "base_M_y_kNm"]
    rows = [[0, 0, -100, 0, 0], [1, 40, -100, 40, 40], [2, 30, -100, 30, 60]]
    figure = {**FIGURE, "y": [axis("base_shear_kN")]}
    run = writeRun(tmp_path / "r", columns, rows, figure=figure, wall={"length_m": 1.0})
    (tmp_path / "t.csv").write_text(f"d,F\n0,0\n1,{peak}\n")
    comparison.compare([run], [f"{tmp_path}/t.csv:d:F"], out="p.png")
    printed = capsys.readouterr().out
    assert ("at most N L/(2 H0) = 50 kN" in printed) == warned


def test_columns_of_older_runs_can_be_named(tmp_path, drawn):
    folder = writeRun(tmp_path, ["time_s", "top_mm"], [[0, 1], [1, -2]])
    with raises(Refused, match="name the columns by --x and --y"):
        comparison.compare([folder], out="p.png")
    comparison.compare([folder], x="time_s", y="top_mm", out="p.png")
    assert drawn[0].axes[0].get_ylabel() == "top [mm]"


@mark.parametrize(
    "words, message",
    [
        (["--csv", "t.csv"], "'t.csv' must be FILE:X:Y"),
        (["--csv", "nowhere.csv:1:2"], "cannot read nowhere.csv: No such file"),
        (["--csv", "t.csv:a:c"], "t.csv: there is no column c, there are a, b"),
        (["--csv", "t.csv:1:3"], "t.csv: there is no column 3"),
        (["--csv", "bad.csv:a:b"], "bad.csv, line 3: 'x' is not a number"),
        (["--csv", "nan.csv:a:b"], "nan.csv: fewer than two rows have both columns"),
        (["--csv", "t.csv:a:b", "--out", "p.bmp"], "p.bmp must end in .png"),
        (["--csv", "t.csv:a:b", "--label", "1", "--label", "2"], "2 labels for 1 curves"),
        (["--csv", "t.csv:a:b", "--out", "no/p.png"], "cannot write no/p.png: No such"),
        (["nowhere"], "cannot read nowhere/curve.csv: No such file"),
        ([], "name one folder of results at least"),
        (["run", "--x", "v"], "curve.csv has no column v, it has u_mm, f_kN"),
    ],
)
def test_what_cannot_be_drawn_is_refused(tmp_path, monkeypatch, capsys, words, message):
    monkeypatch.chdir(tmp_path)
    writeRun("run", ["u_mm", "f_kN"], [[0, 0], [1, 1]], figure=FIGURE)
    for name, last in (("t", "2,3"), ("bad", "2,x"), ("nan", "2,nan")):
        (tmp_path / f"{name}.csv").write_text(f"a,b\n1,2\n{last}\n")
    assert comparison.main(words) == 2
    assert message in capsys.readouterr().err


def test_a_picture_is_written(tmp_path, capsys):
    folder = writeRun(tmp_path, ["u_mm", "f_kN"], [[0, 0], [1, 1]], figure=FIGURE)
    for name, start in (("p.png", b"\x89PNG"), ("p.pdf", b"%PDF")):
        assert comparison.main([folder, "--out", str(tmp_path / name)]) == 0
        assert (tmp_path / name).read_bytes().startswith(start)


@pytest.fixture
def plot():
    from yade import plot

    plot.reset()
    yield plot
    plot.reset()


def test_yade_plot_is_filled_if_the_user_asks(plot, monkeypatch):
    from masonry.run.readings import Readings, plotted

    columns = ["time_s", "u_mm", "f_kN"]
    assert plotted(columns) is None
    plot.plots = {"x": ("u_mm",), "picture": None}
    assert plotted(columns) is None
    for plots in ({"u_mm": None}, {" time_s ": ("y", None, ("f_kN", "r-"))}):
        plot.plots = plots
        assert plotted(columns) is plot
    results = SimpleNamespace(columns=columns, append=lambda rows: None)
    readings = Readings([], results)
    readings.waiting = [[0, 1, 2]]
    readings.write()
    plot.addData(mine=7)  # what the user adds beside
    readings.waiting = [(1, 2, 3), (2, 3, 4)]
    readings.write()
    nan = approx(float("nan"), nan_ok=True)
    assert plot.data["u_mm"] == [1, nan, 2, 3] and plot.data["f_kN"] == [2, nan, 3, 4]
    assert plot.data["mine"] == [nan, 7, nan, nan]
    monkeypatch.delitem(sys.modules, "yade.plot")
    assert plotted(columns) is None
