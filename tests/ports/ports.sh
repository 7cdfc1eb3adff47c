#!/usr/bin/env bash
# Compiles the engine and what the window works on for a system that has no libraries here: objects alone, with
# the headers of this one's packages, which are the same everywhere.
#
#   tests/ports/ports.sh windows|web OUTPUT_FOLDER      77 where there is no such compiler
set -euo pipefail

case ${1-} in
  windows) compiler=x86_64-w64-mingw32-g++-posix files=elsewhere objects=-Wa,-mbig-obj ;;
  web) compiler=em++ files=posix objects= ;;
  *) echo "ports.sh: expected windows or web" >&2 && exit 2 ;;
esac
command -v "$compiler" >/dev/null || { echo "there is no $compiler" && exit 77; }
top=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)
mkdir -p "$2/headers"
cd "$2"

for package in nlohmann fmt sundials cvode arkode nvector sunmatrix sunlinsol sunnonlinsol Spectra; do
  ln -sfn "/usr/include/$package" "headers/$package"
done
for part in Eigen unsupported; do
  ln -sfn "/usr/include/eigen3/$part" "headers/$part"
done

# All files of a folder at a time, as FLYBALL_UNITY does.
compile() {
  local name=${1//\//_} folder
  for folder in "$@"; do
    printf '#include "%s"\n' "$top/$folder"/*.cpp
  done >"$name.cpp"
  "$compiler" -std=c++20 -O0 -w ${objects:+$objects} -I"$top" -isystem headers -c "$name.cpp" -o "$name.o" 2>"$name.log" ||
    { echo "$1: $(grep -m 3 'error' "$name.log")" && return 1; }
}
rooms=(engine/{linear,system,kkt,solve,stability,search,report,continuation,dynamics,study}
  app/{document,live,session})
jobs=("engine/mechanism engine/mechanism/$files" "app/platform app/platform/elsewhere" "${rooms[@]}")
export -f compile
export top compiler objects
printf '%s\n' "${jobs[@]}" | xargs -P "$(nproc)" -I{} bash -c 'compile {}'
echo "${#jobs[@]} folders compile with $compiler"
