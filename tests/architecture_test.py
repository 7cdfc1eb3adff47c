#!/usr/bin/env python3
"""Includes go one way: a folder sees itself and what this table names, and nothing else. Views do not name the App.
A type is defined once (the one-definition rule). A README.md of a folder names its headers.

    architecture_test.py SOURCE_DIR
"""
import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^">]+)[">]', re.M)

# In the order of the house: each folder sees those before it that it names. `engine` is all of the engine.
ENGINE = ["task", "linear", "mechanism", "system", "kkt", "solve", "stability", "search", "report",
          "continuation", "dynamics", "periodic", "study"]
APP = {
    "app/platform": [],
    "app/document": ["engine", "app/platform"],
    "app/live": ["engine"],
    "app/plot": ["engine"],
    "app/render": ["engine", "app/platform"],
    "app/session": ["engine", "app/platform", "app/document", "app/live"],
    "app/report": ["engine", "app/plot", "app/session"],
    "app/viewport": ["engine", "app/platform", "app/document", "app/render"],
    "app/ui": ["engine", "app/platform", "app/document", "app/live", "app/plot", "app/render", "app/session",
               "app/report", "app/viewport"],
    "app/cli": ["engine", "app/platform", "app/document", "app/live", "app/plot", "app/render",
                "app/session", "app/report", "app/viewport", "app/ui"],
}
# What draws has no place in these, nor in the engine.
WITHOUT_DRAWING = ["app/platform", "app/document", "app/live", "app/plot", "app/session", "app/report"]
# What only some systems have is in these.
OF_A_SYSTEM = ("app/platform/linux/", "engine/mechanism/posix/")
SYSTEM = re.compile(r"^(sys/|(unistd|fcntl|poll|spawn|dlfcn|pthread|termios|dirent|pwd|glob|windows)\.h$)")
# All of the window at once is for what assembles its frame and what carries out commands.
OF_THE_FRAME = re.compile(r"^app/ui/(app|build_gui|commands|file_commands|palette_actions|report_export|snapshot|stage|menus/\w+)"
                          r"\.[ch]pp$")
THE_APP = re.compile(r"\bApp\b")
COMMENT = re.compile(r"//.*")
NAMESPACE = re.compile(r"namespace(?: ([\w:]+))? \{$")
TYPE = re.compile(r"(?:struct|class|union|enum class|enum) (\w+)(?: final)?(?: : [^;]*)? \{")
DRAWING = re.compile(r"^(imgui|GL/|glad/|GLFW/|EGL/)")


def folder_of(path):
    parts = path.split("/")
    return "/".join(parts[:2]) if len(parts) > 2 else parts[0]


def violations(source):
    found = []
    for top in ("engine", "app"):
        for file in sorted((source / top).rglob("*.[ch]pp")):
            path = file.relative_to(source).as_posix()
            mine = folder_of(path)
            text = file.read_text()
            if mine == "app/ui" and not OF_THE_FRAME.match(path) and THE_APP.search(COMMENT.sub("", text)):
                found.append(f"{path}: takes the App rather than the parts that it touches")
            for name in INCLUDE.findall(text):
                if DRAWING.match(name) and (top == "engine" or mine in WITHOUT_DRAWING):
                    found.append(f"{path}: {name}: nothing is drawn here")
                if SYSTEM.match(name) and not path.startswith(OF_A_SYSTEM):
                    found.append(f"{path}: {name}: of some systems only")
                if not name.startswith(("engine/", "app/", "tests/")):
                    continue
                theirs = folder_of(name)
                if theirs == mine:
                    continue
                if top == "engine":
                    order = [f"engine/{each}" for each in ENGINE]
                    good = theirs in order and mine in order and order.index(theirs) < order.index(mine)
                    good = good or mine == "engine"  # the public face
                else:
                    seen = APP.get(mine, [])
                    good = theirs in seen or ("engine" in seen and name.startswith("engine/"))
                if not good:
                    found.append(f"{path}: {name}: {mine} may not include {theirs}")
    return found


def defined_twice(source):
    """Types of one name in one namespace: each is right in its own file, and the linker keeps one destructor for both."""
    places = {}
    for top in ("engine", "app"):
        for file in sorted((source / top).rglob("*.[ch]pp")):
            namespaces = []
            for line in file.read_text().splitlines():
                if opened := NAMESPACE.match(line):
                    namespaces.append(opened[1] or "")
                elif line.startswith("} // namespace"):
                    namespaces.pop()
                elif (named := TYPE.match(line)) and "" not in namespaces:
                    places.setdefault("::".join([*namespaces, named[1]]), []).append(file.relative_to(source).as_posix())
    return [f"{name}: in {' and in '.join(files)}" for name, files in places.items() if len(files) > 1]


def unnamed(source):
    """Headers that the README.md of their folder does not name; those of a folder within it by that folder's name."""
    found = []
    for readme in sorted([*source.glob("engine/*/README.md"), *source.glob("app/*/README.md")]):
        words = set(re.findall(r"\w+", readme.read_text()))
        for header in sorted(readme.parent.rglob("*.hpp")):
            within = header.relative_to(readme.parent)
            if within.stem not in words and within.parts[0] not in words:
                found.append(f"{readme.relative_to(source).as_posix()}: nothing on {within.as_posix()}")
    return found


def self_test():
    """The rules refuse what they are there to refuse."""
    import tempfile
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder)
        for path, text in {"app/session/a.cpp": '#include "app/ui/app.hpp"\n#include <imgui.h>\n',
                           "engine/linear/b.cpp": '#include "engine/study/sweep.hpp"\n',
                           "engine/linear/d.cpp": "namespace a {\nnamespace {\n\nstruct C {\n};\n\n} // namespace\n\nstruct B {\n};\n",
                           "app/ui/app.hpp": "namespace a {\n\nstruct App;\nstruct B {\n};\nstruct C {\n};\n",
                           "app/ui/studies/c.cpp": '#include "app/session/session.hpp"\nvoid c(App& app);\n'}.items():
            (source / path).parent.mkdir(parents=True, exist_ok=True)
            (source / path).write_text(text)
        (source / "app/ui/README.md").write_text("`stage`, and what stands in panels/\n")
        return len(violations(source)) == 4 and len(defined_twice(source)) == 1 and len(unnamed(source)) == 1


def main():
    if not self_test():
        sys.exit("the rules do not refuse what they should")
    source = pathlib.Path(sys.argv[1])
    found = violations(source) + defined_twice(source) + unnamed(source)
    print("\n".join(found) or "includes go one way, each type is defined once, and each header is told of")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
