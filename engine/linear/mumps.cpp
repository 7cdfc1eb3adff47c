#include "engine/linear/mumps.hpp"

#include <dlfcn.h>

#include <mutex>

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

// While it runs MUMPS keeps some of its state in global variables.
std::mutex& turn() {
  static std::mutex mutex;
  static const bool calm = (calm_linear_algebra(), true);
  (void)calm;
  return mutex;
}

} // namespace

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

void Mumps::run(int job) {
  data.job = job;
  const std::lock_guard lock(turn());
  dmumps_c(&data);
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

} // namespace flyball
