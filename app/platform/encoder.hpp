// A child process that takes bytes on its standard input and writes a file: ffmpeg, which is looked for on
// PATH. Never waits longer than it is told to, so that a window can feed it between frames.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace flyball {

// Whether there is an ffmpeg on PATH, and programs can be started at all.
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
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace flyball
