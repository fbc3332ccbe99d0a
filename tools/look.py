"""Open pages in a real browser, and complain of what a reader would: `tools/look.py PAGE ...`

Chromium opens every page as a file, at the width of a desk, of a telephone and on paper. A page
fails if its console says anything, if it asks for anything from outside itself, if a picture is
not shown or has no words in its place, or if it is wider than the window. With --out DIR pictures
of it are kept there: FOLDER-PAGE-desk.png, FOLDER-PAGE-phone.png, FOLDER-PAGE.pdf.

Needs Chromium (Debian: apt-get install chromium); its name may be given in CHROMIUM.
"""

from __future__ import annotations

import argparse
import base64
import itertools
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Timer
from typing import Any

FLAGS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-dev-shm-usage", "--hide-scrollbars", "--remote-debugging-pipe",
    # A name that is looked up is a mistake of the page; it is told, and leads nowhere.
    "--host-resolver-rules=MAP * ~NOTFOUND",
)  # fmt: skip

SIZES = {"desk": (1280, 900), "phone": (375, 800)}

PATIENCE = 180.0
"""Seconds in which a page must have been looked at."""

SEEN = """({
  wide: document.documentElement.scrollWidth - window.innerWidth,
  pictures: [...document.images].map(i => ({shown: i.complete && i.naturalWidth > 0, alt: i.alt})),
  title: document.title,
  text: document.body.innerText.length,
})"""


class Browser:
    """A browser that is spoken to through two pipes, in its DevTools protocol."""

    def __init__(self, process: subprocess.Popen, to: Any, back: Any) -> None:
        """Speak through `to`, listen at `back`."""
        self.process, self.to, self.back = process, to, back
        self.numbers = itertools.count(1)
        self.events: list[dict] = []

    def ask(self, method: str, session: str | None = None, **params: Any) -> dict:
        """Return the answer to a request; what happens meanwhile is kept in `events`."""
        number = next(self.numbers)
        request = {"id": number, "method": method, "params": params}
        if session:
            request["sessionId"] = session
        self.to.write(json.dumps(request).encode() + b"\0")
        self.to.flush()
        while True:
            message = self.hear()
            if message.get("id") == number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']['message']}")
                return message["result"]
            self.events.append(message)

    def wait_for(self, method: str) -> None:
        """Wait until something has happened."""
        while not any(event.get("method") == method for event in self.events):
            self.events.append(self.hear())

    def hear(self) -> dict:
        """Return the next message."""
        text = bytearray()
        while (byte := self.back.read(1)) != b"\0":
            if not byte:
                raise RuntimeError("the browser is gone, or took too long")
            text += byte
        return json.loads(text)


@contextmanager
def browser(program: str) -> Iterator[Browser]:
    """Yield a browser with a profile of its own, and end it."""
    in_read, in_write = os.pipe()
    out_read, out_write = os.pipe()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        # The protocol is spoken on the files 3 and 4.
        command = [program, *FLAGS, f"--user-data-dir={profile}", "about:blank"]
        process = subprocess.Popen(
            ["sh", "-c", f'exec "$@" 3<&{in_read} 4>&{out_write}', "sh", *command],
            pass_fds=(in_read, out_write),
            stderr=subprocess.DEVNULL,
        )
        os.close(in_read)
        os.close(out_write)
        try:
            with os.fdopen(in_write, "wb") as to, os.fdopen(out_read, "rb") as back:
                yield Browser(process, to, back)
        finally:
            process.terminate()
            process.wait(timeout=PATIENCE)


@contextmanager
def ended_after(seconds: float, process: subprocess.Popen) -> Iterator[None]:
    """End a browser that takes too long; whoever listens to it is told that it is gone."""
    timer = Timer(seconds, process.kill)
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def complaints(one: Browser, page: Path, out: Path | None) -> list[str]:
    """Return what is wrong with a page."""
    found: list[str] = []
    stem = f"{page.parent.name}-{page.stem}"
    for name, (width, height) in SIZES.items():
        target = one.ask("Target.createTarget", url="about:blank")["targetId"]
        session = one.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            one.ask(f"{domain}.enable", session)
        one.ask(
            "Emulation.setDeviceMetricsOverride", session,
            width=width, height=height, deviceScaleFactor=1, mobile=name == "phone",
        )  # fmt: skip
        one.events.clear()
        one.ask("Page.navigate", session, url=page.as_uri())
        one.wait_for("Page.loadEventFired")
        seen = one.ask("Runtime.evaluate", session, expression=SEEN, returnByValue=True)
        found += [f"{name}: {each}" for each in _seen(seen["result"]["value"])]
        found += [f"{name}: {each}" for each in _happened(one.events, page.as_uri())]
        if out:
            shot = one.ask(
                "Page.captureScreenshot", session, format="png", captureBeyondViewport=True
            )
            (out / f"{stem}-{name}.png").write_bytes(base64.b64decode(shot["data"]))
        if out and name == "desk":
            paper = one.ask(
                "Page.printToPDF", session, printBackground=False, paperWidth=8.27, paperHeight=11.7
            )
            (out / f"{stem}.pdf").write_bytes(base64.b64decode(paper["data"]))
        one.ask("Target.closeTarget", targetId=target)
    return found


def _seen(seen: dict) -> Iterator[str]:
    if seen["wide"] > 0:
        yield f"is {seen['wide']} pixels wider than the window"
    if not seen["title"] or not seen["text"]:
        yield "says nothing"
    for number, picture in enumerate(seen["pictures"], 1):
        if not picture["shown"]:
            yield f"picture {number} is not shown"
        if not picture["alt"]:
            yield f"picture {number} has no words in its place"


def _happened(events: list[dict], address: str) -> Iterator[str]:
    for event in events:
        what = event.get("params", {})
        match event.get("method"):
            case "Runtime.consoleAPICalled":
                yield f"the console says {[arg.get('value') for arg in what['args']]}"
            case "Runtime.exceptionThrown":
                yield f"a script fails: {what['exceptionDetails']['text']}"
            case "Log.entryAdded":
                yield f"the log says {what['entry']['text']}"
            case "Network.requestWillBeSent":
                url = what["request"]["url"]
                if url != address and not url.startswith("data:"):
                    yield f"it asks for {url[:100]}"


def main() -> None:
    """Look at every page, and fail if there is anything to complain of."""
    parser = argparse.ArgumentParser(description="Open pages in Chromium and complain.")
    parser.add_argument("pages", nargs="+", type=Path)
    parser.add_argument("--out", type=Path, help="keep pictures of the pages in this directory")
    given = parser.parse_args()
    program = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("chrome")
    if not program:
        sys.exit("look: there is no Chromium; as root, apt-get install chromium brings it")
    if given.out:
        given.out.mkdir(parents=True, exist_ok=True)
    wrong = 0
    with browser(program) as one:
        for page in given.pages:
            with ended_after(PATIENCE, one.process):
                found = complaints(one, page.resolve(), given.out)
            wrong += len(found)
            for each in found:
                print(f"{page}: {each}")
            if not found:
                print(f"{page}: good")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
