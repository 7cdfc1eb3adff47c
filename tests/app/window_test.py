"""The real program in a real window, under Xvfb with xdotool: drag a slider, save a picture, quit.

Usage: window_test.py FLYBALL SCENE. Exits 77 with a message where Xvfb or xdotool are missing.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
LIMIT = 60  # seconds, for anything to happen


def start_display():
    """Xvfb on a number of its own choice; returns the process and the number."""
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
        pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as pipe:
        number = pipe.readline().strip()
    if not number:
        server.wait()
        print("skipped: Xvfb does not start here")
        sys.exit(SKIPPED)
    return server, ":" + number


class Window:
    def __init__(self, display, state_file, program):
        self.environment = {**os.environ, "DISPLAY": display}
        self.environment.pop("WAYLAND_DISPLAY", None)
        self.state_file = state_file
        self.program = program

    def state(self):
        try:
            return json.loads(self.state_file.read_text())
        except (FileNotFoundError, json.JSONDecodeError):
            return {}

    def wait(self, what, condition):
        """Until the condition holds for the state; returns the state."""
        end = time.time() + LIMIT
        while time.time() < end:
            state = self.state()
            if state and condition(state):
                return state
            if self.program.poll() is not None:
                raise SystemExit(f"the program ended with {self.program.returncode} before: {what}")
            time.sleep(0.05)
        raise SystemExit(f"never happened: {what}; the last state was {self.state()}")

    def do(self, *words):
        """One xdotool command, then time for a few frames: ImGui 1.86 sees one change of input a frame."""
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True)
        time.sleep(0.3)

    def place(self, widget, share=0.5):
        left, top, right, bottom = self.wait(f"{widget} is there", lambda s: widget in s["widgets"])["widgets"][widget]
        return round(left + share * (right - left)), round((top + bottom) / 2)

    def click(self, widget):
        self.do("mousemove", *self.place(widget))
        self.do("mousedown", 1)
        self.do("mouseup", 1)


def run(window, folder):
    speed = "joints.spin.drive.speed"
    first = window.wait("the first answer", lambda s: s["answer"] > 0 and s["status"] == "converged")

    slider = "parameters/" + speed
    window.do("mousemove", *window.place(slider, 0.4))
    window.do("mousedown", 1)
    for share in (0.5, 0.6, 0.7):
        window.do("mousemove", *window.place(slider, share))
    window.do("mouseup", 1)
    moved = window.wait("another solution", lambda s: s["answer"] > first["answer"] and s["parameters"][speed] > 15)
    if moved["coordinates"]["slide"] == first["coordinates"]["slide"]:
        raise SystemExit("the slider moved and the solution did not")

    window.do("key", "ctrl+e")
    window.wait("the dialog", lambda s: s["dialog"] and "export/720p" in s["widgets"])
    window.click("export/720p")
    window.click("export/panels")
    window.click("export/save")
    window.wait("a picture", lambda s: s["notice"].startswith("Saved"))
    picture = folder / "flyball-governor.png"
    header = picture.read_bytes()[:24]
    size = int.from_bytes(header[16:20], "big"), int.from_bytes(header[20:24], "big")
    if header[:8] != b"\x89PNG\r\n\x1a\n" or size != (1280, 720):
        raise SystemExit(f"{picture} is no PNG of the wanted size: {size}")

    window.do("key", "ctrl+q")
    if window.program.wait(LIMIT) != 0:
        raise SystemExit(f"the program ended with {window.program.returncode}")


def main():
    program, scene = map(os.path.abspath, sys.argv[1:])
    for tool in ("Xvfb", "xdotool"):
        if not shutil.which(tool):
            print(f"skipped: {tool} is missing")
            sys.exit(SKIPPED)
    server, display = start_display()
    running = None
    try:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            state_file = folder / "state.json"
            environment = {**os.environ, "DISPLAY": display}
            environment.pop("WAYLAND_DISPLAY", None)
            running = subprocess.Popen([program, scene, "--state-file", state_file], cwd=folder, env=environment)
            run(Window(display, state_file, running), folder)
    finally:
        if running and running.poll() is None:
            running.kill()
            running.wait()
        server.terminate()
        server.wait()
    print("the window solves, draws and saves")


if __name__ == "__main__":
    main()
