// Rows of a study whose points threads or processes share: put into form where they are solved, put out in
// order where all of them are taken.
#pragma once

#include "app/cli/row_output.hpp"
#include "engine/study/work_sharing.hpp"

#include <functional>

namespace flyball::cli {

struct RowBlock {
  std::uint64_t answers = 0;      // how many of its points have one
  std::vector<std::string> forms; // its rows, by output
};
using RowMaker = std::function<RowBlock(std::size_t begin, std::size_t end)>;

struct SharedRows {
  std::size_t count = 0;            // of points
  std::size_t largest_block = 1000; // as of SharedWork
  std::function<RowMaker()> maker;  // called by each thread that solves points
  std::vector<std::unique_ptr<RowOutput>> outputs;
  const char* phase = "solving"; // for the progress bar
};

// How many points have an answer, where rows are taken here (WorkSharing::takes).
std::uint64_t put_out(const SharedRows& rows, WorkSharing& sharing);

} // namespace flyball::cli
