// Work shared with the processes that were started together with this one, by mpirun or the like.
#pragma once

#include "engine/study/work_sharing.hpp"

#include <memory>

namespace flyball::cli {

// Whether there are such.
bool started_together();

// With them where there are such; each then makes one block at a time. Else by all cores. To be called once.
// Throws SceneError where this program was built without MPI: each process would do all of the work.
std::unique_ptr<WorkSharing> share_work();

} // namespace flyball::cli
