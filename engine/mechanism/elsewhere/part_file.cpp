// By the standard library alone: without locks, owners and synchronising.
#include "engine/mechanism/part_file.hpp"

#include "engine/mechanism/error.hpp"

#include <fstream>
#include <random>
#include <string>

namespace flyball {

namespace fs = std::filesystem;

PartFile::PartFile(const fs::path& file, const fs::path& target, Kind kind) : file_(file), target_(target) {
  std::random_device random;
  const std::string name = "." + target.filename().string() + "." + std::to_string(random()) + ".part";
  path_ = target;
  path_.replace_filename(name);
  std::error_code failed;
  if (kind == Kind::folder)
    fs::create_directory(path_, failed);
  else if (!std::ofstream(path_, std::ios::binary))
    failed = std::make_error_code(std::errc::io_error);
  if (failed) throw SceneError(file.string(), "cannot write: " + failed.message());
  if (const fs::file_status old = fs::status(target, failed); kind == Kind::file && fs::exists(old))
    fs::permissions(path_, old.permissions(), failed);
}

PartFile::~PartFile() {
  if (path_.empty()) return;
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void PartFile::write(std::string_view bytes) {
  std::ofstream out(path_, std::ios::binary | std::ios::app);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw SceneError(file_.string(), "cannot write: the disk takes no more");
}

void PartFile::write_at(std::uint64_t place, std::string_view bytes) {
  std::fstream out(path_, std::ios::binary | std::ios::in | std::ios::out);
  out.seekp(static_cast<std::streamoff>(place));
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw SceneError(file_.string(), "cannot write: the disk takes no more");
}

void PartFile::put_in_place() {
  std::error_code failed;
  fs::rename(path_, target_, failed);
  if (failed) throw SceneError(file_.string(), "cannot write: " + failed.message());
  path_.clear();
}

} // namespace flyball
