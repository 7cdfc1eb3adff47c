// Pictures in a row as a film: numbered PNG files, or a GIF or MP4 that ffmpeg makes of them where it is
// installed. What is made is beside its place until it is whole.
#pragma once

#include "app/platform/encoder.hpp"
#include "app/render/image.hpp"
#include "engine/mechanism/part_file.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace flyball {

enum class MovieKind { frames, gif, mp4 };

struct MovieFormat {
  int width = 1280, height = 720; // pixels
  double rate = 30;               // frames a second
  std::size_t frames = 1;         // how many there will be

  bool operator==(const MovieFormat&) const = default;
};

inline constexpr std::size_t most_movie_frames = 100'000;
inline constexpr int largest_movie = 8192; // pixels a side
inline constexpr double gif_rate = 50;     // frames a second: viewers show those of faster ones slowly

// By the file's ending: .png, .gif, .mp4.
std::optional<MovieKind> movie_kind(const std::filesystem::path& file);
// Where a numbered frame, counted from 0, goes: run.png becomes run-0001.png.
std::filesystem::path frame_file(const std::filesystem::path& file, std::size_t frame, std::size_t frames);
// Why there can be no such film, in words for a person; empty where nothing is in its way.
std::string movie_problem(const std::filesystem::path& file, const MovieFormat& format);

class MovieWriter {
 public:
  // Throws SceneError (`where` is the file), as do all others.
  MovieWriter(const std::filesystem::path& file, const MovieFormat& format);
  // Unless it is finished, nothing remains of it.
  ~MovieWriter();
  MovieWriter(const MovieWriter&) = delete;
  MovieWriter& operator=(const MovieWriter&) = delete;

  // Whether the frames so far are on their way, waiting for it at most `seconds`.
  bool ready(double seconds);
  // The next frame, of the format's size; format.frames of them are wanted.
  void add(const Image& frame);
  // After the last frame: whether all is in its place, where it has replaced what was there; waits for it at
  // most `seconds`.
  bool finish(double seconds);

 private:
  void check_frames() const;
  void place_frames();
  void place_film();

  std::filesystem::path file_;
  MovieFormat format_;
  MovieKind kind_;
  std::filesystem::path target_; // where links lead
  std::optional<PartFile> part_; // beside it: the film, or a folder of frames; empty: nothing is there
  std::size_t added_ = 0;
  bool finished_ = false;
  std::optional<Encoder> encoder_;
};

} // namespace flyball
