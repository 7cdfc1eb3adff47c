#include "app/render/movie.hpp"

#include "app/platform/access.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

namespace flyball {

namespace {

namespace fs = std::filesystem;

// ffmpeg holds a whole GIF in memory to find its palette, at four bytes a pixel: 2 GB.
constexpr double most_gif_pixels = 5e8;

[[noreturn]] void fail(const fs::path& file, const std::error_code& error) {
  throw SceneError(file.string(), "cannot write: " + error.message());
}

std::string ending_of(const fs::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

// Why a file cannot be put there, or "".
std::string place_problem(const fs::path& file) {
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  if (fs::is_directory(status)) return "it is a folder";
  if (fs::exists(status) && !fs::is_regular_file(status)) return "it is not a regular file";
  const std::error_code refused = fs::exists(status) ? write_refusal(file) : std::error_code();
  return refused ? refused.message() : "";
}

int even(int pixels) {
  return pixels + pixels % 2;
}

// What ffmpeg is told: raw pictures in, the film out.
std::vector<std::string> arguments_of(MovieKind kind, const MovieFormat& format, const fs::path& out) {
  const int width = kind == MovieKind::mp4 ? even(format.width) : format.width;
  const int height = kind == MovieKind::mp4 ? even(format.height) : format.height;
  std::vector<std::string> words{"-hide_banner",
                                 "-loglevel",
                                 "error",
                                 "-y",
                                 "-f",
                                 "rawvideo",
                                 "-pixel_format",
                                 "rgb24",
                                 "-video_size",
                                 std::to_string(width) + "x" + std::to_string(height),
                                 "-framerate",
                                 number_text(format.rate),
                                 "-i",
                                 "pipe:0"};
  const auto add = [&](std::initializer_list<const char*> more) {
    words.insert(words.end(), more.begin(), more.end());
  };
  if (kind == MovieKind::gif) {
    // One palette for the whole film, so that what stands still does not flicker; no dither, as areas are
    // plain and noise in them would be stored anew in every frame.
    add({"-filter_complex", "split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=none", "-f",
         "gif"});
  } else {
    // Colours as players of HD take them; 4:2:0, which all of them can show.
    add({"-vf",
         "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int",
         "-c:v",
         "libx264",
         "-preset",
         "medium",
         "-crf",
         "18",
         "-pix_fmt",
         "yuv420p",
         "-colorspace",
         "bt709",
         "-color_primaries",
         "bt709",
         "-color_trc",
         "bt709",
         "-movflags",
         "+faststart",
         "-f",
         "mp4"});
  }
  // From the root, so that no name is taken for an option or an address.
  words.push_back(fs::absolute(out).string());
  return words;
}

// Red, green and blue, rows from the top; the last row and column again where a size is to be even.
std::vector<char> raw_frame(const Image& image, int width, int height) {
  std::vector<char> bytes(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  auto out = bytes.begin();
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* row = image.at(0, std::min(y, image.height - 1));
    for (int x = 0; x < width; ++x) {
      const std::uint8_t* pixel = row + 4 * std::min(x, image.width - 1);
      out = std::transform(pixel, pixel + 3, out, [](std::uint8_t c) { return static_cast<char>(c); });
    }
  }
  return bytes;
}

} // namespace

std::optional<MovieKind> movie_kind(const fs::path& file) {
  const std::string ending = ending_of(file);
  if (ending == ".png") return MovieKind::frames;
  if (ending == ".gif") return MovieKind::gif;
  if (ending == ".mp4") return MovieKind::mp4;
  return std::nullopt;
}

fs::path frame_file(const fs::path& file, std::size_t frame, std::size_t frames) {
  constexpr std::size_t least_digits = 4;
  const std::size_t digits = std::max(least_digits, std::to_string(frames).size());
  const std::string number = std::to_string(frame + 1);
  const std::string zeros(digits - std::min(digits, number.size()), '0');
  fs::path named = file;
  return named.replace_filename(file.stem().string() + "-" + zeros + number + file.extension().string());
}

std::string movie_problem(const fs::path& file, const MovieFormat& format) {
  const auto kind = movie_kind(file);
  if (!kind || file.stem().empty())
    return "expected a name that ends in .png for numbered frames, .gif or .mp4";
  if (*kind != MovieKind::frames && !ffmpeg_available())
    return ending_of(file) +
           " needs ffmpeg, which is not installed (package ffmpeg); .png for numbered frames "
           "works without it";
  if (std::min(format.width, format.height) < 1 || std::max(format.width, format.height) > largest_movie)
    return "expected from 1 to " + std::to_string(largest_movie) + " pixels a side";
  if (!(format.rate > 0) || !std::isfinite(format.rate))
    return "expected a positive number of frames a second";
  if (*kind == MovieKind::gif && format.rate > gif_rate)
    return "a GIF shows at most " + number_text(gif_rate) + " frames a second";
  if (format.frames < 1 || format.frames > most_movie_frames)
    return "expected at most " + std::to_string(most_movie_frames) + " frames";
  const double pixels = 1. * format.width * format.height * static_cast<double>(format.frames);
  if (*kind == MovieKind::gif && pixels > most_gif_pixels)
    return "so many frames of this size are too many for a GIF: expected at most " +
           std::to_string(static_cast<int>(most_gif_pixels / format.width / format.height)) +
           " frames, a smaller size, or .mp4";
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) return "there is no folder " + folder.string();
  if (const std::error_code refused = write_refusal(folder))
    return "cannot write to the folder " + folder.string() + ": " + refused.message();
  if (*kind != MovieKind::frames)
    if (const std::string problem = place_problem(file); !problem.empty()) return "cannot write: " + problem;
  return "";
}

MovieWriter::MovieWriter(const fs::path& file, const MovieFormat& format) : file_(file), format_(format) {
  if (const std::string problem = movie_problem(file, format); !problem.empty())
    throw SceneError(file.string(), problem);
  kind_ = *movie_kind(file);
  std::error_code ignored;
  target_ = fs::absolute(file);
  if (kind_ == MovieKind::frames)
    check_frames();
  else
    target_ = fs::weakly_canonical(target_, ignored);
  if (kind_ == MovieKind::frames)
    part_.emplace(file, target_, PartFile::Kind::folder);
  else
    part_.emplace(file, target_, PartFile::Kind::file);
  try {
    if (kind_ != MovieKind::frames) encoder_.emplace(arguments_of(kind_, format, part_->path()));
  } catch (const std::runtime_error& error) {
    throw SceneError(file.string(), error.what());
  }
}

// The encoder ends before its file goes.
MovieWriter::~MovieWriter() = default;

bool MovieWriter::ready(double seconds) {
  try {
    return !encoder_ || encoder_->flush(seconds);
  } catch (const std::runtime_error& error) {
    throw SceneError(file_.string(), error.what());
  }
}

void MovieWriter::add(const Image& frame) {
  if (frame.width != format_.width || frame.height != format_.height || added_ == format_.frames)
    throw SceneError(file_.string(), "expected " + std::to_string(format_.frames) + " frames of " +
                                         std::to_string(format_.width) + "x" +
                                         std::to_string(format_.height));
  if (kind_ == MovieKind::frames)
    write_png(part_->path() / frame_file(target_.filename(), added_, format_.frames), frame);
  else
    encoder_->send(kind_ == MovieKind::mp4 ? raw_frame(frame, even(frame.width), even(frame.height))
                                           : raw_frame(frame, frame.width, frame.height));
  ++added_;
}

bool MovieWriter::finish(double seconds) {
  if (finished_) return true;
  if (added_ != format_.frames)
    throw SceneError(file_.string(), "expected " + std::to_string(format_.frames) + " frames, found " +
                                         std::to_string(added_));
  try {
    if (encoder_ && !encoder_->finish(seconds)) return false;
  } catch (const std::runtime_error& error) {
    throw SceneError(file_.string(), error.what());
  }
  if (encoder_)
    place_film();
  else
    place_frames();
  finished_ = true;
  return true;
}

void MovieWriter::place_film() {
  std::error_code failed;
  const std::uintmax_t size = fs::file_size(part_->path(), failed);
  if (failed) fail(file_, failed);
  if (size == 0) throw SceneError(file_.string(), "ffmpeg has written nothing");
  part_->put_in_place();
  part_.reset();
}

void MovieWriter::check_frames() const {
  for (std::size_t i = 0; i < format_.frames; ++i) {
    const fs::path to = frame_file(target_, i, format_.frames);
    const std::string problem = place_problem(to);
    if (!problem.empty()) throw SceneError(to.string(), "cannot write: " + problem);
  }
}

// All or none: where one cannot be placed, those before it go again, but for those that have replaced
// another.
void MovieWriter::place_frames() {
  check_frames();
  std::vector<fs::path> made;
  for (std::size_t i = 0; i < added_; ++i) {
    const fs::path to = frame_file(target_, i, format_.frames);
    std::error_code failed, ignored;
    const bool replaces = fs::exists(to, ignored);
    fs::rename(part_->path() / to.filename(), to, failed);
    if (failed) {
      for (const fs::path& placed : made)
        fs::remove(placed, ignored);
      fail(to, failed);
    }
    if (!replaces) made.push_back(to);
  }
  part_.reset();
}

} // namespace flyball
