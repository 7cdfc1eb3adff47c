// Looks after the file of the open document, which other programs may change meanwhile.
#pragma once

#include "app/platform/file_stamp.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace flyball {

// Absolute, without dots and links but for the name itself: two ways to a file are told to be the same, and
// what a person calls a file stays its name.
std::filesystem::path resolved(const std::filesystem::path& file);

// Equal texts have equal hashes, others almost certainly not.
std::uint64_t text_hash(std::string_view text);

class FileWatch {
 public:
  FileWatch() = default; // of nothing
  // `text` is what the document is based on: just read from the file, written to it, or left there on
  // purpose.
  FileWatch(std::filesystem::path file, std::string_view text);

  const std::filesystem::path& file() const { return file_; }
  std::uint64_t hash() const { return file_.empty() ? 0 : hash_; } // of what the document is based on
  bool vanished() const { return missing_ >= looks_missing; }

  enum class News { none, changed, vanished };
  struct Look {
    News news = News::none;
    std::string text; // what is there now, where it has changed
  };
  // What has happened since the last look that was not told yet. A file is changed once it has stood still
  // from one look to the next, so that one who writes it slowly is not interrupted; touching it is no change.
  Look look();
  // Whether looking again would tell nothing new until somebody touches the file.
  bool settled() const;
  // Whether the file holds something else than the document is based on, told or not: saving would lose it.
  bool differs() const;

 private:
  static constexpr int looks_missing = 2; // in a row: some programs delete a file and then write it anew

  std::filesystem::path file_;
  std::uint64_t hash_ = 0, told_ = 0; // of what the document is based on, and of what look() told last
  // The stamp with which it held what was told. Nothing at first: a stamp taken after reading might be that
  // of a newer text.
  std::optional<FileStamp> known_;
  std::optional<FileStamp> last_; // at the last look
  int missing_ = 0;               // looks in a row
};

} // namespace flyball
