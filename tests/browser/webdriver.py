"""A headless Chromium by the WebDriver protocol, as far as the tests of the report need it; and Firefox, which speaks one of its
own with the same commands (Marionette), where GFXREPRO_BROWSER is "firefox"."""

import base64
import json
import os
import pathlib
import shutil
import socket
import subprocess
import tempfile
import time
import urllib.request

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # the key of an element's name in the protocol
FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--hide-scrollbars",
         "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--force-device-scale-factor=1"]


IS_FIREFOX = os.environ.get("GFXREPRO_BROWSER") == "firefox"


def missing():
    """The program that the tests need and that is not there; None if all are."""
    return next((p for p in (("firefox-esr",) if IS_FIREFOX else ("chromium", "chromedriver")) if not shutil.which(p)), None)


def browser():
    return Firefox() if IS_FIREFOX else Browser()


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


class Firefox(Browser):
    """What Chromium alone has (emulated media, its console) does nothing here."""

    COMMANDS = {"/url": "Navigate", "/execute/sync": "ExecuteScript", "/element": "FindElement", "/actions": "PerformActions",
                "/window/rect": "SetWindowRect", "/screenshot": "TakeScreenshot", "/click": "ElementClick", "/value": "ElementSendKeys"}
    PREFERENCES = {"marionette.port": 0, "layout.css.devPixelsPerPx": '"1"', "app.update.disabledForTesting": "true",
                   "datareporting.policy.dataSubmissionEnabled": "false", "browser.shell.checkDefaultBrowser": "false"}

    def __enter__(self):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        folder = pathlib.Path(self.profile.name)
        (folder / "user.js").write_text("".join(f'user_pref("{name}", {value});\n' for name, value in self.PREFERENCES.items()))
        self.driver = subprocess.Popen(["firefox-esr", "--headless", "--no-remote", "--marionette", "--profile", folder],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        end = time.monotonic() + 60
        while not (folder / "MarionetteActivePort").exists():
            if self.driver.poll() is not None or time.monotonic() > end:
                raise RuntimeError("firefox-esr did not start")
            time.sleep(0.1)
        self.socket = socket.create_connection(("127.0.0.1", int((folder / "MarionetteActivePort").read_text())), timeout=120)
        self.stream = self.socket.makefile("rb")
        self._receive()
        self._send("NewSession", {"capabilities": {"alwaysMatch": {"acceptInsecureCerts": True}}})
        return self

    def __exit__(self, *_):
        self.stream.close()
        self.socket.close()
        self.driver.terminate()
        self.driver.wait(20)
        self.profile.cleanup()

    def _receive(self):
        size = b""
        while not size.endswith(b":"):
            size += self.stream.read(1)
        return json.loads(self.stream.read(int(size[:-1])))

    def _send(self, name, parameters):
        text = json.dumps([0, 0, "WebDriver:" + name, parameters]).encode()
        self.socket.sendall(b"%d:%s" % (len(text), text))
        _, _, error, result = self._receive()
        if error:
            raise RuntimeError(error["message"])
        return result.get("value") if isinstance(result, dict) and "value" in result else result

    def _call(self, method, path, body=None):
        parts = path.split("/")
        if parts[1] == "element" and len(parts) == 4:  # /element/ID/click
            return self._send(self.COMMANDS["/" + parts[3]], {"id": parts[2], "full": False, **(body or {})})
        return self._send(self.COMMANDS[path], {"full": False, **(body or {})} if path == "/screenshot" else body or {})

    def emulate(self, media="", scheme="light"):
        pass

    def complaints(self):
        return []
