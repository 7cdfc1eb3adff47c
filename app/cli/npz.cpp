#include "app/cli/npz.hpp"

#include "app/report/npz_archive.hpp"
#include "engine/mechanism/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace flyball::cli {
namespace {

constexpr std::size_t word_size = 15; // of the longest status

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
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
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
  return place + npz_local_record(0, name, size).size();
}

NpzWriter::NpzWriter(const std::filesystem::path& file, const std::vector<NpzColumn>& columns,
                     std::uint64_t rows)
    : out_(file) {
  for (const NpzColumn& column : columns) {
    Member member{
        column, column.name + ".npy", npz_array_head(column.type, fmt::format("{},", rows)), end_, 0, 0};
    member.size = member.head.size() + rows * column.size;
    member.checksum = npz_checksum(0, member.head);
    out_.write_at(member.data(), member.head);
    end_ = member.data() + member.size;
    members_.push_back(std::move(member));
  }
}

void NpzWriter::write(std::uint64_t begin, std::uint64_t end, std::string_view columns) {
  for (Member& member : members_) {
    const std::string_view items = columns.substr(0, (end - begin) * member.column.size);
    columns.remove_prefix(items.size());
    member.checksum = npz_checksum(member.checksum, items);
    out_.write_at(member.data() + member.head.size() + begin * member.column.size, items);
  }
}

void NpzWriter::finish() {
  std::string directory;
  for (const Member& member : members_) {
    out_.write_at(member.place, npz_local_record(member.checksum, member.name, member.size));
    directory += npz_central_record(member.checksum, member.name, member.size, member.place);
  }
  out_.write_at(end_, directory + npz_end_record(members_.size(), end_, directory.size()));
  out_.finish();
}

} // namespace flyball::cli
