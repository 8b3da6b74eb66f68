"""Drives a headless Chromium by its DevTools protocol, over a pipe."""

import json
import os
import shutil
import subprocess
import tempfile

PROGRAM = shutil.which("chromium")


class Browser:
    def __init__(self):
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_browser, self.output = os.pipe()
        self.input, from_browser = os.pipe()
        self.process = subprocess.Popen(
            ["sh", "-c", f'exec "$@" 3<&{to_browser} 4>&{from_browser}', "sh", PROGRAM,
             "--headless=new", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe",
             f"--user-data-dir={self.folder.name}", "--window-size=1280,900"],
            pass_fds=(to_browser, from_browser), stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.received, self.number = b"", 0

    def close(self):
        self.process.kill()
        self.process.wait()
        os.close(self.output)
        os.close(self.input)
        self.folder.cleanup()

    def call(self, method, session=None, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        message.update({"sessionId": session} if session else {})
        os.write(self.output, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self.received:
                block = os.read(self.input, 1 << 20)
                assert block, "the browser ended"
                self.received += block
            line, self.received = self.received.split(b"\0", 1)
            answer = json.loads(line)
            if answer.get("id") == self.number:
                return answer["result"]

    def open(self, url):
        return Page(self, self.call("Target.createTarget", url=url)["targetId"])


class Page:
    def __init__(self, browser, target):
        self.browser = browser
        attached = browser.call("Target.attachToTarget", targetId=target, flatten=True)
        self.session = attached["sessionId"]

    def value(self, expression):
        """The value of an expression in the page; that of a promise when it is kept."""
        result = self.browser.call("Runtime.evaluate", self.session, expression=expression,
                                   awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in result, result
        return result["result"].get("value")

    def move_mouse(self, x, y):
        self.browser.call("Input.dispatchMouseEvent", self.session, type="mouseMoved", x=x, y=y)
