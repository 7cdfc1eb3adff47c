"""The installed program: it can be moved, finds its files, and brings manual, completions and the desktop's files.

Usage: install_test.py BUILD SOURCE
"""
import gzip
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

BUILD, SOURCE = map(pathlib.Path, sys.argv[1:3])
FAILED = []


def check(what, right):
    if not right:
        FAILED.append(what)
        print(f"FAILED: {what}")


def run(*words, **options):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=120, **options)


def validate(tool, *words):
    """By a tool of others, where it is installed."""
    if shutil.which(tool) is None:
        print(f"skipped: {tool} is not installed")
        return
    done = run(tool, *words)
    check(f"{tool}: {done.stdout}{done.stderr}", done.returncode == 0)


def commands_of(program):
    help_text = run(program, "--help").stdout
    return re.findall(r"^  ([a-z]+) ", help_text[help_text.index("Subcommands:"):], re.MULTILINE)


def check_manual(program, folder):
    for command in commands_of(program):
        page = folder / f"flyball-{command}.1.gz"
        check(f"{page.name} is there", page.exists())
        text = gzip.decompress(page.read_bytes()).decode().replace("\\-", "-") if page.exists() else ""
        for option in re.findall(r"--[a-z][a-z-]*", run(program, command, "--help").stdout):
            check(f"{page.name} has {option}", option in text)
        validate("mandoc", "-Tlint", "-Wwarning", page)
    whole = gzip.decompress((folder / "flyball.1.gz").read_bytes()).decode()
    check("flyball.1 lists every command",
          all(f"flyball\\-{c}" in whole for c in commands_of(program)))


def completed(script, *words):
    """What bash completes the last of the words to."""
    ask = f"source {script}; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _flyball; echo ${{COMPREPLY[*]}}"
    return run("bash", "-c", ask, "bash", *words).stdout.split()


def check_completions(share):
    script = share / "bash-completion/completions/flyball"
    check("bash completes a command", completed(script, "flyball", "so") == ["solve"])
    check("bash completes an option", completed(script, "flyball", "render", "--the") == ["--theme"])
    check("bash completes a choice", completed(script, "flyball", "render", "--theme", "") == ["light", "dark", "high-contrast"])
    for shell, file in (("zsh", share / "zsh/vendor-completions/_flyball"),
                        ("fish", share / "fish/vendor_completions.d/flyball.fish")):
        check(f"{file} is there", file.stat().st_size > 1000)
        validate(shell, "-n", file)


def check_desktop(share):
    validate("desktop-file-validate", share / "applications/flyball.desktop")
    validate("appstreamcli", "validate", "--no-net", share / "metainfo/flyball.metainfo.xml")
    validate("xmllint", "--noout", share / "mime/packages/flyball.xml", share / "icons/hicolor/scalable/apps/flyball.svg")
    thumbnailer = (share / "thumbnailers/flyball.thumbnailer").read_text()
    return re.search(r"^Exec=(.*)$", thumbnailer, re.MULTILINE).group(1)


def main():
    with tempfile.TemporaryDirectory() as name:
        first, prefix = pathlib.Path(name) / "first", pathlib.Path(name) / "moved"
        for component in ("program", "fonts"):
            done = run("cmake", "--install", BUILD, "--component", component, "--prefix", first)
            check(f"installs {component}: {done.stderr}", done.returncode == 0)
        first.rename(prefix)
        program, share = prefix / "bin/flyball", prefix / "share"
        content = program.read_bytes()
        for path in (SOURCE, BUILD, first):
            check(f"nothing in the program points to {path}", str(path).encode() + b"/" not in content)
        check("no link leads out", not any(p.is_symlink() for p in prefix.rglob("*")))
        scenes = share / "flyball/scenes"
        solved = run(program, "solve", scenes / "pendulum.json", "--json", cwd=name)
        check(f"solves: {solved.stderr}", solved.returncode == 0 and '"converged"' in solved.stdout)
        check("has the schema", (share / "flyball/scene.schema.json").exists())
        thumbnail = pathlib.Path(name) / "thumbnail.png"
        words = check_desktop(share).replace("%i", str(scenes / "governor.json")).replace("%o", str(thumbnail))
        done = run(program, *words.replace("%s", "128").split()[1:])
        check(f"draws a thumbnail: {done.stderr}",
              done.returncode == 0 and thumbnail.read_bytes().startswith(b"\x89PNG"))
        check_manual(program, share / "man/man1")
        check_completions(share)
    sys.exit(1 if FAILED else 0)


main()
