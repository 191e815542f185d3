#include "net/assets.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include "base/same_word.hpp"

namespace roverd::net {

namespace http = boost::beast::http;

namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Takes the part before `separator` off the front of `text`.
std::string_view next_part(std::string_view& text, char separator) {
  const auto end = text.find(separator);
  const std::string_view part = text.substr(0, end);
  text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  return trimmed(part);
}

/// FNV-1a, 64 bits: names a content, protects from nothing.
std::string content_tag(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : bytes) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3u;
  }
  std::array<char, 17> out{};
  std::snprintf(out.data(), out.size(), "%016llx", static_cast<unsigned long long>(hash));
  return out.data();
}

bool forbidden(std::string_view parameters) {
  while (!parameters.empty()) {
    const std::string_view part = next_part(parameters, ';');
    if (part.size() > 2 && (part[0] == 'q' || part[0] == 'Q') && part[1] == '=') {
      return std::strtod(std::string(part.substr(2)).c_str(), nullptr) <= 0.0;
    }
  }
  return false;
}

}  // namespace

void set_security_headers(Response& response, std::span<const std::string> elsewhere) {
  std::string more;
  for (const std::string& origin : elsewhere) more += ' ' + origin;
  response.set("Content-Security-Policy",
               "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: "
               "blob:" +
                   more + "; font-src 'self'; connect-src 'self'" + more +
                   "; worker-src 'self'; manifest-src 'self'; base-uri 'none'; form-action "
                   "'self'; frame-ancestors 'none'");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
}

bool none_match_hits(std::string_view header, std::string_view etag) {
  if (etag.starts_with("W/")) etag.remove_prefix(2);
  while (!header.empty()) {
    std::string_view one = next_part(header, ',');
    if (one == "*") return true;
    if (one.starts_with("W/")) one.remove_prefix(2);
    if (!one.empty() && one == etag) return true;
  }
  return false;
}

Coding choose_coding(std::string_view accept, bool has_gzip, bool has_brotli) {
  // −1 not named, 0 forbidden, 1 allowed
  int brotli = -1;
  int gzip = -1;
  int any = -1;
  while (!accept.empty()) {
    std::string_view part = next_part(accept, ',');
    const std::string_view name = next_part(part, ';');
    const int allowed = forbidden(part) ? 0 : 1;
    if (base::same_word(name, "br")) brotli = allowed;
    if (base::same_word(name, "gzip") || base::same_word(name, "x-gzip")) gzip = allowed;
    if (name == "*") any = allowed;
  }
  if (has_brotli && (brotli < 0 ? any : brotli) > 0) return Coding::Brotli;
  if (has_gzip && (gzip < 0 ? any : gzip) > 0) return Coding::Gzip;
  return Coding::Identity;
}

Files::Files(std::span<const FileEntry> entries) {
  for (const FileEntry& entry : entries) {
    files_.emplace(std::string(entry.path), Held{entry, content_tag(entry.raw)});
  }
}

const Files::Held* Files::find(std::string_view path) const {
  if (const auto exact = files_.find(path); exact != files_.end()) return &exact->second;
  if (!path.ends_with('/')) return nullptr;
  const auto index = files_.find(std::string(path) + "index.html");
  return index == files_.end() ? nullptr : &index->second;
}

bool Files::has(std::string_view path) const {
  return find(path) != nullptr;
}

std::optional<Response> Files::answer(const Request& request) const {
  if (request.method() != http::verb::get && request.method() != http::verb::head) return {};
  const std::string_view target(request.target().data(), request.target().size());
  const Held* held = find(target.substr(0, target.find('?')));
  if (held == nullptr) return {};
  const FileEntry& file = held->entry;
  const auto field = [&request](http::field name) {
    const auto value = request[name];
    return std::string_view(value.data(), value.size());
  };

  const Coding coding =
      choose_coding(field(http::field::accept_encoding), !file.gzip.empty(), !file.brotli.empty());
  std::string etag = "\"" + held->tag;
  if (coding == Coding::Brotli) etag += "-br";
  if (coding == Coding::Gzip) etag += "-gz";
  etag += '"';

  Response response{http::status::ok, 11};
  set_security_headers(response);
  response.set(http::field::etag, etag);
  response.set(http::field::vary, "Accept-Encoding");
  response.set(http::field::cache_control,
               file.immutable ? "public, max-age=31536000, immutable" : "no-cache");
  if (none_match_hits(field(http::field::if_none_match), etag)) {
    response.result(http::status::not_modified);
    return response;
  }
  response.set(http::field::content_type,
               boost::beast::string_view(file.content_type.data(), file.content_type.size()));
  if (coding == Coding::Brotli) response.set(http::field::content_encoding, "br");
  if (coding == Coding::Gzip) response.set(http::field::content_encoding, "gzip");
  switch (coding) {
    case Coding::Identity:
      response.body() = file.raw;
      break;
    case Coding::Gzip:
      response.body() = file.gzip;
      break;
    case Coding::Brotli:
      response.body() = file.brotli;
      break;
  }
  return response;
}

}  // namespace roverd::net
