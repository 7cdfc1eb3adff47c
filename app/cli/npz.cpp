#include "app/cli/npz.hpp"

#include "engine/mechanism/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace flyball::cli {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t word_size = 15; // of the longest status

// CRC-32 of ISO 3309, by bytes; continued from the one before.
std::uint32_t checksum(std::uint32_t before, std::string_view bytes) {
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

std::string array_head(const NpzColumn& column, std::uint64_t rows) {
  std::string text =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({},), }}", column.type, rows);
  constexpr std::size_t alignment = 64, before = 10;
  text.resize((before + text.size() + 1 + alignment - 1) / alignment * alignment - before, ' ');
  text.back() = '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  append(out, static_cast<std::uint16_t>(text.size()));
  return out + text;
}

constexpr std::uint16_t local_extra = 4 + 16, central_extra = 4 + 24;

std::string local_record(std::uint32_t crc, const std::string& name, std::uint64_t size) {
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

std::string central_record(std::uint32_t crc, const std::string& name, std::uint64_t size,
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

std::string end_record(std::uint64_t members, std::uint64_t begin, std::uint64_t size) {
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

} // namespace

std::vector<NpzColumn> npz_columns(const std::vector<Column>& columns) {
  std::vector<NpzColumn> all;
  for (const auto& [name, kind] : columns) {
    if (kind == CellKind::text) continue;
    NpzColumn column{name, "<f8", 8};
    if (kind == CellKind::word) column = {name, fmt::format("|S{}", word_size), word_size};
    if (kind == CellKind::verdict) column = {name, "|i1", 1};
    while (std::ranges::find(all, column.name, &NpzColumn::name) != all.end())
      column.name += "_";
    all.push_back(std::move(column));
  }
  return all;
}

void append_item(std::string& out, double value) {
  append(out, value);
}

void append_word(std::string& out, std::string_view word) {
  const std::size_t begin = out.size();
  out += word.substr(0, word_size);
  out.resize(begin + word_size, '\0');
}

std::int8_t npz_verdict(std::optional<bool> verdict) {
  return static_cast<std::int8_t>(verdict ? (*verdict ? 1 : 0) : -1);
}

std::uint64_t NpzWriter::Member::data() const {
  return place + local_record(0, name, size).size();
}

NpzWriter::NpzWriter(const std::filesystem::path& file, const std::vector<NpzColumn>& columns,
                     std::uint64_t rows)
    : out_(file) {
  for (const NpzColumn& column : columns) {
    Member member{column, column.name + ".npy", array_head(column, rows), end_, 0, 0};
    member.size = member.head.size() + rows * column.size;
    member.checksum = checksum(0, member.head);
    out_.write_at(member.data(), member.head);
    end_ = member.data() + member.size;
    members_.push_back(std::move(member));
  }
}

void NpzWriter::write(std::uint64_t begin, std::uint64_t end, std::string_view columns) {
  for (Member& member : members_) {
    const std::string_view items = columns.substr(0, (end - begin) * member.column.size);
    columns.remove_prefix(items.size());
    member.checksum = checksum(member.checksum, items);
    out_.write_at(member.data() + member.head.size() + begin * member.column.size, items);
  }
}

void NpzWriter::finish() {
  std::string directory;
  for (const Member& member : members_) {
    out_.write_at(member.place, local_record(member.checksum, member.name, member.size));
    directory += central_record(member.checksum, member.name, member.size, member.place);
  }
  out_.write_at(end_, directory + end_record(members_.size(), end_, directory.size()));
  out_.finish();
}

} // namespace flyball::cli
