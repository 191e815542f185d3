#include "config/layers.hpp"

#include <algorithm>
#include <string_view>

namespace roverd {
namespace {

base::Result<void> refuse_url(const std::string& name, std::string detail) {
  const std::string key = "layers." + name + ".url";
  std::string whole = key + " " + detail;
  return base::fail(base::Code::Invalid, std::move(whole), {{key, std::move(detail)}});
}

/// "https://host:port"; empty: it is no such address. What is in it stands in a header later.
std::string_view origin_of(std::string_view url) {
  const std::size_t slashes = url.starts_with("https://") ? 8 : url.starts_with("http://") ? 7 : 0;
  if (slashes == 0) return {};
  const std::size_t end = url.find('/', slashes);
  if (end == std::string_view::npos || end == slashes) return {};
  const auto of_a_host = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '-' || c == ':';
  };
  const std::string_view host = url.substr(slashes, end - slashes);
  return std::ranges::all_of(host, of_a_host) ? url.substr(0, end) : std::string_view{};
}

}  // namespace

base::Result<void> check(const Layers& layers) {
  for (const auto& [name, layer] : layers) {
    const std::string_view url = layer.url;
    const auto names = [url](std::string_view part) {
      return url.find(part) != std::string_view::npos;
    };
    if (origin_of(url).empty()) {
      return refuse_url(name, "must be http://HOST/… or https://HOST/…, without a login");
    }
    if (!names("{z}") || !names("{x}") || !(names("{y}") || names("{-y}"))) {
      return refuse_url(name, "must have {z}, {x} and {y} or {-y} where zoom, column and row go");
    }
    const auto odd = [](char c) { return c <= ' ' || c == '"' || c == '\x7f'; };
    if (std::ranges::any_of(url, odd)) return refuse_url(name, "has a blank or a quotation mark");
  }
  return {};
}

std::vector<std::string> origins_of(const Layers& layers) {
  std::vector<std::string> out;
  for (const auto& [name, layer] : layers) {
    const std::string origin(origin_of(layer.url));
    if (std::ranges::find(out, origin) == out.end()) out.push_back(origin);
  }
  return out;
}

}  // namespace roverd
