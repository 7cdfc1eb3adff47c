#include "app/report/npz_archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

namespace flyball {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class Number>
void append(std::string& out, Number number) {
  out.append(reinterpret_cast<const char*>(&number), sizeof number);
}

constexpr std::uint32_t elsewhere = 0xFFFFFFFF; // told in the field of 64 bits
constexpr std::uint16_t version = 45;           // with such fields
constexpr std::uint16_t first_day = 0x21;       // 1 January 1980: the same bytes whenever they are written

// What both of a member's records have.
void append_member(std::string& out, std::uint32_t crc, const std::string& name, std::uint16_t extra) {
  append(out, version);
  append<std::uint16_t>(out, 1 << 11); // names in UTF-8
  append<std::uint16_t>(out, 0);       // stored
  append<std::uint16_t>(out, 0);
  append(out, first_day);
  append(out, crc);
  append(out, elsewhere);
  append(out, elsewhere);
  append(out, static_cast<std::uint16_t>(name.size()));
  append(out, extra);
}

constexpr std::uint16_t local_extra = 4 + 16, central_extra = 4 + 24;

} // namespace

std::uint32_t npz_checksum(std::uint32_t before, std::string_view bytes) {
  static constexpr auto table = [] {
    std::array<std::uint32_t, 256> t{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      t[i] = i;
      for (int k = 0; k < 8; ++k)
        t[i] = (t[i] >> 1) ^ (t[i] & 1U ? 0xEDB88320U : 0U);
    }
    return t;
  }();
  std::uint32_t crc = ~before;
  for (const char c : bytes)
    crc = (crc >> 8) ^ table[(crc ^ static_cast<unsigned char>(c)) & 0xFFU];
  return ~crc;
}

std::string npz_array_head(std::string_view type, std::string_view shape) {
  std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
  constexpr std::size_t alignment = 64, before = 10;
  text.resize((before + text.size() + 1 + alignment - 1) / alignment * alignment - before, ' ');
  text.back() = '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  append(out, static_cast<std::uint16_t>(text.size()));
  return out + text;
}

std::string npz_local_record(std::uint32_t crc, const std::string& name, std::uint64_t size) {
  std::string out;
  append<std::uint32_t>(out, 0x04034b50);
  append_member(out, crc, name, local_extra);
  out += name;
  append<std::uint16_t>(out, 1);
  append<std::uint16_t>(out, local_extra - 4);
  append(out, size);
  append(out, size);
  return out;
}

std::string npz_central_record(std::uint32_t crc, const std::string& name, std::uint64_t size,
                               std::uint64_t place) {
  std::string out;
  append<std::uint32_t>(out, 0x02014b50);
  append(out, version);
  append_member(out, crc, name, central_extra);
  append<std::uint16_t>(out, 0); // comment
  append<std::uint16_t>(out, 0); // disk
  append<std::uint16_t>(out, 0); // attributes
  append<std::uint32_t>(out, 0);
  append(out, elsewhere);
  out += name;
  append<std::uint16_t>(out, 1);
  append<std::uint16_t>(out, central_extra - 4);
  append(out, size);
  append(out, size);
  append(out, place);
  return out;
}

std::string npz_end_record(std::uint64_t members, std::uint64_t begin, std::uint64_t size) {
  std::string out;
  append<std::uint32_t>(out, 0x06064b50);
  append<std::uint64_t>(out, 44); // bytes that follow
  append(out, version);
  append(out, version);
  append<std::uint32_t>(out, 0);
  append<std::uint32_t>(out, 0);
  append(out, members);
  append(out, members);
  append(out, size);
  append(out, begin);
  append<std::uint32_t>(out, 0x07064b50); // where that is
  append<std::uint32_t>(out, 0);
  append(out, begin + size);
  append<std::uint32_t>(out, 1);
  append<std::uint32_t>(out, 0x06054b50);
  append<std::uint32_t>(out, 0);
  append(out, static_cast<std::uint16_t>(std::min<std::uint64_t>(members, 0xFFFF)));
  append(out, static_cast<std::uint16_t>(std::min<std::uint64_t>(members, 0xFFFF)));
  append(out, elsewhere);
  append(out, elsewhere);
  append<std::uint16_t>(out, 0);
  return out;
}

std::string npz_archive(const std::vector<NpzArray>& arrays) {
  std::string out, directory;
  for (const NpzArray& array : arrays) {
    const std::string name = array.name + ".npy",
                      bytes = npz_array_head(array.type, array.shape) + array.items;
    const std::uint32_t crc = npz_checksum(0, bytes);
    directory += npz_central_record(crc, name, bytes.size(), out.size());
    out += npz_local_record(crc, name, bytes.size()) + bytes;
  }
  const std::uint64_t begin = out.size();
  return out + directory + npz_end_record(arrays.size(), begin, directory.size());
}

} // namespace flyball
