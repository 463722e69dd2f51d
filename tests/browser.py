# SPDX-License-Identifier: GPL-2.0-or-later
"""Chromium without a window, driven through a pipe by its DevTools protocol. It draws by its own
software (SwiftShader)."""

import base64
import contextlib
import json
import os
import select
import shutil
import signal
import subprocess
import tempfile
import time

import numpy as np
import pytest
from matplotlib.image import imread

PROGRAM = shutil.which("chromium")
MISSING = (
    ""
    if PROGRAM
    else "Chromium is not installed (apt-get install --no-install-recommends chromium)"
)
PATIENCE = 120  # for an answer [s]
needed = [
    pytest.mark.skipif(bool(MISSING), reason=MISSING),
    pytest.mark.long,
    pytest.mark.xdist_group("browser"),
]
BRICK, RED = (232, 215, 184), (214, 39, 40)


def near(pixels, colour, within=0.08):
    """How many pixels have nearly a colour, given from 0 to 255."""
    return int((np.abs(pixels - np.array(colour) / 255) < within).all(axis=2).sum())


def seen(chromium, tmp_path, element=None):
    """Colours of the window, an array (high, wide, 3) from 0 to 1, after an element has been
    brought into it."""
    if element:
        chromium.value(f"(document.querySelector('{element}').scrollIntoView(), 0)")
    path = str(tmp_path / "seen.png")
    chromium.picture(path)
    return imread(path)[..., :3]


def viewed(chromium, path):
    """The browser with a page in it; ``view`` is the first View of the page."""
    chromium.problems.clear()
    chromium.requests.clear()
    chromium.open(path, height=900)
    chromium.value("masonryViews[0].then(found => { window.view = found; return 0 })")
    return chromium


def moved(chromium, frame):
    """Move the slider of the frames."""
    slider = "document.querySelector('[aria-label=frame]')"
    chromium.value(f"({slider}.value = {frame}, {slider}.dispatchEvent(new Event('input')), 0)")
    chromium.drawn()


class Browser:
    """A page in a browser of its own.

    - ``problems``: what the page wrote to the console as an error or a warning, and exceptions that
      nothing caught
    - ``requests``: addresses that it asked for, other than parts of itself (``data:`` and
      ``blob:``)
    """

    def __init__(self, pipes, process):
        self._read, self._write = pipes
        self._process, self._rest, self._number, self._session = process, b"", 0, None
        self.problems, self.requests = [], []

    def call(self, method, **parameters):
        """The result of a command of the protocol."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        until = time.monotonic() + PATIENCE
        while True:
            answer = self._next(until)
            if answer.get("id") == self._number:
                assert "error" not in answer, answer
                return answer["result"]

    def _next(self, until):
        while b"\0" not in self._rest:
            ready = select.select([self._read], [], [], max(0, until - time.monotonic()))[0]
            assert ready, f"Chromium did not answer within {PATIENCE} s"
            data = os.read(self._read, 1 << 20)
            assert data, "Chromium ended"
            self._rest += data
        text, self._rest = self._rest.split(b"\0", 1)
        message = json.loads(text)
        self._note(message.get("method"), message.get("params", {}))
        return message

    def _note(self, method, about):
        if method == "Runtime.exceptionThrown":
            self.problems.append(json.dumps(about["exceptionDetails"]))
        elif method == "Runtime.consoleAPICalled" and about["type"] in (
            "error",
            "warning",
            "assert",
        ):
            self.problems.append(json.dumps(about["args"]))
        elif method == "Log.entryAdded" and about["entry"]["level"] in ("error", "warning"):
            # the software that stands in for a graphics card is slow to be read
            if "ReadPixels" not in about["entry"]["text"]:
                self.problems.append(json.dumps(about["entry"]))
        elif method == "Network.requestWillBeSent":
            url = about["request"]["url"]
            if not url.startswith(("data:", "blob:")):
                self.requests.append(url)

    def open(self, path, width=1000, height=700):
        """Load a file, and wait until its pictures are drawn."""
        if not self._session:
            target = self.call("Target.createTarget", url="about:blank")["targetId"]
            found = self.call("Target.attachToTarget", targetId=target, flatten=True)
            self._session = found["sessionId"]
            for domain in ("Page", "Runtime", "Log", "Network"):
                self.call(domain + ".enable")
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )
        self.call("Page.navigate", url="file://" + os.path.abspath(path))
        until = time.monotonic() + PATIENCE
        while not self.value("document.readyState === 'complete'"):
            assert time.monotonic() < until
            time.sleep(0.05)
        self.value("Promise.all(window.masonryViews || []).then(() => 0)")
        self.drawn()

    def value(self, code):
        """Value of an expression of JavaScript in the page; of a promise, what it comes to."""
        found = self.call(
            "Runtime.evaluate", expression=code, awaitPromise=True, returnByValue=True
        )
        assert "exceptionDetails" not in found, found
        return found["result"].get("value")

    def drawn(self):
        """Wait until what was asked for is drawn."""
        self.value(
            "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(0))))"
        )

    def picture(self, path):
        """Write what is seen to a .png file."""
        self.drawn()
        data = self.call("Page.captureScreenshot", format="png")["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(data))

    def drag(self, start, end):
        """Move the mouse from one place to another with its left button down [pixels]."""
        mouse = lambda kind, x, y, **more: self.call(
            "Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", **more
        )
        mouse("mousePressed", *start, buttons=1, clickCount=1)
        for share in (0.25, 0.5, 0.75, 1):
            x, y = (a + share * (b - a) for a, b in zip(start, end))
            mouse("mouseMoved", x, y, buttons=1)
        mouse("mouseReleased", *end, clickCount=1)
        self.drawn()

    def wheel(self, place, pixels):
        x, y = place
        self.call("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=pixels)
        self.drawn()

    def press(self, key):
        """Press a key in what has the focus; ``key`` as JavaScript names it."""
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key)
        self.drawn()


@contextlib.contextmanager
def browser(*options):
    """A :class:`Browser` for as long as the context lasts.

    :param options: further ones of Chromium
    """
    down, up = os.pipe(), os.pipe()  # to Chromium, and from it

    # Chromium reads what is for it from 3, and writes to 4; the ends of this process are above them
    def pipes():
        ends = [os.dup2(end, 100 + n) for n, end in enumerate((down[0], up[1]))]
        for n, end in enumerate(ends):
            os.dup2(end, 3 + n)

    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        command = [
            PROGRAM,
            "--headless",
            "--remote-debugging-pipe",
            "--user-data-dir=" + folder,
            "--no-first-run",
            "--disable-dev-shm-usage",
            "--disable-background-networking",
            "--disable-component-update",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
            "--hide-scrollbars",
            *options,
        ]
        if os.geteuid() == 0:
            command.append("--no-sandbox")  # Chromium has none for root
        process = subprocess.Popen(
            command,
            preexec_fn=pipes,
            close_fds=False,
            start_new_session=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "HOME": folder},
        )
        os.close(down[0])
        os.close(up[1])
        try:
            yield Browser((up[0], down[1]), process)
        finally:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            os.close(down[1])
            os.close(up[0])
