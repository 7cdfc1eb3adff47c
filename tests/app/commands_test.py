"""The commands as a shell sees them: every refusal has its reason, nothing printed steers a terminal, tables are
safe to open, no scene is overwritten, and nothing waits or reads for ever.

Usage: commands_test.py FLYBALL CASES SCENE, with a folder of cases and a scene that has a steady state.
"""
import csv
import io
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import zipfile

FLYBALL, CASES, SCENE = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]
SPEED = "joints.spin.drive.speed"
LIMIT = 120  # seconds, for anything
failures = []


def check(what, holds):
    if not holds:
        print("failed:", what)
        failures.append(what)


def run(*arguments, **options):
    done = subprocess.run([FLYBALL, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          timeout=LIMIT, **options)
    return done.returncode, done.stdout, done.stderr.decode()


def reasons(folder):
    """Whatever the output and wherever it goes, exit 1 says why in one line, and leaves older files alone."""
    scene = CASES / "no_equilibrium.json"
    old = folder / "old"
    forms = [["solve"], ["solve", "--all"], ["solve", "--json"], ["solve", "--nearest"], ["design", "--vary",
             f"{SPEED}=0:20", "--want", "h=0.2"], ["compare"], ["compare", "--csv", old], ["compare", "--csv", "-"],
             ["compare", "--svg", old], ["compare", "--svg", "-"], ["compare", "--json"],
             ["render", "-o", folder / "new.png"], ["report", "-o", folder / "new.html"]]
    for vary in (["branch", "--vary", f"{SPEED}=0:20"],):
        forms += [vary, *([*vary, option, file] for option in ("--csv", "--svg", "--png") for file in (old, "-")),
                  [*vary, "--json"], [*vary, "--all", "--csv", old], [*vary, "--csv", old, "--svg", "-"]]
    model = ["linearize", "--inputs", SPEED, "--outputs", "h"]
    forms += [model, [*model, "--json"], [*model, "--frequencies", "1:2:3", "--csv", old]]
    sweep = ["sweep", "--vary", f"{SPEED}=0:20:3"]
    forms += [sweep, [*sweep, "--csv", folder / "sweep.csv"], [*sweep, "--csv", "-"], [*sweep, "--json"]]
    for form in forms:
        old.write_text("what was here before")
        code, out, error = run(form[0], scene, *form[1:])
        check(f"{form} ends with 1, found {code}", code == 1)
        check(f"{form} says why: {error!r}", error.startswith("flyball: ") and str(scene) in error and
              len(error.splitlines()) == 1 and len(error) > len(str(scene)) + 30)
        check(f"{form} leaves an older file", old.read_text() == "what was here before")
        if "--json" in form:
            json.loads(out)
    code, _, error = run("branch", CASES / "no_equilibrium.json", "--vary", f"{SPEED}=0:20")
    check(f"the words fit: {error}", f"At {SPEED} = 0 rad/s: " in error)
    page = (folder / "new.html").read_text()
    check("a report without a steady state tells why, too", "<h2>No steady state</h2>" in page and "</html>" in page)


def periodic(_):
    """Where the balance turns the motion that returns is told, with the exit code of what was asked for."""
    rotor = pathlib.Path(SCENE).parent / "horizontal_rotor.json"
    for option, wanted in ((), 1), (("--periodic",), 0):
        code, out, error = run("solve", rotor, "--json", *option)
        answer = json.loads(out)
        told = answer["periodic"]
        check(f"solve {option} ends with {wanted}, found {code}: {error}", code == wanted)
        check("the status is that of the steady state", answer["status"] == "no_steady_state")
        check("the motion is found, stable", told["status"] == "found" and told["stable"] is True)
        across = told["coordinates"]["across"]
        check("it has ends about its mean", across["min"] < across["mean"] < across["max"])
        check("its multipliers are told", len(told["floquet"]["multipliers"]) == 4)
        size = told["reactions"]["spin"]["force"]["size"]
        check("what its shaft bears is told", 0 < size["min"] < size["mean"] < size["max"])
        check("its power on the average is what dampers take", told["drive_powers"]["spin"]["mean"] > 0)
        spring = told["joint_springs"]["across"]
        check(f"what springs and dampers do is told: {spring}", told["springs"] == {} and
              list(spring) == ["spring", "damper", "sum"] and
              0 < spring["spring"]["max"] < spring["sum"]["max"] < spring["spring"]["max"] + spring["damper"]["max"])
    code, out, error = run("solve", SCENE, "--json")
    check("a steady state is told alone", code == 0 and "periodic" not in json.loads(out))
    code, _, error = run("solve", CASES / "control_characters.json", "--periodic", "--all")
    check(f"all states and a motion are two questions: {error}", code == 2)


def control_characters(folder):
    """No control character but line ends reaches the terminal, from whatever is printed."""
    scene = json.loads((CASES / "control_characters.json").read_text())
    scene["name"] = "\x1b]0;title\x07\r\u009b2J\u202e\nflyball: all is well"
    for joint in scene["joints"]:
        joint["description"] = "\x1b[2J"
    file = folder / "control.json"
    file.write_text(json.dumps(scene))
    broken = folder / "bro\x1bken.json"
    broken.write_text(json.dumps(scene).replace('"revolute"', '"rev\\u001bolute"'))
    forms = [["check", file], ["check", file, "--json"], ["solve", file], ["solve", file, "--json"],
             ["solve", file, "--all"], ["solve", file, "--set", "joints.\x1b[31m.x=1"],
             ["sweep", file, "--vary", "gravity.1=-1:-2:2"], ["simulate", file, "--duration", "0.1"],
             ["report", file, "-o", folder / "control.html"], ["branch", file, "--vary", "gravity.1=-1:-2"], ["compare", file, "--duration", "0.1", "--repeats", "1"],
             ["design", file, "--vary", "gravity.1=-1:-2", "--want", "\x1b=1"], ["check", broken], ["solve", broken],
             ["solve", folder / "no \x1b such.json"], ["\x1b[31m"], ["solve", file, "--\x1b"]]
    for form in forms:
        _, out, error = run(*form)
        text = out.decode() + error
        check(f"{form} steers the terminal: {text!r}", not re.search("[\0-\x09\x0b-\x1f\x7f-\x9f\u202e]", text))
        check(f"{form} has a line that is none of its own", "\nflyball: all is well" not in text)
    name = json.loads(run("compare", file, "--json", "--duration", "0.1", "--repeats", "1")[1] or b"{}")
    check("JSON is JSON", isinstance(name, dict))


def tables(folder):
    """Cells are text or numbers, never formulas; what is no number is empty."""
    governor = json.loads(pathlib.Path(SCENE).read_text())
    text = json.dumps(governor).replace('"arm1"', json.dumps('=cmd|"/C calc"!A0')).replace(
        '"slide"', '"@s,lide"').replace('"arm2"', '"-arm"').replace("joints.slide.", "joints.@s,lide.")
    file = folder / "formulas.json"
    file.write_text(text)
    address = "joints.spin.drive.speed"
    for form in (["sweep", "--vary", f"{address}=5:10:3"], ["branch", "--vary", f"{address}=5:10"],
                 ["simulate", "--duration", "0.1"]):
        code, out, error = run(form[0], file, *form[1:], "--csv", "-")
        rows = list(csv.reader(io.StringIO(out.decode(), newline="")))
        check(f"{form} works: {error}", code == 0 and len(rows) > 2)
        check(f"{form} has as many cells in each row", len({len(row) for row in rows}) == 1)
        for row in rows:
            for cell in row:
                number = re.fullmatch(r"-?[0-9.]+(e[+-]?[0-9]+)?", cell)
                check(f"{form} has a formula: {cell!r}", number or not cell[:1] in ("=", "+", "-", "@", "\t", "\r"))
        check(f"{form} names its columns: {rows[0]}", "'@s,lide" in rows[0] and "'=cmd|\"/C calc\"!A0" in rows[0])
    code, out, _ = run("sweep", CASES / "infinite_residual.json", "--vary", "gravity.1=0:1e-300:7", "--csv", "-")
    check("no infinity in a table", not re.search("inf|nan", out.decode().lower()))
    _, out, error = run("sweep", CASES / "infinite_residual.json", "--vary", "gravity.1=0:1e-300:7")
    check("none on the screen either", not re.search(r"\b(inf|nan)\b", (out.decode() + error).lower()))


def names_of_columns(folder):
    """Joints may be called as columns that every table has; no two columns are."""
    governor = json.loads(pathlib.Path(SCENE).read_text())
    text = json.dumps(governor)
    for joint, name in (("arm1", "status"), ("arm2", "stable"), ("slide", "t"), ("link1", "residual")):
        text = text.replace(f'"{joint}"', f'"{name}"').replace(f"joints.{joint}.", f"joints.{name}.")
    file = folder / "columns.json"
    file.write_text(text)
    for form in (["sweep", "--vary", f"{SPEED}=5:10:3"], ["branch", "--vary", f"{SPEED}=5:10"],
                 ["branch", "--vary", f"{SPEED}=5:10", "--over", "bodies.collar.mass=1:2:2"],
                 ["spread", "--tolerance", f"{SPEED}=normal:0.1", "--samples", "20"], ["simulate", "--duration", "0.1"]):
        code, out, error = run(form[0], file, *form[1:], "--csv", "-")
        rows = list(csv.reader(io.StringIO(out.decode(), newline="")))
        check(f"{form} works: {error}", code == 0 and len(rows) > 2)
        check(f"{form} has a name for each column: {rows[0]}", len(set(rows[0])) == len(rows[0]))
        check(f"{form} tells joints from its own: {rows[0]}", {"status_", "stable_", "t_"} <= set(rows[0]))
    code, _, error = run("sweep", file, "--vary", f"{SPEED}=5:10:3", "--npz", folder / "columns.npz")
    check(f"columns for NumPy: {error}", code == 0)
    with zipfile.ZipFile(folder / "columns.npz") as archive:
        names = archive.namelist()
    check(f"the same names: {names}", len(set(names)) == len(names) and
          {"status.npy", "status_.npy", "stable.npy", "stable_.npy", "t_.npy", "residual.npy"} <= set(names))


def own_scene(folder):
    """No output replaces the scene that it is about, by whatever name."""
    file = folder / "scene.json"
    link, hard, bare = folder / "link.json", folder / "hard.json", folder / "scene"
    shutil.copy(SCENE, file)
    link.symlink_to(file)
    os.link(file, hard)
    shutil.copy(SCENE, bare)
    before = file.read_bytes()
    vary = ["--vary", f"{SPEED}=5:6:2"]
    for to in (file, link, hard, folder / "." / "scene.json"):
        for form in (["sweep", *vary, "--csv"], ["branch", "--vary", f"{SPEED}=5:6", "--csv"],
                     ["branch", "--vary", f"{SPEED}=5:6", "--svg"], ["branch", "--vary", f"{SPEED}=5:6", "--png"],
                     ["simulate", "--duration", "0.1", "--csv"], ["simulate", "--duration", "0.1", "--save-state"],
                     ["compare", "--repeats", "1", "--duration", "0.1", "--csv"],
                     ["compare", "--repeats", "1", "--duration", "0.1", "--svg"]):
            code, _, error = run(form[0], file, *form[1:], to)
            check(f"{form} refuses its own scene as {to.name}: {code} {error}",
                  code == 2 and "scene itself" in error and file.read_bytes() == before)
    code, _, error = run("render", bare, "-o", bare)
    check(f"render refuses its own scene: {code} {error}", code == 2 and bare.read_bytes() == before)
    code, _, error = run("report", bare, "-o", bare)
    check(f"report refuses its own scene: {code} {error}", code == 2 and bare.read_bytes() == before)
    with open(file, "rb") as stdin:
        code, _, error = run("sweep", "-", *vary, "--csv", file, stdin=stdin)
    check(f"a scene from standard input, too: {error}", code == 2 and file.read_bytes() == before)
    code, _, error = run("branch", file, "--vary", f"{SPEED}=5:6", "--csv", folder / "x", "--svg", folder / "x")
    check(f"two outputs in one file are refused: {error}", code == 2)
    for to in ("-", "/dev/stdout", "/dev/null"):
        code, _, error = run("sweep", file, *vary, "--csv", to)
        check(f"{to} is written directly: {error}", code == 0)


def limits(folder):
    """What has no end is refused, and what nobody writes to can be interrupted."""
    for command in (["check"], ["solve"], ["render", "-o", folder / "x.png"], ["report", "-o", folder / "x.html"]):
        code, _, error = run(command[0], "/dev/zero", *command[1:])
        check(f"{command} /dev/zero: {error}", code == 2 and "/dev/zero" in error and "256 MB" in error)
    large = folder / "large.json"
    with open(large, "wb") as sparse:
        sparse.truncate(300_000_000)
    code, _, error = run("check", large)
    check(f"a large file: {error}", code == 2 and "large.json" in error and "256 MB" in error)
    with open("/dev/zero", "rb") as zero:
        code, _, error = run("check", "-", stdin=zero)
    check(f"standard input without end: {error}", code == 2 and "256 MB" in error)
    pipe = folder / "pipe"
    os.mkfifo(pipe)
    for arguments in (["sweep", SCENE, "--vary", f"{SPEED}=5:6:2", "--csv", pipe], ["check", pipe]):
        waiting = subprocess.Popen([FLYBALL, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        time.sleep(0.5)
        waiting.send_signal(signal.SIGINT)
        check(f"{arguments[0]} at a pipe that nobody has open is interrupted",
              waiting.wait(LIMIT) == -signal.SIGINT)
    writer = subprocess.Popen(["sh", "-c", 'cat "$0" > "$1"', SCENE, pipe])
    code, _, error = run("check", pipe)
    check(f"a pipe is read: {error}", code == 0 and writer.wait(LIMIT) == 0)
    reader = subprocess.Popen(["cat", pipe], stdout=subprocess.PIPE)
    code, _, error = run("sweep", SCENE, "--vary", f"{SPEED}=5:6:2", "--csv", pipe)
    check(f"a pipe is written: {error}", code == 0 and reader.communicate(timeout=LIMIT)[0].count(b"\n") == 3)


def repetitions(folder):
    """What would take minutes to repeat itself is refused with the limit."""
    scene = {"flyball": 1, "name": "many", "gravity": [0, -9.8, 0],
             "bodies": [{"name": "a", "mass": 1, "position": [0.5, 0, 0], "inertia": [0.1, 0.1, 0.1]}]}
    hinge = {"type": "revolute", "bodies": ["ground", "a"], "at": [0, 0, 0], "axis": [0, 0, 1]}
    scene["joints"] = [{"name": f"j{i}", **hinge} for i in range(100_000)]
    file = folder / "joints.json"
    file.write_text(json.dumps(scene))
    code, _, error = run("solve", file)
    check(f"a hundred thousand parallel joints: {error}",
          code == 2 and "expected at most 10000 constraint equations" in error)
    scene["joints"] = scene["joints"][:1]
    scene["sliders"] = [{"parameter": "bodies.a.mass", "range": [1, 2]}] * 100_000
    file.write_text(json.dumps(scene))
    code, _, error = run("solve", file)
    check(f"as many sliders: {error}", code == 2 and "expected at most 10000 sliders" in error)
    scene["sliders"] = scene["sliders"][:10_000]
    file.write_text(json.dumps(scene))
    code, _, error = run("solve", file)
    check(f"ten thousand sliders: {error}", code == 0)


def reports(folder):
    """A report has the numbers that were set, the coordinates that were asked for, and goes where it should."""
    page = folder / "governor.html"
    code, out, error = run("report", SCENE, "--set", f"{SPEED}=12.5", "--plot", "slide", "-o", page)
    text = page.read_text()
    check(f"a report is written: {error}", code == 0 and out.decode().strip() == str(page))
    check("it has the number that was set", "12.5\u00a0rad/s" in text)
    check("it shows the coordinate asked for over both sliders", text.count("<svg") == 4)
    check("it has a picture", text.count("data:image/png;base64,") == 2 or "There is no picture" in text)
    code, out, _ = run("report", SCENE, "-o", "-")
    check("standard output has nothing but the page", code == 0 and out.startswith(b"<!DOCTYPE html>"))
    code, _, error = run("report", SCENE, "--plot", "spin", "-o", folder / "none.html")
    check(f"a driven coordinate is no curve's: {error}", code == 2 and "--plot spin" in error)
    check("what is refused leaves no file", not (folder / "none.html").exists())


def whirling():
    """A disc on springs and dampers that turn with a shaft, which a torque T drives, in still air: beyond some speed
    it whirls about the shaft's axis (rotating damping)."""
    still = {"mass": 0, "position": [0, 0, 0], "inertia": [0, 0, 0]}
    spring = {"spring": {"stiffness": 5000}, "damping": 4}
    place = {"at": [0, 0, 0], "type": "prismatic"}
    return json.dumps({
        "flyball": 2, "name": "whirling", "parameters": {"T": {"value": 6, "unit": "N m"}},
        "bodies": [{"name": "shaft", "mass": 0.5, "position": [0, 0, 0], "inertia": [0.1, 0.1, 0.1]},
                   {"name": "between", **still},
                   {"name": "disc", "mass": 2, "position": [0, 0, 0], "inertia": [0.02, 0.02, 0.04]}],
        "joints": [{"name": "s", "type": "revolute", "bodies": ["ground", "shaft"], "at": [0, 0, 0], "axis": [0, 0, 1],
                    "drive": {"torque": "=T - 0.1 N m s*rate(s)", "speed": 60}},
                   {"name": "x", "bodies": ["shaft", "between"], "axis": [1, 0, 0], **place, **spring},
                   {"name": "y", "bodies": ["between", "disc"], "axis": [0, 1, 0], **place, **spring}],
        "forces": [{"type": "drag", "name": "air", "body": "disc", "at": [0, 0, 0], "linear": 3}]}).encode()


def units_of_ranges(folder):
    """Ranges are given as settings are: in SI units, in others, or by parameters."""
    turn = 2 * math.pi  # rad/s at 60 rpm
    tables = [list(csv.DictReader(run("sweep", SCENE, "--vary", f"{SPEED}={ends}", "--csv", "-")[1].decode()
                                  .splitlines())) for ends in ("60 rpm:2*60 rpm:3", f"{turn}:{2 * turn}:3")]
    check("a range has units", len(tables[0]) == 3 and all(
        abs(float(a[SPEED]) - float(b[SPEED])) < 1e-12 for a, b in zip(*tables)))
    for command in ("branch", "campbell"):
        code, _, error = run(command, SCENE, "--vary", f"{SPEED}=60 rpm:90 rpm", "--csv", "-")
        check(f"the range of {command} has units: {error}", code == 0)
    code, _, error = run("sweep", SCENE, "--vary", f"{SPEED}=1 kg:2 kg:3")
    check(f"units of something else are refused: {error}", code == 2 and "--vary " + SPEED in error)


def modes_over_other_numbers(_):
    """Over what is no speed there are no critical speeds; the JSON object says so as the text does."""
    why = "Critical speeds and whirl are not looked for"
    for address, told in (("joints.slide.spring.stiffness", True), (SPEED, False)):
        low, high = (900, 1100) if told else (8, 12)
        out = json.loads(run("campbell", SCENE, "--vary", f"{address}={low}:{high}", "--json")[1])
        check(f"why there are no critical speeds over {address}", out["branches"] and (why in out["message"]) == told)


def critical_speeds_over_an_expression(_):
    """Where a drive turns twice as fast as a number, orders count its turns, and both are told."""
    with open(SCENE, encoding="utf-8") as file:
        scene = json.load(file)
    plain = json.loads(run("campbell", SCENE, "--vary", f"{SPEED}=1:20", "--order", "1", "--json")[1])
    scene.update(flyball=2, parameters={"n": {"value": 5.5, "unit": "rad/s"}}, sliders=[])
    next(joint for joint in scene["joints"] if "drive" in joint)["drive"]["speed"] = "=2*n"
    args = ("campbell", "-", "--vary", "parameters.n=0.5:10", "--order", "1")
    twice = json.loads(run(*args, "--json", input=json.dumps(scene).encode())[1])
    told = [(c["speed_rad_s"], c["value"]) for c in twice["critical_speeds"]]
    alone = [(c["speed_rad_s"], c["value"]) for c in plain["critical_speeds"]]
    check(f"critical speeds over half the speed: {told}, {alone}", len(told) == len(alone) > 0 and all(
        abs(a - b) < 1e-9 and abs(2 * n - a) < 1e-9 and b == w for (a, n), (b, w) in zip(told, alone)))
    point = twice["branches"][0]["points"][0]
    check(f"points tell both: {point['value']}, {point['speed']}", point["speed"] == 2 * point["value"])
    text = run(*args, input=json.dumps(scene).encode())[1].decode()
    check(f"the text tells both: {text}", f"parameters.n = {told[0][1]:.12g} rad/s" in text)


def what_turns_in_a_sweep(_):
    """A pendulum that weighs nothing is carried round by friction; heavier, it hangs, and has a column for where."""
    pin = {"type": "revolute", "axis": [0, 0, 1], "at": [0, 0, 0]}
    scene = {"flyball": 2, "name": "carried", "gravity": [0, -10, 0],
             "bodies": [{"name": "shaft", "mass": 1, "position": [0, 0, 0], "inertia": [0.01, 0.01, 0.01]},
                        {"name": "bob", "mass": 0, "position": [0, -0.1, 0], "inertia": [0, 0, 0]}],
             "joints": [{**pin, "name": "drive", "bodies": ["ground", "shaft"], "drive": {"speed": 5}},
                        {**pin, "name": "on_shaft", "bodies": ["shaft", "bob"], "damping": 0.01},
                        {**pin, "name": "on_ground", "bodies": ["ground", "bob"]}]}
    for mass in (0, 1):  # what is drawn decides nothing
        scene["bodies"][1]["mass"] = mass
        code, out, error = run("sweep", "-", "--vary", "bodies.bob.mass=0:0.5:2", "--csv", "-",
                               input=json.dumps(scene).encode())
        carried, hanging = csv.DictReader(io.StringIO(out.decode(), newline=""))
        check(f"what turns is told: {carried}, {error}", code == 0 and float(carried["on_ground.speed"]) == 5
              and carried["on_ground"] == "")
        check(f"what hangs is told: {hanging}", float(hanging["on_ground.speed"]) == 0
              and abs(math.sin(float(hanging["on_ground"])) - 0.01 * 5 / (0.5 * 10 * 0.1)) < 1e-9)


def resonance(folder):
    """A sweep of periodic motions has at each point what `solve` tells there, and of steady states these."""
    rotor = pathlib.Path(SCENE).parent / "horizontal_rotor.json"
    code, out, error = run("sweep", rotor, "--vary", "parameters.n=20:40:3", "--vary", "parameters.e=0:0.001:2",
                           "--periodic", "--csv", "-")
    rows = list(csv.DictReader(io.StringIO(out.decode(), newline="")))
    check(f"a resonance curve is found: {error}", code == 0 and len(rows) == 6)
    for row in rows:
        told = json.loads(run("solve", rotor, "--set", f"parameters.n={row['parameters.n']}", "--set",
                              f"parameters.e={row['parameters.e']}", "--json")[1])
        motion = told.get("periodic")
        check(f"a row says which it is of: {row['status']}", row["status"] == ("periodic" if motion else "converged"))
        for name in ("across", "up"):
            values = [motion["coordinates"][name][key] for key in ("mean", "min", "max")] if motion else [
                told["coordinates"][name]] * 3
            found = [float(row[key]) for key in (name, name + ".min", name + ".max")]
            check(f"{name} is that of solve: {found}, {values}",
                  all(abs(a - b) < 1e-9 for a, b in zip(found, values)))
    code, out, error = run("sweep", "-", "--vary", "parameters.T=8:12:2", "--periodic", "--csv", "-",
                           input=whirling())
    rows = list(csv.DictReader(io.StringIO(out.decode(), newline="")))
    check(f"where the steady state is unstable the stable limit cycle is told: {error}, {out}",
          code == 0 and [row["status"] for row in rows] == ["converged", "periodic"] and rows[1]["stable"] == "true")
    code, _, error = run("sweep", rotor, "--vary", "parameters.n=20:40:2", "--all", "--periodic")
    check(f"not all motions: {error}", code == 2)


def loads(folder):
    """`simulate --loads` has what joints and drives exert beside the columns that are there without."""
    tables = [list(csv.DictReader(run("simulate", SCENE, "--duration", "0.1", "--csv", "-", *more)[1].decode()
                                  .splitlines())) for more in ([], ["--loads"])]
    plain, loaded = (list(table[0]) for table in tables)
    check("the columns without loads come first", loaded[:len(plain)] == plain and len(loaded) > len(plain))
    for row in tables[1]:
        power = float(row["spin.torque"]) * float(row["spin.rate"])
        check("a power is torque times rate", abs(float(row["spin.power"]) - power) <= 1e-12 * abs(power))
        check("the drive's torque is in its joint's moment",
              abs(float(row["spin.moment.y"]) - float(row["spin.torque"])) < 1e-9)
    engine = pathlib.Path(SCENE).parent / "governor_engine.json"
    set_load = "joints.spin.drive.load=25"
    table = list(csv.DictReader(run("simulate", engine, "--set", set_load, "--duration", "0.5", "--csv", "-")[1]
                                .decode().splitlines()))
    for row in table:
        given, load, less = (float(row[f"spin.{part}"]) for part in ("given", "load", "torque"))
        check("a drive by torque gives what its law says, against its load",
              abs(given - 7500 * (float(row["slide"]) - 0.15)) < 1e-9 and load == 25 and abs(given - load - less) < 1e-9)
    linkage = pathlib.Path(SCENE).parent / "fourbar_turntable.json"
    reactions = json.loads(run("solve", linkage, "--json")[1])["reactions"]
    plane = [r for r in reactions.values() if r.get("nonunique")]
    check("forces in the plane of a linkage and moments across it are unique", len(plane) == 4 and all(
        r["unique"] == {"force": [True, True, False], "torque": [False, False, True]} and
        r["unique_part"]["force"] == [*r["force"][:2], 0] and r["unique_part"]["torque"] == [0, 0, r["torque"][2]]
        for r in plane))
    check("others are so altogether", all("unique" not in r for r in reactions.values() if r not in plane))
    told = [line for line in run("solve", linkage)[1].decode().splitlines() if "(not unique)" in line and "≈" in line]
    check("and text marks what is open", len(told) == 4 and all(line.count("≈") == 3 for line in told))
    code, _, error = run("simulate", SCENE, "--loads")
    check(f"loads are for a table: {error}", code == 2 and "--csv" in error)


def hunting(folder):
    """Where a branch begins to hunt, its Hopf points have the loss that `hunting` finds on its boundary."""
    engine = pathlib.Path(SCENE).parent / "governor_engine.json"
    grid = json.loads(run("branch", engine, "--vary", "joints.slide.damping=15:30", "--over",
                          "parameters.gain=7000:8000:2", "--json")[1] or b"{}")
    for point in grid["points"]:
        hopf = [special for special in point["special"] if special["type"] == "hopf"]
        check("the governor with its engine hunts below a damper", len(hopf) == 1)
        gain = point["parameters"]["parameters.gain"]
        boundary = json.loads(run("hunting", engine, "--vary", "joints.slide.damping=5:60", "--vary",
                                  f"parameters.gain={gain}:20000", "--json")[1] or b"{}")
        ends = [curve["points"][i] for curve in boundary["curves"] for i in (0, -1)]
        other = min(ends, key=lambda end: abs(end["y"] - gain))
        check("both find it in the same place", abs(other["x"] - hopf[0]["parameter"]) < 1e-8 * other["x"])
        one, two = hopf[0]["hunting"], other["hunting"]
        check(f"both tell the same of it: {one}, {two}",
              one["loss"] == two["loss"] == "hard" and abs(one["lyapunov"] / two["lyapunov"] - 1) < 1e-6 and
              abs(one["frequency_rad_s"] / two["frequency_rad_s"] - 1) < 1e-9)
    for count in (1, 3):
        numbers = ["joints.slide.damping=5:60", "parameters.gain=7000:8000", "joints.spin.drive.load=0:1"][:count]
        code, _, error = run("hunting", engine, *(word for number in numbers for word in ("--vary", number)))
        check(f"two numbers make its plane, not {count}: {code} {error!r}",
              code == 2 and error.startswith("flyball: --vary: expected two numbers"))


def states(folder):
    """A motion goes on from a state that was saved; what is none, or too far off in time, is refused."""
    state = folder / "state.json"
    run("simulate", SCENE, "--duration", "0.5", "--save-state", state)
    whole = json.loads(run("simulate", SCENE, "--duration", "1", "--json")[1])
    rest = json.loads(run("simulate", SCENE, "--duration", "0.5", "--from-state", state, "--json")[1])
    check(f"it goes on: {whole['coordinates']} {rest['coordinates']}", abs(rest["time"] - 1) < 1e-12 and all(
        abs(value - rest["coordinates"][name]) < 1e-6 for name, value in whole["coordinates"].items()))
    told = json.loads(state.read_text())
    for broken, words in (({**told, "time": 1e300}, "expected a time of at most"),
                          ({"coordinates": []}, "as --save-state writes it: key 'time' not found")):
        state.write_text(json.dumps(broken))
        code, _, error = run("simulate", SCENE, "--duration", "0.5", "--from-state", state)
        check(f"no state: {code} {error}", code == 2 and words in error and "exception" not in error)


def slipping(folder):
    """A disc on a shaft that the air brakes by 0.09 N m s: friction of 1.8 N m holds it up to 20 rad/s, then slips."""
    body = {"mass": 1, "position": [0, 0, 0], "inertia": [0.01, 0.01, 0.02]}
    turning = {"type": "revolute", "at": [0, 0, 0], "axis": [0, 0, 1]}
    scene = {"flyball": 2, "name": "Disc", "bodies": [dict(body, name="shaft"), dict(body, name="disc")],
             "joints": [dict(turning, name="shaft", bodies=["ground", "shaft"], drive={"speed": 20}),
                        dict(turning, name="free", bodies=["shaft", "disc"], friction={"limit": 1.8})],
             "forces": [{"name": name, "type": "drag", "body": "disc", "at": [x, 0, 0], "linear": 0.5}
                        for name, x in (("a", 0.3), ("b", -0.3))]}
    file = folder / "slipping.json"
    file.write_text(json.dumps(scene))
    vary = ("--vary", "joints.shaft.drive.speed=11:31:5")
    rows = list(csv.DictReader(run("sweep", file, *vary, "--csv", "-")[1].decode().splitlines()))
    wanted = [("held", "0", 0), ("held", "0", 0), ("slips", "", -1), ("slips", "", -6), ("slips", "", -11)]
    check("a sweep tells whether friction holds, and how fast it slips", len(rows) == 5 and all(
        (row["rests_on_friction"], row["free"]) == w[:2] and abs(float(row["free.speed"]) - w[2]) < 1e-9
        for row, w in zip(rows, wanted)))
    points = json.loads(run("sweep", file, *vary, "--json")[1])["points"]
    check("a sweep tells in JSON what it rests on",
          [p["rests_on_friction"]["free"]["slips"] for p in points] == [False, False, True, True, True])
    vary = ("--vary", "joints.shaft.drive.speed=11:31")
    rows = list(csv.DictReader(run("branch", file, *vary, "--csv", "-")[1].decode().splitlines()))
    slip = [row for row in rows if row["special"] == "slip"]
    check("a branch goes from what is held to what slips", {row["rests_on_friction"] for row in rows} == {"held", "slips"}
          and len(slip) == 1 and abs(float(slip[0]["joints.shaft.drive.speed"]) - 20) < 1e-9
          and all(abs(float(row["free.speed"]) - min(0, 20 - float(row["joints.shaft.drive.speed"]))) < 1e-8
                  for row in rows))
    code, out, error = run("branch", file, *vary, "--svg", "-")
    check("a branch draws how fast it slips", code == 0 and b"free.speed" in out and b"slip 20" in out)
    code, out, _ = run("solve", file, "--all", "--set", "joints.shaft.drive.speed=25")
    check("all: what slips", code == 0 and b"free slips at a constant rate" in out)
    friction = pathlib.Path(SCENE).parent / "governor_friction.json"
    found = json.loads(run("solve", friction, "--all", "--json")[1])["equilibria"]
    band = json.loads(run("solve", friction, "--json")[1])["friction"]["band"]
    check("all: each has its band", any(e["friction"]["band"] == band for e in found))


def parts(folder):
    """What a killed program left is removed by the next that writes there; what another one writes stays."""
    own = folder / "parts"
    own.mkdir()
    ended = subprocess.Popen(["true"])
    ended.wait()
    (own / f".x.csv.{ended.pid}-0.part").write_text("half")
    film = own / f".film.mp4.{ended.pid}-3.part"
    film.mkdir()
    (film / "film-0001.png").write_text("half")
    kept = [own / f".x.csv.{os.getpid()}-0.part", own / f".x.csv.{ended.pid}.part", own / f"x.csv.{ended.pid}-0.part"]
    for file in kept:
        file.write_text("not to be touched")
    code, _, error = run("sweep", SCENE, "--vary", f"{SPEED}=5:6:2", "--csv", own / "x.csv")
    check(f"written: {error}", code == 0)
    names = sorted(path.name for path in own.iterdir())
    check(f"only what is of a program that has ended goes: {names}",
          names == sorted([file.name for file in kept] + ["x.csv"]))


with tempfile.TemporaryDirectory() as name:
    for part in (reasons, periodic, slipping, control_characters, tables,
                 names_of_columns, own_scene, limits, repetitions, reports, resonance,
                 units_of_ranges, modes_over_other_numbers, critical_speeds_over_an_expression, what_turns_in_a_sweep,
                 hunting, states, loads, parts):
        home = pathlib.Path(name) / part.__name__
        home.mkdir()
        part(home)
if failures:
    sys.exit(1)
print("the commands say why, and spare terminals, tables and files")
