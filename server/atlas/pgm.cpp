// Portable grey maps. Source: pgm(5) of netpbm: magic, width, height, greatest value, one blank,
// then the values; between the words of the head a '#' begins a comment, to the end of its line.

#include <optional>
#include <utility>

#include "atlas/map_files.hpp"

namespace roverd::atlas {

namespace {

using base::Bytes;
using base::Code;
using base::FieldError;
using base::Result;

tl::unexpected<base::Error> bad_byte(std::size_t at, const std::string& what) {
  std::string place = "byte " + std::to_string(at);
  std::string detail = "the picture " + what + " (" + place + ")";
  return base::fail(Code::Malformed, std::move(detail), {FieldError{std::move(place), what}});
}

bool is_blank(std::uint8_t b) noexcept {
  return b == ' ' || (b >= '\t' && b <= '\r');
}

/// The words of the head and, in P2, the values.
class WordReader {
 public:
  explicit WordReader(Bytes file) : file_(file) {}

  /// Blanks and comments up to the next word. @return false: nothing follows.
  bool skip() noexcept {
    while (at_ < file_.size()) {
      if (file_[at_] == '#') {
        while (at_ < file_.size() && file_[at_] != '\n' && file_[at_] != '\r') ++at_;
      } else if (is_blank(file_[at_])) {
        ++at_;
      } else {
        return true;
      }
    }
    return false;
  }

  /// @return empty: no number of at most 9 digits.
  std::optional<std::uint32_t> number() noexcept {
    if (!skip()) return std::nullopt;
    std::uint32_t value = 0;
    const std::size_t begin = at_;
    for (; at_ < file_.size() && file_[at_] >= '0' && file_[at_] <= '9'; ++at_) {
      if (at_ - begin >= 9) return std::nullopt;
      value = value * 10U + (file_[at_] - static_cast<std::uint32_t>('0'));
    }
    const bool ends = at_ == file_.size() || is_blank(file_[at_]) || file_[at_] == '#';
    if (at_ == begin || !ends) return std::nullopt;
    return value;
  }

  std::size_t at() const noexcept { return at_; }
  void step() noexcept { ++at_; }

 private:
  Bytes file_;
  std::size_t at_ = 2;  // behind the magic
};

Result<Picture> read_head(WordReader& words) {
  Picture picture;
  const std::pair<std::uint32_t*, const char*> numbers[] = {
      {&picture.columns, "has no width"},
      {&picture.rows, "has no height"},
      {&picture.greatest, "has no greatest value"}};
  for (const auto& [value, missing] : numbers) {
    const auto read = words.number();
    if (!read) return bad_byte(words.at(), missing);
    *value = *read;
  }
  if (picture.columns == 0 || picture.rows == 0) return bad_byte(words.at(), "has no cells");
  if (picture.greatest == 0 || picture.greatest > 65535) {
    return bad_byte(words.at(), "has a greatest value outside of 1 to 65535");
  }
  const std::size_t count = static_cast<std::size_t>(picture.columns) * picture.rows;
  if (count > nav::chart::kMostCells) {
    return base::fail(Code::TooLarge,
                      "the picture has " + std::to_string(picture.columns) + " x " +
                          std::to_string(picture.rows) + " cells; a map may have " +
                          std::to_string(nav::chart::kMostCells),
                      {FieldError{"/size", "must be at most " +
                                               std::to_string(nav::chart::kMostCells) + " cells"}});
  }
  return picture;
}

Result<Picture> read_binary(Bytes file, WordReader& words, Picture picture) {
  words.step();  // the one blank behind the head
  const std::size_t count = static_cast<std::size_t>(picture.columns) * picture.rows;
  const std::size_t width = picture.greatest > 255 ? 2 : 1;
  if (words.at() > file.size() || file.size() - words.at() < count * width) {
    return bad_byte(file.size(), "is cut: " + std::to_string(count) + " values were announced");
  }
  if (file.size() - words.at() > count * width) {
    return bad_byte(words.at() + count * width, "is followed by something");
  }
  picture.values.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = words.at() + i * width;
    const std::uint32_t value =
        width == 1 ? file[at] : (static_cast<std::uint32_t>(file[at]) << 8U) | file[at + 1];
    if (value > picture.greatest) return bad_byte(at, "has a value above its greatest");
    picture.values[i] = static_cast<std::uint16_t>(value);
  }
  return picture;
}

Result<Picture> read_text(Bytes file, WordReader& words, Picture picture) {
  const std::size_t count = static_cast<std::size_t>(picture.columns) * picture.rows;
  // Each value takes two bytes at least: a short file does not make us hold a large picture.
  if (file.size() < 2 * count) {
    return bad_byte(file.size(), "is cut: " + std::to_string(count) + " values were announced");
  }
  picture.values.reserve(count);
  while (picture.values.size() < count) {
    const auto value = words.number();
    if (!value) return bad_byte(words.at(), "lacks a value, or has one that is no number");
    if (*value > picture.greatest) return bad_byte(words.at(), "has a value above its greatest");
    picture.values.push_back(static_cast<std::uint16_t>(*value));
  }
  if (words.skip()) return bad_byte(words.at(), "is followed by something");
  return picture;
}

}  // namespace

Result<Picture> read_pgm(Bytes file) {
  const bool magic = file.size() >= 3 && file[0] == 'P' && (file[1] == '2' || file[1] == '5') &&
                     (is_blank(file[2]) || file[2] == '#');
  if (!magic) return bad_byte(0, "does not begin with P5 or P2");
  WordReader words(file);
  auto picture = read_head(words);
  if (!picture) return picture;
  return file[1] == '5' ? read_binary(file, words, std::move(*picture))
                        : read_text(file, words, std::move(*picture));
}

std::vector<std::uint8_t> write_pgm(const Picture& picture) {
  const std::string head = "P5\n" + std::to_string(picture.columns) + " " +
                           std::to_string(picture.rows) + "\n" + std::to_string(picture.greatest) +
                           "\n";
  std::vector<std::uint8_t> file(head.begin(), head.end());
  const bool wide = picture.greatest > 255;
  file.reserve(file.size() + picture.values.size() * (wide ? 2 : 1));
  for (const std::uint16_t value : picture.values) {
    if (wide) file.push_back(static_cast<std::uint8_t>(value >> 8U));
    file.push_back(static_cast<std::uint8_t>(value & 0xFFU));
  }
  return file;
}

}  // namespace roverd::atlas
