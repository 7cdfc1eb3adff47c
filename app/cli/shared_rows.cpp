#include "app/cli/shared_rows.hpp"

#include "app/cli/progress.hpp"

#include <cstring>

namespace flyball::cli {
namespace {

// Each form's bytes come after their number.
std::string pack(const RowBlock& block) {
  std::string out;
  const auto add_count = [&](std::uint64_t n) { out.append(reinterpret_cast<const char*>(&n), sizeof n); };
  add_count(block.answers);
  for (const std::string& rows : block.forms) {
    add_count(rows.size());
    out += rows;
  }
  return out;
}

std::uint64_t take_count(std::string_view& bytes) {
  std::uint64_t n = 0;
  std::memcpy(&n, bytes.data(), sizeof n);
  bytes.remove_prefix(sizeof n);
  return n;
}

} // namespace

std::uint64_t put_out(const SharedRows& rows, WorkSharing& sharing) {
  std::uint64_t answers = 0;
  SharedWork work;
  work.count = rows.count;
  work.largest_block = rows.largest_block;
  work.maker = [&]() -> BlockMaker {
    return [maker = rows.maker()](std::size_t begin, std::size_t end) { return pack(maker(begin, end)); };
  };
  work.take = [&](std::size_t begin, std::size_t end, std::string_view block) {
    answers += take_count(block);
    for (const auto& output : rows.outputs) {
      const std::uint64_t size = take_count(block);
      output->take(begin, end, block.substr(0, size));
      block.remove_prefix(size);
    }
  };
  if (!sharing.takes()) {
    sharing.run(work);
    return 0;
  }
  for (const auto& output : rows.outputs)
    output->begin();
  {
    ProgressBar progress(rows.phase);
    work.progress = [&](std::size_t done, std::size_t all) { progress.show(rows.phase, done, all); };
    sharing.run(work);
  }
  for (const auto& output : rows.outputs)
    output->finish();
  return answers;
}

} // namespace flyball::cli
