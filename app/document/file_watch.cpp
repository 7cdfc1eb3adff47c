#include "app/document/file_watch.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"

namespace flyball {

namespace {

std::optional<std::string> text_of(const std::filesystem::path& file) {
  try {
    return read_bytes(file);
  } catch (const SceneError&) {
    return std::nullopt;
  }
}

} // namespace

std::filesystem::path resolved(const std::filesystem::path& file) {
  std::error_code failed;
  const std::filesystem::path absolute = std::filesystem::absolute(file, failed);
  if (failed || !absolute.has_filename() || absolute.filename() == "." || absolute.filename() == "..") {
    const std::filesystem::path folder = std::filesystem::weakly_canonical(absolute, failed);
    return failed ? absolute : folder;
  }
  const std::filesystem::path folder = std::filesystem::weakly_canonical(absolute.parent_path(), failed);
  return (failed ? absolute.parent_path() : folder) / absolute.filename();
}

std::uint64_t text_hash(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325U; // FNV-1a
  for (const char c : text)
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

FileWatch::FileWatch(std::filesystem::path file, std::string_view text)
    : file_(std::move(file)), hash_(text_hash(text)), told_(hash_) {}

FileWatch::Look FileWatch::look() {
  if (file_.empty()) return {};
  const std::optional<FileStamp> now = stamp_of(file_);
  missing_ = now ? 0 : missing_ + 1;
  if (!now) return {.news = missing_ == looks_missing ? News::vanished : News::none, .text = {}};
  const bool still = now == last_;
  last_ = now;
  if (now == known_ || !still) return {};
  std::optional<std::string> text = text_of(file_);
  if (!text) return {};
  known_ = now;
  const std::uint64_t hash = text_hash(*text);
  if (hash == told_) return {};
  told_ = hash;
  if (hash == hash_) return {}; // back to what it was
  return {News::changed, std::move(*text)};
}

bool FileWatch::settled() const {
  return file_.empty() || (missing_ > 0 ? vanished() : last_ && last_ == known_);
}

bool FileWatch::differs() const {
  const std::optional<FileStamp> now = stamp_of(file_);
  if (!now) return false;
  if (now == known_) return told_ != hash_;
  const std::optional<std::string> text = text_of(file_);
  return text && text_hash(*text) != hash_;
}

} // namespace flyball
