#include "link/slcan.hpp"

#include <array>
#include <charconv>
#include <cstdio>
#include <utility>

#include "link/can_wire.hpp"

namespace roverd::link {
namespace {

constexpr std::array<unsigned, 9> kBitrates{10'000,  20'000,  50'000,  100'000,  125'000,
                                            250'000, 500'000, 800'000, 1'000'000};
constexpr char kBell = '\a';

tl::unexpected<base::Error> bad_line(std::string_view problem) {
  return base::fail(base::Code::Malformed, std::string(problem));
}

std::optional<std::uint32_t> number(std::string_view digits, int radix) noexcept {
  std::uint32_t value = 0;
  const auto [end, ec] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value, radix);
  if (digits.empty() || ec != std::errc() || end != digits.data() + digits.size()) return {};
  return value;
}

/// After t, T, r or R.
base::Result<SlcanLine> read_frame(char kind, std::string_view rest) {
  SlcanLine out{.kind = SlcanLine::Kind::Frame};
  base::CanFrame& frame = out.frame;
  frame.extended = kind == 'T' || kind == 'R';
  frame.remote = kind == 'r' || kind == 'R';
  const std::size_t id_digits = frame.extended ? 8 : 3;
  if (rest.size() < id_digits) return bad_line("the id is too short");
  const auto id = number(rest.substr(0, id_digits), 16);
  if (!id) return bad_line("the id is not hex digits");
  if (*id > (frame.extended ? kExtendedIdMask : kStandardIdMask)) {
    return bad_line("the id is too large");
  }
  frame.id = *id;
  rest.remove_prefix(id_digits);
  if (rest.empty() && frame.remote) return out;
  if (rest.empty() || rest.front() < '0' || rest.front() > '8') {
    return bad_line("the length is not 0 to 8");
  }
  frame.len = static_cast<std::uint8_t>(rest.front() - '0');
  rest.remove_prefix(1);
  const std::size_t data_digits = frame.remote ? 0 : 2U * frame.len;
  if (rest.size() != data_digits) {
    return bad_line("the number of digits is not what the length says");
  }
  for (std::size_t i = 0; i < data_digits / 2; ++i) {
    const auto byte = number(rest.substr(2 * i, 2), 16);
    if (!byte) return bad_line("the data is not hex digits");
    frame.data[i] = static_cast<std::uint8_t>(*byte);
  }
  return out;
}

/// After s: "a000000", a letter and two counters of three decimal digits, received first.
base::Result<SlcanLine> read_state(std::string_view rest) {
  constexpr std::string_view kLetters = "awpb";
  const auto letter = rest.empty() ? std::string_view::npos : kLetters.find(rest.front());
  if (letter == std::string_view::npos || rest.size() != 7) return bad_line("not a state");
  const auto rx = number(rest.substr(1, 3), 10);
  const auto tx = number(rest.substr(4, 3), 10);
  if (!rx || !tx) return bad_line("the error counters are not digits");
  SlcanLine out{.kind = SlcanLine::Kind::State};
  out.controller = static_cast<CanController>(letter);
  out.rx_errors = static_cast<std::uint16_t>(*rx);
  out.tx_errors = static_cast<std::uint16_t>(*tx);
  return out;
}

base::Result<SlcanLine> read_flags(std::string_view rest) {
  const auto flags = number(rest, 16);
  if (!flags || rest.size() != 2) return bad_line("the status is not two hex digits");
  SlcanLine out{.kind = SlcanLine::Kind::Flags};
  out.flags = static_cast<std::uint8_t>(*flags);
  return out;
}

/// After e: how many, then as many letters.
base::Result<SlcanLine> read_errors(std::string_view rest) {
  const bool counted = !rest.empty() && rest.front() >= '0' && rest.front() <= '9';
  if (!counted || rest.size() - 1 != static_cast<std::size_t>(rest.front() - '0') ||
      rest.substr(1).find_first_not_of("abBcfosO") != std::string_view::npos) {
    return bad_line("not a list of bus errors");
  }
  SlcanLine out{.kind = SlcanLine::Kind::Errors};
  out.text = rest.substr(1);
  return out;
}

}  // namespace

std::optional<char> slcan_speed(unsigned bitrate) noexcept {
  for (std::size_t i = 0; i < kBitrates.size(); ++i) {
    if (kBitrates[i] == bitrate) return static_cast<char>('0' + i);
  }
  return {};
}

std::string to_slcan_line(const base::CanFrame& frame) {
  std::array<char, 16> text{};
  const char kind = frame.remote ? (frame.extended ? 'R' : 'r') : (frame.extended ? 'T' : 't');
  std::snprintf(text.data(), text.size(), frame.extended ? "%c%08X%d" : "%c%03X%d", kind, frame.id,
                frame.len);
  std::string out = text.data();
  if (!frame.remote) {
    for (const std::uint8_t byte : frame.bytes()) {
      std::snprintf(text.data(), text.size(), "%02X", byte);
      out += text.data();
    }
  }
  return out + '\r';
}

base::Result<SlcanLine> parse_slcan_line(std::string_view line) {
  if (line.empty() || line == "z" || line == "Z") return SlcanLine{};
  const auto rest = line.substr(1);
  switch (line.front()) {
    case 't':
    case 'T':
    case 'r':
    case 'R':
      return read_frame(line.front(), rest);
    case 's':
      return read_state(rest);
    case 'e':
      return read_errors(rest);
    case 'F':
      return read_flags(rest);
    case 'V':
    case 'v':
    case 'N': {
      SlcanLine out{.kind = SlcanLine::Kind::Other};
      out.text = line;
      return out;
    }
    default:
      return bad_line("begins with a letter that no adapter says");
  }
}

std::string slcan_flag_words(std::uint8_t flags) {
  constexpr std::array<std::string_view, 8> kWords{
      "receive queue full", "transmit queue full", "error warning", "data overrun", "bit 4",
      "error passive",      "arbitration lost",    "bus error"};
  std::string out;
  for (std::size_t i = 0; i < kWords.size(); ++i) {
    if ((flags >> i & 1) != 0) out += (out.empty() ? "" : ", ") + std::string(kWords[i]);
  }
  return out;
}

void SlcanFramer::feed(base::Bytes bytes, std::vector<Piece>& out) {
  for (const std::uint8_t byte : bytes) {
    const char c = static_cast<char>(byte);
    if (c == '\n') continue;
    if (c == '\r' || c == kBell) {
      out.push_back({c == kBell, too_long_, std::exchange(line_, {})});
      too_long_ = false;
    } else if (line_.size() == kLongestLine) {
      too_long_ = true;
    } else {
      line_ += c;
    }
  }
}

void SlcanFramer::reset() noexcept {
  line_.clear();
  too_long_ = false;
}

}  // namespace roverd::link
