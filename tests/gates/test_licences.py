# SPDX-License-Identifier: GPL-2.0-or-later
"""Each source file names its licence."""

import licences


def test_each_source_file_names_its_licence():
    assert licences.missing() == []


def test_a_file_without_the_line_or_with_another_licence_is_found(tmp_path):
    line = "# " + licences.LICENCE + "\n"
    for name, text, isMissing in (
        ("first.py", line, False),
        ("shebang.sh", "#!/usr/bin/env bash\n" + line, False),
        ("cpp.hpp", "// " + licences.LICENCE + "\n", False),
        ("none.py", '"""Nothing."""\n', True),
        ("empty.py", "", True),
        ("late.py", "\n\n\n" + line, True),
        ("other.py", line.replace("2.0", "3.0"), True),
    ):
        (tmp_path / name).write_text(text)
        assert licences.isMissing(name, tmp_path) == isMissing, name
