#include "camera/source.hpp"

#include <algorithm>
#include <charconv>

#include "ntrip/caster.hpp"

namespace roverd::camera {
namespace {

constexpr std::size_t kLongestAddress = 1024;

bool is_visible(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c > ' ' && c < 0x7F; });
}

/// "p%40ss" to "p@ss"; empty: not well-formed, or with a sign that no header may hold.
std::string plain_login(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned byte = static_cast<unsigned char>(text[i]);
    if (text[i] == '%') {
      const char* begin = text.data() + i + 1;
      if (i + 2 >= text.size()) return {};
      const auto [end, bad] = std::from_chars(begin, begin + 2, byte, 16);
      if (bad != std::errc{} || end != begin + 2) return {};
      i += 2;
    }
    if (byte < 0x20 || byte == 0x7F) return {};
    out += static_cast<char>(byte);
  }
  return out;
}

base::Result<Source> wrong(const std::string& why) {
  return base::fail(base::Code::Invalid, "a camera's address " + why);
}

/// "HOST" or "HOST:PORT", an IPv6 host in brackets.
bool take_host(std::string_view text, Source& out) {
  const auto colon = text.rfind(':');
  const auto bracket = text.rfind(']');
  if (colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket)) {
    unsigned port = 0;
    const char* last = text.data() + text.size();
    const auto [end, bad] = std::from_chars(text.data() + colon + 1, last, port);
    if (bad != std::errc{} || end != last || port < 1 || port > 65'535) return false;
    out.port = static_cast<std::uint16_t>(port);
    text = text.substr(0, colon);
  }
  out.host = text;
  return !text.empty();
}

}  // namespace

std::string Source::name() const {
  return (tls ? "https://" : "http://") + host + ":" + std::to_string(port) +
         path.substr(0, path.find('?'));
}

std::string Source::address() const {
  return (tls ? "tls:" : "tcp:") + host + ":" + std::to_string(port);
}

base::Result<Source> parse_source(std::string_view text) {
  constexpr std::string_view kPlain = "http://";
  constexpr std::string_view kTls = "https://";
  Source out;
  out.tls = text.starts_with(kTls);
  if (!out.tls && !text.starts_with(kPlain)) return wrong("must begin with http:// or https://");
  if (text.size() > kLongestAddress) return wrong("must have 1024 signs at most");
  if (!is_visible(text)) return wrong("must be printable ASCII without blanks: %20 is one");
  text.remove_prefix(out.tls ? kTls.size() : kPlain.size());
  text = text.substr(0, text.find('#'));
  const auto slash = text.find_first_of("/?");
  std::string_view host = text.substr(0, slash);
  if (slash != std::string_view::npos) {
    out.path = (text[slash] == '?' ? "/" : "") + std::string(text.substr(slash));
  }
  if (const auto at = host.rfind('@'); at != std::string_view::npos) {
    out.login = plain_login(host.substr(0, at));
    if (out.login.find(':') == std::string::npos) {
      return wrong("wants USER:PASSWORD before the @; %2F is a / in it");
    }
    host.remove_prefix(at + 1);
  }
  out.port = out.tls ? 443 : 80;
  if (!take_host(host, out)) return wrong("wants HOST or HOST:PORT after the //");
  return out;
}

std::optional<std::string> request(const Source& source, const Wish& wish,
                                   std::string_view cnonce) {
  std::string text = "GET " + source.path + " HTTP/1.1\r\nHost: " + source.host + ":" +
                     std::to_string(source.port) +
                     "\r\nUser-Agent: roverd\r\nAccept: multipart/x-mixed-replace, image/jpeg, "
                     "*/*\r\nConnection: close\r\n";
  if (wish.digest) {
    const auto answer = ntrip::digest_answer(*wish.digest, source.login, source.path, cnonce);
    if (!answer) return {};
    text += "Authorization: " + *answer + "\r\n";
  } else if (wish.basic) {
    text += "Authorization: Basic " + ntrip::base64(source.login) + "\r\n";
  }
  return text + "\r\n";
}

}  // namespace roverd::camera
