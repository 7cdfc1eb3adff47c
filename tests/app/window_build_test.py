"""The swing pendulum built from an empty document in the real window, with mouse and keys alone.

Usage: window_build_test.py FLYBALL SCENE. Exits 77 with a message where Xvfb or xdotool are missing.
"""
import os
import pathlib
import shutil
import sys
import tempfile

from window_test import SKIPPED, Window, own_display


class Builder:
    def __init__(self, window):
        self.window = window

    def key(self, keys):
        self.window.do("key", keys)

    def command(self, keys):
        """A letter, which is a command while the hand is in the view."""
        left, top, right, bottom = self.window.state()["widgets"]["view"]
        self.window.do("mousemove", round((left + right) / 2), round((top + bottom) / 2))
        self.key(keys)

    def pixel(self, x, y):
        screen = self.window.state()["screen"]
        origin, right, up = screen["origin"], screen["x"], screen["y"]
        return [round(origin[i] + x * (right[i] - origin[i]) + y * (up[i] - origin[i])) for i in (0, 1)]

    def click_at(self, x, y):
        self.window.do("mousemove", *self.pixel(x, y))
        self.window.do("mousedown", 1)
        self.window.do("mouseup", 1)

    def zoom_to_height(self, metres):
        left, top, right, bottom = self.window.state()["widgets"]["view"]
        self.window.do("mousemove", round((left + right) / 2), round((top + bottom) / 2))
        for _ in range(60):
            screen = self.window.state()["screen"]
            seen = (bottom - top) / abs(screen["y"][1] - screen["origin"][1])
            if 0.9 * metres < seen < 1.1 * metres:
                return
            self.window.do("click", 4 if seen > metres else 5)
        raise SystemExit("the wheel does not zoom")

    def seen(self, widget):
        """Whether the whole of an inspector's widget is in its panel."""
        rect = self.window.state()["widgets"].get(widget)  # what of it can be seen
        return rect and rect[3] - rect[1] >= 16

    def click(self, widget):
        if widget.startswith("inspector/"):
            left, top, right, bottom = self.window.state()["widgets"]["view"]
            for button, most in ((4, 15), (5, 40)):
                for _ in range(most):
                    if self.seen(widget):
                        break
                    self.window.do("mousemove", round(right + 12), round(top + 200))
                    self.window.do("click", button)
        self.window.click(widget)

    def fill(self, field, text):
        self.click("inspector/" + field)
        self.key("ctrl+a")
        self.window.do("type", text)
        self.key("Return")

    def joint(self, x, y, kind, axis, name):
        self.click("tools/joint")
        self.click_at(x, y)
        self.window.wait("the card of the joint", lambda s: "tools/join" in s["widgets"])
        self.click("tools/type/" + kind)
        self.click("tools/axis/" + axis)
        self.click("tools/join")
        self.fill("name", name)


def build(window):
    b = Builder(window)
    window.wait("the first answer", lambda s: s["answer"] > 0)
    b.key("ctrl+n")
    window.wait("an empty document", lambda s: s["name"] == "Untitled")
    b.key("1")
    b.command("shift+r")  # the first steps make room
    b.zoom_to_height(7)
    b.click("inspector/gravity/none")

    b.command("shift+r")
    b.click_at(0, 0)
    b.click_at(1, 0)
    b.fill("name", "crank")  # what it weighs changes nothing
    b.command("shift+r")
    b.click_at(1, 0)
    b.click_at(2.4, 0)
    b.fill("name", "arm")
    b.fill("mass", "0")
    b.command("shift+b")
    b.click_at(2.1, 0)
    b.fill("name", "weight")
    b.fill("position/x", "2100 mm")
    b.fill("mass", "1")  # a ball turns as a point does

    b.joint(0, 0, "revolute", "z", "spin")
    b.click("inspector/drive")
    b.fill("drive/speed", "20 rad/s")
    b.joint(1, 0, "revolute", "z", "theta")
    b.click("inspector/spring")
    b.fill("spring/stiffness", "300")
    b.fill("spring/free", "1.0472 rad")
    b.joint(2.1, 0, "prismatic", "x", "d")
    b.fill("coordinate", "1.1")
    b.click("inspector/spring")
    b.fill("spring/stiffness", "50 kN/m")
    b.fill("spring/free", "1")
    b.key("Tab")

    state = window.wait("a steady state", lambda s: s["status"] == "converged" and "d" in s.get("coordinates", {}))
    found = state["coordinates"]
    if abs(found["theta"] - 0.4537717) > 5e-8 or abs(found["d"] - 1.0153129) > 5e-8:
        raise SystemExit(f"built another mechanism: {found}")
    b.key("ctrl+q")
    window.wait("a question", lambda s: "unsaved/discard" in s["widgets"])
    window.click("unsaved/discard")
    window.ends_well()


def main():
    program, scene = map(os.path.abspath, sys.argv[1:])
    for tool in ("Xvfb", "xdotool"):
        if not shutil.which(tool):
            print(f"skipped: {tool} is missing")
            sys.exit(SKIPPED)
    with (tempfile.TemporaryDirectory() as name, own_display() as display,
          Window(display, pathlib.Path(name), program, scene) as window):
        build(window)
    print("the pendulum was built in the window and settles where it should")


if __name__ == "__main__":
    main()
