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
        # one and a half of the last digit
        (
            "0 1\n0.010 2\n0.023 3\n",
            (
                r"line 2: its times are not evenly apart: 0.01 s is 0.01 s after the one before,"
                r" and the mean is 0.0115 s"
            ),
        ),
        (
            "0 1\n0.01 2\n0.02 1\n0.01 3\n",
            r"line 2|line 4: its times are not evenly apart: 0.01 s must be after 0.02 s",
        ),
        ("0 1\n0.01 2 3\n", r"line 2: 3 numbers, and the lines must have one or two"),
        ("# components: x y z\n0 1\n0.01 2\n", r"line 2: 2 numbers, .* or three below"),
        ("# components: N E Z\n", r"line 1: components 'N E Z' must be x y z"),
        ("time_s,a\n0,1\n", r"it must have two lines of samples at least"),
        ("# unit: g\n40\n1.5\n2.5\n", r"line 2: it begins with the whole number 40, and 2 samples"),
        ("0.5,1\n0,2\n", r"line 2: 1 numbers|not evenly|must be after"),
        ("0,5\n1,2\n", r"line 1: is 0,5 one number or two\?"),
        ("0,5\n1,0\n", r"line 1: is 0,5 one number or two\?"),
        ("t,x\n0,1\n0.01,2\n0.02,O\n", r"line 4: 'O' is not a number"),
        ("1 2 3\n4 5 6\n", r"line 1: 3 numbers, and the lines must have one or two"),
        ("acc [mm/s2]\n1\n2\n", r"line 1: unit 'mm/s2' must be one of"),
        ("", r"it must have two lines of samples at least"),
        ("# unit: mm/s2\n0 1\n0.01 2\n", r"line 1: unit 'mm/s2' must be one of"),
        ("# unit: g\n# unit: m/s2\n0 1\n0.01 2\n", r"line 2: it says unit twice"),
        (
            "# every: 0.02 s\n0 1\n0.01 2\n",
            r"its times are 0.01 s apart, and it says every: 0.02 s",
        ),
        ("\0\0\0\0", r"no text, it has bytes of zero"),
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


# -- what people's files are like ------------------------------------------------------------------

G = 9.81
WAVE = [round(1.7 * math.sin(n / 5), 4) for n in range(64)]
TIMED = [f"{n * 0.01:.2f} {a:.4f}" for n, a in enumerate(WAVE)]
COLUMN = [f"{a:.4f}" for a in WAVE]


def commas(lines, mark=";"):
    return "\n".join(lines).replace(" ", mark).replace(".", ",")


@mark.parametrize(
    "text, factor",
    [
        *(
            (f"# {said}\n" + "\n".join(TIMED), 0.01)
            for said in (
                "unit: cm/s2",
                "units: cm/s2",
                "Units = gal",
                "unit cm/s2",
                "acceleration (cm/s2)",
                "Acceleration unit: cm/s^2",
                "time [s]  acceleration [cm/s2]",
                "units: s, cm/sec^2",
            )
        ),
        ("# units: g\n" + "\n".join(TIMED), G),
        ("time_s,acceleration_ms2\n" + "\n".join(TIMED).replace(" ", ","), 1),
        ("acc [g],time [s]\n" + "\n".join(",".join(line.split()[::-1]) for line in TIMED), G),
        ("\ufeff# every: 0.01 s\r\n% measured\r\n" + "\r\n".join(COLUMN), 1),
        ("\n".join(TIMED).replace(" ", "\t"), 1),
        (commas(TIMED), 1),
        (commas(TIMED, " "), 1),
        ("# every: 0.01 s\n" + commas(["a"] + COLUMN), 1),
        ("# every: 0.01 s\n" + "\n".join(COLUMN), 1),
        ("// every: 0.01 s\n" + commas(COLUMN), 1),
        ("64 0.01\n" + "\n".join(COLUMN), 1),
        ("# every: 0.01 s\n# unit: gal\n64\n" + "\n".join(COLUMN), 0.01),
        ("\n".join(f"{n / 256:.4f} {a}" for n, a in enumerate(WAVE)), 1),
        (peer(WAVE, "DT= .1D-01").replace("UNITS OF G", "(CM/S/S)"), 0.01),
    ],
)
def test_the_peculiarities_of_peoples_files(tmp_path, text, factor):
    values, every = readRecord(file(tmp_path, text), None)
    assert values == approx([factor * a for a in WAVE], abs=1e-12)
    assert every == approx(1 / 256 if "0.0039" in text else 0.01, rel=1e-3)


def test_numbers_of_fortran(tmp_path):
    rows = " .1D-01 -.2d-01 .3E+00\n .4118037-103 -.5-002\n-.1234567E-03-.2345678E-03 0.5-1.5\n"
    head = peer([], "DT= .5D-02 SEC", count=9)
    found = read(file(tmp_path, head + rows))
    assert found.every == 0.005
    assert found.values == [
        *(0.01, -0.02, 0.3, 4.118037e-104, -0.005, -1.234567e-4, -2.345678e-4, 0.5, -1.5)
    ]


def test_several_samples_a_line_need_unit_and_time_step(tmp_path):
    rows = ["".join(f"{a:10.5f}" for a in WAVE[n : n + 7]) for n in range(0, 64, 7)]
    path = file(tmp_path, "\n".join(rows))
    assert readRecord(path, 0.01, unit="m/s²") == (WAVE, 0.01)
    with raises(Refused, match="several samples, .* say every= and unit="):
        readRecord(path, 0.01)


@mark.parametrize(
    "head, order",
    [
        ("x y z", (0, 1, 2)),
        ("acc_z,acc_x,acc_y", (1, 2, 0)),
        ("time [s];NS [m/s2];EW [m/s2];UD [m/s2]", (1, 0, 2)),
    ],
)
def test_a_head_names_the_components(tmp_path, head, order):
    parts = [WAVE, WAVE[::-1], [0.5 * a for a in WAVE]]
    columns = ([[0.01 * n for n in range(64)]] if "time" in head else []) + parts
    mark = next((m for m in ";," if m in head), " ")
    rows = [mark.join(f"{c:.4f}" for c in row) for row in zip(*columns)]
    values, _ = readRecord(
        file(tmp_path, "\n".join([head, *rows])), None if "time" in head else 0.01
    )
    assert np.array(values) == approx(np.transpose([parts[k] for k in order]), abs=1e-4)


def test_a_triple_of_peer_differs_by_a_few_samples(tmp_path, capsys):
    lengths = {"RSN1_180": 60, "RSN1_270": 61, "RSN1_UP": 62}
    for name, count in lengths.items():
        file(tmp_path, peer(WAVE[:count]), f"{name}.AT2")
    values, every = readRecord(str(tmp_path / "RSN1_*.AT2"), None)
    assert (len(values), every) == (62, 0.005)
    assert np.array(values)[:60] == approx(G * np.transpose([WAVE[:60]] * 3))
    assert values[-1] == approx([0, 0, G * WAVE[61]])
    assert "components of 60, 61, 62 samples" in capsys.readouterr().out
    (tmp_path / "RSN1_UP.AT2").unlink()
    with raises(Refused, match="2 files, 0 of them vertical"):
        readRecord(str(tmp_path / "RSN1_*.AT2"), None)


def knet(values, rate="100Hz", duration="0.64", scale="3920(gal)/6182761"):
    lines = {"Origin Time": "2018/01/24 19:51:00", "Lat.": "41.0", "Long.": "142.4"}
    lines |= {"Depth. (km)": "34", "Mag.": "6.3", "Station Code": "AOM001", "Record Time": "-"}
    lines |= {"Sampling Freq(Hz)": rate, "Duration Time(s)": duration, "Dir.": "N-S"}
    lines |= {"Scale Factor": scale, "Max. Acc. (gal)": "1", "Last Correction": "-", "Memo.": ""}
    counts = [13000 + round(100 * a * 6182761 / 3920) for a in values]
    rows = ["".join(f"{c:9d}" for c in counts[n : n + 8]) for n in range(0, len(counts), 8)]
    return "\n".join([f"{key:18s}{value}" for key, value in lines.items()] + rows) + "\n"


def cosmos(values, unit="cm/sec2 (04)", upwards=400, quantity="acceleration"):
    whole, real = [-999] * 100, [-999.0] * 100
    whole[53], real[61] = upwards, 10.0
    lines = [f"Corrected {quantity}   (Format v01.20 with 13 text lines)"]
    lines += ["Record of an earthquake 12 34"] * 12
    lines += [" 100 Integer-header values follow on  10 lines, Format = (10I8)"]
    lines += ["".join(f"{v:8d}" for v in whole[n : n + 10]) for n in range(0, 100, 10)]
    lines += [" 100 Real-header values follow on  20 lines, Format =(5F15.6)"]
    lines += ["".join(f"{v:15.6f}" for v in real[n : n + 5]) for n in range(0, 100, 5)]
    lines += ["   1 Comment line(s) follow, each starting with a |", "| none"]
    lines += [f" {len(values)} {quantity} pts, approx 1 secs, units={unit},Format=(8F10.4)"]
    lines += [
        "".join(f"{100 * v:10.4f}" for v in values[n : n + 8]) for n in range(0, len(values), 8)
    ]
    return "\n".join([*lines, "End-of-data for Chan 1"]) + "\n"


def geonet(values, component):
    whole, real = [0] * 40, [0.0] * 60
    whole[33:36], real[25] = [len(values)] * 3, 0.01
    lines = ["Corrected accelerogram 2016 GNS Science"] + ["text 1 2"] * 11
    lines += [f"Component {component}"] + ["text"] * 3
    lines += ["".join(f"{v:8d}" for v in whole[n : n + 10]) for n in range(0, 40, 10)]
    lines += ["".join(f"{v:8.4f}" for v in real[n : n + 10]) for n in range(0, 60, 10)]
    for factor in (1000, 1, 2):
        scaled = [factor * v for v in values]
        lines += ["".join(f"{v:8.1f}" for v in scaled[n : n + 10]) for n in range(0, 64, 10)]
    return "\n".join(lines) + "\n"


def csmip(values, unit="cm/sec2", channel="Up"):
    lines = ["Corrected accelerogram", f"Chan  1: {channel}"]
    lines += [
        f" {len(values)} points of accel data equally spaced at  .010 sec, in {unit}. (8f10.4)"
    ]
    lines += [
        "".join(f"{100 * v:10.4f}" for v in values[n : n + 8]) for n in range(0, len(values), 8)
    ]
    return "\n".join(lines) + "\n"


@mark.parametrize(
    "text, kind, parts",
    [
        (knet(WAVE), "K-NET", 1),
        (cosmos(WAVE), "COSMOS", 1),
        (cosmos([10 * v / G for v in WAVE], unit="mg (11)"), "COSMOS", 1),
        (cosmos(WAVE) + cosmos(WAVE, quantity="velocity", unit="cm/sec (05)"), "COSMOS", 1),
        (cosmos(WAVE) + cosmos(WAVE, upwards=90) + cosmos(WAVE, upwards=360), "COSMOS", 3),
        (csmip(WAVE), "CSMIP", 1),
        ("".join(geonet(WAVE, c) for c in ("N10E", "Up", "S80E")), "GeoNet", 3),
        (geonet(WAVE, "N10E"), "GeoNet", 1),
    ],
)
def test_records_of_databases(tmp_path, text, kind, parts):
    path = file(tmp_path, text)
    assert read(path).kind == kind
    values, every = readRecord(path, None)
    assert every == approx(0.01)
    offset = np.mean(WAVE) if kind == "K-NET" else 0
    expected = np.subtract(WAVE, offset)
    shown = np.array(values).reshape(64, -1)
    assert shown == approx(np.transpose([expected] * parts), abs=1e-4 if kind == "GeoNet" else 1e-5)


def test_the_vertical_component_of_three_is_the_last(tmp_path):
    up = cosmos([2 * a for a in WAVE])
    text = up + cosmos(WAVE, upwards=90) + cosmos(WAVE, upwards=360)
    values = np.array(readRecord(file(tmp_path, text), None)[0])
    assert values == approx(np.transpose([WAVE, WAVE, np.multiply(2, WAVE)]), abs=1e-5)


@mark.parametrize(
    "text, message",
    [
        (knet(WAVE, duration="0.65"), "line 9: duration × rate is 65, and the file has 64 values"),
        (knet(WAVE, scale="3920/6182761"), r"line 11: Scale Factor .* must be as 3920\(gal\)"),
        (cosmos(WAVE, unit="counts (50)"), r"counts \(50\) are no accelerations"),
        (cosmos(WAVE) + cosmos(WAVE), "2 accelerations, 2 of them vertical: there must be one"),
        (cosmos(WAVE)[:-200], "number of points is 64, and the file has"),
        (csmip(WAVE, unit="furlong"), "line 3: unit 'furlong' must be one of"),
        (geonet(WAVE, "Up")[:900], "number of points is"),
    ],
)
def test_a_record_of_a_database_that_is_wrong_is_refused(tmp_path, text, message):
    with raises(Refused, match=message):
        read(file(tmp_path, text))


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
