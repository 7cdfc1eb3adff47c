// A stand-in for ffmpeg, first on PATH for as long as it lives: a script that notes its arguments and copies
// what it reads to the file named last.
#pragma once

#include "temporary_folder.hpp"

#include "engine/mechanism/file.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

namespace flyball::test {

// PATH as it is to be, until the end of the scope.
class SearchPath {
 public:
  explicit SearchPath(const std::string& path) : former_(std::getenv("PATH") ? std::getenv("PATH") : "") {
    ::setenv("PATH", path.c_str(), 1);
  }
  ~SearchPath() { ::setenv("PATH", former_.c_str(), 1); }
  SearchPath(const SearchPath&) = delete;
  SearchPath& operator=(const SearchPath&) = delete;

  const std::string& former() const { return former_; }

 private:
  std::string former_;
};

class FakeFfmpeg {
 public:
  // `script` runs with the output's name in $out.
  explicit FakeFfmpeg(const std::string& script = "cat > \"$out\"")
      : path_(folder_.path().string() + ":" + (std::getenv("PATH") ? std::getenv("PATH") : "")) {
    const std::filesystem::path program = folder_ / "ffmpeg";
    write_bytes(program, "#!/bin/sh\nfor word; do out=$word; printf '%s\\n' \"$word\"; done > '" +
                             (folder_ / "arguments").string() + "'\n" + script + "\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  }
  // One a line.
  std::string arguments() const { return read_bytes(folder_ / "arguments"); }

 private:
  TemporaryFolder folder_;
  SearchPath path_;
};

// A PATH on which there is no ffmpeg.
class NoFfmpeg {
 private:
  TemporaryFolder folder_;
  SearchPath path_{folder_.path().string()};
};

} // namespace flyball::test
