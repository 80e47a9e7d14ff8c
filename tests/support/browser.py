"""Drives headless Chromium by way of ChromeDriver, which speaks JSON over HTTP: nothing but Python is needed.

usage: browser.py PAGE WIDTH HEIGHT OUT.png [SCRIPT]   takes a picture of a report's page, after a script if there is one
"""
import base64
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request


def is_installed():
    return all(shutil.which(name) for name in ("chromium", "chromedriver"))


class Browser:
    """A window of its own, with an empty profile; to be used in a with statement."""

    def __init__(self, width=1280, height=800, webgl=True):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.driver = subprocess.Popen([shutil.which("chromedriver"), "--port=0"], stdout=subprocess.PIPE,
                                       stderr=subprocess.DEVNULL, text=True)
        started = filter(None, (re.search(r"started successfully on port (\d+)", line) for line in self.driver.stdout))
        self.url = f"http://127.0.0.1:{next(started).group(1)}/session"
        arguments = ["--headless", "--no-sandbox", "--disable-quic", "--no-first-run",
                     "--disable-background-networking", "--disable-component-update", "--disable-sync",
                     "--disable-dev-shm-usage", "--hide-scrollbars", "--force-device-scale-factor=1",
                     f"--window-size={width},{height}", f"--user-data-dir={self.profile.name}"]
        # Triangles are drawn in software, the same on every machine.
        arguments += (["--use-angle=swiftshader", "--enable-unsafe-swiftshader"] if webgl
                      else ["--disable-gpu", "--disable-3d-apis"])
        options = {"goog:chromeOptions": {"args": arguments, "binary": shutil.which("chromium")},
                   "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}
        self.url += "/" + self.post("", {"capabilities": {"alwaysMatch": options}})["sessionId"]
        self.post("/url", {"url": "about:blank"})
        for kind in ("browser", "performance"):
            self.log(kind)  # that of the page that the browser itself began with

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            urllib.request.urlopen(urllib.request.Request(self.url, method="DELETE"), timeout=60).close()
        finally:
            self.driver.terminate()
            self.driver.wait(timeout=60)
            self.driver.stdout.close()
            self.profile.cleanup()

    def post(self, command, body):
        request = urllib.request.Request(self.url + command, json.dumps(body).encode(),
                                         {"Content-Type": "application/json"})
        try:
            with urllib.request.urlopen(request, timeout=240) as response:
                return json.load(response)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from None

    def open(self, path):
        """Open a page of the file system."""
        self.post("/url", {"url": pathlib.Path(os.path.abspath(path)).as_uri()})

    def run(self, script):
        """What the body of a function returns that is run in the page."""
        return self.post("/execute/sync", {"script": script, "args": []})

    def wait_for(self, condition, seconds=120):
        """Until an expression in the page is true."""
        end = time.monotonic() + seconds
        while not self.run(f"return Boolean({condition})"):
            if time.monotonic() > end:
                raise TimeoutError(condition)
            time.sleep(0.05)

    def resize(self, width, height):
        """Give the page this size, without the window around it."""
        self.post("/goog/cdp/execute", {"cmd": "Emulation.setDeviceMetricsOverride", "params": {
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}})

    def screenshot(self):
        """The bytes of a PNG of the window."""
        with urllib.request.urlopen(self.url + "/screenshot", timeout=240) as response:
            return base64.b64decode(json.load(response)["value"])

    def log(self, kind):
        """What came in since this was last asked for: "browser" for the console, "performance" for events."""
        return self.post("/se/log", {"type": kind})


if __name__ == "__main__":
    page, width, height, out = sys.argv[1:5]
    with Browser() as window:
        window.resize(int(width), int(height))
        window.open(page)
        window.wait_for("view")
        window.run(sys.argv[5] if len(sys.argv) > 5 else "")
        # The second frame is drawn once the first has been shown.
        window.run("window.drawn = false; requestAnimationFrame(() => requestAnimationFrame(() => drawn = true))")
        window.wait_for("drawn")
        with open(out, "wb") as file:
            file.write(window.screenshot())
