"""Linear models as files: JSON, NumPy's arrays, and scripts for MATLAB and Python say the same; the response is
C (s E - A)^-1 B + D; what is refused leaves an older file. Where python-control is installed its poles and
responses are compared, else that part is skipped, and says so.

Usage: linear_model_test.py FLYBALL SCENES
"""
import cmath
import csv
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import zipfile

FLYBALL, SCENES = sys.argv[1], pathlib.Path(sys.argv[2])
INPUTS = ["joints.spin.drive.speed", "torque(slide)", "joints.slide.spring.free"]
OUTPUTS = ["slide", "rate(slide)", "y(ball1)"]
failures = []


def check(what, holds):
    if not holds:
        print("failed:", what)
        failures.append(what)


def run(*arguments):
    done = subprocess.run([FLYBALL, "linearize", *map(str, arguments)], capture_output=True, timeout=120)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


def npz(file):
    """Matrices of numbers and lists of words, without NumPy."""
    arrays = {}
    with zipfile.ZipFile(file) as archive:
        check("the archive is whole", archive.testzip() is None)
        for name in archive.namelist():
            data = archive.read(name)
            length, = struct.unpack("<H", data[8:10])
            head, items = eval(data[10:10 + length], {}), data[10 + length:]
            shape, kind = head["shape"], head["descr"]
            if kind == "<f8":
                values = list(struct.unpack(f"<{len(items) // 8}d", items))
                if len(shape) == 2:
                    values = [values[i * shape[1]:(i + 1) * shape[1]] for i in range(shape[0])]
            else:
                check(f"texts are NumPy's: {kind}", kind.startswith("<U"))
                size = 4 * int(kind[2:])
                values = [items[i:i + size].decode("utf-32-le").rstrip("\0") for i in range(0, len(items), size)]
            arrays[name.removesuffix(".npy")] = values
    return arrays


def solve(matrix, right):
    """Gauss, with pivots."""
    n = len(matrix)
    rows = [list(map(complex, row)) + [complex(b)] for row, b in zip(matrix, right)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, n):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k])]
    x = [0j] * n
    for k in reversed(range(n)):
        x[k] = (rows[k][n] - sum(rows[k][j] * x[j] for j in range(k + 1, n))) / rows[k][k]
    return x


def response(model, s, output, input):
    a, b, c, d = (model[key] for key in "ABCD")
    n = len(a)
    e = model.get("E") or [[float(i == j) for j in range(n)] for i in range(n)]
    x = solve([[s * e[i][j] - a[i][j] for j in range(n)] for i in range(n)], [b[i][input] for i in range(n)])
    return sum(c[output][i] * x[i] for i in range(n)) + d[output][input]


def formats(folder):
    scene = SCENES / "governor.json"
    told = {}
    for ending in ("json", "npz", "m", "py"):
        file = folder / f"model.{ending}"
        code, out, error = run(scene, "--inputs", *INPUTS, "--outputs", *OUTPUTS, "-o", file)
        check(f"{ending} is written: {error}", code == 0 and file.exists())
        check(f"and told: {out}", "static gain" in out and "poles" in out)
    model = json.loads((folder / "model.json").read_text())
    arrays = npz(folder / "model.npz")
    for key in "ABCD":
        check(f"{key} is the same in both", model[key] == arrays[key])
    for what in ("state", "input", "output"):
        for part in ("name", "unit", "value"):
            check(f"{what}s have the same {part}",
                  [x[part] for x in model[f"{what}s"]] == arrays[f"{what}_{part}s"])
    check("signals are named as asked for", [x["name"] for x in model["inputs"]] == INPUTS and
          [x["name"] for x in model["outputs"]] == OUTPUTS)
    script = {}
    exec(compile((folder / "model.py").read_text(), "model.py", "exec"), script)
    as_lists = [[list(map(float, row)) for row in script[key]] for key in "ABCD"]
    check("the script of Python has the same", as_lists == [model[key] for key in "ABCD"])
    check("and names", script["output_names"] == OUTPUTS)
    done = subprocess.run([sys.executable, folder / "model.py"], capture_output=True)
    check(f"it runs by itself: {done.stderr.decode()}", done.returncode == 0 and done.stdout)
    text = (folder / "model.m").read_text()
    values = {}
    for key in "ABCD":
        inside = text.split(f"\n{key} = [")[1].split("];")[0]
        values[key] = [[float(x) for x in row.split(",")] for row in inside.split(";")]
    check("the script of MATLAB has the same", all(values[key] == model[key] for key in "ABCD"))
    check("and text in its quotes", "output_names = {'slide', 'rate(slide)', 'y(ball1)'};" in text)
    told["model"] = model
    return model, script


def table(model):
    scene = SCENES / "governor.json"
    form = [scene, "--inputs", *INPUTS, "--outputs", *OUTPUTS, "--frequencies", "0.05:20:41"]
    code, out, error = run(*form)
    rows = list(csv.reader(out.splitlines()))
    check(f"the response is a table: {error}", code == 0 and len(rows) == 42 and len(rows[0]) == 1 + 2 * 9)
    check(f"with names and units: {rows[0][:3]}", rows[0][1] == "slide by joints.spin.drive.speed (m/(rad/s))")
    frequencies = [float(row[0]) for row in rows[1:]]
    check("evenly on a logarithmic axis", frequencies[0] == 0.05 and frequencies[-1] == 20 and
          abs(frequencies[20] - 1) < 1e-12)
    for row, f in zip(rows[1:], frequencies):
        for output in range(3):
            for input in range(3):
                h = response(model, 2j * math.pi * f, output, input)
                at = 1 + 2 * (3 * output + input)
                magnitude, phase = float(row[at]), float(row[at + 1])
                found = cmath.rect(magnitude, math.radians(phase))
                check(f"output {output} by input {input} at {f} Hz", abs(found - h) <= 1e-9 * abs(h))
    for column in range(2, 19, 2):
        phases = [float(row[column]) for row in rows[1:]]
        check("phases go on without jumps", all(abs(b - a) < 180 for a, b in zip(phases, phases[1:])))
    for output in range(3):
        for input in range(3):
            dc = response(model, 0, output, input)
            gain = model["static_gain"][output][input]
            check(f"the static gain of {output} by {input}", abs(dc - gain) <= 1e-10 * abs(gain))
    code, out, _ = run(*form, "--json")
    parsed = json.loads(out)
    told = parsed["response"]["slide"]["torque(slide)"]
    check("JSON has it, too", len(told["magnitude"]) == 41 and
          f'{told["magnitude"][7]:.12g}' == f"{float(rows[8][3]):.12g}")


def with_control(model, script):
    try:
        import control
        import numpy
    except ImportError as error:
        print(f"python-control was not compared: {error}")
        return
    system = script["system"]
    check("the script made a system", system is not None)
    wanted = sorted((complex(*pole) for pole in model["poles"]), key=lambda s: (round(s.real, 6), s.imag))
    found = sorted(control.poles(system), key=lambda s: (round(s.real, 6), s.imag))
    check(f"poles: {wanted} and {found}", numpy.allclose(wanted, found, rtol=1e-9))
    for omega in (0.1, 1, 6.5, 40):
        h = numpy.asarray(system(1j * omega))
        for output in range(3):
            for input in range(3):
                wanted = response(model, 1j * omega, output, input)
                check(f"response at {omega}", abs(h[output][input] - wanted) <= 1e-9 * abs(wanted))
                zeros = model["zeros"][OUTPUTS[output]][INPUTS[input]]
                found = control.zeros(control.ss(system.A, system.B[:, [input]], system.C[[output], :],
                                                 system.D[[output], :][:, [input]]))
                finite = sorted((z for z in found if abs(z) < 1e6), key=lambda s: (round(s.real, 3), s.imag))
                ours = sorted((complex(*z) for z in zeros), key=lambda s: (round(s.real, 3), s.imag))
                check(f"zeros of {OUTPUTS[output]} by {INPUTS[input]}: {ours} and {finite}",
                      len(ours) == len(finite) and numpy.allclose(ours, finite, rtol=1e-5, atol=1e-6))
    print("python-control", control.__version__, "agrees")


def with_octave(model, script):
    """Octave's package `control` reads the script of MATLAB."""
    read = (f"pkg load control; source('{script}'); p = pole(model); disp(mat2str([real(p) imag(p)], 17)); "
            "disp(mat2str(dcgain(model), 17)); disp(strjoin(model.InputName', ' '))")
    try:
        done = subprocess.run(["octave-cli", "--no-gui", "--eval", read], capture_output=True, text=True)
    except FileNotFoundError:
        print("Octave was not compared: it is not installed")
        return
    if "package control" in done.stderr:
        print(f"Octave was not compared: {done.stderr.strip()}")
        return
    lines = done.stdout.splitlines()
    check(f"Octave takes the script: {done.stderr}", len(lines) == 3)
    poles, gain = ([[float(x) for x in row.split()] for row in line.strip("[]").split(";")] for line in lines[:2])
    check(f"poles of Octave: {poles}", all(
        min(abs(complex(*ours) - complex(*p)) for p in poles) <= 1e-9 * abs(complex(*ours))
        for ours in model["poles"]) and len(poles) == len(model["poles"]))
    check(f"static gains of Octave: {gain}", all(
        abs(g - wanted) <= 1e-9 * abs(wanted) + 1e-15
        for row, ours in zip(gain, model["static_gain"]) for g, wanted in zip(row, ours)))
    check(f"names: {lines[2]}", lines[2] == " ".join(INPUTS))
    print("Octave agrees")


def refusals(folder):
    scene, file = SCENES / "governor.json", folder / "old.json"
    file.write_text("what was here before")
    for inputs, outputs, code in (["force_x(ball1)", "slide", 1], ["torque(slide)", "x(ball1)", 1],
                                  ["torque(spin)", "slide", 1], ["nothing", "slide", 2],
                                  ["torque(slide)", "nothing", 2]):
        ended, out, error = run(scene, "--inputs", inputs, "--outputs", outputs, "-o", file)
        check(f"{inputs}, {outputs} end with {code}, not {ended}", ended == code)
        check(f"and say why: {error!r}", error.startswith("flyball: ") and str(scene) in error)
        check("and leave an older file", file.read_text() == "what was here before")
    ended, out, _ = run(scene, "--inputs", "force_x(ball1)", "--outputs", "slide", "--json")
    check("JSON tells the reason", ended == 1 and json.loads(out)["A"] is None and json.loads(out)["message"])
    ended, _, error = run(scene, "--inputs", "torque(slide)", "--outputs", "slide", "-o", folder / "model.xls")
    check(f"endings that are none are refused: {error}", ended == 2 and ".npz" in error)
    for wrong in ("1:0:5", "1:10:0", "1:10", "1:ten:5"):
        ended, _, error = run(scene, "--inputs", "torque(slide)", "--outputs", "slide", "--frequencies", wrong)
        check(f"frequencies that are none are refused: {error}", ended == 2 and f"{wrong}: expected FROM:TO" in error)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        model, script = formats(folder)
        table(model)
        with_control(model, script)
        with_octave(model, folder / "model.m")
        refusals(folder)
    sys.exit(1 if failures else 0)


main()
