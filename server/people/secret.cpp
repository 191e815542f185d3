#include "people/secret.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>

#include <sodium.h>

namespace roverd::people {

namespace {

constexpr unsigned long long kPasses = 40;
constexpr std::size_t kMemory = std::size_t{16} << 20U;
/// Without 0 O 1 I L, and without letters that sound alike next to each other (B D P T, M N).
constexpr std::string_view kSpoken = "ACEFGHJKMRSUVWXYZ23456789";
constexpr std::size_t kCode = 8;

void need_sodium() {
  static const int begun = sodium_init();
  if (begun < 0) throw std::runtime_error("libsodium cannot begin: the system gives no chance");
}

template <std::size_t n>
std::array<unsigned char, n> some_bytes() {
  need_sodium();
  std::array<unsigned char, n> bytes{};
  randombytes_buf(bytes.data(), bytes.size());
  return bytes;
}

std::string hexadecimal(const unsigned char* bytes, std::size_t size) {
  std::string out(2 * size + 1, '\0');
  sodium_bin2hex(out.data(), out.size(), bytes, size);
  out.pop_back();
  return out;
}

}  // namespace

std::string random_secret() {
  constexpr auto kVariant = sodium_base64_VARIANT_URLSAFE_NO_PADDING;
  const auto bytes = some_bytes<32>();
  std::string out(sodium_base64_ENCODED_LEN(bytes.size(), kVariant), '\0');
  sodium_bin2base64(out.data(), out.size(), bytes.data(), bytes.size(), kVariant);
  out.pop_back();  // its end
  return out;
}

std::string random_id() {
  const auto bytes = some_bytes<6>();
  return hexadecimal(bytes.data(), bytes.size());
}

std::string digest(std::string_view secret) {
  need_sodium();
  std::array<unsigned char, crypto_generichash_BYTES> hash{};
  crypto_generichash(hash.data(), hash.size(),
                     reinterpret_cast<const unsigned char*>(secret.data()), secret.size(), nullptr,
                     0);
  return hexadecimal(hash.data(), hash.size());
}

bool same(std::string_view a, std::string_view b) noexcept {
  return a.size() == b.size() && sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::string spoken_code() {
  need_sodium();
  std::string out;
  for (std::size_t i = 0; i < kCode; ++i) {
    if (i == kCode / 2) out += '-';
    out += kSpoken[randombytes_uniform(static_cast<std::uint32_t>(kSpoken.size()))];
  }
  return out;
}

std::string plain_code(std::string_view typed) {
  std::string out;
  for (const char c : typed.substr(0, 64)) {
    if (c == ' ' || c == '-') continue;
    if (out.size() == kCode / 2) out += '-';
    out += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return out;
}

base::Result<std::string> hash_password(std::string_view password) {
  need_sodium();
  std::array<char, crypto_pwhash_STRBYTES> out{};
  if (crypto_pwhash_str_alg(out.data(), password.data(), password.size(), kPasses, kMemory,
                            crypto_pwhash_ALG_ARGON2ID13) != 0) {
    return base::fail(base::Code::Unavailable, "there is no memory to hash a password");
  }
  return std::string(out.data());
}

bool is_password(const std::string& hash, std::string_view password) noexcept {
  // It reads so many bytes of the hash, whatever they are.
  std::array<char, crypto_pwhash_STRBYTES> whole{};
  if (hash.size() >= whole.size() || sodium_init() < 0) return false;
  std::copy(hash.begin(), hash.end(), whole.begin());
  return crypto_pwhash_str_verify(whole.data(), password.data(), password.size()) == 0;
}

const std::string& nobodys_hash() {
  // Its salt and hash are zeros: no password is known that it belongs to.
  static const std::string kHash =
      "$argon2id$v=19$m=" + std::to_string(kMemory / 1024) + ",t=" + std::to_string(kPasses) +
      ",p=1$AAAAAAAAAAAAAAAAAAAAAA$AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA";
  return kHash;
}

std::string password_problem(std::string_view password, std::string_view user) {
  if (password.size() < kShortestPassword) {
    return "must have at least " + std::to_string(kShortestPassword) + " characters";
  }
  if (password.size() > kLongestPassword) {
    return "must have at most " + std::to_string(kLongestPassword) + " bytes";
  }
  if (password == user) return "must not be the user's name";
  const bool one =
      std::all_of(password.begin(), password.end(), [&](char c) { return c == password.front(); });
  return one ? "must not be one character again and again" : "";
}

std::string pin_problem(std::string_view pin) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (pin.size() < kShortestPin || pin.size() > kLongestPin ||
      !std::all_of(pin.begin(), pin.end(), is_digit)) {
    return "must be " + std::to_string(kShortestPin) + " to " + std::to_string(kLongestPin) +
           " digits";
  }
  // Steps from digit to digit, 9 before 0: 1111, 1234, 7890, 4321, 1212.
  bool equal = true;
  bool pairs = true;
  for (std::size_t i = 1; i < pin.size(); ++i) {
    equal = equal && (pin[i] - pin[i - 1] + 10) % 10 == (pin[1] - pin[0] + 10) % 10;
    pairs = pairs && (i < 2 || pin[i] == pin[i - 2]);
  }
  const int step = (pin[1] - pin[0] + 10) % 10;
  const bool run = equal && (step == 0 || step == 1 || step == 9);
  return run || pairs ? "must not be as easy to guess as 0000, 1234 or 1212" : "";
}

std::string user_name_problem(std::string_view name) {
  const bool fine =
      !name.empty() && name.size() <= 40 && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '.' || c == '-' || c == '_';
      });
  return fine ? "" : "must be 1 to 40 letters a to z, digits, dots, hyphens or underscores";
}

}  // namespace roverd::people
