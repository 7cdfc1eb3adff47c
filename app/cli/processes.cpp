#include "app/cli/processes.hpp"

#include "app/platform/data_folder.hpp"
#include "app/platform/runtime_library.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/study/message_sharing.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace flyball::cli {
namespace {

// MPI comes with a library of its own, so that the program starts without it.
class ProcessSharing final : public WorkSharing {
 public:
  ProcessSharing() : library_({(data_folder().parent_path().parent_path() / FLYBALL_MPI_LIBRARY).c_str()}) {
    const auto make = library_.find<MessagePassing* (*)()>("flyball_message_passing");
    if (!make)
      throw SceneError("mpirun", "expected a flyball that was built where MPI is (Debian: libopenmpi-dev); "
                                 "without it --shard shares work");
    passing_.reset(make());
    sharing_ = std::make_unique<MessageSharing>(*passing_);
  }
  void run(const SharedWork& work) override { sharing_->run(work); }
  bool takes() const override { return sharing_->takes(); }

 private:
  RuntimeLibrary library_; // outlives what it made
  std::unique_ptr<MessagePassing> passing_;
  std::unique_ptr<MessageSharing> sharing_;
};

} // namespace

bool started_together() {
  // Of Open MPI, of MPICH and its kin, and of Slurm.
  constexpr std::array<const char*, 3> told{"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"};
  return std::ranges::any_of(told, [](const char* name) { return std::getenv(name) != nullptr; });
}

std::unique_ptr<WorkSharing> share_work() {
  if (started_together()) return std::make_unique<ProcessSharing>();
  return std::make_unique<ThreadSharing>();
}

} // namespace flyball::cli
