# SPDX-License-Identifier: GPL-2.0-or-later
"""Pages from templates of jinja2. Texts of files of a run are text in them: none becomes a tag or a
script."""

import os

from masonry.errors import Refused
from masonry.folders import check, replaced
from masonry.packages import needed
from masonry.terminal import say, escapeControls

#: What a whole page may do: run what stands in it. The browser refuses every request to a network.
POLICY = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:"


def rendered(path, **values):
    """A page, or a part of one, from a template of this folder, with control characters of texts
    written out.

    :param path: of the template; texts of other files beside it are ``own("name")`` there
    :param values: of its names; what is no ``markupsafe.Markup`` is escaped
    """
    jinja2 = needed("jinja2")
    here = os.path.dirname(__file__)
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(here),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        finalize=lambda value: escapeControls(value) if type(value) is str else value,
        trim_blocks=True,
        lstrip_blocks=True,
    )

    def own(name):
        return environment.loader.get_source(environment, name)[0]

    environment.filters["script"] = asScript
    return environment.get_template(path).render(own=own, policy=POLICY, **values)


def write(path, text):
    """Write a page, whole or not at all. Raises OSError, also if its name is that of a symbolic
    link."""
    with replaced(path, encoding="utf-8") as file:
        file.write(text)


def save(makePage, path, directory, name):
    """Write a page for the user of a program, and say so. Raises Refused if it cannot be written.

    :param makePage: is called if the path is fine
    :param path: of a file that ends in .html or .htm; None: ``name`` in the folder of the run
    """
    if path is None:
        check(directory)
        path = os.path.join(directory, name)
    if os.path.isdir(path):
        raise Refused(f"{path} is a folder; name a file that ends in .html or .htm")
    if not path.lower().endswith((".html", ".htm")):
        raise Refused(f"{path} must end in .html or .htm")
    if not os.path.isdir(os.path.dirname(path) or "."):
        raise Refused(f"cannot write {path}: there is no folder {os.path.dirname(path)}")
    try:
        write(path, makePage())
    except OSError as problem:
        raise Refused(f"cannot write {path}: {problem.strerror}") from None
    say(f"{path}: {os.path.getsize(path) / 1e6:.2f} MB; any browser opens it")


def asScript(code):
    """A text that can stand in a script element: nothing in it ends or comments out the element."""
    from markupsafe import Markup  # jinja2 has it

    return Markup(code.replace("</script", "<\\/script").replace("<!--", "<\\!--"))
