#!/usr/bin/env python3
"""One-line changes of the engine, each of which some test must catch.

    mutate.py --check            every change still fits the sources: its text is there, once
    mutate.py [NAME...]          makes each change (or those named) in a copy of the tree, builds the suite that ought
                                 to catch it, runs it, and writes the table of README.md anew

The copy lies in build/mutation and stays there, so that the next campaign builds little. A change counts as caught
where the suite fails, crashes, does not end in time, or no longer builds.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import time

from mutations import MUTATIONS

HERE = pathlib.Path(__file__).resolve().parent
TOP = HERE.parent.parent
COPY = TOP / "build" / "mutation"
LIMIT = 120  # s a suite may take
BEGIN, END = "<!-- table -->\n", "<!-- end of table -->\n"


def misfits():
    """Changes whose text is not in their file exactly once, in words."""
    out = []
    names = [m.name for m in MUTATIONS]
    out += [f"{name}: named twice" for name in sorted(set(names)) if names.count(name) > 1]
    for m in MUTATIONS:
        found = (TOP / m.file).read_text().count(m.old) if (TOP / m.file).exists() else 0
        if found != 1:
            out.append(f"{m.name}: its text is in {m.file} {found} times")
    return out


def run(command, limit=None):
    return subprocess.run(command, cwd=COPY, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=limit, text=True, errors="replace")


def prepare():
    COPY.mkdir(parents=True, exist_ok=True)
    for part in ("CMakeLists.txt", "CMakePresets.json", "engine", "tests", "assets", "shaders", "app"):
        source, target = TOP / part, COPY / part
        if source.is_file():
            copy_if_new(source, target)
            continue
        wanted = {p.relative_to(source) for p in source.rglob("*") if p.is_file() and "__pycache__" not in p.parts}
        for name in wanted:
            copy_if_new(source / name, target / name)
        for old in [p for p in target.rglob("*") if p.is_file()]:
            if old.relative_to(target) not in wanted:
                old.unlink()
    done = run(["cmake", "--preset", "engine", "-DFLYBALL_BENCH=OFF"])
    if done.returncode:
        sys.exit(done.stdout)


def copy_if_new(source, target):
    if target.exists() and target.read_bytes() == source.read_bytes():
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)


def build(target):
    return run(["ninja", "-C", "build/engine-only", "-j2", target])


def suite(target, tests):
    """Whether the suite passes, and the first test that does not."""
    program = COPY / "build" / "engine-only" / "bin" / target
    try:
        done = run([str(program), "--durations", "no", "--abort", *([tests] if tests else [])], LIMIT)
    except subprocess.TimeoutExpired:
        return False, "does not end"
    if done.returncode == 0:
        return "No tests ran" not in done.stdout, ""
    heads = re.findall(r"^-{70,}\n(.+?)\n", done.stdout, re.MULTILINE)
    return False, heads[0].strip() if heads else f"ends with {done.returncode}"


def campaign(names):
    prepare()
    chosen = [m for m in MUTATIONS if not names or m.name in names]
    for target in sorted({m.target for m in chosen}):
        print("building", target, flush=True)
        built = build(target)
        if built.returncode:
            sys.exit(built.stdout[-3000:])
    for target, tests in sorted({(m.target, m.tests) for m in chosen}):
        passes, which = suite(target, tests)
        if not passes:
            sys.exit(f"{target} {tests}: fails without any change: {which}")
    results = {}
    for m in chosen:
        began = time.monotonic()
        file = COPY / m.file
        text = file.read_text()
        file.write_text(text.replace(m.old, m.new))
        try:
            built = build(m.target)
            if built.returncode:
                verdict = "does not build" if "error" in built.stdout else "?"
            else:
                passes, which = suite(m.target, m.tests)
                verdict = "**not caught**" if passes else which
        finally:
            file.write_text(text)
        results[m.name] = verdict
        print(f"{m.name}: {verdict} ({time.monotonic() - began:.0f} s)", flush=True)
    return results


def write_table(results):
    readme = HERE / "README.md"
    text = readme.read_text()
    told = dict(re.findall(r"^\| ([^|]+?) \| `[^|]*` \| [^|]* \| ([^|]+?) \|$", text, re.MULTILINE))
    rows = ["| change | where | in which suite | caught by |", "|---|---|---|---|"]
    for m in MUTATIONS:
        verdict = results.get(m.name, told.get(m.name, "not run"))
        rows.append(f"| {m.name} | `{m.file.removeprefix('engine/')}` | {m.target} | {verdict.replace('|', '/')} |")
    table = "\n".join(rows) + "\n"
    head, rest = text.split(BEGIN)
    readme.write_text(head + BEGIN + table + END + rest.split(END)[1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("names", nargs="*")
    asked = parser.parse_args()
    wrong = misfits()
    print("\n".join(wrong) if wrong else f"{len(MUTATIONS)} changes fit")
    if wrong or asked.check:
        return 1 if wrong else 0
    unknown = set(asked.names) - {m.name for m in MUTATIONS}
    if unknown:
        sys.exit(f"no such change: {', '.join(sorted(unknown))}")
    results = campaign(asked.names)
    write_table(results)
    missed = [name for name, verdict in results.items() if verdict in ("**not caught**", "?")]
    print(f"{len(results)} changes, {len(missed)} not caught")
    return 1 if missed else 0


sys.exit(main())
