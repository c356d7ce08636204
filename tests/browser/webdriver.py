"""A headless Chromium by the WebDriver protocol, as far as the tests of the report need it."""

import base64
import json
import shutil
import subprocess
import tempfile
import time
import urllib.request

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # the key of an element's name in the protocol
FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--hide-scrollbars",
         "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--force-device-scale-factor=1"]


def missing():
    """The program that the tests need and that is not there; None if all are."""
    return next((p for p in ("chromium", "chromedriver") if not shutil.which(p)), None)


class Browser:
    """`with Browser() as browser: browser.open(path)`."""

    def __enter__(self):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE,
                                       stderr=subprocess.DEVNULL, text=True)
        self.base = None
        for line in self.driver.stdout:
            if "started successfully on port" in line:
                self.base = "http://127.0.0.1:" + line.rstrip(". \n").split()[-1]
                break
        if not self.base:
            raise RuntimeError("chromedriver did not start")
        options = {"args": [*FLAGS, "--user-data-dir=" + self.profile.name]}
        reply = self._call("POST", "/session", {"capabilities": {"alwaysMatch": {
            "browserName": "chrome", "goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}}})
        self.base += "/session/" + reply["sessionId"]
        return self

    def __exit__(self, *_):
        try:
            self._call("DELETE", "")
        finally:
            self.driver.terminate()
            self.driver.wait(20)
            self.driver.stdout.close()
            self.profile.cleanup()

    def _call(self, method, path, body=None):
        data = None if method in ("GET", "DELETE") else json.dumps(body or {}).encode()
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"}, method=method)
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))  # loopback needs no proxy
        try:
            with opener.open(request, timeout=120) as reply:
                return json.load(reply)["value"]
        except urllib.error.HTTPError as problem:
            raise RuntimeError(json.load(problem)["value"]["message"]) from None

    def open(self, path, fragment=""):
        """Loads a file; gives the seconds until its load event."""
        self._call("POST", "/url", {"url": "about:blank"})  # else a new fragment alone loads nothing
        start = time.monotonic()
        self._call("POST", "/url", {"url": path.resolve().as_uri() + fragment})
        return time.monotonic() - start

    def resize(self, width, height):
        self._call("POST", "/window/rect", {"width": width, "height": height})

    def emulate(self, media="", scheme="light"):
        """Print ("print") or screen; "light" or "dark"."""
        self._call("POST", "/goog/cdp/execute", {"cmd": "Emulation.setEmulatedMedia", "params": {
            "media": media, "features": [{"name": "prefers-color-scheme", "value": scheme}]}})

    def script(self, text, *arguments):
        """What a function body returns."""
        return self._call("POST", "/execute/sync", {"script": text, "args": list(arguments)})

    def wait(self, text, *arguments):
        """Until a function body returns something true."""
        end = time.monotonic() + 20
        while time.monotonic() < end:
            value = self.script(text, *arguments)
            if value:
                return value
            time.sleep(0.05)
        raise AssertionError("waited in vain for: " + text)

    def find(self, selector):
        return self._call("POST", "/element", {"using": "css selector", "value": selector})[ELEMENT]

    def click(self, selector):
        element = self.find(selector)
        self.script("document.querySelector(arguments[0]).scrollIntoView({block: 'center'})", selector)
        self._call("POST", f"/element/{element}/click")

    def point(self, selector):
        """Moves the mouse over an element."""
        self.script("document.querySelector(arguments[0]).scrollIntoView({block: 'center'})", selector)
        self._pointer([{"type": "pointerMove", "x": 0, "y": 0, "origin": {ELEMENT: self.find(selector)}}])

    def drag(self, selector, dx, dy):
        self._pointer([{"type": "pointerMove", "x": 0, "y": 0, "origin": {ELEMENT: self.find(selector)}},
                       {"type": "pointerDown", "button": 0},
                       {"type": "pointerMove", "x": dx, "y": dy, "origin": "pointer"},
                       {"type": "pointerUp", "button": 0}])

    def scroll(self, selector, dy):
        self._call("POST", "/actions", {"actions": [{"type": "wheel", "id": "wheel", "actions": [
            {"type": "scroll", "x": 0, "y": 0, "deltaX": 0, "deltaY": dy, "origin": {ELEMENT: self.find(selector)}}]}]})

    def _pointer(self, actions):
        self._call("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": actions,
                                                     "parameters": {"pointerType": "mouse"}}]})

    def press(self, key, held=""):
        """A key; while another is held."""
        keys = [*held, key]
        self._call("POST", "/actions", {"actions": [{"type": "key", "id": "keys", "actions": [
            *({"type": "keyDown", "value": k} for k in keys), *({"type": "keyUp", "value": k} for k in reversed(keys))]}]})

    def type(self, selector, text):
        self._call("POST", f"/element/{self.find(selector)}/value", {"text": text})

    def screenshot(self, file, selector=None):
        path = f"/element/{self.find(selector)}/screenshot" if selector else "/screenshot"
        file.write_bytes(base64.b64decode(self._call("GET", path)))

    def complaints(self):
        """Errors and warnings of the console since the last call."""
        return [entry["message"] for entry in self._call("POST", "/se/log", {"type": "browser"})
                if entry["level"] in ("SEVERE", "WARNING")]
