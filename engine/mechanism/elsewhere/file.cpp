// By the standard library alone: pipes and devices by name are files like others.
#include "engine/mechanism/file.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/part_file.hpp"

#include <array>
#include <fstream>
#include <iostream>

namespace flyball {
namespace {

namespace fs = std::filesystem;

// Where its links lead to, whether or not anything is there yet.
fs::path follow_links(const fs::path& file) {
  std::error_code failed;
  const fs::path target = fs::weakly_canonical(file, failed);
  return failed ? file : target;
}

} // namespace

std::string read_bytes(const fs::path& file, std::optional<double>) {
  std::ifstream opened;
  if (file != "-") opened.open(file, std::ios::binary);
  std::istream& in = file == "-" ? std::cin : opened;
  std::string bytes;
  std::array<char, 65536> buffer{};
  while (in.read(buffer.data(), buffer.size()), in.gcount() > 0) {
    bytes.append(buffer.data(), static_cast<std::size_t>(in.gcount()));
    if (bytes.size() > largest_file)
      throw SceneError(file.string(), "expected at most " + std::to_string(largest_file / 1'000'000) +
                                          " MB, and there is more");
  }
  if (!in.eof()) throw SceneError(file.string(), "cannot read");
  return bytes;
}

struct FileWriter::State {
  std::optional<PartFile> part; // else standard output
};

FileWriter::FileWriter(const fs::path& file) : state_(std::make_unique<State>()) {
  if (file == "-") return;
  const fs::path target = follow_links(file);
  std::error_code ignored;
  if (fs::exists(target, ignored) && !fs::is_regular_file(target, ignored))
    throw SceneError(file.string(), "cannot write: it is no regular file");
  state_->part.emplace(file, target, PartFile::Kind::file);
}
FileWriter::~FileWriter() = default;
FileWriter::FileWriter(FileWriter&&) noexcept = default;
FileWriter& FileWriter::operator=(FileWriter&&) noexcept = default;

void FileWriter::write(std::string_view bytes) {
  if (state_->part)
    state_->part->write(bytes);
  else if (!std::cout.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush())
    throw SceneError("-", "cannot write");
}

void FileWriter::write_at(std::uint64_t place, std::string_view bytes) {
  if (!state_->part) throw SceneError("-", "cannot write: it is no regular file");
  state_->part->write_at(place, bytes);
}

void FileWriter::finish() {
  if (state_->part) state_->part->put_in_place();
}

void write_bytes(const fs::path& file, std::string_view bytes) {
  FileWriter out(file);
  out.write(bytes);
  out.finish();
}

void replace_file(const fs::path& file, std::string_view bytes) {
  if (file == "-") throw SceneError(file.string(), "cannot write: it is no regular file");
  write_bytes(file, bytes);
}

bool same_file(const fs::path& input, const fs::path& output) {
  if (input == "-" || output == "-") return false;
  std::error_code failed;
  if (fs::exists(input, failed) && fs::exists(output, failed))
    return fs::is_regular_file(input, failed) && fs::equivalent(input, output, failed);
  return follow_links(input) == follow_links(output);
}

} // namespace flyball
