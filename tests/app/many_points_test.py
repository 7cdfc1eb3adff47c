"""Studies of many points: the same bytes by one process, by shards put together and by processes under MPI; columns
for NumPy; memory that does not grow with the points.

Usage: many_points_test.py FLYBALL SCENE [--processes]

With --processes under mpirun alone; exit 77 where there is none, or the program was built without MPI.
"""
import csv
import json
import math
import os
import pathlib
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zipfile

FLYBALL, SCENE = sys.argv[1:3]
SKIPPED = 77
SPEED = "joints.spin.drive.speed"
# What shares its work besides a sweep: of each how many rows at least it has.
STUDIES = {
    "spread": (1501, ["spread", pathlib.Path(SCENE).with_name("governor_parametric.json"), "--samples", 1501,
                      "--tolerance", "parameters.L=uniform:45%", "--tolerance", "parameters.k=triangular:20"]),
    # Arms too long for their links make no mechanism: a row each.
    "branch": (2000, ["branch", pathlib.Path(SCENE).with_name("governor_parametric.json"), "--vary",
                      "parameters.w=5:15", "--over", "parameters.L=0.1:0.24:15", "--over", "parameters.k=500:1500:3"]),
    "branch_all": (2000, ["branch", pathlib.Path(SCENE).with_name("conical_pendulum.json"), "--vary",
                          "joints.spin.drive.speed=0:10", "--over", "gravity.1=-4:-16:9", "--all"]),
    "sweep_all": (90, ["sweep", pathlib.Path(SCENE).with_name("conical_pendulum.json"), "--all", "--vary",
                        "joints.spin.drive.speed=0:10:6", "--vary", "gravity.1=-4:-16:5"]),
}
failures = []


def check(right, what):
    if not right:
        failures.append(what)
        print("failed:", what)


def run(*words, before=()):
    done = subprocess.run([*before, FLYBALL, *map(str, words)], capture_output=True, text=True, timeout=120)
    return done.returncode, done.stdout, done.stderr


def sweep(*words, **more):
    return run("sweep", SCENE, "--vary", f"{SPEED}=5:20:501", "--vary", "bodies.collar.mass=0.5:3:3", *words, **more)


def columns_of(file):
    """The arrays of an .npz file by name, read without NumPy: (descr, values)."""
    columns = {}
    with zipfile.ZipFile(file) as archive:
        check(archive.testzip() is None, f"checksums of {file}")
        for name in archive.namelist():
            data = archive.read(name)
            check(data[:8] == b"\x93NUMPY\x01\x00", f"magic of {name}")
            length = struct.unpack("<H", data[8:10])[0]
            check((10 + length) % 64 == 0 and data[9 + length:10 + length] == b"\n", f"head of {name}")
            head = eval(data[10:10 + length])  # a dictionary of constants, by the format
            count = head["shape"][0]
            body = data[10 + length:]
            kind = head["descr"]
            if kind == "<f8":
                values = struct.unpack(f"<{count}d", body)
            elif kind == "|i1":
                values = struct.unpack(f"{count}b", body)
            else:
                size = int(kind[2:])
                values = [body[i * size:(i + 1) * size].rstrip(b"\0").decode() for i in range(count)]
            columns[name.removesuffix(".npy")] = values
    return columns


def check_columns(table, npz):
    head, *rows = [line.split(",") for line in table.read_text().splitlines()]
    columns = columns_of(npz)
    check(list(columns) == head, "npz has the columns of the CSV")
    for i, name in enumerate(head):
        cells = [row[i] for row in rows]
        values = columns[name]
        if name in ("status", "fate"):
            check(list(values) == cells, "status in npz")
        elif name == "stable":
            check([{"true": 1, "false": 0, "": -1}[cell] for cell in cells] == list(values), "stable in npz")
        else:
            same = all(value != value if cell == "" else float(cell) == value for cell, value in zip(cells, values))
            check(same and len(cells) == len(values), f"{name} in npz")
    try:
        import numpy
    except ImportError:
        print("without NumPy: read by hand alone")
        return
    with numpy.load(npz) as arrays:
        check(list(arrays) == head, "NumPy finds the columns")
        if "slide" not in head or "status" not in head:
            return
        check(arrays["slide"].dtype == numpy.float64 and len(arrays["slide"]) == len(rows), "NumPy reads numbers")
        check(arrays["status"][0].decode() == rows[0][head.index("status")], "NumPy reads words")


def check_shards(folder):
    whole, npz, merged = folder / "whole.csv", folder / "whole.npz", folder / "merged.csv"
    code, _, error = sweep("--csv", whole, "--npz", npz, "--no-times")
    check(code == 0, f"whole sweep: {error}")
    check_columns(whole, npz)
    code, out, _ = sweep("--csv", "-", "--no-times")
    check(out == whole.read_text(), "standard output has the same bytes")

    parts = [folder / f"part{i}.csv" for i in range(1, 8)]
    for i, part in enumerate(parts, 1):
        code, _, error = sweep("--shard", f"{i}/7", "--csv", part)
        check(code == 0, f"shard {i}: {error}")
    code, _, error = run("merge", *reversed(parts), "-o", merged)
    check(code == 0 and merged.read_bytes() == whole.read_bytes(), f"merged CSV is the whole's: {error}")
    code, _, error = run("merge", *parts, "-o", folder / "merged.npz")
    check(code == 0 and (folder / "merged.npz").read_bytes() == npz.read_bytes(), f"merged npz is the whole's: {error}")

    # A killed shard leaves nothing in its place, and is done again alone.
    long = ["sweep", SCENE, "--vary", f"{SPEED}=5:20:300000", "--shard", "2/2", "--csv", str(folder / "killed.csv")]
    killed = subprocess.Popen([FLYBALL, *long])
    time.sleep(0.3)
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    check(not (folder / "killed.csv").exists(), "a killed shard leaves no file")
    parts[3].unlink()
    code, _, error = run("merge", *parts, "-o", merged)
    check(code == 2 and str(parts[3]) in error, f"a part that is not there is named: {error}")
    code, _, error = run("merge", *parts[:3], *parts[4:], "-o", merged)
    check(code == 2 and "missing 4" in error, f"what is missing is told: {error}")
    check(sweep("--shard", "4/7", "--csv", parts[3])[0] == 0, "a shard again")
    merged.unlink()
    check(run("merge", *parts, "-o", merged)[0] == 0 and merged.read_bytes() == whole.read_bytes(), "merged again")

    # Parts that do not belong together.
    def refused(words, replace, what, expected):
        kept = parts[2].read_bytes()
        if words:
            run("sweep", *words, "--csv", parts[2])
        else:
            parts[2].write_bytes(replace(kept))
        merged.unlink(missing_ok=True)
        code, _, error = run("merge", *parts, "-o", merged)
        check(code == 2 and expected in error and parts[2].name in error, f"{what}: {code} {error}")
        check(not merged.exists(), f"{what}: no file")
        parts[2].write_bytes(kept)

    vary = ["--vary", f"{SPEED}=5:20:501", "--vary", "bodies.collar.mass=0.5:3:3"]
    refused([SCENE, *vary, "--set", "gravity.1=-9", "--shard", "3/7"], None, "another scene", "its scene")
    refused([SCENE, *vary[:3], "bodies.collar.mass=0.5:3:4", "--shard", "3/7"], None, "another grid", "its variations")
    refused([SCENE, *vary, "--shard", "3/8"], None, "another division", "its number of parts")
    refused([SCENE, *vary, "--shard", "2/7"], None, "one twice", "expected each part once")
    refused(None, lambda b: b[:-40], "cut off", "damaged")
    refused(None, lambda b: b + b"1,2,3\n", "too long", "damaged")
    rows = lambda b: b.split(b"\n")
    refused(None, lambda b: b"\n".join(rows(b)[:2] + rows(b)[3:1:-1] + rows(b)[4:]), "rows exchanged", "damaged")
    refused(None, lambda b: b.replace(b",true,", b",false,", 1), "a word changed", "damaged")
    refused(None, lambda b: b[5:], "no part", "expected a part, as")
    code, _, error = run("merge", *parts, "-o", parts[0])
    check(code == 2, f"a part is not written over: {error}")
    check(sweep("--shard", "8/7", "--csv", merged)[0] == 2, "part 8 of 7")
    check(sweep("--shard", "1/7")[0] == 2, "a shard without a file")
    # More parts than points.
    few = ["sweep", SCENE, "--vary", f"{SPEED}=5:20:2", "--no-times"]
    run(*few, "--csv", whole)
    for i in range(1, 4):
        run(*few, "--shard", f"{i}/3", "--csv", folder / f"few{i}.csv")
    run("merge", *[folder / f"few{i}.csv" for i in range(1, 4)], "-o", merged)
    check(merged.read_bytes() == whole.read_bytes(), "more parts than points")


def check_studies(folder):
    """Whatever shares its work: parts put together are the whole, one done again alone, too."""
    for name, (least, words) in STUDIES.items():
        whole, merged, npz = folder / f"{name}.csv", folder / f"{name}_merged.csv", folder / f"{name}.npz"
        code, _, error = run(*words, "--csv", whole)
        count = len(whole.read_text().splitlines()) - 1
        check(code == 0 and count >= least, f"{name}: {error} {count} rows")
        check(run(*words, "--csv", "-")[1] == whole.read_text(), f"{name}: standard output has the same bytes")
        parts = [folder / f"{name}{i}.csv" for i in range(1, 4)]
        for i, part in enumerate(parts, 1):
            code, out, error = run(*words, "--shard", f"{i}/3", "--csv", part)
            check(code == 0 and out == "", f"{name}, shard {i}: {error}")
        parts[1].unlink()
        code, _, error = run("merge", parts[0], parts[2], "-o", merged)
        check(code == 2 and "missing 2" in error and not merged.exists(), f"{name}: what is missing is told: {error}")
        run(*words, "--shard", "2/3", "--csv", parts[1])
        code, _, error = run("merge", *reversed(parts), "-o", merged)
        check(code == 0 and merged.read_bytes() == whole.read_bytes(), f"{name}: merged is the whole: {error}")
        code, _, error = run("merge", *parts, "-o", npz)
        check(code == 0 and {len(values) for values in columns_of(npz).values()} == {count}, f"{name}: npz: {error}")
        kept = parts[1].read_bytes()
        for damage, what in ((kept[:-30], "cut off"), (kept + b"1,2\n", "too long"),
                             (kept.replace(b"\n", b"\n1,2\n", 1), "a row too many")):
            parts[1].write_bytes(damage)
            merged.unlink(missing_ok=True)
            code, _, error = run("merge", *parts, "-o", merged)
            check(code == 2 and "damaged" in error and parts[1].name in error and not merged.exists(),
                  f"{name}, {what}: {code} {error}")
        run(*words, "--set", "gravity.1=-9", "--shard", "2/3", "--csv", parts[1])
        code, _, error = run("merge", *parts, "-o", merged)
        check(code == 2 and "its scene" in error, f"{name}, another scene: {error}")


def check_statistics(folder):
    """Statistics of parts are those of the whole; other seeds and sweeps do not go with them."""
    words = STUDIES["spread"][1]
    parts = [folder / f"seed{i}.csv" for i in range(1, 3)]
    for i, part in enumerate(parts, 1):
        run(*words, "--shard", f"{i}/2", "--csv", part)
    whole = json.loads(run(*words, "--json", "--npz", folder / "whole.npz")[1])
    merged = json.loads(run("merge", *parts, "-o", folder / "both.csv", "--json")[1])
    run("merge", *parts, "-o", folder / "both.npz")
    check((folder / "both.npz").read_bytes() == (folder / "whole.npz").read_bytes(), "merged npz is the whole's")
    check_columns(folder / "both.csv", folder / "both.npz")
    check(whole.pop("run_time_s") > 0 and merged.pop("run_time_s") is None, "merging tells no run time")
    check(whole == merged and whole["fates"]["no_mechanism"] > 0 and whole["samples"] == 1501, f"statistics: {merged}")
    run(*words, "--seed", 2, "--shard", "2/2", "--csv", parts[1])
    code, _, error = run("merge", *parts, "-o", folder / "both.csv")
    check(code == 2 and "its seed" in error, f"another seed: {error}")
    sweep("--shard", "2/2", "--csv", parts[1])
    code, _, error = run("merge", *parts, "-o", folder / "both.csv")
    check(code == 2 and "its study" in error, f"a sweep and a spread: {error}")


def rows_of(file):
    with open(file, newline="") as text:
        return list(csv.DictReader(text))


def check_grids(folder):
    """Forks of a conical pendulum over gravity, and how many equilibria there are on either side of them."""
    length = 0.7  # m, of the scene's pendulum
    run(*STUDIES["branch_all"][1], "--csv", folder / "forks.csv")
    forks = [row for row in rows_of(folder / "forks.csv") if row["special"] == "branch_point"]
    check(len({row["gravity.1"] for row in forks}) == 9, "a fork at each place of the grid")
    for row in forks:
        speed, fork = float(row[SPEED]), math.sqrt(-float(row["gravity.1"]) / length)
        check(abs(speed - fork) < 1e-9, f"a fork at {speed} rather than {fork}")
    run(*STUDIES["sweep_all"][1], "--csv", folder / "regions.csv")
    for row in rows_of(folder / "regions.csv"):
        beyond = float(row[SPEED]) ** 2 * length > -float(row["gravity.1"])
        check(row["equilibria"] == ("4" if beyond else "2"), f"equilibria: {row}")
    # What cannot be made is told in its place, and where nothing can, on standard error, too.
    words = STUDIES["branch"][1]
    run(*words, "--csv", folder / "arms.csv")
    for row in rows_of(folder / "arms.csv"):
        right = float(row["parameters.L"]) < 0.21844  # twice the link
        check((row["status"] == "converged") == right and (right or "not finite" in row["note"]), f"a place: {row}")
        check(not right or re.fullmatch("((begins|ends): the (beginning|end) of the range)?", row["note"]), f"an end: {row}")
    told = json.loads(run(*words, "--json")[1])
    check([place["status"] for place in told["points"]].count("infeasible") == 9 and len(told["points"]) == 45,
          "JSON has each place")
    code, out, error = run(*words[:5], "parameters.L=0.23:0.24:2")
    check(code == 1 and "no branch at any of the 2 places" in error and out.count("infeasible") == 2, f"none: {error}")
    for wrong, expected in ((["--over", "parameters.w=1:2:2"], "varied already"),
                            (["--over", "parameters.none=1:2:2"], "parameters.none"),
                            (["--over", "parameters.L=0.1:0.2"], "address=from:to:count"),
                            (["--shard", "1/2", "--csv", folder / "x.csv"], "--over"),
                            (["--over", "parameters.L=0.1:0.2:2", "--svg", folder / "x.svg"], "excludes")):
        code, _, error = run(*words[:4], *wrong)
        check(code == 2 and expected in error, f"{wrong}: {code} {error}")


def check_turning(folder):
    """What turns with the drives has its speed for a cell, and moves no other out of its column."""
    scene, file = pathlib.Path(SCENE).with_name("governor_bearing.json"), folder / "turning.csv"
    run("sweep", scene, "--vary", f"{SPEED}=10:20:3", "--csv", file)
    head, *rows = [line.split(",") for line in file.read_text().splitlines()]
    for row in rows:
        turns = float(row[head.index("bearing.speed")]) == -float(row[head.index(SPEED)])
        check(turns and row[head.index("lift")] == row[head.index("slide")], f"{row}")


def check_memory(folder):
    def memory(points):  # kB, of the largest child so far
        code, _, error = run("sweep", SCENE, "--vary", f"{SPEED}=10:20:{points}", "--csv", folder / "many.csv",
                             "--npz", folder / "many.npz")
        check(code == 0, f"{points} points: {error}")
        return resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss

    # A few blocks wait for each core's thread: of two cores, so that these are full with few points.
    cores = os.sched_getaffinity(0)
    os.sched_setaffinity(0, sorted(cores)[:2])
    few, many = memory(10_000), memory(100_000)
    os.sched_setaffinity(0, cores)
    print(f"memory: {few} kB for 10000 points, {many} kB for 100000")
    check(many < few + 8_000, "memory does not grow with the points")


def check_processes(folder):
    mpirun = shutil.which("mpirun")
    if not mpirun:
        sys.exit(SKIPPED)
    whole, npz, together = folder / "whole.csv", folder / "whole.npz", folder / "together.csv"
    sweep("--csv", whole, "--npz", npz, "--no-times")
    for count in (1, 2, 5):
        start = [mpirun, "--allow-run-as-root", "--oversubscribe", "-n", str(count)]
        code, _, error = sweep("--csv", together, "--npz", folder / "together.npz", before=start)
        if "was built where MPI is" in error:
            sys.exit(SKIPPED)
        check(code == 0, f"{count} processes: {error}")
        check(together.read_bytes() == whole.read_bytes(), f"{count} processes give the same CSV")
        check((folder / "together.npz").read_bytes() == npz.read_bytes(), f"{count} processes give the same npz")
        together.unlink()
    for name, (_, words) in STUDIES.items():
        run(*words, "--csv", whole)
        start[-1] = "3"  # counts are the sweep's affair: all studies are shared out by the same code
        code, _, error = run(*words, "--csv", together, before=start)
        check(code == 0 and together.read_bytes() == whole.read_bytes(), f"{name} by 3 processes: {error}")
        together.unlink(missing_ok=True)
    code, _, error = run("sweep", SCENE, "--vary", "bodies.collar.mass=1:-1:2001", "--csv", together, before=start)
    check(code == 2 and "bodies.collar.mass: expected zero or more" in error, f"a mistake at some point: {error}")
    code, _, error = sweep("--csv", folder / "nowhere" / "x.csv", before=start)
    check(code == 2 and "cannot write" in error, f"a file that cannot be written: {error}")
    code, _, error = run("sweep", folder / "none.json", "--vary", "a=1:2:3", "--csv", together, before=start)
    check(code == 2 and "cannot read" in error and not together.exists(), f"a scene that is not there: {error}")


with tempfile.TemporaryDirectory() as name:
    if "--processes" in sys.argv:
        check_processes(pathlib.Path(name))
    else:
        check_memory(pathlib.Path(name))  # first: it looks at the largest process until then
        check_shards(pathlib.Path(name))
        check_studies(pathlib.Path(name))
        check_statistics(pathlib.Path(name))
        check_grids(pathlib.Path(name))
        check_turning(pathlib.Path(name))
sys.exit(1 if failures else 0)
