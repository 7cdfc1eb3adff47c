"""How the real program ends, and what it does at rest, under Xvfb: signals and a lost display cost no work, nothing is
drawn or asked of the processor where nothing changes, and pipes and other programs' files hold nothing up.

Usage: window_end_test.py FLYBALL SCENE. Exits 77 with a message where Xvfb or xdotool are missing.
"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from window_test import LIMIT, SKIPPED, SPEED, Window, hidden_files, own_display, side_by_side, start_display


def fail(words):
    raise SystemExit("failed: " + words)


def kept_scene(folder, how):
    """The scene in the only autosave of the folder."""
    kept = [folder / name for name in hidden_files(folder)]
    if len(kept) != 1:
        fail(f"{how}: one autosave is left, but {kept}")
    return json.loads(kept[0].read_text().split("\n", 1)[1])


def speed_of(scene):
    return next(joint for joint in scene["joints"] if joint["name"] == "spin")["drive"]["speed"]


def position_of_ball(scene):
    return next(body for body in scene["bodies"] if body["name"] == "ball1")["position"]


def keep_another_speed(window):
    """Tries another speed and makes it the document's; returns it."""
    window.drag_speed()
    window.click("explored/keep")
    return window.wait("an edit", lambda s: s["unsaved"])["parameters"][SPEED]


def drag_without_pause(window):
    """Moves a ball, and the button stays down."""
    window.wait("the first answer", lambda s: s["answer"] > 0 and s["status"] == "converged")
    window.do("key", "Tab")
    window.wait("the tools", lambda s: "tools/joint" in s["widgets"])
    window.click("outline/bodies/ball1")
    x, y = window.place("gizmo/x")
    window.do("mousemove", x, y)
    window.do("mousedown", 1)
    for step in range(1, 5):
        window.do("mousemove", x + 6 * step, y)
    window.wait("an edit", lambda s: s["unsaved"])


def ends_and_keeps_speed(window, folder, wanted, speed, how):
    ends(window, wanted, how)
    if (kept := speed_of(kept_scene(folder, how))) != speed:
        fail(f"{how}: {kept} was kept for {speed}")


def ends_and_keeps_move(window, copy, wanted, how):
    ends(window, wanted, how)
    if position_of_ball(kept_scene(copy.parent, how)) == position_of_ball(json.loads(copy.read_text())):
        fail(f"{how}: the ball is where it was")


def ends(window, wanted, how):
    code = window.program.wait(LIMIT)
    if code != wanted:
        fail(f"{how}: the program ended with {code}")


def ticks(process):
    fields = pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
    return int(fields[11]) + int(fields[12])


def share_of_core(window, seconds):
    before = ticks(window.program.pid)
    time.sleep(seconds)
    return (ticks(window.program.pid) - before) / (seconds * os.sysconf("SC_CLK_TCK"))


def rests(window, what):
    """Nothing is drawn, and hardly anything done, while nothing happens."""
    window.wait("the notice fades", lambda s: not s["notice"])
    time.sleep(2)
    frame = window.state()["frame"]
    share = share_of_core(window, 4)
    if share > 0.01:
        fail(f"{what}: {100 * share:.1f} % of a core at rest")
    if window.state()["frame"] != frame:
        fail(f"{what}: drawn although nothing changed")


def rest_and_watch(window, copy):
    """At rest nothing is drawn; a file that another program replaces is read again all the same."""
    window.wait("the first answer", lambda s: s["answer"] > 0 and s["status"] == "converged")
    window.do("mousemove", 5, 5)
    rests(window, "open")
    scene = json.loads(copy.read_text())
    next(joint for joint in scene["joints"] if joint["name"] == "spin")["drive"]["speed"] = 7.5
    beside = copy.with_name("4913~")
    beside.write_text(json.dumps(scene))
    beside.rename(copy)  # as editors do
    window.wait("the file is read again", lambda s: s["parameters"][SPEED] == 7.5)
    rests(window, "after reading again")
    window.do("key", "space")
    window.wait("it plays", lambda s: s["playing"])
    number = subprocess.run(["xdotool", "search", "--name", "Flyball"], env=window.environment, check=True,
                            capture_output=True, text=True).stdout.split()[-1]
    subprocess.run(["xdotool", "windowunmap", "--sync", number], env=window.environment, check=True)
    rests(window, "playing unmapped")
    frame = window.state()["frame"]
    subprocess.run(["xdotool", "windowmap", "--sync", number], env=window.environment, check=True)
    window.wait("it plays on where it is seen", lambda s: s["frame"] > frame + 10)


def pipes(window):
    """A pipe that nobody writes to does not hold up the start, nor one that nobody reads a save."""
    shown = window.wait("the window in spite of the pipe", lambda s: s["frame"] > 3)
    if "no regular file" not in shown["problem"]:
        fail(f"no word on the pipe, but {shown['problem']!r}")
    window.program.kill()


def save_onto_pipe(window, copy):
    keep_another_speed(window)
    copy.unlink()
    os.mkfifo(copy)
    window.do("key", "ctrl+s")
    shown = window.wait("an answer to saving", lambda s: s["dialog"] or not s["unsaved"])
    if not shown["unsaved"]:
        fail("saved to a pipe")
    window.program.send_signal(signal.SIGTERM)
    if window.program.wait(LIMIT) != -signal.SIGTERM:
        fail("the program hangs at a pipe")


def main():
    program, scene = map(os.path.abspath, sys.argv[1:])
    for tool in ("Xvfb", "xdotool"):
        if not shutil.which(tool):
            print(f"skipped: {tool} is missing")
            sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as name:
        def begin(part, display, file="governor.json"):
            """The program with a copy of the scene, or beside it, in a folder of its own; and the copy."""
            folder = pathlib.Path(name) / part
            (folder / "own").mkdir(parents=True)
            copy = pathlib.Path(shutil.copy(scene, folder / "own" / "governor.json"))
            if file == "pipe":
                os.mkfifo(folder / "own" / file)
            return Window(display, folder, program, folder / "own" / file), copy

        def signals():
            for number in (signal.SIGTERM, signal.SIGHUP):
                with own_display() as display:
                    window, copy = begin(number.name, display)
                    with window:
                        speed = keep_another_speed(window)
                        window.program.send_signal(number)
                        ends_and_keeps_speed(window, copy.parent, -number, speed, number.name)
            with own_display() as display:
                window, copy = begin("dragging", display)
                with window:
                    drag_without_pause(window)
                    window.program.send_signal(signal.SIGINT)
                    ends_and_keeps_move(window, copy, -signal.SIGINT, "while dragging")

        def lost_displays():
            for part in ("display lost", "display lost while dragging"):
                dragging = part.endswith("dragging")
                doomed, display = start_display()
                window, copy = begin(part, display)
                with window:
                    try:
                        speed = drag_without_pause(window) if dragging else keep_another_speed(window)
                    finally:
                        doomed.kill()
                        doomed.wait()
                    if dragging:
                        ends_and_keeps_move(window, copy, 1, part)
                    else:
                        ends_and_keeps_speed(window, copy.parent, 1, speed, part)

        def at_rest():
            with own_display() as display:
                window, copy = begin("rest", display)
                with window:
                    rest_and_watch(window, copy)

        def at_pipes():
            with own_display() as display:
                window, _ = begin("pipe", display, file="pipe")
                with window:
                    pipes(window)
                window, copy = begin("saving", display)
                with window:
                    save_onto_pipe(window, copy)

        side_by_side(signals, lost_displays, at_rest, at_pipes)
    print("no work is lost at the end, and nothing is done at rest")


if __name__ == "__main__":
    main()
