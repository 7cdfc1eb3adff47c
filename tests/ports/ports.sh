#!/usr/bin/env bash
# Compiles the engine and what the window works on for a system that has no libraries here: objects alone, with
# the headers of this one's packages, which are the same everywhere.
#
#   tests/ports/ports.sh windows|web OUTPUT_FOLDER
#
# Exits with 77 where there is no such compiler, or its library is older than C++20, as that of Debian 12's
# Emscripten.
set -euo pipefail

case ${1-} in
  windows) compiler=x86_64-w64-mingw32-g++-posix files=elsewhere objects=-Wa,-mbig-obj ;;
  web) compiler=em++ files=posix objects=-fexperimental-library ;;
  *) echo "ports.sh: expected windows or web" >&2 && exit 2 ;;
esac
command -v "$compiler" >/dev/null || { echo "there is no $compiler" && exit 77; }
top=$(CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)
mkdir -p "$2/headers"
cd "$2"

# The youngest of what is used of the standard library.
if ! "$compiler" -std=c++20 "$objects" -fsyntax-only -x c++ - 2>/dev/null <<'END'; then
#include <algorithm>
#include <charconv>
#include <string_view>
#include <thread>
int main() {
  char text[32];
  std::to_chars(text, text + 32, 0.1);
  return std::ranges::all_of(std::string_view(text), [](char c) { return c != 0; }) + std::jthread().joinable();
}
END
  echo "$compiler has not all of C++20's library"
  exit 77
fi

for package in nlohmann fmt sundials cvode arkode nvector sunmatrix sunlinsol sunnonlinsol sunadaptcontroller \
  sunmemory Spectra nlopt.h Random123; do
  ln -sfn "/usr/include/$package" "headers/$package"
done
for part in Eigen unsupported; do
  ln -sfn "/usr/include/eigen3/$part" "headers/$part"
done
# Debian 13's SUNDIALS is built for MPI, too, whose headers are this system's; it names one type of them.
printf 'typedef void* MPI_Comm;\n#define MPI_COMM_NULL ((MPI_Comm)0)\n' >headers/mpi.h

# One file; what failed is told, and the others are compiled still.
compile() {
  local name=${1//\//_}
  "$compiler" -std=c++20 -O0 -w "$objects" -I"$top" -isystem headers -c "$top/$1" -o "$name.o" 2>"$name.log" ||
    { echo "$1: $(grep -im 3 'error' "$name.log")" && return 1; }
}
folders=(engine/{linear,mechanism,system,kkt,solve,stability,search,report,continuation,dynamics,periodic,study}
  app/{platform,document,live,session} "engine/mechanism/$files" app/platform/elsewhere)
export -f compile
export top compiler objects
cd "$top"
mapfile -t sources < <(find "${folders[@]}" -maxdepth 1 -name '*.cpp' | sort)
cd - >/dev/null
printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -I{} bash -c 'compile {}'
echo "${#sources[@]} files compile with $compiler"
