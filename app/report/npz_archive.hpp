// Archives of arrays for NumPy: a ZIP archive of one array a member (numpy.lib.format, version 1.0), stored
// as they are. Sizes and places have 64 bits (PKWARE, .ZIP File Format Specification 6.3, 4.5.3). The parts,
// for whoever writes members side by side, and a small archive at once.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace flyball {

// CRC-32 of ISO 3309, by bytes; continued from the one before.
std::uint32_t npz_checksum(std::uint32_t before, std::string_view bytes);
// What an array begins with: NumPy's type "<f8" and shape "3," or "3, 2".
std::string npz_array_head(std::string_view type, std::string_view shape);
// The archive's record of a member before it, and in the directory at the end; the directory's end.
std::string npz_local_record(std::uint32_t crc, const std::string& name, std::uint64_t size);
std::string npz_central_record(std::uint32_t crc, const std::string& name, std::uint64_t size,
                               std::uint64_t place);
std::string npz_end_record(std::uint64_t members, std::uint64_t begin, std::uint64_t size);

struct NpzArray {
  std::string name, type, shape; // as above
  std::string items;             // bytes, row by row, little-endian
};
std::string npz_archive(const std::vector<NpzArray>& arrays);

} // namespace flyball
