// A child process that takes bytes on its standard input and writes a file: ffmpeg, which is looked for on
// PATH. Never waits longer than it is told to, so that a window can feed it between frames.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <sys/types.h>
#include <vector>

namespace flyball {

// Whether there is an ffmpeg on PATH.
bool ffmpeg_available();

class Encoder {
 public:
  // Starts ffmpeg with these arguments. Throws std::runtime_error where there is none.
  explicit Encoder(const std::vector<std::string>& arguments);
  ~Encoder(); // ends it, whatever it is at
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  // Sends these bytes after those that still wait to be taken.
  void send(std::vector<char> bytes);
  // Hands over what waits, for at most `seconds`; whether it is all gone. Throws std::runtime_error with
  // ffmpeg's own words where it has given up.
  bool flush(double seconds);
  // The same, and then waits for it to end well.
  bool finish(double seconds);

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void close_input();
  bool ended(double seconds);
  [[noreturn]] void fail();

  pid_t child_ = -1; // -1: has ended
  int status_ = 0;   // of its end, as waitpid() tells
  int input_ = -1;   // the pipe to it; -1: closed
  std::vector<char> waiting_;
  std::size_t sent_ = 0;                        // of these
  std::unique_ptr<std::FILE, CloseFile> words_; // its standard error
};

} // namespace flyball
