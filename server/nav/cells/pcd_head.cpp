#include "nav/cells/pcd_head.hpp"

#include <algorithm>
#include <charconv>

#include "nav/cells/pcd.hpp"

namespace roverd::nav::cells::pcd {

namespace {

constexpr std::size_t kMostFields = 64;
constexpr std::size_t kMostHeader_bytes = 65'536;
constexpr std::size_t kMostCount = 4096;  // values of one field, as of a descriptor
constexpr std::size_t kMostRow_bytes = 65'536;

template <class Number>
bool number_of(std::string_view word, Number& out) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), out);
  return error == std::errc{} && end == word.data() + word.size();
}

}  // namespace

tl::unexpected<base::Error> wrong_line(std::size_t line, const std::string& what) {
  return base::fail(base::Code::Malformed, "PCD line " + std::to_string(line) + ": " + what,
                    {{"line " + std::to_string(line), what}});
}

std::string_view next_word(std::string_view& rest) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t from = std::min(rest.find_first_not_of(kBlank), rest.size());
  rest.remove_prefix(from);
  const std::size_t to = std::min(rest.find_first_of(kBlank), rest.size());
  const std::string_view word = rest.substr(0, to);
  rest.remove_prefix(to);
  return word;
}

bool read_number(std::string_view word, double& out) {
  return number_of(word, out);
}

namespace {

std::vector<std::string_view> words_of(std::string_view rest) {
  std::vector<std::string_view> out;
  for (auto word = next_word(rest); !word.empty() && out.size() <= kMostFields;
       word = next_word(rest)) {
    out.push_back(word);
  }
  return out;
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
               !number_of(words[i], value) || value == 0 || value > kMostCount) {
      return std::string(key) + " of " + f.name + " must be 1 to 4096";
    }
  }
  if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS") {
    std::uint32_t value = 0;
    if (words.size() != 1 || !number_of(words[0], value)) {
      return std::string(key) + " must be one number";
    }
    if (key == "POINTS") h.points = value;
    if (key == "WIDTH") h.width = value;
    if (key == "HEIGHT") h.height = value;
  } else if (key == "VIEWPOINT") {
    if (words.size() != 7) return "VIEWPOINT must be seven numbers";
    for (std::size_t i = 0; i < 7; ++i) {
      if (!number_of(words[i], h.viewpoint[i])) return "VIEWPOINT must be seven numbers";
    }
  } else if (key == "DATA") {
    if (words.size() != 1) return "DATA must be one word";
    h.data = words[0];
  } else if (!of_fields && key != "VERSION") {
    return "not a line of a PCD header";
  }
  return {};
}

}  // namespace

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

}  // namespace roverd::nav::cells::pcd
