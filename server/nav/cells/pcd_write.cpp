#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>

#include "nav/cells/lzf.hpp"
#include "nav/cells/pcd.hpp"

namespace roverd::nav::cells {

namespace {

template <class Number>
void append(std::string& out, Number value) {
  std::array<char, 64> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  out.append(text.data(), end);
}

void append_each(std::string& out, const char* key, std::size_t times, const char* word) {
  out += key;
  for (std::size_t i = 0; i < times; ++i) out.append(" ").append(word);
  out += "\n";
}

std::string header_of(const PcdTable& t, const char* data) {
  std::string out = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS";
  for (const std::string& name : t.names) out.append(" ").append(name);
  out += "\n";
  append_each(out, "SIZE", t.names.size(), "4");
  append_each(out, "TYPE", t.names.size(), "F");
  append_each(out, "COUNT", t.names.size(), "1");
  out += "WIDTH ";
  append(out, t.width);
  out += "\nHEIGHT ";
  append(out, t.height);
  out += "\nVIEWPOINT";
  for (const double v : t.viewpoint) {
    out += " ";
    append(out, v);
  }
  out += "\nPOINTS ";
  append(out, std::uint64_t{t.width} * t.height);
  return out.append("\nDATA ").append(data).append("\n");
}

std::string wrong_in(const PcdTable& t) {
  const std::uint64_t points = std::uint64_t{t.width} * t.height;
  if (points > kMostPcdPoints) return "too many points for one file";
  if (t.names.empty() || t.names.size() > 64 || t.names.size() != t.columns.size()) {
    return "one name a column, 1 to 64 of them";
  }
  for (const std::string& name : t.names) {
    const bool plain = std::all_of(name.begin(), name.end(), [](char c) { return c > ' '; });
    if (name.empty() || !plain) return "a column's name without blanks";
  }
  for (const auto& column : t.columns) {
    if (column.size() != points) return "as many values a column as width times height";
  }
  return {};
}

std::vector<std::uint8_t> with_bytes(const std::string& text, base::Bytes more) {
  std::vector<std::uint8_t> out(text.begin(), text.end());
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

using Value = std::function<float(std::size_t column, std::size_t point)>;

/// Behind `head` the two sizes, then the columns, each packed for itself.
std::vector<std::uint8_t> packed_behind(const std::string& head, std::size_t columns,
                                        std::size_t points, const Value& value) {
  const std::size_t plain_bytes = columns * points * 4;
  std::vector<std::uint8_t> out;
  // Address space alone, as far as it is not filled.
  out.reserve(head.size() + 8 + plain_bytes + plain_bytes / 32 + columns);
  out.assign(head.begin(), head.end());
  out.resize(head.size() + 8);
  std::vector<std::uint8_t> column(points * 4);
  for (std::size_t c = 0; c < columns; ++c) {
    for (std::size_t i = 0; i < points; ++i) {
      const float v = value(c, i);
      std::memcpy(column.data() + i * 4, &v, 4);
    }
    const auto packed = pack_lzf(column);
    out.insert(out.end(), packed.begin(), packed.end());
  }
  const std::array<std::uint32_t, 2> sizes = {
      static_cast<std::uint32_t>(out.size() - head.size() - 8),
      static_cast<std::uint32_t>(plain_bytes)};
  std::memcpy(out.data() + head.size(), sizes.data(), sizeof sizes);
  return out;
}

std::vector<std::uint8_t> bytes_by_points(const PcdTable& t, std::size_t points) {
  std::vector<std::uint8_t> out(points * 4 * t.columns.size());
  std::size_t at = 0;
  for (std::size_t i = 0; i < points; ++i) {
    for (const auto& column : t.columns) {
      std::memcpy(out.data() + at, &column[i], 4);
      at += 4;
    }
  }
  return out;
}

}  // namespace

base::Result<std::vector<std::uint8_t>> write_pcd(const PcdTable& table, PcdData data) {
  if (const std::string wrong = wrong_in(table); !wrong.empty()) {
    return base::fail(base::Code::Invalid, "a PCD file wants " + wrong);
  }
  const std::size_t points = std::size_t{table.width} * table.height;
  switch (data) {
    case PcdData::Binary:
      return with_bytes(header_of(table, "binary"), bytes_by_points(table, points));
    case PcdData::Compressed:
      return packed_behind(
          header_of(table, "binary_compressed"), table.columns.size(), points,
          [&table](std::size_t column, std::size_t i) { return table.columns[column][i]; });
    case PcdData::Ascii:
      break;
  }
  std::string text = header_of(table, "ascii");
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      if (c > 0) text += " ";
      append(text, table.columns[c][i]);
    }
    text += "\n";
  }
  return with_bytes(text, {});
}

std::vector<std::uint8_t> write_packed_pcd(std::span<const std::string_view> names,
                                           std::uint32_t points, const Value& value) {
  PcdTable head;
  head.width = points;
  head.names.assign(names.begin(), names.end());
  return packed_behind(header_of(head, "binary_compressed"), names.size(), points, value);
}

PcdTable pcd_table(std::span<const Eigen::Vector3f> cloud) {
  PcdTable out;
  out.width = static_cast<std::uint32_t>(cloud.size());
  out.names = {"x", "y", "z"};
  out.columns.resize(3);
  for (auto& column : out.columns) column.reserve(cloud.size());
  for (const Eigen::Vector3f& p : cloud) {
    out.columns[0].push_back(p.x());
    out.columns[1].push_back(p.y());
    out.columns[2].push_back(p.z());
  }
  return out;
}

}  // namespace roverd::nav::cells
