// Files as bytes: read whole, and written so that nobody ever sees half of one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace flyball {

// What a file may hold; what is longer is refused. A scene of a million bodies is half of it.
inline constexpr std::size_t largest_file = 256'000'000; // bytes

// The whole of a file, at most largest_file; "-" is standard input. Where it is neither a regular file nor
// one of this process's own descriptors ("-", /dev/stdin, /dev/fd/3), but a pipe or device by name, it is
// waited for at most `patience` seconds at a time, if that is given. Throws SceneError (`where` is the path)
// where it cannot be read.
std::string read_bytes(const std::filesystem::path& file, std::optional<double> patience = std::nullopt);

// Replaces a file: written beside it, synchronised and renamed, through symbolic links, with the permissions
// it had and, where this process may give it, the owner. Other hard links keep what was there. What killed
// programs have left of writing in that folder is removed. "-" is standard output; a path that is no regular
// file (a pipe, /dev/stdout) is written directly, and a named pipe waits for its reader. Throws SceneError
// (`where` is the path), and then leaves the old file as it was.
void write_bytes(const std::filesystem::path& file, std::string_view bytes);
// The same in pieces, with nothing in the file's place before the last.
class FileWriter {
 public:
  // Throws where nothing can be written there, as far as that is known beforehand. A pipe or standard output
  // gets each piece at once.
  explicit FileWriter(const std::filesystem::path& file);
  ~FileWriter(); // without finish() the file stays as it was
  FileWriter(FileWriter&&) noexcept;
  FileWriter& operator=(FileWriter&&) noexcept;

  void write(std::string_view bytes);
  // From this place (bytes) on, whatever is written elsewhere. Throws for what is no regular file.
  void write_at(std::uint64_t place, std::string_view bytes);
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};
// The same for whoever may not wait: refuses what is there and no regular file, "-" too.
void replace_file(const std::filesystem::path& file, std::string_view bytes);

// Whether both are the same regular file, through links as well; "-" is standard input for the first and
// standard output for the second. A file that is not there is the same as one of the same place and name.
bool same_file(const std::filesystem::path& input, const std::filesystem::path& output);

} // namespace flyball
