#pragma once
// Files held in memory (the page), answered with compression, ETag and caching rules.

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "net/server.hpp"

namespace roverd::net {

/// One file. The views must live as long as the Files (they are bytes of the program).
struct FileEntry {
  std::string_view path;          ///< "/index.html"
  std::string_view content_type;  ///< whole header value
  bool immutable = false;         ///< the name carries a hash of the content: never changes
  std::string_view raw;
  std::string_view gzip;    ///< empty: there is none
  std::string_view brotli;  ///< empty: there is none
};

/// Headers for everything a browser shows: own scripts and styles only, no frames, no guessing.
/// @param elsewhere origins from which pictures may come as well ("https://tiles.example.org")
void set_security_headers(Response& response, std::span<const std::string> elsewhere = {});

/// Does If-None-Match name this ETag? (RFC 9110, section 13.1.2: weak comparison, lists, "*".)
bool none_match_hits(std::string_view header, std::string_view etag);

enum class Coding { Identity, Gzip, Brotli };
/// What Accept-Encoding allows, best first: brotli, gzip, as it is. "q=0" forbids.
Coding choose_coding(std::string_view accept_encoding, bool has_gzip, bool has_brotli);

/// Immutable after construction; any thread.
class Files {
 public:
  /// "/" and folders answer with their index.html.
  explicit Files(std::span<const FileEntry> entries);

  /// For GET and HEAD of a known path; empty otherwise.
  std::optional<Response> answer(const Request& request) const;
  /// The path of the target without query, as it was sent.
  bool has(std::string_view path) const;

 private:
  struct Held {
    FileEntry entry;
    std::string tag;  ///< hash of the content, hexadecimal
  };
  const Held* find(std::string_view path) const;

  std::map<std::string, Held, std::less<>> files_;
};

}  // namespace roverd::net
