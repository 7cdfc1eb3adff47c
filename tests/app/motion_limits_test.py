"""Motions on the command line that would not end: where the time limit stops them, and what is kept.

Usage: motion_limits_test.py FLYBALL SCENES CASES
"""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import time

FLYBALL = sys.argv[1]
SCENES, CASES = (pathlib.Path(folder) for folder in sys.argv[2:4])
ENDLESS = ["motion_with_a_far_point", "motion_with_extreme_damping", "motion_of_a_string_held_far_away"]


def check(what, holds):
    if not holds:
        sys.exit(f"failed: {what}")


def run(*arguments):
    """Exit code, standard output and error, seconds."""
    start = time.monotonic()
    done = subprocess.run([FLYBALL, *map(str, arguments)], capture_output=True, text=True, timeout=120)
    return done.returncode, done.stdout, done.stderr, time.monotonic() - start


with tempfile.TemporaryDirectory() as folder:
    table = pathlib.Path(folder) / "run.csv"
    # A motion of a day in half a second: what was computed until then is there, and the reason.
    code, out, error, seconds = run("simulate", SCENES / "pendulum.json", "--undamped", "--duration", 86400,
                                    "--rate", 10, "--time-limit", 0.5, "--csv", table)
    check("exit 1 at the limit", code == 1)
    check("the reason on standard error", "time limit of 0.5 s" in error and "samples, is kept" in error)
    check("within seconds", seconds < 20)
    rows = list(csv.DictReader(table.open()))
    check("rows up to there", len(rows) > 3 and float(rows[-1]["t"]) > float(rows[0]["t"]))
    check("numbers in all of them", all(value not in ("", "nan", "inf") for row in rows for value in row.values()))
    code, out, error, seconds = run("simulate", SCENES / "pendulum.json", "--undamped", "--duration", 86400,
                                    "--rate", 10, "--time-limit", 0.5, "--json")
    check("the object with it", code == 1 and json.loads(out)["status"] == "time_limit" and error)

    # Nothing at all: the old table stays.
    before = table.read_bytes()
    code, out, error, seconds = run("simulate", SCENES / "governor.json", "--time-limit", 1e-9, "--csv", table)
    check("no motion began", code == 1 and "before the motion began" in error)
    check("the old table is as it was", table.read_bytes() == before)
    code, out, error, seconds = run("simulate", SCENES / "governor.json", "--time-limit", 1e-9, "--json")
    check("nulls", code == 1 and json.loads(out)["time"] is None)

    for name in ENDLESS:
        for command in (["simulate", "--duration", 0.5], ["compare"]):
            code, out, error, seconds = run(command[0], CASES / (name + ".json"), *command[1:], "--time-limit", 1)
            check(f"{command[0]} {name} ends", seconds < 30)
            check(f"{command[0]} {name} says why", code == 0 or (code in (1, 2) and len(error) > 20))
    for name in ("crash_simulate_lost_mass", "crash_simulate_heavy_and_massless"):
        for command in (["simulate", "--duration", 0.5], ["compare"]):
            code, out, error, seconds = run(command[0], CASES / (name + ".json"), *command[1:])
            check(f"{command[0]} {name} says why", code == 0 or (code in (1, 2) and len(error) > 20))

    # A comparison keeps what it has measured.
    code, out, error, seconds = run("compare", SCENES / "governor.json", "--time-limit", 0.2, "--csv", table)
    check("a comparison is broken off", code == 1 and "time limit of 0.2 s" in error and seconds < 20)
    rows = list(csv.DictReader(table.open()))
    check("with the direct solution", any(row["method"] == "direct_answer" for row in rows))
