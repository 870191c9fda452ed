"""A display of its own, a Loam window on it, and hands: mouse, keyboard and eyes."""
import json
import os
import queue
import shutil
import subprocess
import tempfile
import threading
import time

from PIL import Image

NEEDED = ("Xvfb", "xdotool", "import")


def missing_tools():
    return [tool for tool in NEEDED if shutil.which(tool) is None]


class Display:
    """An X server on a free display number."""

    def __init__(self, width=1400, height=900):
        read, write = os.pipe()
        self.process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{width}x{height}x24", "-nolisten", "tcp"],
            pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            number = pipe.readline().strip()
        assert number, "Xvfb did not start"
        self.name = f":{number}"
        self.environment = dict(os.environ, DISPLAY=self.name)

    def close(self):
        self.process.terminate()
        self.process.wait()

    def xdotool(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True, stdout=subprocess.DEVNULL)

    def screenshot(self):
        with tempfile.NamedTemporaryFile(suffix=".png") as file:
            subprocess.run(["import", "-window", "root", file.name], env=self.environment, check=True)
            return Image.open(file.name).convert("RGB")

    # --- mouse and keyboard ---
    def key(self, *names):
        for name in names:
            self.xdotool("key", name)
            time.sleep(0.12)

    def click(self, x, y, button=1):
        self.xdotool("mousemove", x, y)
        time.sleep(0.1)
        self.xdotool("mousedown", button)
        time.sleep(0.08)
        self.xdotool("mouseup", button)
        time.sleep(0.1)

    def drag(self, x0, y0, x1, y1, steps=15, button=1, pause=0.03):
        self.xdotool("mousemove", x0, y0)
        time.sleep(0.1)
        self.xdotool("mousedown", button)
        for i in range(1, steps + 1):
            self.xdotool("mousemove", x0 + (x1 - x0) * i // steps, y0 + (y1 - y0) * i // steps)
            time.sleep(pause)
        self.xdotool("mouseup", button)
        time.sleep(0.1)


class Window:
    """`loam edit` with its report read line by line."""

    def __init__(self, display, executable, project, *arguments):
        self.process = subprocess.Popen(
            [executable, "edit", str(project), "--report", "--validation", *map(str, arguments)],
            env=display.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.events = []
        self.errors = []
        self._lines = queue.Queue()
        self._threads = [threading.Thread(target=self._read, daemon=True),
                         threading.Thread(target=self._read_errors, daemon=True)]
        for thread in self._threads:
            thread.start()

    def _read(self):
        for line in self.process.stdout:
            self._lines.put(json.loads(line))
        self._lines.put(None)

    def _read_errors(self):
        self.errors.extend(self.process.stderr)

    def _take(self, timeout):
        """One more event into the list; False when none came."""
        try:
            event = self._lines.get(timeout=timeout)
        except queue.Empty:
            return False
        if event is None:
            raise AssertionError("the window is gone: " + "".join(self.errors))
        self.events.append(event)
        return True

    def wait_for(self, name, timeout=90):
        """The next event of that name that has not been waited for."""
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            if self._take(0.2) and self.events[-1]["event"] == name:
                return self.events[-1]
        raise AssertionError(f"no {name} within {timeout} s; last: {self.events[-3:]} {''.join(self.errors)}")

    def settle(self, quiet_s=1.5, timeout=90):
        """Until it is idle, and stays so, after the last command."""
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            if self._take(quiet_s):
                continue
            if next((e["event"] for e in reversed(self.events) if e["event"] in ("idle", "command")), "") == "idle":
                return
        raise AssertionError(f"the window does not come to rest; last: {self.events[-3:]}")

    def wait_message(self, part, timeout=90):
        """What the status line says once it holds that."""
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            said = self.last("message")
            if said and part in said["text"]:
                return said["text"]
            self._take(0.1)
        raise AssertionError(f"no message with {part!r}; last: {self.last('message')}")

    def last(self, name):
        return next((e for e in reversed(self.events) if e["event"] == name), None)

    def commands(self):
        return [e["command"] for e in self.events if e["event"] == "command"]

    def cpu_s(self):
        with open(f"/proc/{self.process.pid}/stat") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def close(self, display):
        display.key("ctrl+q")
        return self.wait_until_closed()

    def wait_until_closed(self):
        try:
            code = self.process.wait(timeout=60)
        finally:
            if self.process.poll() is None:
                self.process.kill()
        for thread in self._threads:
            thread.join()
        while not self._lines.empty():
            event = self._lines.get()
            if event is not None:
                self.events.append(event)
        return code
