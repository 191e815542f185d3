#include "api/form_data.hpp"

#include <algorithm>
#include <utility>

namespace roverd::api {

namespace {

using base::Code;
using base::Error;
using base::Result;

constexpr std::string_view kLineEnd = "\r\n";
constexpr std::size_t kMostHeader = 8 * 1024;

char small(char c) noexcept {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool same_word(std::string_view a, std::string_view b) noexcept {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return small(x) == small(y); });
}

std::string_view bare(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// A header's value: "form-data", then its parameters.
class Parameters {
 public:
  explicit Parameters(std::string_view value) {
    word_ = bare(value.substr(0, value.find(';')));
    rest_ = value.substr(std::min(value.find(';'), value.size()));
  }
  std::string_view word() const noexcept { return word_; }

  /// Empty: it is not there. A name that comes twice counts once.
  std::optional<std::string> find(std::string_view name) const {
    std::string_view rest = rest_;
    while (!rest.empty()) {
      rest.remove_prefix(1);  // ';'
      const std::size_t end = std::min(rest.find_first_of("=;"), rest.size());
      const std::string_view found = bare(rest.substr(0, end));
      rest.remove_prefix(end);
      std::string value;
      if (rest.starts_with('=')) value = take_value(rest);
      if (same_word(found, name)) return value;
      rest.remove_prefix(std::min(rest.find(';'), rest.size()));
    }
    return std::nullopt;
  }

 private:
  /// Behind '='. In quotes only \" and \\ are escapes: some send paths with plain backslashes.
  static std::string take_value(std::string_view& rest) {
    rest.remove_prefix(1);
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    if (!rest.starts_with('"')) {
      const std::string_view token = rest.substr(0, rest.find(';'));
      rest.remove_prefix(token.size());
      return std::string(bare(token));
    }
    rest.remove_prefix(1);
    std::string value;
    while (!rest.empty() && rest.front() != '"') {
      const bool escape = rest.starts_with("\\\"") || rest.starts_with("\\\\");
      value += rest[escape ? 1 : 0];
      rest.remove_prefix(escape ? 2 : 1);
    }
    rest.remove_prefix(rest.empty() ? 0 : 1);
    return value;
  }

  std::string_view word_;
  std::string_view rest_;
};

/// Browsers write a quote and line ends inside a name so (WHATWG HTML, "multipart/form-data").
std::string without_percents(std::string name) {
  constexpr std::pair<std::string_view, char> kEscapes[] = {
      {"%22", '"'}, {"%0D", ' '}, {"%0A", ' '}};
  for (const auto& [from, to] : kEscapes) {
    for (std::size_t at = name.find(from); at != std::string::npos; at = name.find(from, at + 1)) {
      name.replace(at, from.size(), 1, to);
    }
  }
  return name;
}

bool is_boundary(std::string_view text) noexcept {
  constexpr std::size_t kMost = 70;
  constexpr std::string_view kMarks = "'()+_,-./:=? ";
  return !text.empty() && text.size() <= kMost && text.back() != ' ' &&
         std::all_of(text.begin(), text.end(), [&](char c) {
           return (small(c) >= 'a' && small(c) <= 'z') || (c >= '0' && c <= '9') ||
                  kMarks.find(c) != std::string_view::npos;
         });
}

class FormReader {
 public:
  FormReader(std::string_view body, std::string_view boundary)
      : rest_(body), line_("--" + std::string(boundary)), delimiter_("\r\n" + line_) {}

  Result<std::vector<FormPart>> read() {
    // The first line needs no line end before it, where there is no preamble.
    if (!at_delimiter(rest_, line_)) {
      const std::size_t at = next_delimiter();
      if (at == std::string_view::npos) return bad("the form has no line with its boundary");
      rest_.remove_prefix(at + kLineEnd.size());
    }
    rest_.remove_prefix(line_.size());
    while (!rest_.starts_with("--")) {
      rest_.remove_prefix(rest_.find(kLineEnd) + kLineEnd.size());
      if (parts_.size() == kMostFormParts) {
        return base::fail(Code::TooLarge,
                          "the form has more than " + std::to_string(kMostFormParts) + " parts");
      }
      if (auto taken = part(); !taken) return tl::unexpected<Error>(taken.error());
    }
    return std::move(parts_);
  }

 private:
  /// Is there a whole line of the boundary, or the last one, with "--"? Blanks may follow it.
  static bool at_delimiter(std::string_view text, std::string_view delimiter) {
    if (!text.starts_with(delimiter)) return false;
    text.remove_prefix(delimiter.size());
    if (text.starts_with("--")) return true;
    const std::size_t end = text.find_first_not_of(" \t");
    return end != std::string_view::npos && text.substr(end).starts_with(kLineEnd);
  }

  std::size_t next_delimiter() const {
    std::size_t at = rest_.find(delimiter_);
    while (at != std::string_view::npos && !at_delimiter(rest_.substr(at), delimiter_)) {
      at = rest_.find(delimiter_, at + 1);
    }
    return at;
  }

  tl::unexpected<Error> bad(const std::string& what) const {
    const std::string where = "part " + std::to_string(parts_.size() + 1);
    return base::fail(Code::Malformed, what, {{where, what}});
  }
  tl::unexpected<Error> bad_part(const std::string& what) const {
    return bad("part " + std::to_string(parts_.size() + 1) + " of the form " + what);
  }

  Result<void> part() {
    FormPart out;
    bool disposed = false;
    for (std::size_t header_bytes = 0;;) {
      const std::size_t end = rest_.find(kLineEnd);
      header_bytes += std::min(end, rest_.size());
      if (end == std::string_view::npos || header_bytes > kMostHeader) {
        return bad_part("has no end of its headers");
      }
      const std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(end + kLineEnd.size());
      if (line.empty()) break;
      if (auto ok = header(line, out, disposed); !ok) return ok;
    }
    if (!disposed) return bad_part("has no Content-Disposition: form-data with a name");
    // An empty content ends with the line end that ended the headers.
    rest_ = {rest_.data() - kLineEnd.size(), rest_.size() + kLineEnd.size()};
    const std::size_t end = next_delimiter();
    if (end == std::string_view::npos) return bad_part("breaks off");
    if (end > 0) out.content = rest_.substr(kLineEnd.size(), end - kLineEnd.size());
    rest_.remove_prefix(end + delimiter_.size());
    parts_.push_back(std::move(out));
    return {};
  }

  Result<void> header(std::string_view line, FormPart& out, bool& disposed) const {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) return bad_part("has a line that is no header");
    const std::string_view name = bare(line.substr(0, colon));
    const Parameters value(line.substr(colon + 1));
    if (same_word(name, "content-transfer-encoding")) {
      const bool plain = same_word(value.word(), "7bit") || same_word(value.word(), "8bit") ||
                         same_word(value.word(), "binary");
      if (plain) return {};
      return base::fail(Code::Unsupported, "a part of the form is encoded: send it as it is");
    }
    if (!same_word(name, "content-disposition")) return {};
    const auto given = value.find("name");
    if (disposed || !same_word(value.word(), "form-data") || !given) {
      return bad_part("must have one Content-Disposition: form-data with a name");
    }
    disposed = true;
    out.name = without_percents(*given);
    out.file_name = value.find("filename");
    if (out.file_name) out.file_name = without_percents(std::move(*out.file_name));
    return {};
  }

  std::string_view rest_;
  const std::string line_;       ///< "--boundary"
  const std::string delimiter_;  ///< with the line end before it
  std::vector<FormPart> parts_;
};

}  // namespace

Result<std::optional<std::string>> form_boundary(std::string_view content_type) {
  const Parameters type(content_type);
  if (!same_word(type.word(), "multipart/form-data")) return std::optional<std::string>{};
  const auto boundary = type.find("boundary");
  if (boundary && is_boundary(*boundary)) return boundary;
  return base::fail(Code::Malformed,
                    "Content-Type: multipart/form-data needs a boundary of 1 to 70 characters",
                    {{"Content-Type", "must tell the boundary"}});
}

Result<std::vector<FormPart>> form_parts(std::string_view body, std::string_view boundary) {
  return FormReader(body, boundary).read();
}

}  // namespace roverd::api
