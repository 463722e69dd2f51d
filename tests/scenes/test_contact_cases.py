# SPDX-License-Identifier: GPL-2.0-or-later
"""The quick variants of the cases of contact hold their limits, or miss them for the reason that
the program says."""

import contact
from hosted import *
from contact_arch import largestSpread, statics
from contact_motion import theory
from contact_rows import CASES, Row


#: Cases that tests/host/test_contacts.py runs.
QUICKEST = {"rest", "slope"}


@mark.parametrize("name", [name for name in CASES if name not in QUICKEST])
def test_a_quick_case_holds_its_limits_or_says_why_not(name):
    rows = CASES[name](True)
    for row in rows:
        assert row.met is not False or row.misses, f"{row.what}: {row.measured}"
        if name == "rocking-loss":  # has no limit of its own
            assert row.expected - 0.01 < row.measured < 1


def test_the_statics_of_the_arch_is_that_of_three_hinges():
    thrust, shares = statics(0)
    assert thrust == approx(547.5, abs=0.1)
    for spread in (0, 0.02, 0.035):
        thrust, shares = statics(spread)
        assert shares[4] == approx(0, abs=1e-12) == shares[17]
        assert all(-1e-12 < share < 1 + 1e-12 for share in shares)
    assert largestSpread() == approx(0.0369, abs=1e-4)
    assert statics(largestSpread())[0] == approx(598.5, abs=0.2)


def test_the_theory_of_dominoes_has_the_speed_of_a_single_impact():
    """The second domino gets the momentum of the first: after a plastic impact of two equal ones
    both turn half as fast."""
    speeds, spin = theory(0.02, 0.0, count=2, spin=50.0)
    first = 50.0 - 0.5 * (50.0 - 2 * spin)
    assert 40 < 2 * spin < 52 and 40 < first < 52
    assert speeds[0] == approx((0.0275 / 0.02) * 0.048 * first, rel=0.1)


def test_the_program_prints_rows_and_misses(tmp_path, capsys, monkeypatch):
    good = [Row("a [m]", "b", 1.001, 1.0, 0.01), Row("c", "d", 2.0, (1, 3))]
    bad = [Row("a", "b", 1.2, 1.0, 0.01), Row("c", "d", 0.2, limit=0.1, misses="why")]
    monkeypatch.setattr(contact, "CASES", {"good": lambda quick: good})
    path = tmp_path / "table.md"
    assert contact.main(["--out", str(path)]) is False
    assert "| good | a [m] | b | 1 | 1.001 | +0.10 % | ± 1 % |" in path.read_text()
    assert "| good | c | d | 1 … 3 | 2 |  | within |" in path.read_text()
    monkeypatch.setattr(contact, "CASES", {"bad": lambda quick: bad, "worse": lambda quick: 1 / 0})
    assert contact.main(["--only", "bad"]) is True
    out = capsys.readouterr().out
    assert out.count("**missed**") == 2
    assert "- bad, a: the reason is not known" in out and "- bad, c: why" in out
    assert contact.main(["--only", "worse"]) is True
    assert "ZeroDivisionError" in capsys.readouterr().err
    with raises(SystemExit):
        contact.main(["--only", "nothing"])
    assert "no case nothing; there are bad, worse" in capsys.readouterr().err
