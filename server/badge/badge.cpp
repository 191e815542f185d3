#include "badge/badge.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <utility>

namespace roverd::badge {
namespace {

constexpr std::string_view kDrawn = "/robot.svg";
constexpr std::size_t kLongestLabel = 50;  // DNS takes 63, and a number may follow
/// The plain letters of U+00C0 to U+00FF.
constexpr std::string_view kPlain =
    "aaaaaaaceeeeiiiidnooooo-ouuuuytsaaaaaaaceeeeiiiidnooooo-ouuuuyty";

bool is_alnum(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0;
}

bool continues(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

/// The bytes of the character that begins there; 0: it is no UTF-8.
std::size_t length_at(std::string_view text, std::size_t at) {
  const auto first = static_cast<unsigned char>(text[at]);
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xC2 && first < 0xE0 ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  if (length == 0 || at + length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (!continues(text[at + i])) return 0;
  }
  return length;
}

/// One letter of a DNS name; '-' for what has none.
char plain_letter(std::string_view character) {
  if (character.size() == 1) {
    const char c = character[0];
    return is_alnum(c) ? static_cast<char>(std::tolower(static_cast<unsigned char>(c))) : '-';
  }
  if (character.size() != 2) return '-';
  const unsigned code =
      (static_cast<unsigned>(static_cast<unsigned char>(character[0]) & 0x1FU) << 6U) |
      (static_cast<unsigned char>(character[1]) & 0x3FU);
  if (code >= 0xC0 && code <= 0xFF) return kPlain[code - 0xC0];
  if (code == 0x160 || code == 0x161) return 's';
  if (code == 0x17D || code == 0x17E) return 'z';
  return '-';
}

/// FNV-1a: the same in every build.
std::uint32_t hash_of(std::string_view text) {
  std::uint32_t hash = 2166136261U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  return hash;
}

std::string escaped_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

/// In JSON; a name has no control characters.
std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

}  // namespace

base::Result<void> check_name(std::string_view name) {
  if (name.size() > kLongestName) {
    return base::fail(base::Code::Invalid,
                      "must not be longer than " + std::to_string(kLongestName) + " bytes");
  }
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t length = length_at(name, at);
    const auto first = static_cast<unsigned char>(name[at]);
    if (length == 0 || first < 0x20 || first == 0x7F) {
      return base::fail(base::Code::Invalid, "must be one line of UTF-8 text");
    }
    at += length;
  }
  if (name.starts_with(' ') || name.ends_with(' ')) {
    return base::fail(base::Code::Invalid, "must not begin or end with a blank");
  }
  return {};
}

base::Result<Colour> colour_of(std::string_view said, std::string_view name) {
  if (said.empty()) return kColours[hash_of(name) % kColours.size()];
  const auto found = std::find_if(kColours.begin(), kColours.end(),
                                  [&](const Colour& one) { return one.name == said; });
  if (found != kColours.end()) return *found;
  std::string known;
  for (const Colour& one : kColours) known += (known.empty() ? "" : ", ") + std::string(one.name);
  return base::fail(base::Code::Invalid,
                    "must be one of " + known + ", is \"" + std::string(said) + "\"");
}

std::string label_of(std::string_view name) {
  std::string label;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t length = std::max<std::size_t>(1, length_at(name, at));
    const char letter = plain_letter(name.substr(at, length));
    if (letter != '-' || (!label.empty() && label.back() != '-')) label += letter;
    at += length;
  }
  label.resize(std::min(label.size(), kLongestLabel));
  while (label.ends_with('-')) label.pop_back();
  return label.empty() ? "robot" : label;
}

std::string initials_of(std::string_view name) {
  std::string first;
  std::string second;     // the next one
  std::string next_word;  // the first of the next word
  bool fresh = true;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t length = std::max<std::size_t>(1, length_at(name, at));
    std::string letter(name.substr(at, length));
    at += length;
    if (length == 1 && !is_alnum(letter[0])) {
      fresh = true;
      continue;
    }
    if (length == 1)
      letter[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(letter[0])));
    if (first.empty()) {
      first = letter;
    } else {
      if (second.empty() && !fresh) second = letter;
      if (next_word.empty() && fresh) next_word = letter;
    }
    fresh = false;
  }
  return first.empty() ? "R" : first + (next_word.empty() ? second : next_word);
}

base::Result<Picture> picture_of(std::string bytes) {
  const std::string_view head(bytes);
  if (head.starts_with("\x89PNG\r\n\x1a\n"))
    return Picture{std::move(bytes), "image/png", "/robot.png"};
  if (head.starts_with("\xFF\xD8\xFF"))
    return Picture{std::move(bytes), "image/jpeg", "/robot.jpg"};
  if (head.starts_with("RIFF") && head.substr(0, 12).ends_with("WEBP")) {
    return Picture{std::move(bytes), "image/webp", "/robot.webp"};
  }
  return base::fail(base::Code::Invalid, "must be a PNG, JPEG or WebP picture");
}

std::string svg_of(const Badge& badge) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 64 64\"><rect width=\"64\" "
         "height=\"64\" rx=\"14\" fill=\"" +
         std::string(badge.colour.rgb) +
         "\"/><text x=\"32\" y=\"43\" fill=\"#fff\" font-family=\"system-ui,sans-serif\" "
         "font-size=\"30\" font-weight=\"700\" text-anchor=\"middle\">" +
         escaped_text(initials_of(badge.name)) + "</text></svg>\n";
}

std::string_view picture_path(const Badge& badge) noexcept {
  return badge.picture ? badge.picture->path : kDrawn;
}

std::string manifest_of(const Badge& badge) {
  const std::string_view type = badge.picture ? badge.picture->content_type : "image/svg+xml";
  return "{\"name\":" + quoted(badge.name) + ",\"short_name\":" + quoted(badge.name) +
         ",\"start_url\":\"/\",\"display\":\"standalone\",\"background_color\":\"#f3f1ea\","
         "\"theme_color\":" +
         quoted(badge.colour.rgb) + ",\"icons\":[{\"src\":" + quoted(picture_path(badge)) +
         ",\"sizes\":\"any\",\"type\":" + quoted(type) + "}]}\n";
}

std::optional<File> file_at(std::string_view path, const Badge& badge) {
  if (path == "/roverd.webmanifest") return File{"application/manifest+json", manifest_of(badge)};
  if (path == kDrawn) return File{"image/svg+xml", svg_of(badge)};
  if (badge.picture && path == badge.picture->path) {
    return File{badge.picture->content_type, badge.picture->bytes};
  }
  return std::nullopt;
}

}  // namespace roverd::badge
