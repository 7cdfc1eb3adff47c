// Films: numbered frames, and what goes through the pipe to ffmpeg. A script stands in for ffmpeg; where the
// real one is installed, its files are looked into as well.
#include "fake_ffmpeg.hpp"

#include "app/render/movie.hpp"
#include "engine/mechanism/error.hpp"
#include "tests/catch.hpp"

#include <array>
#include <csignal>
#include <limits>
#include <set>
#include <unistd.h>

using namespace flyball;
using namespace flyball::test;
namespace fs = std::filesystem;

namespace {

constexpr double forever = std::numeric_limits<double>::infinity();

Image plain_image(int width, int height, std::array<std::uint8_t, 3> color) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 4; ++c)
        image.at(x, y)[c] = c < 3 ? color[static_cast<std::size_t>(c)] : std::uint8_t{255};
  return image;
}

// No two frames alike.
Image frame_of(int width, int height, std::size_t i) {
  return plain_image(width, height,
                     {static_cast<std::uint8_t>(40 * i), 7, static_cast<std::uint8_t>(200 - i)});
}

std::set<std::string> names_in(const TemporaryFolder& folder) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path()))
    names.insert(entry.path().filename().string());
  return names;
}
using Names = std::set<std::string>;

void write_film(const fs::path& file, const MovieFormat& format) {
  MovieWriter writer(file, format);
  for (std::size_t i = 0; i < format.frames; ++i) {
    writer.add(frame_of(format.width, format.height, i));
    const bool gone = writer.ready(forever); // outside CHECK, which would keep what it throws
    CHECK(gone);
  }
  const bool finished = writer.finish(forever);
  CHECK(finished);
}

std::string message_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// All bytes from the first frame on, as ffmpeg gets them.
std::string raw(const MovieFormat& format, int width, int height) {
  std::string bytes;
  for (std::size_t i = 0; i < format.frames; ++i) {
    const Image image = frame_of(1, 1, i);
    for (int pixel = 0; pixel < width * height; ++pixel)
      bytes.append(reinterpret_cast<const char*>(image.at(0, 0)), 3);
  }
  return bytes;
}

} // namespace

TEST_CASE("frames are numbered, whole and in order") {
  const TemporaryFolder folder;
  write_film(folder / "run.png", {8, 6, 30, 3});
  CHECK(names_in(folder) == Names{"run-0001.png", "run-0002.png", "run-0003.png"});
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(read_png(frame_file(folder / "run.png", i, 3)) == frame_of(8, 6, i));
}

TEST_CASE("numbers of frames have as many digits as the last one needs") {
  CHECK(frame_file("a/run.png", 0, 1) == "a/run-0001.png");
  CHECK(frame_file("a/run.png", 9998, 9999) == "a/run-9999.png");
  CHECK(frame_file("a/run.png", 0, 10000) == "a/run-00001.png");
  CHECK(frame_file("a.b/my.run.PNG", 41, 20) == "a.b/my.run-0042.PNG");
}

TEST_CASE("nothing of a film is seen before it is finished, and nothing remains of one given up") {
  const std::string name = GENERATE("run.png", "run.gif", "run.mp4");
  const FakeFfmpeg ffmpeg;
  const TemporaryFolder folder;
  const bool frames = name == "run.png";
  const fs::path first = frames ? folder / "run-0001.png" : folder / name;
  write_bytes(first, "kept");
  {
    MovieWriter writer(folder / name, {8, 6, 30, 2});
    writer.add(frame_of(8, 6, 0));
    CHECK(writer.ready(forever));
    CHECK(read_bytes(first) == "kept");
    for (const std::string& each : names_in(folder))
      CHECK((each.starts_with(".") || fs::path(each) == first.filename()));
    CHECK(names_in(folder).size() == 2);
    CHECK(has(message_of([&] { writer.finish(forever); }), "expected 2 frames, found 1"));
  }
  CHECK(names_in(folder) == Names{first.filename().string()});
  CHECK(read_bytes(first) == "kept");
  write_film(folder / name, {8, 6, 30, 2});
  CHECK(read_bytes(first) != "kept");
  CHECK(names_in(folder).size() == (frames ? 2 : 1));
}

TEST_CASE("ffmpeg gets every frame through the pipe, and is told what they are") {
  const FakeFfmpeg ffmpeg;
  const TemporaryFolder folder;
  const MovieFormat format{300, 201, 12.5, 4}; // more than a pipe holds
  const bool gif = GENERATE(true, false);
  const fs::path file = folder / (gif ? "run.gif" : "run.mp4");
  write_film(file, format);
  CHECK(names_in(folder) == Names{file.filename().string()});
  // H.264 with 4:2:0 has even sizes: the last row goes twice.
  const int height = gif ? 201 : 202;
  CHECK((read_bytes(file) == raw(format, 300, height)));
  const std::string words = ffmpeg.arguments();
  CHECK(has(words, "rawvideo\n-pixel_format\nrgb24\n-video_size\n300x" + std::to_string(height) +
                       "\n-framerate\n12.5\n-i\npipe:0\n"));
  CHECK(has(words, gif ? "palettegen" : "libx264"));
  CHECK(has(words, gif ? "paletteuse" : "yuv420p"));
  CHECK(has(words, gif ? "-f\ngif\n/" : "-f\nmp4\n/"));
}

TEST_CASE("ffmpeg's own words tell why it failed") {
  const TemporaryFolder folder;
  std::string message;
  SECTION("at once, while frames are still sent") {
    const FakeFfmpeg ffmpeg("echo 'Unknown encoder libx264' >&2; exit 3");
    message = message_of([&] { write_film(folder / "run.mp4", {640, 480, 30, 4}); });
    CHECK(has(message, "exit code 3: Unknown encoder libx264"));
  }
  SECTION("when it has all of them") {
    const FakeFfmpeg ffmpeg("cat > /dev/null; echo 'No space left' >&2; exit 1");
    message = message_of([&] { write_film(folder / "run.gif", {8, 6, 30, 2}); });
    CHECK(has(message, "exit code 1: No space left"));
  }
  SECTION("well, but without a file") {
    const FakeFfmpeg ffmpeg("cat > /dev/null");
    message = message_of([&] { write_film(folder / "run.gif", {8, 6, 30, 2}); });
    CHECK(has(message, "has written nothing"));
  }
  SECTION("well, but before it had all") {
    const FakeFfmpeg ffmpeg("exit 0");
    message = message_of([&] { write_film(folder / "run.gif", {640, 480, 30, 2}); });
    CHECK(has(message, "ended before it had all frames"));
  }
  SECTION("killed") {
    const FakeFfmpeg ffmpeg("kill -9 $$");
    message = message_of([&] { write_film(folder / "run.gif", {8, 6, 30, 2}); });
    CHECK(has(message, "signal 9"));
  }
  CHECK(has(message, (folder / "run").string()));
  CHECK(names_in(folder).empty());
}

TEST_CASE("an ffmpeg that takes its time holds nobody up") {
  const FakeFfmpeg ffmpeg("sleep 0.4; cat > \"$out\"");
  const TemporaryFolder folder;
  MovieWriter writer(folder / "run.mp4", {640, 480, 30, 1});
  writer.add(frame_of(640, 480, 0));
  CHECK_FALSE(writer.ready(0));
  CHECK_FALSE(writer.finish(0.01));
  CHECK(names_in(folder).size() == 1); // the part
  CHECK(writer.finish(forever));
  CHECK(names_in(folder) == Names{"run.mp4"});
}

TEST_CASE("giving up ends an ffmpeg that hangs") {
  const TemporaryFolder folder;
  const fs::path note = folder / "number";
  const FakeFfmpeg ffmpeg("echo $$ > '" + note.string() + "'; exec sleep 60");
  pid_t child = 0;
  {
    MovieWriter writer(folder / "run.mp4", {640, 480, 30, 1});
    writer.add(frame_of(640, 480, 0));
    for (int tries = 0; tries < 1000 && child == 0; ++tries) {
      CHECK_FALSE(writer.ready(0.01));
      if (fs::exists(note)) child = std::atoi(read_bytes(note).c_str());
    }
    REQUIRE(child > 0);
    CHECK(::kill(child, 0) == 0);
  }
  CHECK(::kill(child, 0) != 0);
  CHECK(names_in(folder) == Names{"number"});
}

TEST_CASE("what cannot become a film is told before anything is drawn") {
  const TemporaryFolder folder;
  const MovieFormat format{8, 6, 30, 2};
  const auto problem = [&](const char* name, const MovieFormat& wanted) {
    const std::string found = movie_problem(folder / name, wanted);
    CHECK(has(message_of([&] { MovieWriter writer(folder / name, wanted); }), found));
    CHECK(names_in(folder) == Names{"folder.png", "folder.gif"});
    return found;
  };
  fs::create_directory(folder / "folder.png");
  fs::create_directory(folder / "folder.gif");
  {
    const NoFfmpeg none;
    CHECK_FALSE(ffmpeg_available());
    CHECK(movie_problem(folder / "run.png", format).empty());
    CHECK(has(problem("run.mp4", format), ".mp4 needs ffmpeg, which is not installed (package ffmpeg)"));
    CHECK(has(problem("run.GIF", format), ".gif needs ffmpeg"));
  }
  const FakeFfmpeg ffmpeg;
  CHECK(ffmpeg_available());
  CHECK(movie_problem(folder / "run.GIF", format).empty());
  for (const char* name : {"run.avi", "run", ".mp4", "run.png.bak"})
    CHECK(has(problem(name, format), "expected a name that ends in .png for numbered frames, .gif or .mp4"));
  CHECK(has(problem("none/run.mp4", format), "there is no folder"));
  CHECK(has(problem("folder.gif", format), "it is a folder"));
  CHECK(has(problem("run.gif", {8, 6, 51, 2}), "at most 50 frames a second"));
  CHECK(movie_problem(folder / "run.gif", {1280, 720, 30, 500}).empty());
  CHECK(has(problem("run.gif", {1280, 720, 30, 600}), "expected at most 542 frames"));
  CHECK(has(problem("run.mp4", {0, 6, 30, 2}), "from 1 to 8192 pixels"));
  CHECK(has(problem("run.mp4", {8, 8193, 30, 2}), "from 1 to 8192 pixels"));
  CHECK(has(problem("run.png", {8, 6, 0, 2}), "positive number of frames a second"));
  CHECK(has(problem("run.png", {8, 6, 30, most_movie_frames + 1}), "at most 100000 frames"));
}

TEST_CASE("frames that cannot all be placed are not placed at all") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "run-0002.png");
  CHECK(has(message_of([&] { write_film(folder / "run.png", {8, 6, 30, 3}); }), "run-0002.png"));
  CHECK(names_in(folder) == Names{"run-0002.png"});
}

TEST_CASE("frames of another size or number are refused") {
  const TemporaryFolder folder;
  MovieWriter writer(folder / "run.png", {8, 6, 30, 1});
  CHECK(has(message_of([&] { writer.add(frame_of(8, 7, 0)); }), "expected 1 frames of 8x6"));
  writer.add(frame_of(8, 6, 0));
  CHECK(has(message_of([&] { writer.add(frame_of(8, 6, 1)); }), "expected 1 frames of 8x6"));
}

TEST_CASE("a film goes where a link leads, and keeps the permissions of what it replaces") {
  const FakeFfmpeg ffmpeg;
  const TemporaryFolder folder;
  fs::create_directory(folder / "films");
  write_bytes(folder / "films/run.mp4", "old");
  fs::permissions(folder / "films/run.mp4", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("films/run.mp4", folder / "link.mp4");
  write_film(folder / "link.mp4", {8, 6, 30, 2});
  CHECK(fs::is_symlink(folder / "link.mp4"));
  CHECK(fs::file_size(folder / "films/run.mp4") == 2 * 8 * 6 * 3);
  CHECK(fs::status(folder / "films/run.mp4").permissions() ==
        (fs::perms::owner_read | fs::perms::owner_write));
}

TEST_CASE("the real ffmpeg makes files that players know") {
  if (!ffmpeg_available()) {
    WARN("skipped: ffmpeg is not installed");
    return;
  }
  const TemporaryFolder folder;
  const std::string name = GENERATE("a: b%03d.gif", "-run.mp4");
  write_film(folder / name, {65, 33, 10, 5});
  CHECK(names_in(folder) == Names{name});
  const std::string bytes = read_bytes(folder / name);
  REQUIRE(bytes.size() > 32);
  CHECK((name.ends_with(".gif") ? bytes.substr(0, 6) == "GIF89a" : bytes.substr(4, 4) == "ftyp"));
}
