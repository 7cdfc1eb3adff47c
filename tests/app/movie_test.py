"""Films from the command line: `flyball simulate --movie` and `flyball modes --movie`, with a script that stands in
for ffmpeg.

Usage: movie_test.py FLYBALL SCENE
"""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

FLYBALL, SCENE = sys.argv[1:3]
COPY = """#!/bin/sh
for word; do out=$word; done
printf '%s\\n' "$@" > "$NOTE"
cat > "$out"
"""
FAIL = """#!/bin/sh
echo "no such codec" >&2
exit 7
"""
HANG = """#!/bin/sh
echo $$ > "$NOTE"
exec sleep 60
"""


class Folder:
    """A folder to write to, and a PATH with this ffmpeg alone, or with none."""

    def __init__(self, script=None, command="simulate"):
        self.command = command
        self.whole = tempfile.TemporaryDirectory()
        root = pathlib.Path(self.whole.name)
        self.out, self.note, programs = root / "out", root / "note", root / "programs"
        self.out.mkdir()
        programs.mkdir()
        for tool in ("sh", "cat", "sleep"):
            (programs / tool).symlink_to("/bin/" + tool)
        if script:
            (programs / "ffmpeg").write_text(script)
            (programs / "ffmpeg").chmod(0o755)
        self.environment = {**os.environ, "PATH": str(programs), "NOTE": str(self.note)}

    def start(self, *arguments):
        return subprocess.Popen([FLYBALL, self.command, SCENE, *arguments], cwd=self.out, env=self.environment,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def run(self, *arguments):
        """Exit code and standard error."""
        process = self.start(*arguments)
        _, error = process.communicate(timeout=120)
        return process.returncode, error

    def names(self):
        return sorted(path.name for path in self.out.iterdir())


def check(what, holds):
    if not holds:
        print("failed:", what)
        sys.exit(1)


def check_refused(folder, arguments, words):
    code, error = folder.run(*arguments)
    check(f"{arguments} is refused with 2, found {code}: {error}", code == 2 and words in error)
    check(f"{arguments} leaves nothing", folder.names() == [])


short = ["--duration", "0.2", "--size", "160x90", "--fps", "20"]

frames = Folder()
code, error = frames.run(*short, "--movie", "run.png")
check(f"frames are drawn without ffmpeg: {code} {error}", code == 0 and error == "")
check("five frames, numbered", frames.names() == [f"run-000{i}.png" for i in range(1, 6)])
pictures = {(frames.out / name).read_bytes() for name in frames.names()}
check("PNG files that differ", len(pictures) == 5 and all(p.startswith(b"\x89PNG") for p in pictures))

slow = Folder(COPY)
code, error = slow.run(*short, "--slow-motion", "0.5", "--movie", "run.mp4")
check(f"a film is made: {code} {error}", code == 0)
check("nothing but the film", slow.names() == ["run.mp4"])
check("nine frames at half speed", (slow.out / "run.mp4").stat().st_size == 9 * 160 * 90 * 3)
check("ffmpeg is told the size", "\n160x90\n-framerate\n20\n" in slow.note.read_text())

none = Folder()
check_refused(none, [*short, "--movie", "run.mp4"], "needs ffmpeg, which is not installed")
check_refused(none, [*short, "--movie", "run.avi"], "expected a name that ends in .png")
check_refused(none, [*short, "--movie", "no/run.png"], "there is no folder no")
check_refused(none, ["--movie", "run.png", "--size", "160"], "--size: expected WIDTHxHEIGHT")
check_refused(none, ["--movie", "run.png", "--fps", "0"], "--fps")
check_refused(none, ["--size", "160x90"], "--movie")
check_refused(Folder(FAIL), [*short, "--movie", "run.gif"], "ffmpeg failed with exit code 7: no such codec")

# The governor's mode swings at 1.04 Hz: 10 frames a second are 10 a swing, and the next swing is the same.
mode = ["--size", "160x90", "--fps", "10"]
swing = Folder(command="modes")
code, error = swing.run(*mode, "--swings", "2", "--movie", "swing.png")
check(f"a mode is filmed: {code} {error}", code == 0 and error == "")
names = swing.names()
check(f"two swings of ten frames, found {names}", names == [f"swing-00{i:02}.png" for i in range(1, 21)])
pictures = [(swing.out / name).read_bytes() for name in names]
check("both swings are alike", pictures[:10] == pictures[10:])
check("it moves", pictures[0] != pictures[5] and pictures[0] != pictures[2])
wide = Folder(command="modes")
code, error = wide.run(*mode, "--amplitude", "0.3", "--movie", "swing.png")
check("as far as it is told", code == 0 and (wide.out / names[5]).read_bytes() != pictures[5])
check_refused(Folder(command="modes"), [*mode, "--mode", "2", "--movie", "swing.png"], "--mode: expected 1 to 1")
check_refused(Folder(command="modes"), ["--amplitude", "1"], "--movie")

for wanted in (signal.SIGINT, signal.SIGTERM):
    hanging = Folder(HANG)
    process = hanging.start(*short, "--movie", "run.mp4")
    end = time.time() + 60
    while not (hanging.note.exists() and hanging.note.read_text()) and time.time() < end:
        time.sleep(0.02)
    child = int(hanging.note.read_text())
    check("a part is there meanwhile", len(hanging.names()) == 1 and hanging.names()[0].startswith("."))
    process.send_signal(wanted)
    process.communicate(timeout=60)
    check(f"it ends by {wanted.name}, found {process.returncode}", process.returncode == -wanted)
    check("and leaves nothing", hanging.names() == [])
    check("not even ffmpeg", not pathlib.Path(f"/proc/{child}").exists())
