#include "nav/cells/pcd.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "nav/cells/lzf.hpp"
#include "nav/cells/pcd_head.hpp"

namespace roverd::nav::cells {

namespace {

using pcd::Field;
using pcd::Header;
using pcd::wrong_line;

constexpr std::size_t kMostPacked_bytes = std::size_t{1} << 30U;
constexpr std::size_t kAtOnce = 1024;  // points that are unpacked together

tl::unexpected<base::Error> wrong_byte(std::size_t byte, const std::string& what) {
  return base::fail(base::Code::Malformed, "PCD byte " + std::to_string(byte) + ": " + what,
                    {{"byte " + std::to_string(byte), what}});
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

/// What is packed, after its two sizes.
struct Packed {
  base::Bytes bytes;
  std::size_t plain_bytes = 0;
};

base::Result<Packed> packed_in(base::Bytes body, const Header& h, std::size_t points) {
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
  return Packed{body.subspan(8, u32(0)), u32(4)};
}

/// Whether a body of the kind that the header says can hold its points.
base::Result<void> holds_points(base::Bytes file, const Header& h, std::size_t points) {
  const base::Bytes body = file.subspan(h.ends_at);
  if (h.data == "ascii") {
    std::size_t words = 0;
    for (const Field& f : h.fields) words += f.count;
    if (points > 0 && points > (body.size() + 1) / (2 * words)) {
      return wrong_line(h.lines, "more points than the text can hold");
    }
  } else if (h.data == "binary") {
    if (body.size() / h.row_bytes() < points) {
      return wrong_byte(file.size(), "ends before the last point");
    }
  } else if (h.data == "binary_compressed") {
    const auto packed = packed_in(body, h, points);
    if (!packed) return tl::unexpected<base::Error>(packed.error());
    return check_lzf(packed->bytes, packed->plain_bytes);
  } else {
    return base::fail(base::Code::Unsupported,
                      "PCD data must be ascii, binary or binary_compressed");
  }
  return {};
}

/// One line of numbers into `values`, those of the wanted fields.
base::Result<void> take_line(std::string_view line, std::string_view word, const Header& h,
                             std::size_t line_number, std::span<const std::size_t> places,
                             std::vector<float>& values) {
  for (std::size_t i = 0; i < h.fields.size(); ++i) {
    for (std::size_t k = 0; k < h.fields[i].count; ++k) {
      double value = 0.0;
      if (!pcd::read_number(word, value)) {
        return wrong_line(line_number, "no number for " + h.fields[i].name);
      }
      for (std::size_t c = 0; c < places.size(); ++c) {
        if (places[c] == i) values[c] = static_cast<float>(value);
      }
      word = pcd::next_word(line);
    }
  }
  if (!word.empty()) return wrong_line(line_number, "more values than fields");
  return {};
}

base::Result<void> read_ascii(base::Bytes body, const Header& h,
                              std::span<const std::size_t> places, std::size_t points,
                              const PcdReader::Take& take) {
  std::string_view text(reinterpret_cast<const char*>(body.data()), body.size());
  std::vector<float> values(places.size());
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
      word = pcd::next_word(line);
    }
    if (auto read = take_line(line, word, h, line_number, places, values); !read) return read;
    if (!take(values)) return {};
  }
  return {};
}

/// Where a field of a point begins.
std::size_t offset_of(const Header& h, std::size_t place) {
  std::size_t offset = 0;
  for (std::size_t i = 0; i < place; ++i) offset += h.fields[i].bytes();
  return offset;
}

void read_binary(base::Bytes body, const Header& h, std::span<const std::size_t> places,
                 std::size_t points, const PcdReader::Take& take) {
  struct Column {
    Convert convert;
    std::size_t offset;
  };
  std::vector<Column> columns;
  for (const std::size_t place : places) {
    columns.push_back({converter(h.fields[place]), offset_of(h, place)});
  }
  std::vector<float> values(places.size());
  const std::size_t row = h.row_bytes();
  for (std::size_t i = 0; i < points; ++i) {
    const std::uint8_t* from = body.data() + i * row;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      values[c] = columns[c].convert(from + columns[c].offset);
    }
    if (!take(values)) return;
  }
}

/// Packed are all values of the first field, then all of the second, and so on: each wanted field
/// is unpacked beside the others from where its values begin, so that no more than a few kilobytes
/// of any are held.
base::Result<void> read_packed(base::Bytes body, const Header& h,
                               std::span<const std::size_t> places, std::size_t points,
                               const PcdReader::Take& take) {
  const auto packed = packed_in(body, h, points);
  if (!packed) return tl::unexpected<base::Error>(packed.error());
  std::vector<LzfStream> streams(places.size(), LzfStream(packed->bytes));
  for (std::size_t c = 0; c < places.size(); ++c) {
    if (auto to = streams[c].read(nullptr, offset_of(h, places[c]) * points); !to) return to;
  }
  std::vector<std::uint8_t> bytes;
  std::vector<float> together(places.size() * kAtOnce);
  for (std::size_t done = 0; done < points; done += kAtOnce) {
    const std::size_t now = std::min(kAtOnce, points - done);
    for (std::size_t c = 0; c < places.size(); ++c) {
      const Field& field = h.fields[places[c]];
      bytes.resize(now * field.bytes());
      if (auto read = streams[c].read(bytes.data(), bytes.size()); !read) return read;
      const Convert convert = converter(field);
      for (std::size_t i = 0; i < now; ++i) {
        together[i * places.size() + c] = convert(bytes.data() + i * field.bytes());
      }
    }
    for (std::size_t i = 0; i < now; ++i) {
      if (!take({together.data() + i * places.size(), places.size()})) return {};
    }
  }
  return {};
}

}  // namespace

struct PcdReader::Inside {
  base::Bytes file;
  Header header;
  std::vector<std::size_t> places;
};

PcdReader::PcdReader(std::unique_ptr<Inside> inside) : inside_(std::move(inside)) {}
PcdReader::PcdReader(PcdReader&&) noexcept = default;
PcdReader& PcdReader::operator=(PcdReader&&) noexcept = default;
PcdReader::~PcdReader() = default;

base::Result<PcdReader> PcdReader::open(base::Bytes file,
                                        std::span<const std::string_view> wanted) {
  static_assert(std::endian::native == std::endian::little);
  auto header = pcd::read_header(file);
  if (!header) return tl::unexpected<base::Error>(header.error());
  auto places = places_of(*header, wanted);
  if (!places) return tl::unexpected<base::Error>(places.error());
  const std::size_t points = std::size_t{header->width} * header->height;
  if (auto holds = holds_points(file, *header, points); !holds) {
    return tl::unexpected<base::Error>(holds.error());
  }
  return PcdReader(std::make_unique<Inside>(Inside{file, std::move(*header), std::move(*places)}));
}

std::uint32_t PcdReader::width() const noexcept {
  return inside_->header.width;
}

std::uint32_t PcdReader::height() const noexcept {
  return inside_->header.height;
}

const std::array<double, 7>& PcdReader::viewpoint() const noexcept {
  return inside_->header.viewpoint;
}

base::Result<void> PcdReader::read(const Take& take) const {
  const Header& h = inside_->header;
  const base::Bytes body = inside_->file.subspan(h.ends_at);
  if (h.data == "ascii") return read_ascii(body, h, inside_->places, points(), take);
  if (h.data == "binary_compressed") return read_packed(body, h, inside_->places, points(), take);
  read_binary(body, h, inside_->places, points(), take);
  return {};
}

base::Result<PcdTable> read_pcd(base::Bytes file, std::span<const std::string_view> wanted) {
  const auto reader = PcdReader::open(file, wanted);
  if (!reader) return tl::unexpected<base::Error>(reader.error());
  PcdTable out{reader->width(), reader->height(), reader->viewpoint(), {}, {}};
  out.names.assign(wanted.begin(), wanted.end());
  out.columns.resize(wanted.size());
  for (auto& column : out.columns) column.reserve(reader->points());
  const auto read = reader->read([&out](std::span<const float> values) {
    for (std::size_t c = 0; c < values.size(); ++c) out.columns[c].push_back(values[c]);
    return true;
  });
  if (!read) return tl::unexpected<base::Error>(read.error());
  return out;
}

base::Result<Cloud> read_pcd_cloud(base::Bytes file) {
  const auto reader = PcdReader::open(file, kPcdXyz);
  if (!reader) return tl::unexpected<base::Error>(reader.error());
  Cloud out;
  out.reserve(reader->points());
  const auto read = reader->read([&out](std::span<const float> at) {
    out.emplace_back(at[0], at[1], at[2]);
    return true;
  });
  if (!read) return tl::unexpected<base::Error>(read.error());
  return out;
}

}  // namespace roverd::nav::cells
