#include "people/audit.hpp"

#include "people/secret.hpp"

namespace roverd::people {

namespace {

/// With its length in front: no two rows have the same text.
void add(std::string& text, std::string_view part) {
  text += std::to_string(part.size()) + ":";
  text += part;
}

/// How many bytes this sign of UTF-8 has; 0: it is none.
std::size_t sign_at(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(at);
  const std::size_t size = first < 0x80   ? 1
                           : first < 0xC2 ? 0
                           : first < 0xE0 ? 2
                           : first < 0xF0 ? 3
                           : first < 0xF5 ? 4
                                          : 0;
  if (size == 0 || at + size > text.size()) return 0;
  for (std::size_t i = at + 1; i < at + size; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  if (size < 3) return size;
  // Overlong, a half of a pair, or beyond the last sign.
  const unsigned second = byte(at + 1);
  const bool none = (first == 0xE0 && second < 0xA0) || (first == 0xED && second >= 0xA0) ||
                    (first == 0xF0 && second < 0x90) || (first == 0xF4 && second >= 0x90);
  return none ? 0 : size;
}

std::string plain(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = sign_at(text, at);
    const bool control =
        size == 1 && (static_cast<unsigned char>(text[at]) < 0x20 || text[at] == 0x7F);
    const std::string_view sign = size == 0 || control ? "?" : text.substr(at, size);
    if (out.size() + sign.size() > Deed::kLongest) break;
    out += sign;
    at += size == 0 ? 1 : size;
  }
  return out;
}

}  // namespace

std::string chained(std::string_view before, std::int64_t id, const Deed& deed) {
  std::string text;
  add(text, before);
  add(text, std::to_string(id));
  add(text, std::to_string(deed.time.time_since_epoch().count()));
  for (const std::string* part :
       {&deed.user, &deed.credential, &deed.address, &deed.call, &deed.target}) {
    add(text, *part);
  }
  add(text, std::to_string(deed.status));
  add(text, deed.detail);
  add(text, std::to_string(deed.times));
  return digest(text);
}

std::optional<std::int64_t> first_break(std::int64_t before_id, std::string_view before,
                                        const std::vector<KeptDeed>& rows) {
  std::string last(before);
  std::int64_t id = before_id;
  for (const KeptDeed& row : rows) {
    if (row.id != id + 1 || row.hash != chained(last, row.id, row.deed)) return id + 1;
    last = row.hash;
    id = row.id;
  }
  return std::nullopt;
}

Deed tidied(Deed deed) {
  for (std::string* text :
       {&deed.user, &deed.credential, &deed.address, &deed.call, &deed.target, &deed.detail}) {
    *text = plain(*text);
  }
  return deed;
}

}  // namespace roverd::people
