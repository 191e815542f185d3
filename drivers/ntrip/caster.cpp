#include "ntrip/caster.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

namespace roverd::ntrip {
namespace {

/// Printable and no blank: what may stand in a request line.
bool is_plain(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c > ' ' && c < 0x7F; });
}

std::optional<std::uint16_t> port_of(std::string_view text) {
  unsigned port = 0;
  const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (ec != std::errc() || end != text.data() + text.size() || port < 1 || port > 65'535) return {};
  return static_cast<std::uint16_t>(port);
}

/// "%40" to '@'. Empty: not well-formed.
std::optional<std::string> unescaped(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    unsigned byte = 0;
    if (i + 2 >= text.size()) return {};
    const auto [end, ec] = std::from_chars(text.data() + i + 1, text.data() + i + 3, byte, 16);
    if (ec != std::errc() || end != text.data() + i + 3) return {};
    out += static_cast<char>(byte);
    i += 2;
  }
  return out;
}

/// @return what is wrong; empty: `out` is set.
std::string parse_one(std::string_view text, Caster& out) {
  constexpr std::string_view kPlain = "ntrip://";
  constexpr std::string_view kTls = "ntrips://";
  out.tls = text.starts_with(kTls);
  if (!out.tls && !text.starts_with(kPlain)) return "must begin with ntrip:// or ntrips://";
  if (!is_plain(text)) return "must be printable ASCII; %20 is a blank";
  text.remove_prefix(out.tls ? kTls.size() : kPlain.size());
  const auto slash = text.rfind('/');  // a password may hold one, a mountpoint may not
  const auto at_sign = text.rfind('@');
  if (slash != std::string_view::npos && (at_sign == std::string_view::npos || slash > at_sign)) {
    out.mountpoint = text.substr(slash + 1);
    text = text.substr(0, slash);
  }
  if (at_sign != std::string_view::npos) {
    const auto login = unescaped(text.substr(0, at_sign));
    if (!login || login->find(':') == std::string::npos) return "wants USER:PASSWORD before the @";
    out.login = *login;
    text.remove_prefix(at_sign + 1);
  }
  out.port = out.tls ? 443 : 2101;
  const auto colon = text.rfind(':');
  const auto bracket = text.rfind(']');
  if (colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket)) {
    const auto port = port_of(text.substr(colon + 1));
    if (!port) return "wants a port of 1..65535 after the host";
    out.port = *port;
    text = text.substr(0, colon);
  }
  if (text.empty() || text.find('/') != std::string_view::npos) return "wants a host";
  out.host = text;
  return {};
}

char quality(base::FixType fix) noexcept {
  switch (fix) {
    case base::FixType::RtkFixed:
      return '4';
    case base::FixType::RtkFloat:
      return '5';
    case base::FixType::Differential:
      return '2';
    case base::FixType::Single:
    case base::FixType::None:
    case base::FixType::Unknown:
    case base::FixType::Estimated:
      break;
  }
  return '1';
}

/// ddmm.mmmmm in steps of 1e-5 minutes, so that no minute becomes 60.
std::string arc(double deg, int width) {
  const long long steps = std::llround(std::abs(deg) * 60e5);
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%0*lld%08.5f", width, steps / 6'000'000,
                static_cast<double>(steps % 6'000'000) / 1e5);
  return text.data();
}

}  // namespace

std::string Caster::name() const {
  return (tls ? "ntrips://" : "ntrip://") + host + ":" + std::to_string(port) + "/" + mountpoint;
}

std::string Caster::address() const {
  return (tls ? "tls:" : "tcp:") + host + ":" + std::to_string(port);
}

base::Result<std::vector<Caster>> parse_casters(std::string_view text) {
  std::vector<Caster> out;
  while (true) {
    const auto begin = text.find_first_not_of(' ');
    if (begin == std::string_view::npos) break;
    text.remove_prefix(begin);
    const auto word = text.substr(0, text.find(' '));
    Caster caster;
    if (const auto problem = parse_one(word, caster); !problem.empty()) {
      return base::fail(base::Code::Invalid, "caster number " + std::to_string(out.size() + 1) +
                                                 " " + problem +
                                                 ": ntrip://USER:PASSWORD@HOST:PORT/MOUNTPOINT");
    }
    out.push_back(std::move(caster));
    text.remove_prefix(word.size());
  }
  if (out.empty()) {
    return base::fail(base::Code::Invalid,
                      "names no caster: ntrip://USER:PASSWORD@HOST:PORT/MOUNTPOINT");
  }
  return out;
}

std::string base64(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < text.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool there = i + k < text.size();
      group = group << 8U | (there ? static_cast<std::uint8_t>(text[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool there = i + k <= text.size();
      out += there ? kDigits[group >> (18U - 6U * k) & 63U] : '=';
    }
  }
  return out;
}

std::string request(const Caster& caster, int version, const std::string& authorization) {
  const bool second = version == 2;
  std::string out = "GET /" + caster.mountpoint + (second ? " HTTP/1.1\r\n" : " HTTP/1.0\r\n");
  if (second) {
    out += "Host: " + caster.host + ":" + std::to_string(caster.port) + "\r\n";
    out += "Ntrip-Version: Ntrip/2.0\r\n";
  }
  out += "User-Agent: NTRIP roverd/1\r\n";
  if (!authorization.empty()) {
    out += "Authorization: " + authorization + "\r\n";
  } else if (!caster.login.empty()) {
    out += "Authorization: Basic " + base64(caster.login) + "\r\n";
  }
  return out + "Accept: */*\r\nConnection: close\r\n\r\n";
}

std::string gga_of(const base::GnssFix& fix) {
  if (!fix.position || fix.fix == base::FixType::None) return {};
  using std::chrono::floor;
  std::array<char, 160> text{};
  long long of_day_cs = 0;
  if (fix.utc) {
    const auto since = *fix.utc - floor<std::chrono::days>(*fix.utc);
    of_day_cs = std::chrono::duration_cast<std::chrono::milliseconds>(since).count() / 10;
  }
  const long long of_day_s = of_day_cs / 100;
  std::snprintf(text.data(), text.size(),
                "GPGGA,%02lld%02lld%02lld.%02lld,%s,%c,%s,%c,%c,%02d,%.1f,%.2f,M,%.2f,M,,",
                of_day_s / 3600, of_day_s / 60 % 60, of_day_s % 60, of_day_cs % 100,
                arc(fix.position->lat, 2).c_str(), fix.position->lat < 0.0 ? 'S' : 'N',
                arc(fix.position->lon, 3).c_str(), fix.position->lon < 0.0 ? 'W' : 'E',
                quality(fix.fix), fix.satellites.value_or(12), fix.hdop.value_or(1.0),
                fix.alt_msl_m.value_or(0.0), fix.geoid_sep_m.value_or(0.0));
  unsigned sum = 0;
  const std::string body = text.data();
  for (const char c : body) sum ^= static_cast<std::uint8_t>(c);
  std::snprintf(text.data(), text.size(), "*%02X\r\n", sum);
  return "$" + body + text.data();
}

}  // namespace roverd::ntrip
