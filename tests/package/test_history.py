# SPDX-License-Identifier: GPL-2.0-or-later
"""Displacement histories: what the option may say, what is refused, and where the drive brakes."""

from usual import *
import hashlib
import itertools
from masonry.scene import history, options
from masonry.scene.history import PathPoint

amplitude = some.floats(history.MIN_AMPLITUDE, history.MAX_DISPLACEMENT)
piece = some.tuples(amplitude, some.integers(1, 20))
pieces = some.lists(piece, min_size=1, max_size=8)


def parse(*words):
    return options.parser("a wall", until=12).parse_args(words)


def test_an_amplitude_is_a_cycle_to_either_side_and_back():
    found = history.parse("1,2x3,4")
    twice = [2, -2, 0]
    assert found["points_mm"] == [1, -1, 0, *twice, *twice, *twice, 4, -4, 0]
    assert found["amplitudes_mm"] == [[1, 1], [2, 3], [4, 1]]
    assert history.describe(found) == {
        "text": "1,2x3,4",
        "amplitudes_mm": [[1, 1], [2, 3], [4, 1]],
        "points": 15,
        "turning_points": 10,
        "path_mm": 4 * (1 + 3 * 2 + 4),
        "noise_mm": 0.015,
    }


@given(pieces)
def test_any_list_of_amplitudes_is_read_as_it_was_written(wanted):
    text = ",".join(f"{a!r}x{n}" if n > 1 else f" {a!r}" for a, n in wanted)
    found = history.parse(text)
    assert found["amplitudes_mm"] == [[a, n] for a, n in wanted]
    points, cycles = found["points_mm"], sum(n for _, n in wanted)
    assert len(points) == 3 * cycles and points[-1] == 0
    assert max(points) == -min(points) == max(a for a, _ in wanted)
    assert history.turns(points) == 2 * cycles
    assert json.loads(json.dumps(found)) == found


@given(some.text("0123456789.,x+-einfa ", max_size=30))
@settings(max_examples=500)
def test_any_text_is_refused_in_words_or_is_a_history(text):
    try:
        found = history.parse(text)
    except ValueError as refused:
        message = str(refused)
        assert message.startswith(("'", "must be amplitudes in mm")) or "cycles" in message
        assert all(piece in text for piece in message.split("'")[1::2])
    else:
        assert all(map(math.isfinite, found["points_mm"]))
        assert history.pathLength(found["points_mm"]) >= 4 * history.MIN_AMPLITUDE


@mark.parametrize(
    "text, messages",
    [
        ("", ["must be amplitudes in mm such as 1,2x3,4, or the path of a CSV file"]),
        ("1,,2", ["'' is no amplitude in mm such as 2 or 2x3"]),
        ("1,x3,two", ["'x3' is no amplitude", "'two' is no amplitude"]),
        ("2x0,2x1.5,1x", ["'2x0': the number of cycles must be a whole", "'1x'"]),
        ("-1,nan", ["'-1': the amplitude must be from 0.02 to 1000 mm", "'nan'"]),
        ("1x9000,2x2000", ["11000 cycles are more than 10000"]),
        ("loops", ["'loops' is no amplitude in mm such as 2 or 2x3, and no file has"]),
        ("nowhere.csv", ["cannot read nowhere.csv: No such file"]),
    ],
)
def test_wrong_pieces_are_reported_at_once(capsys, text, messages):
    with raises(SystemExit) as refused:
        parse("--history", text)
    assert refused.value.code == 2
    error = capsys.readouterr().err
    assert all(message in error for message in messages)
    assert error.count("argument --history: ") == 1


def test_a_history_takes_the_place_of_until(capsys):
    assert parse().history is None and parse().until == 12
    args = parse("--history", "2")
    assert args.until is None and args.history["points_mm"] == [2, -2, 0]
    with raises(SystemExit):
        parse("--history", "2", "--until", "3")
    assert "not allowed with argument" in capsys.readouterr().err
    with raises(SystemExit):
        options.parser("two bricks", until=2, loops=False).parse_args(["--history", "2"])
    assert "unrecognized arguments: --history" in capsys.readouterr().err


def test_a_file_gives_its_displacements_and_leaves_other_columns_alone(tmp_path):
    path = tmp_path / "measured.csv"
    data = (
        "\ufeff# of test 5\r\ntime_s, displacement_mm ,note\r\n0,0,a\r\n1,0.5,\r\n\r\n2,-1e0,x\r\n"
    )
    path.write_bytes(data.encode())
    found = parse("--history", str(path)).history
    assert found["points_mm"] == [0, 0.5, -1]
    assert found["file"] == str(path)
    assert found["sha256"] == hashlib.sha256(data.encode()).hexdigest()
    report = history.describe(found)
    assert (report["points"], report["turning_points"], report["path_mm"]) == (3, 1, 2)
    assert "points_mm" not in report
    assert report["noise_mm"] == 0.015
    assert history.noise(dict(found, points_mm=[0, -40, 3])) == 0.4  # 1 % of 40 mm


@mark.parametrize(
    "content, message",
    [
        ("", "must name one column displacement_mm, it has no names"),
        ("a,b\n1,2\n", "must name one column displacement_mm, it has a, b"),
        ("displacement_mm,displacement_mm\n1,2\n", "must name one column"),
        ("displacement_mm\n1\n", "it has 1 displacements, a history needs two"),
        ("displacement_mm\n1\n\ntwo\n3\n[mm]\n", "line 4: 'two' is not a number; "),
        ("a,displacement_mm\n1,2\n3\n4,5\n", "line 3: '' is not a number"),
        ("displacement_mm\n1\nnan\n", "line 3: 'nan' is not a finite number"),
        ("displacement_mm\n1\n2e3\n", "line 3: 2e3 mm must be"),
        ("displacement_mm\n0\n0.01\n", "no displacement is 0.02 mm or more"),
        ('displacement_mm\n1\n"2\n', "line 3: '\"2' is not a number"),
        ("displacement_mm\n1\n1_0\n", "line 3: '1_0' is not a number"),
        (b"displacement_mm\n\xff\n", "line 2: 'ÿ' is not a number"),
        (b"displacement_mm\n1\n\x00\n", "it is no text"),
    ],
)
def test_a_file_that_is_no_history_is_refused(tmp_path, content, message):
    path = tmp_path / "h.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with raises(ValueError) as refused:
        history.parse(str(path))
    assert message in str(refused.value) and str(path) in str(refused.value)
    assert len(str(refused.value).splitlines()) == 1


def test_no_more_than_ten_problems_of_a_file_are_reported(tmp_path):
    path = tmp_path / "h.csv"
    path.write_text("displacement_mm\n" + "x\n" * 5000)
    with raises(ValueError, match="line 11: 'x' is not a number; and 4990 more"):
        history.parse(str(path))


def test_the_drive_brakes_where_it_turns_and_passes_the_rest():
    points = [1, -1, 0, 2, -2, 0]
    ways, brakes = [1, -1, 1, 1, -1, 1], [1, -1, 2, 2, -2, None]
    expected = [PathPoint(*three) for three in zip(points, ways, brakes)]
    assert history.targets(points) == expected
    ends = [(1, 1, 2), (2, 1, 2), (2, 1, 2), (1.5, -1, 1.5)]
    assert history.targets([1, 2, 2, 1.5], True) == [PathPoint(*three) for three in ends]


@given(some.lists(some.integers(-2, 2).map(float), min_size=1, max_size=30))
def test_the_drive_brakes_for_the_next_extreme_on_its_way(points):
    found = history.targets(points, stops=True)
    assert [t.displacement for t in found] == points
    for n, target in enumerate(found):
        isSame = lambda other: other.direction == target.direction
        last = [*itertools.takewhile(isSame, found[n:])][-1]
        assert target.brake == last.displacement
        assert target.direction * (target.brake - target.displacement) >= 0


@given(pieces, pieces)
def test_a_history_is_extended_only_by_appending(old, more):
    write = lambda wanted: ",".join(f"{a!r}x{n}" for a, n in wanted)
    first, longer = history.parse(write(old)), history.parse(write(old + more))
    assert history.extends(longer, first) and history.extends(first, first)
    assert not history.extends(first, longer)
    amplitude = old[-1][0]
    other = amplitude / 2 if amplitude > 1 else 2 * amplitude
    changed = history.parse(write([*old[:-1], (other, old[-1][1]), *more]))
    assert not history.extends(changed, first)
