"""Every command that takes over a second says on a terminal what it is doing and for how long, and wipes that at the
end; elsewhere nothing is printed. Run as: progress_test.py FLYBALL GOVERNOR"""

import json
import os
import pty
import re
import select
import signal
import subprocess
import sys
import tempfile
import time

FLYBALL, GOVERNOR = sys.argv[1:3]
LIMIT = 120  # s, far more than anything here takes
failures = []


def chain(links):
    """Links of 0.1 m on a driven shaft, dragged through the air: dense equations, which take their time."""
    bodies = [{"name": "hub", "mass": 1, "position": [0, 0, 0], "inertia": [1, 1, 1]}]
    joints = [{"name": "spin", "type": "revolute", "bodies": ["ground", "hub"], "at": [0, 0, 0],
               "axis": [0, 1, 0], "drive": {"speed": 5}}]
    for i in range(links):
        x, y = 0.05 + 0.01 * (i + 0.5), -0.1 * (i + 0.5)
        bodies.append({"name": f"b{i}", "mass": 0.1, "position": [x, y, 0], "inertia": [1e-4, 0, 1e-4]})
        joints.append({"name": f"j{i}", "type": "revolute", "bodies": ["hub" if i == 0 else f"b{i - 1}", f"b{i}"],
                       "at": [0.05 + 0.01 * i, -0.1 * i, 0], "axis": [0, 0, 1],
                       "spring": {"stiffness": 5, "free": 0}, "damping": 0.01})
    return {"flyball": 1, "name": "Chain", "gravity": [0, -9.80665, 0], "bodies": bodies, "joints": joints}


def on_terminal(arguments, until):
    """What appears on the terminal of a run, which is ended when `until` is in it."""
    child, terminal = pty.fork()
    if child == 0:
        os.environ["TERM"] = "xterm"
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, 1)
        os.execv(FLYBALL, [FLYBALL, *arguments])
    seen, begin, ended = "", time.monotonic(), False
    while time.monotonic() - begin < LIMIT:
        ready, _, _ = select.select([terminal], [], [], 0.05)
        if ready:
            try:
                data = os.read(terminal, 65536)
            except OSError:
                break  # the other end is closed
            if not data:
                break
            seen += data.decode(errors="replace")
        if until and re.search(until, seen) and not ended:
            os.kill(child, signal.SIGKILL)
            ended = True
    os.waitpid(child, 0)
    os.close(terminal)
    return seen


def check(condition, what):
    if not condition:
        failures.append(what)
        print("FAILED:", what)


def main():
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "chain.json")
        with open(scene, "w", encoding="utf-8") as file:
            json.dump(chain(180), file)
        vary = "joints.spin.drive.speed=0:20"
        long_ones = {
            "solve --all": (["solve", scene, "--all", "--search-time", "60"], r"\d+ s"),
            "sweep": (["sweep", GOVERNOR, "--vary", vary + ":300000"], r"solving \[[= ]+\] \d+ of 300000, \d+ s"),
            "branch": (["branch", scene, "--vary", vary], r"\d+ s"),
            "design": (["design", scene, "--vary", vary, "--want", "j0=0.1"], r"\d+ s"),
            "simulate": (["simulate", GOVERNOR, "--undamped", "--duration", "5000", "--rate", "1"],
                         r"simulating \[[= ]+\] \d+ %, \d+ s"),
            "compare": (["compare", GOVERNOR, "--repeats", "1000"], r"\d+ s"),
        }
        for name, (arguments, wanted) in long_ones.items():
            seen = on_terminal(arguments, wanted)
            check(re.search(wanted, seen), f"{name} shows its progress: {seen[-200:]!r}")

        # Wiped at the end: what the terminal is left with is an empty line.
        arguments = ["sweep", GOVERNOR, "--vary", vary + ":60000"]
        seen = on_terminal(arguments, None)
        if "solving" in seen:  # where this machine takes over a second
            check(seen.endswith("\r\x1b[K"), f"the bar is wiped: {seen[-60:]!r}")
        # No terminal, no bar.
        done = subprocess.run([FLYBALL, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              timeout=LIMIT, check=False)
        check(done.returncode == 0 and done.stderr == b"", f"nothing elsewhere: {done.stderr!r}")
    return 1 if failures else 0


sys.exit(main())
