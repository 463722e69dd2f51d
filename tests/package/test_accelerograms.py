# SPDX-License-Identifier: GPL-2.0-or-later
"""Records of ground acceleration: the formats that are read, what is refused, and when a record
drifts."""

from usual import *
from masonry.scene import accelerograms
from masonry.scene.accelerograms import drift, read
from masonry.scene.ground import readRecord

sample = some.floats(-30, 30).map(lambda v: float(f"{round(v, 6):.7E}"))
numbers = some.lists(sample, min_size=2, max_size=60)


GOOD = [0.1, 0.2, -0.1, 0.3, 0.1, -0.2]


def peer(
    values, every="DT=   .0050 SEC,", count=None, unit="UNITS OF G", what="TIME SERIES", columns=5
):
    head = ["PEER NGA STRONG MOTION DATABASE RECORD", "Nowhere-01, 1/1/2000, Desk, 90"]
    head.append(f"ACCELERATION {what} IN {unit}")
    head.append(f"NPTS= {len(values) if count is None else count:6d}, {every}")
    rows = [values[n : n + columns] for n in range(0, len(values), columns)]
    return "\n".join(head + ["".join(f"{v:15.7E}" for v in row) for row in rows]) + "\n"


def esm(values, **changes):
    keys = {"EVENT_NAME": "none", "EVENT_DATE_YYYYMMDD": "20000101", "PGA_CM/S^2": ""}
    keys |= {"SAMPLING_INTERVAL_S": "0.005", "NDATA": len(values), "STREAM": "HNE"}
    keys |= {"UNITS": "cm/s^2", "DATA_TYPE": "ACCELERATION", **changes}
    head = [f"{key}: {value}" for key, value in keys.items()]
    head += [f"USER{n}:" for n in range(len(head), 64)]
    return "\n".join(head + [f"{v:.7E}" for v in values]) + "\n"


def file(tmp_path, text, name="record.txt"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return str(path)


@given(values=numbers, columns=some.integers(1, 8))
@settings(max_examples=60)
def test_a_file_of_peer_gives_its_samples_in_g(tmp_path_factory, values, columns):
    path = file(tmp_path_factory.mktemp("peer"), peer(values, columns=columns))
    found = read(path)
    assert (found.kind, found.unit, found.every) == ("PEER", "g", 0.005)
    assert found.values == values


@mark.parametrize("every", ["DT=0.005 SEC", "DT=  5.0E-03 SEC", "dt= 0.0050"])
@mark.parametrize("more", ["", ". FILTER POINT: HP=0.1 Hz LP=25.0 Hz"])
def test_the_spellings_of_time_step_and_unit_of_peer(tmp_path, every, more):
    found = read(file(tmp_path, peer([0.1, 0.2], every, unit="UNITS OF G" + more)))
    assert (found.every, found.unit) == (0.005, "g")


def test_the_old_line_of_peer_has_the_numbers_before_the_names(tmp_path):
    text = peer(GOOD, what="TIME HISTORY")
    text = text.replace("NPTS=      6, DT=   .0050 SEC,", "    6    .0050    NPTS, DT")
    path = file(tmp_path, text)
    found = read(path)
    assert (found.values, found.every, found.unit) == (GOOD, 0.005, "g")
    assert readRecord(path, None) == ([9.81 * v for v in GOOD], 0.005)


@given(values=numbers)
@settings(max_examples=60)
def test_a_file_of_esm_gives_its_samples_in_its_unit(tmp_path_factory, values):
    path = file(tmp_path_factory.mktemp("esm"), esm(values))
    found = read(path)
    assert (found.kind, found.unit, found.every) == ("ESM", "cm/s²", 0.005)
    assert found.values == values
    assert readRecord(path, None) == ([0.01 * v for v in values], 0.005)


@given(values=numbers, every=some.sampled_from([0.001, 0.005, 0.01, 1 / 256]))
@settings(max_examples=60)
def test_a_text_has_times_and_accelerations(tmp_path_factory, values, every):
    lines = ["# by hand", "# unit: g", *(f"{n * every!r}, {v!r}" for n, v in enumerate(values)), ""]
    found = read(file(tmp_path_factory.mktemp("text"), "\n".join(lines)))
    assert (found.kind, found.unit) == ("text", "g")
    assert found.every == approx(every, rel=1e-9)
    assert found.values == values


@given(values=numbers, every=some.floats(1e-4, 0.1))
@settings(max_examples=60)
def test_what_is_written_is_read_bit_for_bit(tmp_path_factory, values, every):
    text = accelerograms.written(values, every, "a record")
    path = file(tmp_path_factory.mktemp("written"), text)
    assert readRecord(path, None) == (values, every)


def test_three_components_are_read_from_one_file_or_three(tmp_path):
    parts = [[0.0, 3.0, -0.1], [0.2, 2.0, 0.3], [1.0, -1.6, 0.4]]
    rows = [*map(list, zip(*parts))]
    one = file(tmp_path, accelerograms.written(rows, 0.02, "a record"))
    assert readRecord(one, None) == (rows, 0.02)
    three = [file(tmp_path, "\n".join(map(str, p)), f"{n}.txt") for n, p in enumerate(parts)]
    assert readRecord(three, 0.02) == (rows, 0.02)
    inG = readRecord(three, 0.02, unit="g")[0]
    assert np.array(inG) == approx(9.81 * np.array(rows))
    file(tmp_path, "1\n3\n", "2.txt")
    with raises(Refused, match="must be alike, not 3 samples every 0.02 s, .*, 2 samples"):
        readRecord(three, 0.02)
    with raises(Refused, match="the first is number 1, -999"):
        readRecord([[0, 1, 2], [0, -999, 1]], 0.02)


def test_a_text_without_a_unit_keeps_the_rule_of_its_peak(tmp_path):
    plain = file(tmp_path, "0 0\n0.01 0.4\n0.02 0\n")
    assert read(plain).unit is None
    with raises(Refused, match="the peak of the record is 0.4, .* is it in g"):
        readRecord(plain, None)
    assert readRecord(plain, None, unit="g")[0] == approx([0, 3.924, 0])
    says = file(tmp_path, "# unit: m/s^2\n0 0\n0.01 0.4\n0.02 0\n")
    assert readRecord(says, None)[0] == [0, 0.4, 0]


def test_what_a_script_says_must_agree_with_the_file(tmp_path):
    path = file(tmp_path, peer([0.1, 0.2, -0.1]))
    assert readRecord(path, 0.005, unit="g") == readRecord(path, None)
    with raises(Refused, match="it is in g, not in cm/s²"):
        readRecord(path, None, unit="cm/s²")
    with raises(Refused, match="samples are 0.005 s apart, not 0.01 s"):
        readRecord(path, 0.01)


@mark.parametrize(
    "text, message",
    [
        (peer(GOOD, count=5), r"txt, line 4: NPTS is 5, and the file has 6 values"),
        (peer(GOOD)[:-16], r"line 4: NPTS is 6, and the file has 5 values: is it cut off"),
        (peer(GOOD)[:-4], r"line 6: '-2.0000000E' is not a number"),
        (peer([0.1, math.nan, 0.2]), r"line 5: 'NAN' is not a finite number"),
        (
            peer([0.1, 0.2], "DELTA= 0.01"),
            r"line 4: the line must have NPTS and DT, .* and is 'NPTS= 2, DELTA= 0.01'",
        ),
        (
            peer([0.1, 0.2], unit="UNITS OF FURLONGS"),
            r"line 3: unit 'FURLONGS' must be one of m/s², g, cm/s²",
        ),
        (
            peer([0.1, 0.2]).replace("ACCELERATION", "VELOCITY"),
            r"line 3: it must hold accelerations, and says 'VELOCITY",
        ),
        (peer([]), r"it must have two lines of samples at least"),
        (esm(GOOD, NDATA="8"), r"line 5: NDATA is 8, and the file has 6 values"),
        (esm(GOOD, NDATA="many"), r"line 5: NDATA 'many' must be a whole number"),
        (esm(GOOD, UNITS="furlong"), r"line 7: unit 'furlong' must be one of"),
        (esm(GOOD, UNITS=""), r"its header must have UNITS, and ends with line 64"),
        (
            esm(GOOD, DATA_TYPE="VELOCITY"),
            r"line 8: DATA_TYPE must be ACCELERATION, got 'VELOCITY'",
        ),
        (
            esm(GOOD, SAMPLING_INTERVAL_S="-1"),
            r"line 4: the time between samples, -1 s, must be above 0",
        ),
        (esm([0.1, math.inf]), r"line 66: 'INF' is not a finite number"),
        (esm(GOOD) + "1 2\n", r"line 71: 2 numbers, there must be one a line"),
        ("0 1\n0.01 2\n0.02 nan\n", r"line 3: 'nan' is not a finite number"),
        # half a per cent, five times what is allowed
        (
            "0 1\n0.01 2\n0.0201 3\n",
            (
                r"line 2: its times are not evenly apart: 0.01 s is 0.01 s after the one before,"
                r" and the mean is 0.01005 s"
            ),
        ),
        (
            "0 1\n0.01 2\n0.02 1\n0.01 3\n",
            r"line 2|line 4: its times are not evenly apart: 0.01 s must be after 0.02 s",
        ),
        ("0 1\n0.01 2 3\n", r"line 2: 3 numbers, and the lines must have one or two"),
        ("# components: x y z\n0 1\n0.01 2\n", r"line 2: 2 numbers, .* or three below"),
        ("# components: N E Z\n", r"line 1: components 'N E Z' must be x y z"),
        ("time_s,a\n0,1\n", r"line 1: 'time_s' is not a number"),
        ("", r"it must have two lines of samples at least"),
        ("# unit: mm/s2\n0 1\n0.01 2\n", r"line 1: unit 'mm/s2' must be one of"),
        ("# unit: g\n# unit: m/s2\n0 1\n0.01 2\n", r"line 2: it says unit twice"),
        (
            "# every: 0.02 s\n0 1\n0.01 2\n",
            r"its times are 0.01 s apart, and it says every: 0.02 s",
        ),
        ("\0\0\0\0", r"line 1: .* is not a number"),
    ],
)
def test_a_file_that_is_wrong_is_refused_with_file_line_and_value(tmp_path, text, message):
    with raises(Refused, match=message) as caught:
        read(file(tmp_path, text))
    assert str(tmp_path) in str(caught.value) and "\n" not in str(caught.value)


def test_what_is_no_file_is_refused(tmp_path):
    with raises(Refused, match="No such file"):
        read(str(tmp_path / "none.AT2"))
    with raises(Refused, match="cannot read .*: Is a directory"):
        read(str(tmp_path))


@given(text=some.text("0123456789.-+eE,:# \nNPTS=DTUIabc\t", max_size=200))
@settings(max_examples=200)
def test_any_text_is_read_or_refused(tmp_path_factory, text):
    path = file(tmp_path_factory.mktemp("any"), text)
    try:
        found = read(path)
    except Refused as refused:
        assert path in str(refused)
    else:
        assert len(found.values) > 1 and all(map(math.isfinite, found.values))


EVERY = 0.01


def pulse(n=400, cycles=4):
    """A ground motion whose velocity is a sine under a bell, so that velocity and displacement come
    back to zero."""
    time = [EVERY * k for k in range(n + 1)]
    bell = lambda t: math.sin(math.pi * t / time[-1]) ** 4
    place = lambda t: 0.05 * bell(t) * math.sin(2 * math.pi * cycles * t / time[-1])
    h = EVERY
    return [(place(t - h) - 2 * place(t) + place(t + h)) / h**2 for t in time]


def test_a_motion_that_ends_at_rest_does_not_drift():
    found = drift(pulse(), EVERY)
    assert found.sentence() is None
    assert abs(found.endVelocity) < 1e-3 * found.peakVelocity
    assert found.peakDisplacement == approx(0.05, rel=0.1)


def test_integrals_are_those_of_closed_forms():
    """A constant acceleration a: v = a t, d = a t²/2, whose line of least squares rises by a t²/2
    over the whole."""
    found = drift([2.0] * 101, EVERY)
    assert found.endVelocity == approx(2.0)
    assert found.peakDisplacement == approx(1.0)
    assert found.rise == approx(1.0, rel=1e-3)
    assert found.lean == approx(2.0)
    # an acceleration that grows evenly, a = j t: d = j t³/6, exact however few samples there are
    found = drift([0.0, 2.0, 4.0], EVERY)
    assert found.peakDisplacement == approx(4.0 * (2 * EVERY) ** 2 / 6)
    # a triangle of accelerations up and down: the largest velocity a t/2, at its end
    half = [0.04 * n for n in range(51)]
    found = drift(half + half[-2::-1], EVERY)
    assert found.endVelocity == found.peakVelocity == approx(1.0)


def test_an_offset_is_named_with_its_numbers():
    shifted = [a + 0.05 for a in pulse()]
    said = drift(shifted, EVERY).sentence()
    assert "its velocity at the end is 0.2 m/s" in said
    assert "a constant acceleration of 0.05 m/s²" in said and "rises by" in said


@mark.parametrize(
    "values, every, message",
    [
        (
            [0, 2.0, 0],
            10.0,
            "every 10 s, the time between samples, must be at most 0.5 s: is it in s, not ms?",
        ),
        (
            [0, 2.0, -9999.0, 0],
            0.01,
            "1 samples stand for missing values, the first is number 2, -9999",
        ),
        ([0, 400.0, -200.0], 0.01, "the peak of the record is 400, "),
    ],
)
def test_a_record_that_no_instrument_has_made_is_refused(values, every, message):
    with raises(Refused, match=re.escape(message)):
        readRecord(values, every)
    with raises(Refused, match="the peak of the record, 197 g in m/s²"):
        readRecord([0, 1930.0], 0.01, unit="m/s²")


@mark.parametrize("peak, unit, found", [(4.0, None, 4.0), (400, "cm/s²", 4), (0.4, "m/s²", 0.4)])
def test_a_list_is_read_in_its_unit(peak, unit, found):
    assert readRecord([0, peak], 0.01, unit=unit)[0] == approx([0, found])
    with raises(Refused, match="unit must be one of m/s², g, cm/s²"):
        readRecord([0, peak], 0.01, unit="mm/s²")
    for scale in (0.1, -0.1):
        with raises(Refused, match="the peak of the record is 0.2"):
            readRecord([0, 2, -1], 0.01, scale=scale)
