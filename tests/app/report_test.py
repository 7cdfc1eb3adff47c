"""A report in a browser: it opens without a word on the console, shows something on light and on dark ground, and
can be printed.

Usage: report_test.py FLYBALL SCENES CASES [FOLDER], which keeps the pictures in a folder.
"""
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

FLYBALL, SCENES, CASES = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
BROWSER = next((found for name in ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
                if (found := shutil.which(name))), None)
SKIPPED = 77
WIDTH, HEIGHT = 1000, 1400  # pixels
failures = []


def check(what, holds):
    if not holds:
        print("failed:", what)
        failures.append(what)


def pixels(png):
    """The pixels of a PNG file, 8 bits a channel, as rows of tuples."""
    width, height, depth, kind = struct.unpack(">IIBB", png[16:26])
    assert depth == 8 and kind in (2, 6)
    data, at = b"", 8
    while at < len(png):
        (length,), name = struct.unpack(">I", png[at:at + 4]), png[at + 4:at + 8]
        data += png[at + 8:at + 8 + length] if name == b"IDAT" else b""
        at += length + 12
    raw, size = zlib.decompress(data), 3 if kind == 2 else 4
    rows, before = [], bytearray(width * size)
    for y in range(height):
        begin = y * (width * size + 1)
        how, row = raw[begin], bytearray(raw[begin + 1:begin + 1 + width * size])
        for i in range(len(row)):
            left = row[i - size] if i >= size else 0
            up, corner = before[i], before[i - size] if i >= size else 0
            if how == 1:
                row[i] = row[i] + left & 255
            elif how == 2:
                row[i] = row[i] + up & 255
            elif how == 3:
                row[i] = row[i] + (left + up) // 2 & 255
            elif how == 4:
                p = left + up - corner
                _, nearest = min((abs(p - left), left), (abs(p - up), up), (abs(p - corner), corner),
                                 key=lambda pair: pair[0])
                row[i] = row[i] + nearest & 255
        rows.append([tuple(row[i:i + 3]) for i in range(0, len(row), size)])
        before = row
    return rows


def browse(page, folder, *arguments):
    """Runs the browser without a window, and without a network; what it said of the page."""
    full = [BROWSER, "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--hide-scrollbars",
            "--disable-dev-shm-usage", f"--user-data-dir={folder / 'profile'}", "--enable-logging=stderr",
            "--host-resolver-rules=MAP * ~NOTFOUND", f"--window-size={WIDTH},{HEIGHT}", *arguments, page.as_uri()]
    done = subprocess.run(full, stdin=subprocess.DEVNULL, capture_output=True, timeout=120)
    said = done.stderr.decode(errors="replace")
    check(f"the browser ends well: {said[-500:]}", done.returncode == 0)
    return [line for line in said.splitlines() if "CONSOLE" in line], done.stdout.decode(errors="replace")


def look(page, folder, name, dark):
    file = folder / f"{name}.png"
    scheme = ["--blink-settings=preferredColorScheme=0"] if dark else ["--blink-settings=preferredColorScheme=1"]
    console, _ = browse(page, folder, *scheme, f"--screenshot={file}")
    check(f"{name}: nothing on the console: {console}", not console)
    rows = pixels(file.read_bytes())
    colors = {color for row in rows for color in row}
    ground = sum(rows[5][5]) / 3
    check(f"{name} is not blank: {len(colors)} colours", len(colors) > 500 or (name == "refusal" and len(colors) > 50))
    check(f"{name} has {'dark' if dark else 'light'} ground: {ground}", ground < 60 if dark else ground > 230)


def main():
    if not BROWSER:
        print("no Chromium is installed: nothing was looked at")
        return SKIPPED
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(sys.argv[4] if len(sys.argv) > 4 else name).resolve()
        folder.mkdir(exist_ok=True)
        for scene, code, label in ((SCENES / "governor.json", 0, "governor"),
                                   (CASES / "no_equilibrium.json", 1, "refusal")):
            page = folder / f"{label}.html"
            done = subprocess.run([FLYBALL, "report", str(scene), "-o", str(page)], capture_output=True, timeout=120)
            check(f"report ends with {code}: {done.stderr.decode()}", done.returncode == code)
            look(page, folder, label, False)
            look(page, folder, label + "-dark", True)
        page = folder / "governor.html"
        _, dom = browse(page, folder, "--dump-dom")
        check("the browser found every section", dom.count("<section") >= 9 and dom.count("<svg") == 8)
        paper = folder / "governor.pdf"
        browse(page, folder, "--no-pdf-header-footer", f"--print-to-pdf={paper}")
        check("it can be printed", paper.exists() and paper.read_bytes().startswith(b"%PDF"))
    return 1 if failures else 0


sys.exit(main())
