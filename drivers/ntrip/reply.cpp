#include "ntrip/reply.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace roverd::ntrip {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

std::optional<double> number_of(std::string_view text) {
  double value = 0.0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = ec == std::errc() && end == text.data() + text.size() && !text.empty();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Printable and short.
std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 80;
  std::string out;
  for (const char c : text.substr(0, kLongest)) out += c >= ' ' && c < 0x7F ? c : '?';
  return "\"" + out + "\"";
}

}  // namespace

Source parse_source(std::string_view line) {
  std::array<std::string_view, 16> field{};
  for (std::string_view& f : field) {
    const auto end = line.find(';');
    f = line.substr(0, end);
    if (end == std::string_view::npos) break;
    line.remove_prefix(end + 1);
  }
  if (field[0] != "STR") return {};
  Source out{std::string(field[1]), std::string(field[3]), std::string(field[6]), field[11] == "1"};
  out.place = field[2];
  out.country = field[8];
  const auto lat = number_of(field[9]);
  const auto lon = number_of(field[10]);
  const bool placed = lat && lon && std::abs(*lat) <= 90.0 && std::abs(*lon) <= 360.0;
  if (placed && (*lat != 0.0 || *lon != 0.0)) {
    out.lat = lat;
    out.lon = *lon > 180.0 ? *lon - 360.0 : *lon;  // some count eastward only
  }
  if (field[15] == "B" || field[15] == "D") out.login = field[15][0];
  return out;
}

Reply::Step Reply::take(Bytes rest) {
  if (state_ == State::Refused || state_ == State::Ended) return {rest.size(), 0};
  if (state_ == State::Stream) {
    if (chunk_ == Chunk::None) return {0, rest.size()};
    if (chunk_ == Chunk::Body && left_ > 0) {
      const std::size_t n = std::min(left_, rest.size());
      left_ -= n;
      return {0, n};
    }
  }
  // A version 1 stream may begin where another header could stand.
  const bool text = (rest[0] >= ' ' && rest[0] < 0x7F) || rest[0] == '\r' || rest[0] == '\n';
  if (state_ == State::Head && icy_ && !text) {
    line_.clear();
    state_ = State::Stream;
    return {0, 0};
  }
  if (state_ == State::Head && ++head_bytes_ > kMaxHead) {
    refuse("the caster's answer does not end");
    return {rest.size(), 0};
  }
  const char c = static_cast<char>(rest[0]);
  if (c != '\n') {
    if (line_.size() < kMaxLine) line_ += c;
    return {1, 0};
  }
  if (!line_.empty() && line_.back() == '\r') line_.pop_back();
  on_line(std::exchange(line_, {}));
  return {1, 0};
}

void Reply::on_line(const std::string& line) {
  switch (state_) {
    case State::Head:
      if (!status_seen_) return on_status(line);
      return line.empty() ? head_ends() : on_header(line);
    case State::Table:
      if (line.starts_with("ENDSOURCETABLE")) {
        state_ = State::Ended;
      } else if (Source source = parse_source(line);
                 !source.mountpoint.empty() && sources_.size() < kMaxSources) {
        sources_.push_back(std::move(source));
      }
      return;
    case State::Stream:
      if (chunk_ == Chunk::Body) {  // the line end behind a chunk
        chunk_ = Chunk::Size;
        return;
      }
      return on_chunk_size(line);
    case State::Refused:
    case State::Ended:
      return;
  }
}

void Reply::on_status(const std::string& line) {
  status_seen_ = true;
  version_ = line.starts_with("HTTP/1.1") ? 2 : 1;
  if (line.starts_with("ICY 200")) {
    icy_ = true;
  } else if (line.starts_with("SOURCETABLE 200")) {
    table_ = true;
  } else if (line.find("401") != std::string::npos ||
             lower(line).find("bad pas") != std::string::npos) {
    unauthorized_ = true;
    refusal_ = "the caster does not accept the login";
    if (!line.starts_with("HTTP/1.")) refuse(refusal_);
  } else if (line.starts_with("HTTP/1.") && line.find(" 404") != std::string::npos) {
    refuse("the caster has no such mountpoint");
  } else if (!line.starts_with("HTTP/1.") || line.find(" 200") == std::string::npos) {
    refuse("the caster answers " + quoted(line));
  }
}

void Reply::on_header(const std::string& line) {
  const std::string header = lower(line);
  constexpr std::string_view kChallenge = "www-authenticate:";
  if (unauthorized_ && header.starts_with(kChallenge)) {
    // Several may be offered; one whose algorithm is known here is better than one that is not.
    const auto asked = parse_challenge(std::string_view(line).substr(kChallenge.size()));
    if (asked && (!challenge_ || !digest_answer(*challenge_, ":", "/", "x"))) challenge_ = asked;
  }
  if (header.starts_with("transfer-encoding:") && header.find("chunked") != std::string::npos) {
    chunked_ = true;
  }
  if (header.starts_with("content-type:") && (header.find("sourcetable") != std::string::npos ||
                                              header.find("text/plain") != std::string::npos)) {
    table_ = true;
  }
}

void Reply::head_ends() {
  if (unauthorized_) return refuse(refusal_);
  state_ = table_ ? State::Table : State::Stream;
  if (state_ == State::Stream && chunked_) chunk_ = Chunk::Size;
}

void Reply::on_chunk_size(const std::string& line) {
  std::size_t size = 0;
  const auto [end, ec] = std::from_chars(line.data(), line.data() + line.size(), size, 16);
  const bool whole = end == line.data() + line.size() || *end == ';' || *end == ' ';
  constexpr std::size_t kLargest = 1 << 20;
  if (ec != std::errc() || !whole || size > kLargest) {
    return refuse("the caster's chunks are damaged");
  }
  left_ = size;
  chunk_ = Chunk::Body;
  if (size == 0) state_ = State::Ended;
}

void Reply::refuse(const std::string& why) {
  state_ = State::Refused;
  refusal_ = why;
}

}  // namespace roverd::ntrip
