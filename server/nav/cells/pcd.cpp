#include "nav/cells/pcd.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <utility>

#include "nav/cells/lzf.hpp"

namespace roverd::nav::cells {

namespace {

constexpr std::size_t kMostFields = 64;
constexpr std::size_t kMostHeader_bytes = 65'536;
constexpr std::size_t kMostCount = 4096;  // values of one field, as of a descriptor
constexpr std::size_t kMostRow_bytes = 65'536;
constexpr std::size_t kMostPacked_bytes = std::size_t{1} << 30U;

struct Field {
  std::string name;
  std::size_t size = 4;
  char type = 'F';
  std::size_t count = 1;
  std::size_t bytes() const noexcept { return size * count; }
};

struct Header {
  std::vector<Field> fields;
  std::uint32_t width = 0;
  std::uint32_t height = 1;
  std::optional<std::uint32_t> points;
  std::array<double, 7> viewpoint = {0, 0, 0, 1, 0, 0, 0};
  std::string data;
  std::size_t lines = 0;
  std::size_t ends_at = 0;  // byte after it

  std::size_t row_bytes() const noexcept {
    std::size_t sum = 0;
    for (const Field& f : fields) sum += f.bytes();
    return sum;
  }
};

tl::unexpected<base::Error> wrong_line(std::size_t line, const std::string& what) {
  return base::fail(base::Code::Malformed, "PCD line " + std::to_string(line) + ": " + what,
                    {{"line " + std::to_string(line), what}});
}

tl::unexpected<base::Error> wrong_byte(std::size_t byte, const std::string& what) {
  return base::fail(base::Code::Malformed, "PCD byte " + std::to_string(byte) + ": " + what,
                    {{"byte " + std::to_string(byte), what}});
}

/// The next word of the line; empty at its end.
std::string_view next_word(std::string_view& rest) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t from = std::min(rest.find_first_not_of(kBlank), rest.size());
  rest.remove_prefix(from);
  const std::size_t to = std::min(rest.find_first_of(kBlank), rest.size());
  const std::string_view word = rest.substr(0, to);
  rest.remove_prefix(to);
  return word;
}

std::vector<std::string_view> words_of(std::string_view rest) {
  std::vector<std::string_view> out;
  for (auto word = next_word(rest); !word.empty() && out.size() <= kMostFields;
       word = next_word(rest)) {
    out.push_back(word);
  }
  return out;
}

template <class Number>
bool read_number(std::string_view word, Number& out) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), out);
  return error == std::errc{} && end == word.data() + word.size();
}

bool known_type(const Field& f) {
  if (f.type == 'F') return f.size == 4 || f.size == 8;
  return (f.type == 'I' || f.type == 'U') &&
         (f.size == 1 || f.size == 2 || f.size == 4 || f.size == 8);
}

/// Takes the words of one line of the header. @return what is wrong; empty: nothing
std::string take_line(std::string_view key, const std::vector<std::string_view>& words, Header& h) {
  const bool of_fields = key == "SIZE" || key == "TYPE" || key == "COUNT";
  if (key == "FIELDS" || key == "COLUMNS") {
    if (words.empty() || words.size() > kMostFields) return "FIELDS names 1 to 64 fields";
    if (!h.fields.empty()) return "FIELDS for the second time";
    for (const auto word : words) h.fields.push_back({std::string(word)});
    return {};
  }
  if (of_fields && words.size() != h.fields.size()) {
    return std::string(key) + " has not as many values as FIELDS";
  }
  for (std::size_t i = 0; of_fields && i < words.size(); ++i) {
    Field& f = h.fields[i];
    if (key == "TYPE") {
      f.type = words[i].size() == 1 ? words[i][0] : '?';
    } else if (std::size_t& value = key == "SIZE" ? f.size : f.count;
               !read_number(words[i], value) || value == 0 || value > kMostCount) {
      return std::string(key) + " of " + f.name + " must be 1 to 4096";
    }
  }
  if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS") {
    std::uint32_t value = 0;
    if (words.size() != 1 || !read_number(words[0], value)) {
      return std::string(key) + " must be one number";
    }
    if (key == "POINTS") h.points = value;
    if (key == "WIDTH") h.width = value;
    if (key == "HEIGHT") h.height = value;
  } else if (key == "VIEWPOINT") {
    if (words.size() != 7) return "VIEWPOINT must be seven numbers";
    for (std::size_t i = 0; i < 7; ++i) {
      if (!read_number(words[i], h.viewpoint[i])) return "VIEWPOINT must be seven numbers";
    }
  } else if (key == "DATA") {
    if (words.size() != 1) return "DATA must be one word";
    h.data = words[0];
  } else if (!of_fields && key != "VERSION") {
    return "not a line of a PCD header";
  }
  return {};
}

base::Result<Header> read_header(base::Bytes file) {
  const auto head = file.first(std::min(file.size(), kMostHeader_bytes));
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  Header h;
  while (h.data.empty()) {
    ++h.lines;
    const std::size_t end = text.find('\n', h.ends_at);
    if (end == std::string_view::npos) return wrong_line(h.lines, "ends before DATA");
    std::string_view line = text.substr(h.ends_at, end - h.ends_at);
    h.ends_at = end + 1;
    const std::string_view key = next_word(line);
    if (key.empty() || key.front() == '#') continue;
    if (const std::string wrong = take_line(key, words_of(line), h); !wrong.empty()) {
      return wrong_line(h.lines, wrong);
    }
  }
  if (h.fields.empty()) return wrong_line(h.lines, "DATA without FIELDS before it");
  for (const Field& f : h.fields) {
    if (!known_type(f))
      return wrong_line(h.lines, "field " + f.name + " has no known TYPE and SIZE");
  }
  if (h.row_bytes() > kMostRow_bytes) return wrong_line(h.lines, "more than 65536 bytes a point");
  const std::uint64_t points = std::uint64_t{h.width} * h.height;
  if (points > kMostPcdPoints) {
    return base::fail(base::Code::TooLarge, "PCD of " + std::to_string(points) +
                                                " points: more than " +
                                                std::to_string(kMostPcdPoints));
  }
  if (h.points && *h.points != points) return wrong_line(h.lines, "POINTS is not WIDTH x HEIGHT");
  return h;
}

/// Little-endian, as every machine that writes them.
template <class T>
float number_at(const std::uint8_t* p) {
  T value{};
  std::memcpy(&value, p, sizeof value);
  return static_cast<float>(value);
}

using Convert = float (*)(const std::uint8_t*);
Convert converter(const Field& f) {
  if (f.type == 'F') return f.size == 4 ? number_at<float> : number_at<double>;
  const bool plus = f.type == 'U';
  switch (f.size) {
    case 1:
      return plus ? number_at<std::uint8_t> : number_at<std::int8_t>;
    case 2:
      return plus ? number_at<std::uint16_t> : number_at<std::int16_t>;
    case 4:
      return plus ? number_at<std::uint32_t> : number_at<std::int32_t>;
    default:
      return plus ? number_at<std::uint64_t> : number_at<std::int64_t>;
  }
}

/// The wanted fields' places among the header's.
base::Result<std::vector<std::size_t>> places_of(const Header& h,
                                                 std::span<const std::string_view> wanted) {
  std::vector<std::size_t> out;
  for (const std::string_view name : wanted) {
    const auto field = std::find_if(h.fields.begin(), h.fields.end(),
                                    [&](const Field& f) { return f.name == name; });
    if (field == h.fields.end()) {
      return base::fail(base::Code::Malformed, "PCD has no field " + std::string(name),
                        {{"/" + std::string(name), "is missing"}});
    }
    if (field->count != 1) {
      return base::fail(base::Code::Unsupported, "PCD field " + std::string(name) + " is an array",
                        {{"/" + std::string(name), "must have COUNT 1"}});
    }
    out.push_back(static_cast<std::size_t>(field - h.fields.begin()));
  }
  return out;
}

base::Result<void> read_ascii(base::Bytes body, const Header& h,
                              std::span<const std::size_t> places, std::size_t points,
                              PcdTable& out) {
  std::string_view text(reinterpret_cast<const char*>(body.data()), body.size());
  std::size_t words = 0;
  for (const Field& f : h.fields) words += f.count;
  if (points > 0 && points > (text.size() + 1) / (2 * words)) {
    return wrong_line(h.lines, "more points than the text can hold");
  }
  for (auto& column : out.columns) column.reserve(points);
  std::size_t line_number = h.lines;
  for (std::size_t point = 0; point < points; ++point) {
    std::string_view line;
    std::string_view word;
    while (word.empty()) {
      if (text.empty()) return wrong_line(line_number, "ends before the last point");
      ++line_number;
      const std::size_t end = std::min(text.find('\n'), text.size());
      line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      word = next_word(line);
    }
    for (std::size_t i = 0; i < h.fields.size(); ++i) {
      for (std::size_t k = 0; k < h.fields[i].count; ++k) {
        double value = 0.0;
        if (!read_number(word, value)) {
          return wrong_line(line_number, "no number for " + h.fields[i].name);
        }
        for (std::size_t c = 0; c < places.size(); ++c) {
          if (places[c] == i) out.columns[c].push_back(static_cast<float>(value));
        }
        word = next_word(line);
      }
    }
    if (!word.empty()) return wrong_line(line_number, "more values than fields");
  }
  return {};
}

/// @param by_columns all values of the first field, then of the second, ...: as they are packed
void take_binary(const std::uint8_t* data, const Header& h, std::span<const std::size_t> places,
                 std::size_t points, bool by_columns, PcdTable& out) {
  const std::size_t row = h.row_bytes();
  for (std::size_t c = 0; c < places.size(); ++c) {
    const Field& field = h.fields[places[c]];
    std::size_t offset = 0;
    for (std::size_t i = 0; i < places[c]; ++i) offset += h.fields[i].bytes();
    const std::uint8_t* from = data + (by_columns ? offset * points : offset);
    const std::size_t step = by_columns ? field.bytes() : row;
    const Convert convert = converter(field);
    out.columns[c].resize(points);
    for (std::size_t i = 0; i < points; ++i) out.columns[c][i] = convert(from + i * step);
  }
}

base::Result<void> read_packed(base::Bytes body, const Header& h,
                               std::span<const std::size_t> places, std::size_t points,
                               PcdTable& out) {
  if (body.size() < 8) return wrong_byte(h.ends_at, "ends before the packed sizes");
  const auto u32 = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, body.data() + at, sizeof value);
    return std::size_t{value};
  };
  if (u32(0) > body.size() - 8) return wrong_byte(h.ends_at, "ends before the packed data do");
  if (u32(4) != points * h.row_bytes()) {
    return wrong_byte(h.ends_at + 4, "what is packed is not as long as the points are");
  }
  if (u32(4) > kMostPacked_bytes) {
    return base::fail(base::Code::TooLarge, "PCD packs more than 1 GB");
  }
  const auto plain = unpack_lzf(body.subspan(8, u32(0)), u32(4));
  if (!plain) return tl::unexpected<base::Error>(plain.error());
  take_binary(plain->data(), h, places, points, true, out);
  return {};
}

}  // namespace

base::Result<PcdTable> read_pcd(base::Bytes file, std::span<const std::string_view> wanted) {
  static_assert(std::endian::native == std::endian::little);
  auto header = read_header(file);
  if (!header) return tl::unexpected<base::Error>(header.error());
  const auto places = places_of(*header, wanted);
  if (!places) return tl::unexpected<base::Error>(places.error());
  PcdTable out{header->width, header->height, header->viewpoint, {}, {}};
  out.names.assign(wanted.begin(), wanted.end());
  out.columns.resize(wanted.size());
  const std::size_t points = std::size_t{header->width} * header->height;
  const base::Bytes body = file.subspan(header->ends_at);
  base::Result<void> read;
  if (header->data == "ascii") {
    read = read_ascii(body, *header, *places, points, out);
  } else if (header->data == "binary") {
    if (body.size() / header->row_bytes() < points) {
      return wrong_byte(file.size(), "ends before the last point");
    }
    take_binary(body.data(), *header, *places, points, false, out);
  } else if (header->data == "binary_compressed") {
    read = read_packed(body, *header, *places, points, out);
  } else {
    return base::fail(base::Code::Unsupported,
                      "PCD data must be ascii, binary or binary_compressed");
  }
  if (!read) return tl::unexpected<base::Error>(read.error());
  return out;
}

base::Result<Cloud> read_pcd_cloud(base::Bytes file) {
  constexpr std::array<std::string_view, 3> kXyz = {"x", "y", "z"};
  const auto table = read_pcd(file, kXyz);
  if (!table) return tl::unexpected<base::Error>(table.error());
  Cloud out(table->columns[0].size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = {table->columns[0][i], table->columns[1][i], table->columns[2][i]};
  }
  return out;
}

}  // namespace roverd::nav::cells
