#include "base/network.hpp"

#include <algorithm>
#include <vector>

namespace roverd::base {

namespace {

constexpr std::size_t kGroups = 8;

using Groups = std::vector<std::string_view>;

bool is_group(std::string_view text) {
  return !text.empty() && text.size() <= 4 &&
         text.find_first_not_of("0123456789abcdefABCDEF") == std::string_view::npos;
}

/// "2001:db8" → its groups. @return false: there is something else in it
bool split(std::string_view text, Groups& out) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(':'), text.size());
    if (!is_group(text.substr(0, end)) || end + 1 == text.size()) return false;
    out.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return true;
}

}  // namespace

std::string network_of(std::string_view address) {
  const std::size_t percent = std::min(address.find('%'), address.size());
  const std::string_view scope = address.substr(percent);
  address = address.substr(0, percent);
  if (address == "::1") return {};
  Groups groups;
  Groups behind;
  const std::size_t gap = address.find("::");
  const bool fine = split(address.substr(0, gap), groups) &&
                    (gap == std::string_view::npos || split(address.substr(gap + 2), behind));
  const std::size_t said = groups.size() + behind.size();
  if (!fine || (gap == std::string_view::npos ? said != kGroups : said >= kGroups)) return {};
  groups.resize(kGroups - behind.size(), "0");
  groups.insert(groups.end(), behind.begin(), behind.end());
  std::string out;
  for (std::size_t i = 0; i < kGroups / 2; ++i) {
    out += (i > 0 ? ":" : "") + std::string(groups[i]);
  }
  return out + "/64" + std::string(scope);
}

}  // namespace roverd::base
