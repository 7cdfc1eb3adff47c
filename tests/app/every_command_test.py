"""Every shipped scene and every case under every command, twice: the same bits but for run times; an exit of 0, 1
or 2 within a deadline; words wherever the exit is not 0; no number that is none in JSON and CSV. What takes a tenth of
a second or is ended by the clock runs once, and each of the commands that solve many times over runs on every third
scene. With FLYBALL_LONG=1 in the environment all run on all scenes, and what takes half a second twice.

Usage: every_command_test.py [--memcheck] FLYBALL FOLDER...

With --memcheck a few commands run under valgrind instead, where reading memory that nobody wrote is an error.
"""
import csv
import hashlib
import io
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

MEMCHECK = "--memcheck" in sys.argv
FLYBALL, *FOLDERS = [word for word in sys.argv[1:] if word != "--memcheck"]
DEADLINE = 60  # s on the clock, of a machine that may be busy; on an idle one the slowest takes a tenth of it
CAMPAIGN = os.environ.get("FLYBALL_LONG") == "1"
LONG = 0.5 if CAMPAIGN else 0.1  # s
SKIPPED = 77
RUN_TIMES = {"run_time_s", "motion_s", "direct_s", "ratio"}
DRAWN = {"governor", "brace_of_wrong_length"}  # a picture takes a second: two of them
MANY = 40  # bodies, with which many solutions take too long
# Comparisons with motions that go on to a limit of time: how far they come is the clock's affair.
CLOCKED = {"motion_with_a_far_point", "motion_of_a_string_held_far_away"}
ENDLESS = CLOCKED | {"motion_with_extreme_damping"}  # and motions by themselves
# Left to the campaign: these on two scenes of three, so that each scene has a third of them...
MANY_SOLUTIONS = ("branch", "branch --all", "branch --over", "campbell", "compare", "design", "solve --all", "spread",
                  "sweep --all")
# ... and what takes seconds on a scene, where it does on others, in less time, what it does there.
SECONDS = {
    "branch --all": {"asymmetric_sleeping_top", "chain20", "crash_simulate_lost_mass", "error_estimate_of_rotors",
                     "five_bodies_from_afar", "gear_train", "governor_bearing", "governor_friction", "governor_hartnell",
                     "governor_parametric", "governor_porter", "governor_proell", "governor_watt",
                     "motion_of_a_string_held_far_away", "motion_with_extreme_damping", "oil_whip",
                     "qz_without_convergence", "rotating_saddle", "rotor_oil_whip", "triple_pendulum_turning",
                     "uninitialised_eigenvalues_of_a_pencil", "watt_governor"},
    "solve --all": {"chain20", "triple_pendulum_turning"},
    "branch": {"uninitialised_eigenvalues"},
    "sweep": {"uninitialised_eigenvalues"},
    "branch --over": {"asymmetric_sleeping_top", "governor_friction", "qz_without_convergence", "rotating_saddle",
                      "steady_at_another_root", "uninitialised_eigenvalues_of_a_pencil"},
    "campbell": {"qz_without_convergence", "rotating_saddle", "uninitialised_eigenvalues_of_a_pencil"},
}


def first_coordinate(scene):
    """A coordinate that is free, to ask `design` for."""
    for joint in scene["joints"]:
        if joint["type"] in ("revolute", "prismatic") and "drive" not in joint:
            return joint["name"]
    return None


def a_parameter(scene):
    """The address and range of a number to vary: the first slider's, else a drive's speed, else a mass."""
    for slider in scene.get("sliders", []):
        return slider["parameter"], *slider["range"]
    for joint in scene["joints"]:
        if isinstance(joint.get("drive"), dict):
            speed = joint["drive"]["speed"]
            return f"joints.{joint['name']}.drive.speed", 0, 2 * speed if abs(speed) < 1e3 and speed else 10
    for body in scene["bodies"]:
        if body["mass"]:
            return f"bodies.{body['name']}.mass", body["mass"] / 2, 2 * body["mass"]
    return "gravity.1", 0, -9.80665


def kind_of(words):
    return words[0] + next((" " + word for word in ("--all", "--over") if word in words), "")


def is_left_to_the_campaign(words, number, path):
    """Of the scene of this number."""
    kind = kind_of(words)
    if kind in MANY_SOLUTIONS and (number + MANY_SOLUTIONS.index(kind)) % 3:
        return True
    return path.stem in SECONDS.get(kind, ())


def commands(path):
    """What is run on a scene in the campaign: lists of words, in which OUT is a file that the run may write."""
    yield ["check"]
    yield ["check", "--json"]
    yield ["solve"]
    yield ["solve", "--json"]
    yield ["solve", "--nearest", "--modes", "4", "--json"]
    yield ["modes", "--count", "4", "--json"]
    limit = ["--time-limit", "0.3"] if path.stem in ENDLESS else []
    yield ["simulate", "--duration", "0.1", "--json", "--csv", "OUT", *limit]
    limit = ["--time-limit", "1"] if path.stem in CLOCKED else []
    yield ["compare", "--repeats", "1", "--json", "--duration", "0.02", *limit]
    try:
        scene = json.loads(path.read_text())
    except ValueError:
        return
    address, low, high = a_parameter(scene)
    vary = ["--vary", f"{address}={low!r}:{high!r}"]
    yield ["sweep", "--vary", f"{address}={low!r}:{high!r}:3", "--csv", "OUT"]
    yield ["sweep", "--vary", f"{address}={low!r}:{high!r}:3", "--csv", "-"]
    yield ["branch", *vary, "--csv", "OUT", "--svg", "OUT2"]
    if len(scene["bodies"]) > MANY:
        return
    if path.stem in DRAWN:
        yield ["render", "--size", "160x120", "-o", "OUT"]
        yield ["render", "--size", "160x120", "--mode", "1", "-o", "OUT"]
        yield ["report", "--size", "160x120", "-o", "OUT"]
    wanted = first_coordinate(scene)
    if wanted:
        yield ["linearize", "--inputs", address, f"torque({wanted})", "--outputs", wanted, "--frequencies",
               "0.01:100:20", "--json"]
        yield ["design", "--connected", *vary, "--want", f"{wanted}=0.1", "--json"]
    yield ["solve", "--all", "--json"]
    yield ["branch", "--all", *vary, "--json"]
    yield ["campbell", *vary, "--json"]
    if scene["name"] == "Governor with engine":
        yield ["hunting", "--vary", "joints.slide.damping=5:60", "--vary", "parameters.gain=1000:20000", "--json"]
    yield ["sweep", "--all", "--search-time", "0.05", "--vary", f"{address}={low!r}:{high!r}:2", "--csv", "OUT"]
    over = "gravity.0=0:1:2" if address == "gravity.1" else "gravity.1=0:-10:2"
    yield ["branch", *vary, "--over", over, "--csv", "OUT"]
    yield ["spread", "--tolerance", f"{address}=normal:{abs(high - low) / 50 or 1!r}", "--samples", "20", "--json",
           "--csv", "OUT"]


def without_times(value):
    if isinstance(value, dict):
        return {key: None if key in RUN_TIMES else without_times(part) for key, part in value.items()}
    return [without_times(part) for part in value] if isinstance(value, list) else value


def no_number(word):
    raise ValueError(f"{word} in JSON")


def read_json(text):
    value = json.loads(text, parse_constant=no_number)

    def look(part):
        if isinstance(part, float) and not math.isfinite(part):
            raise ValueError("a number beyond all numbers in JSON")
        for inner in part.values() if isinstance(part, dict) else part if isinstance(part, list) else ():
            look(inner)

    look(value)
    return value


def read_csv(text):
    rows = list(csv.reader(io.StringIO(text)))
    timed = {i for i, name in enumerate(rows[0]) if name in RUN_TIMES} if rows else set()
    for row in rows:
        if len(row) != len(rows[0]):
            raise ValueError(f"{len(row)} cells under {len(rows[0])} names in CSV")
        for cell in row:
            if re.fullmatch(r"[+-]?(nan|inf|infinity)(\(.*\))?", cell.strip(), re.IGNORECASE):
                raise ValueError(f"{cell} in CSV")
    return [[None if i in timed else cell for i, cell in enumerate(row)] for row in rows]


def normal(text, words, where):
    """What must be the same in every run."""
    if not text:
        return ""
    as_json = "--json" in words and where == "stdout"
    if as_json:
        return json.dumps(without_times(read_json(text)))
    as_csv = "--csv" in words and (where == "OUT" or words[words.index("--csv") + 1] == "-")
    if as_csv:
        return json.dumps(read_csv(text))
    if re.search(r"(^|[\s=(\[])[+-]?(nan|inf)\b", text, re.IGNORECASE):
        raise ValueError("a number that is none in the text")
    text = re.sub(r"<time>.*?</time>", "#", text)  # in a report
    return re.sub(r"[\d.]+ (?:ns|µs|us|ms|s)\b", "#", text)


def run_once(words, path):
    with tempfile.TemporaryDirectory() as folder:
        files = {name: pathlib.Path(folder) / name for name in ("OUT", "OUT2")}
        full = [FLYBALL, words[0], str(path)] + [str(files.get(word, word)) for word in words[1:]]
        done = subprocess.run(full, stdin=subprocess.DEVNULL, capture_output=True, timeout=DEADLINE)
        out, error = done.stdout.decode(), done.stderr.decode()
        if done.returncode not in (0, 1, 2):
            raise ValueError(f"exit {done.returncode}: {error[-300:]}")
        if done.returncode and not error.strip():
            told = read_json(out).get("message") if "--json" in words and out else None if "-" in words else out
            if not (told or "").strip():
                raise ValueError(f"exit {done.returncode} without a word")
        if done.returncode == 2 and not error.strip():
            raise ValueError("exit 2 without a word on standard error")
        parts = [str(done.returncode), normal(out, words, "stdout"), normal(error, words, "stderr")]
        for name, file in files.items():
            if words[0] == "render" and file.exists():
                parts.append(hashlib.sha256(file.read_bytes()).hexdigest())
            elif file.exists():
                parts.append(normal(file.read_text(), words, name))
            else:
                parts.append("no file")
        left = sorted(p.name for p in pathlib.Path(folder).iterdir() if p.name not in files)
        if left:
            raise ValueError(f"left behind: {left}")
        return [part.replace(folder, "") for part in parts]


def difference(one, two):
    for a, b in zip(one, two):
        if a != b:
            at = next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
            return f"...{a[max(0, at - 60):at + 60]}... and then ...{b[max(0, at - 60):at + 60]}..."
    return "in nothing"


def complaint(words, path):
    try:
        begun = time.monotonic()
        first = run_once(words, path)
        once = "--time-limit" in words or time.monotonic() - begun > LONG
        second = first if once else run_once(words, path)
    except subprocess.TimeoutExpired:
        return f"not done after {DEADLINE} s"
    except (ValueError, UnicodeDecodeError) as error:
        return str(error)
    return None if first == second else "another answer the second time: " + difference(first, second)


def memcheck():
    valgrind = shutil.which("valgrind")
    if not valgrind:
        print("valgrind is not installed: nothing was looked at")
        return SKIPPED
    scenes = {path.stem: path for folder in FOLDERS for path in pathlib.Path(folder).glob("*.json")}
    looked_at = [
        ("governor", ["solve", "--json"]),
        ("conical_pendulum", ["branch", "--vary", "joints.spin.drive.speed=5:8", "--all", "--json"]),
        ("watt_governor", ["branch", "--vary", "joints.spin.drive.speed=11.5:12.5", "--json"]),
        ("uninitialised_eigenvalues_of_a_pencil", ["solve", "--json"]),
        ("crash_simulate_lost_mass", ["simulate", "--duration", "0.01", "--json"]),
    ]
    wrong = 0
    for name, words in looked_at:
        full = [valgrind, "--quiet", "--error-exitcode=99", "--leak-check=no", FLYBALL, words[0], str(scenes[name]),
                *words[1:]]
        done = subprocess.run(full, stdin=subprocess.DEVNULL, capture_output=True, timeout=400)
        if done.returncode not in (0, 1, 2):
            wrong += 1
            print(f"{name} {' '.join(words)}: exit {done.returncode}\n{done.stderr.decode()[:3000]}")
    print(f"{len(looked_at)} runs under valgrind, {wrong} wrong")
    return 1 if wrong else 0


def main():
    if MEMCHECK:
        return memcheck()
    paths = sorted(path for folder in FOLDERS for path in pathlib.Path(folder).glob("*.json"))
    jobs = [(words, path) for number, path in enumerate(paths) for words in commands(path)
            if CAMPAIGN or not is_left_to_the_campaign(words, number, path)]
    wrong = 0
    for words, path in jobs:
        if said := complaint(words, path):
            wrong += 1
            print(f"{path.name}: flyball {' '.join(words)}: {said}")
    print(f"{len(jobs)} commands on {len(paths)} scenes: {wrong} wrong")
    return 1 if wrong or not jobs else 0


sys.exit(main())
