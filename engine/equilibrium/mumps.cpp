#include "engine/equilibrium/mumps.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <mutex>

#ifdef FLYBALL_SECOND_MUMPS
extern "C" void dmumps_c_second(DMUMPS_STRUC_C*);
#endif

namespace flyball {
namespace {

constexpr int initialise = -1, terminate = -2;
constexpr int use_comm_world = -987654; // what MUMPS wants to be told where there is one process

// One thread for each matrix is enough: on fronts as small as ours more only wait for each other.
void calm_linear_algebra() {
  if (const auto set_threads =
          reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads")))
    set_threads(1);
}

// OpenBLAS without threads of its own has no locks either, and of another library nothing is known.
bool linear_algebra_has_locks() {
  constexpr int posix_threads = 1;
  const auto parallel = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_parallel"));
  return parallel && parallel() == posix_threads;
}

// The one that a copy is called under. Copies may be at work at once where nothing is shared.
std::mutex& turn_of(int copy) {
  static std::array<std::mutex, 2> turns;
  static const bool apart = (calm_linear_algebra(), linear_algebra_has_locks());
  return turns[apart ? static_cast<std::size_t>(copy) : 0];
}

#ifdef FLYBALL_SECOND_MUMPS
constexpr std::array copies{dmumps_c, dmumps_c_second};
#else
constexpr std::array copies{dmumps_c};
#endif

} // namespace

Mumps::Mumps(int copy) : copy_(std::min(copy, static_cast<int>(copies.size()) - 1)) {}

void Mumps::open(SparsePattern& pattern) {
  close();
  data = {};
  data.par = 1;
  data.sym = pattern.symmetric ? 2 : 0;
  data.comm_fortran = use_comm_world;
  run(initialise);
  open_ = true;
  for (const int output : {1, 2, 3})
    setting(output) = -1;
  constexpr int messages = 4;
  setting(messages) = 0;
  setting(ordering) = 2;         // approximate minimum fill; PORD ends the program on some small graphs
  setting(compressed_graph) = 1; // as it is: pairing multipliers with motions by the first values misleads
  data.n = pattern.size;
  data.nnz = static_cast<MUMPS_INT8>(pattern.rows.size());
  data.irn = pattern.rows.data();
  data.jcn = pattern.columns.data();
}

void Mumps::close() {
  if (open_) run(terminate);
  open_ = false;
}

void Mumps::prepare(std::vector<int>& order) {
  if (!order.empty()) {
    setting(ordering) = 1;
    data.perm_in = order.data();
  }
  setting(scaling) = 0;
  setting(undivided_root) = 1; // factored like the rest, for its zero pivots to be found
  setting(find_null_pivots) = 1;
  data.cntl[0] = least_pivot;
}

void Mumps::leave(std::vector<int>& last, double* matrix) {
  if (last.empty()) return;
  setting(schur) = 1;
  data.size_schur = static_cast<MUMPS_INT>(last.size());
  data.listvar_schur = last.data();
  data.schur = matrix;
}

void Mumps::run(int job) {
  data.job = job;
  const std::lock_guard turn(turn_of(copy_));
  copies[static_cast<std::size_t>(copy_)](&data);
}

bool Mumps::run_factorise() {
  constexpr int short_of_memory = -9, short_of_integers = -8;
  for (const int percent : {100, 200, 400, 800}) { // of what is estimated, for pivots that have to wait
    setting(extra_memory) = percent;
    run(factorise);
    if (data.infog[0] != short_of_memory && data.infog[0] != short_of_integers) break;
  }
  return !failed();
}

void Mumps::run_substitute(double* x, Eigen::Index columns) {
  data.rhs = x;
  data.nrhs = static_cast<MUMPS_INT>(columns);
  data.lrhs = data.n;
  run(substitute);
}

void Mumps::reduce(double* x, double* reduced) {
  setting(reduced_solve) = 1;
  data.redrhs = reduced;
  data.lredrhs = data.size_schur;
  run_substitute(x);
}

void Mumps::expand(double* x, double* reduced) {
  setting(reduced_solve) = 2;
  data.redrhs = reduced;
  data.lredrhs = data.size_schur;
  run_substitute(x);
}

} // namespace flyball
