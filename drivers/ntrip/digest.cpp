#include "ntrip/digest.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include <openssl/evp.h>

namespace roverd::ntrip {
namespace {

constexpr std::size_t kLongestPart = 512;

std::string small(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// One `name=value` or `name="value"` from the front of `rest`, which loses it and its comma.
/// @return empty name: there is none.
struct Part {
  std::string name;
  std::string value;
};
Part take_part(std::string_view& rest) {
  while (!rest.empty() && (rest.front() == ' ' || rest.front() == ',')) rest.remove_prefix(1);
  const auto equals = rest.find('=');
  if (equals == std::string_view::npos) return {};
  Part part{small(trimmed(rest.substr(0, equals))), {}};
  rest.remove_prefix(equals + 1);
  if (!rest.starts_with('"')) {
    const auto end = std::min(rest.find(','), rest.size());
    part.value = trimmed(rest.substr(0, end));
    rest.remove_prefix(end);
    return part;
  }
  rest.remove_prefix(1);
  while (!rest.empty() && rest.front() != '"') {
    if (rest.front() == '\\' && rest.size() > 1) rest.remove_prefix(1);
    part.value += rest.front();
    rest.remove_prefix(1);
  }
  if (!rest.empty()) rest.remove_prefix(1);
  return part;
}

/// May it be sent back between quotation marks?
bool harmless(std::string_view text) {
  return text.size() <= kLongestPart && std::ranges::all_of(text, [](char c) {
           return c >= ' ' && c < 0x7F && c != '"' && c != '\\';
         });
}

std::optional<std::string> hex_hash(const EVP_MD* kind, const std::string& text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> sum{};
  unsigned size = 0;
  if (EVP_Digest(text.data(), text.size(), sum.data(), &size, kind, nullptr) != 1) return {};
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out;
  for (unsigned i = 0; i < size; ++i) {
    out += kDigits[sum[i] >> 4U];
    out += kDigits[sum[i] & 15U];
  }
  return out;
}

}  // namespace

std::optional<Challenge> parse_challenge(std::string_view value) {
  value = trimmed(value);
  constexpr std::string_view kScheme = "digest ";
  if (small(value.substr(0, kScheme.size())) != kScheme) return std::nullopt;
  value.remove_prefix(kScheme.size());
  Challenge out;
  for (Part part = take_part(value); !part.name.empty(); part = take_part(value)) {
    if (!harmless(part.value)) return std::nullopt;
    if (part.name == "realm") out.realm = part.value;
    if (part.name == "nonce") out.nonce = part.value;
    if (part.name == "opaque") out.opaque = part.value;
    if (part.name == "algorithm") out.algorithm = part.value;
    if (part.name == "qop") {
      const std::string offered = "," + small(part.value) + ",";
      out.auth = offered.find(",auth,") != std::string::npos ||
                 offered.find(" auth,") != std::string::npos;
    }
  }
  if (out.nonce.empty()) return std::nullopt;
  return out;
}

std::optional<std::string> digest_answer(const Challenge& c, std::string_view login,
                                         std::string_view path, std::string_view cnonce) {
  const std::string algorithm = small(c.algorithm);
  const bool md5 = algorithm.empty() || algorithm == "md5";
  if (!md5 && algorithm != "sha-256") return std::nullopt;
  const EVP_MD* kind = md5 ? EVP_md5() : EVP_sha256();
  const auto colon = login.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const std::string user(login.substr(0, colon));
  if (!harmless(user)) return std::nullopt;
  const std::string uri(path);
  const auto who =
      hex_hash(kind, user + ":" + c.realm + ":" + std::string(login.substr(colon + 1)));
  const auto what = hex_hash(kind, "GET:" + uri);
  if (!who || !what) return std::nullopt;
  const std::string middle =
      c.auth ? ":" + c.nonce + ":00000001:" + std::string(cnonce) + ":auth:" : ":" + c.nonce + ":";
  const auto proof = hex_hash(kind, *who + middle + *what);
  if (!proof) return std::nullopt;
  std::string out = "Digest username=\"" + user + "\", realm=\"" + c.realm + "\", nonce=\"" +
                    c.nonce + "\", uri=\"" + uri + "\", response=\"" + *proof + "\"";
  if (!c.algorithm.empty()) out += ", algorithm=" + c.algorithm;
  if (c.auth) out += ", qop=auth, nc=00000001, cnonce=\"" + std::string(cnonce) + "\"";
  if (!c.opaque.empty()) out += ", opaque=\"" + c.opaque + "\"";
  return out;
}

}  // namespace roverd::ntrip
