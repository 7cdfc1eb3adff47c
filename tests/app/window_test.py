"""The real program in a real window, under Xvfb with xdotool: drag a slider, save a picture, quit; and crash, and
recover.

Usage: window_test.py FLYBALL SCENE. Exits 77 with a message where Xvfb or xdotool are missing.
"""
import concurrent.futures
import contextlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

SKIPPED = 77
ONE_AT_A_TIME = threading.Lock()  # two servers that start may choose the same number
LIMIT = 60  # seconds, for anything to happen
LOOK = 0.01  # seconds between two looks at the state
SPEED = "joints.spin.drive.speed"


def start_display(resets=False):
    """Xvfb on a number of its own choice, which starts anew or not when its last client has gone; returns the process
    and the number."""
    with ONE_AT_A_TIME:
        read, write = os.pipe()
        server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp",
             *([] if resets else ["-noreset"])],
            pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            number = pipe.readline().strip()
    if not number:
        server.wait()
        print("skipped: Xvfb does not start here")
        sys.exit(SKIPPED)
    return server, ":" + number


@contextlib.contextmanager
def own_display(resets=False):
    """The number of an Xvfb that ends with the block."""
    server, number = start_display(resets)
    try:
        yield number
    finally:
        server.terminate()
        server.wait()


def side_by_side(*parts):
    """Runs functions at once, as they mostly wait; ends with what one of them raised, a failure before a skip."""
    with concurrent.futures.ThreadPoolExecutor(len(parts)) as threads:
        raised = [error for begun in [threads.submit(part) for part in parts] if (error := begun.exception())]
    for error in sorted(raised, key=lambda e: isinstance(e, SystemExit) and e.code == SKIPPED):
        raise error


class Window:
    """The program in a window of its own, to be used in a `with` block, at whose end it ends."""

    def __init__(self, display, folder, program, scene):
        self.environment = {**os.environ, "DISPLAY": display, "XDG_STATE_HOME": str(folder / "state")}
        self.environment.pop("WAYLAND_DISPLAY", None)
        self.state_file = folder / "state.json"
        self.state_file.unlink(missing_ok=True)
        self.program = subprocess.Popen([program, scene, "--state-file", self.state_file], cwd=folder,
                                        env=self.environment)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()

    def end(self):
        if self.program.poll() is None:
            self.program.kill()
        self.program.wait()

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
            time.sleep(LOOK)
        raise SystemExit(f"never happened: {what}; the last state was {self.state()}")

    def do(self, *words):
        """One xdotool command, then a few frames: ImGui 1.86 sees one change of input a frame."""
        before = self.wait("a frame", lambda s: "frame" in s)["frame"]
        subprocess.run(["xdotool", *map(str, words)], env=self.environment, check=True)
        end = time.time() + 3  # what changes nothing draws nothing
        while self.state().get("frame", 0) < before + 3 and time.time() < end:
            time.sleep(LOOK)
        time.sleep(0.03)

    def place(self, widget, share=0.5):
        left, top, right, bottom = self.wait(f"{widget} is there", lambda s: widget in s["widgets"])["widgets"][widget]
        return round(left + share * (right - left)), round((top + bottom) / 2)

    def click(self, widget):
        self.do("mousemove", *self.place(widget))
        self.do("mousedown", 1)
        self.do("mouseup", 1)

    def hurry(self, *commands):
        """xdotool's commands while the program stands still: it finds all of it in one go."""
        os.kill(self.program.pid, signal.SIGSTOP)
        try:
            for words in commands:
                subprocess.run(["xdotool", *words], env=self.environment, check=True)
        finally:
            os.kill(self.program.pid, signal.SIGCONT)

    def drag_speed(self):
        """Waits for the first answer, drags the slider and returns the states before and after."""
        first = self.wait("the first answer", lambda s: s["answer"] > 0 and s["status"] == "converged")
        slider = "parameters/" + SPEED
        self.do("mousemove", *self.place(slider, 0.4))
        self.do("mousedown", 1)
        for share in (0.5, 0.6, 0.7):
            self.do("mousemove", *self.place(slider, share))
        self.do("mouseup", 1)
        return first, self.wait("another solution",
                                lambda s: s["answer"] > first["answer"] and s["parameters"][SPEED] > 15)

    def ends_well(self):
        if self.program.wait(LIMIT) != 0:
            raise SystemExit(f"the program ended with {self.program.returncode}")


def explore(window, folder):
    first, moved = window.drag_speed()
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

    watch_motion(window)
    if window.state()["unsaved"]:
        raise SystemExit("what was tried counts as an edit")
    window.do("key", "ctrl+q")  # nothing to ask
    window.ends_well()


def watch_motion(window):
    """The motion is computed in the background while it plays, scrubbed, and goes with its panel."""
    window.do("key", "m")
    window.wait("the motion plays", lambda s: s.get("motion", {}).get("time", 0) > 0.2 and s["playing"])
    done = window.wait("the whole motion", lambda s: s.get("motion", {}).get("finished"))
    if "from the direct solution" not in done["motion"]["settled"]:
        raise SystemExit(f"no word on whether it settled: {done['motion']}")
    window.do("key", "space")
    window.wait("it is paused", lambda s: not s["playing"])
    window.do("mousemove", *window.place("motion/scrub", 0.5))
    window.do("mousedown", 1)
    window.do("mouseup", 1)
    half = done["motion"]["computed"] / 2
    window.wait("it is scrubbed to the middle", lambda s: abs(s["motion"]["time"] - half) < 0.1 * half)
    window.click("study/close")
    window.wait("the motion is gone", lambda s: "motion" not in s)


def type_ahead(window, scene):
    """However much comes within a frame, each key sees what the one before has done."""
    window.wait("the first answer", lambda s: s["answer"] > 0 and s["status"] == "converged")
    window.do("mousemove", *window.place("view"))
    window.hurry(["key", "ctrl+p"], ["type", "spin 15"], ["key", "Return"])
    window.wait("the palette sets a speed", lambda s: s["parameters"][SPEED] == 15)
    window.do("key", "Tab")
    window.wait("building", lambda s: s["mode"] == "build")
    window.click("outline/bodies/ball1")
    window.click("inspector/position/x")
    window.wait("a field", lambda s: s["typing"] == "inspector/position/x")
    # A button is pressed where the mouse was then, wherever it has gone since.
    rows = [[str(number) for number in window.place(f"outline/bodies/{body}")] for body in ("ball2", "collar")]
    window.hurry(["mousemove", *rows[0]], ["click", "1"], ["mousemove", *rows[1]])
    window.wait("the row that was clicked", lambda s: s["selected"] == "ball2")
    time.sleep(0.5)
    if window.state()["selected"] != "ball2":
        raise SystemExit(f"clicked ahead, {window.state()['selected']} is selected")
    window.click("outline/bodies/ball1")
    window.wait("the ball", lambda s: s["selected"] == "ball1")
    window.click("inspector/position/x")
    window.wait("the field again", lambda s: s["typing"] == "inspector/position/x")
    window.hurry(["key", "ctrl+a"], ["type", "0.31"], ["key", "Tab"], ["type", "0.12"], ["key", "Tab"],
                 ["key", "ctrl+a"], ["type", "0.05"], ["key", "Return"])
    window.wait("the fields are left", lambda s: s["unsaved"] and not s["typing"])
    window.do("key", "ctrl+s")
    window.wait("it is saved", lambda s: not s["unsaved"])
    bodies = {body["name"]: body for body in json.loads(scene.read_text())["bodies"]}
    if bodies["ball1"]["position"] != [0.31, 0.12, 0.05]:
        raise SystemExit(f"typed ahead, the ball is at {bodies['ball1']['position']}")
    window.do("key", "ctrl+q")
    window.ends_well()


def hidden_files(folder):
    return [file.name for file in folder.iterdir() if file.name.startswith(".")]


def crash(window):
    """Keeps what was tried, and dies without a word three seconds later; returns the value that would be lost."""
    window.drag_speed()
    window.click("explored/keep")
    window.wait("an edit", lambda s: s["unsaved"])
    time.sleep(3)
    value = window.state()["parameters"][SPEED]
    window.program.kill()
    window.program.wait()
    return value


def recover(window, scene, value):
    if len(hidden_files(scene.parent)) != 1:
        raise SystemExit(f"no autosave was left, but {hidden_files(scene.parent)}")
    offered = window.wait("an offer to recover", lambda s: s["leftovers"] == 1 and "recover/recover" in s["widgets"])
    if offered["parameters"][SPEED] == value or offered["unsaved"]:
        raise SystemExit("the file says what was never saved to it")
    window.click("recover/recover")
    window.wait("the work is back", lambda s: s["parameters"][SPEED] == value and s["unsaved"])
    window.do("key", "ctrl+s")
    window.wait("it is saved", lambda s: not s["unsaved"] and s["notice"].startswith("Saved"))
    joints = {joint["name"]: joint for joint in json.loads(scene.read_text())["joints"]}
    if joints["spin"]["drive"]["speed"] != value:
        raise SystemExit(f"saved {joints['spin']['drive']['speed']} instead of {value}")
    if hidden_files(scene.parent):
        raise SystemExit(f"left behind: {hidden_files(scene.parent)}")
    window.do("key", "ctrl+q")
    window.ends_well()


def open_bare(program, scene, folder):
    """A server that starts anew whenever its last client has gone is asked for a window once."""
    with own_display(resets=True) as display, Window(display, folder, program, scene) as window:
        window.wait("a frame of the window", lambda s: s.get("frame", 0) > 0)
        window.do("key", "ctrl+q")
        window.ends_well()


def main():
    program, scene = map(os.path.abspath, sys.argv[1:])
    for tool in ("Xvfb", "xdotool"):
        if not shutil.which(tool):
            print(f"skipped: {tool} is missing")
            sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as name:
        def copied(part):
            """A folder for a part of the test, and a copy of the scene in a folder in it."""
            folder = pathlib.Path(name) / part
            (folder / "own").mkdir(parents=True)
            return folder, pathlib.Path(shutil.copy(scene, folder / "own" / "governor.json"))

        def explores():
            folder, _ = copied("bare")
            open_bare(program, scene, folder)
            folder, copy = copied("explored")
            with own_display() as display, Window(display, folder, program, copy) as window:
                explore(window, copy.parent)  # pictures go beside their scene

        def types_ahead():
            folder, copy = copied("ahead")
            with own_display() as display, Window(display, folder, program, copy) as window:
                type_ahead(window, copy)

        def crashes():
            folder, copy = copied("crashed")
            with own_display() as display:
                with Window(display, folder, program, copy) as window:
                    value = crash(window)
                with Window(display, folder, program, copy) as window:
                    recover(window, copy, value)

        side_by_side(explores, types_ahead, crashes)
    print("the window solves, draws, saves and recovers")


if __name__ == "__main__":
    main()
