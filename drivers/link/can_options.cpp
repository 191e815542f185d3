#include "link/can_options.hpp"

#include <array>
#include <charconv>
#include <cstdio>

#include "link/can_wire.hpp"

namespace roverd::link {
namespace {

constexpr std::size_t kMostIds = 64;
constexpr unsigned kSlowest = 10'000;
constexpr unsigned kFastest = 1'000'000;
constexpr unsigned kLongestRestart_ms = 60'000;

tl::unexpected<base::Error> bad_option(std::string problem) {
  return base::fail(base::Code::Invalid, std::move(problem));
}

std::optional<std::uint32_t> number(std::string_view text, int radix) noexcept {
  std::uint32_t value = 0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value, radix);
  if (text.empty() || ec != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

/// Takes the text before `mark` off the front of `rest`.
std::string_view take_until(std::string_view& rest, char mark) noexcept {
  const auto end = rest.find(mark);
  const auto part = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  return part;
}

base::Result<void> read_ids(std::string_view text, std::vector<CanId>& out) {
  while (!text.empty()) {
    const auto word = take_until(text, '+');
    const auto id = number(word, 16);
    const bool extended = word.size() == 8;
    if (!id || (word.size() != 3 && !extended) ||
        *id > (extended ? kExtendedIdMask : kStandardIdMask)) {
      return bad_option("only: '" + std::string(word) +
                        "' is no CAN id of 3 or 8 hex digits (ids are joined by +)");
    }
    out.push_back({*id, extended});
  }
  if (out.empty() || out.size() > kMostIds) return bad_option("only: must name 1 to 64 ids");
  return {};
}

base::Result<void> read_option(std::string_view key, std::string_view value, CanOptions& out) {
  const auto n = number(value, 10);
  if (key == "only") return read_ids(value, out.only);
  if (key == "up") {
    if (value != "0" && value != "1") return bad_option("up must be 0 or 1");
    out.up = value == "1";
  } else if (key == "bitrate") {
    if (!n || *n < kSlowest || *n > kFastest) {
      return bad_option("bitrate must be 10000..1000000 bit/s");
    }
    out.bitrate = *n;
  } else if (key == "restart_ms") {
    if (!n || *n > kLongestRestart_ms) return bad_option("restart_ms must be 0..60000");
    out.restart_ms = *n;
  } else {
    return bad_option("unknown option '" + std::string(key) + "' (bitrate, up, restart_ms, only)");
  }
  return {};
}

}  // namespace

base::Result<CanOptions> parse_can_options(std::string_view text) {
  CanOptions out;
  while (!text.empty()) {
    std::string_view value = take_until(text, '&');
    const auto key = take_until(value, '=');
    if (auto read = read_option(key, value, out); !read) return tl::unexpected(read.error());
  }
  return out;
}

std::string to_string(const CanOptions& options) {
  std::string out;
  const auto add = [&out](const std::string& key, const std::string& value) {
    out += (out.empty() ? "?" : "&") + key + "=" + value;
  };
  if (options.bitrate) add("bitrate", std::to_string(*options.bitrate));
  if (options.up) add("up", "1");
  if (options.restart_ms) add("restart_ms", std::to_string(*options.restart_ms));
  std::string ids;
  for (const CanId& id : options.only) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), id.extended ? "%08X" : "%03X", id.id);
    ids += (ids.empty() ? "" : "+") + std::string(text.data());
  }
  if (!ids.empty()) add("only", ids);
  return out;
}

}  // namespace roverd::link
