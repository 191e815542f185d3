#pragma once
// The table of what the server answers: method, path, handler, and the statuses that the OpenAPI
// document promises for it. Pure; built once, then only read.

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/access.hpp"
#include "api/message.hpp"

namespace roverd::api {

using Handler = std::function<void(CallPtr)>;

/// The largest bodies, bytes: of a command, of a document, of a file to be imported.
inline constexpr std::size_t kCommandBytes = 64 * 1024;
inline constexpr std::size_t kDocumentBytes = 8 * 1024 * 1024;
inline constexpr std::size_t kFileBytes = 64 * 1024 * 1024;
/// Of a picture, and of a piece of a file that may be larger than the memory.
inline constexpr std::size_t kPictureBytes = 1'000'000;
inline constexpr std::size_t kPieceBytes = 4 * 1024 * 1024;

struct Route {
  http::verb method = http::verb::get;
  std::string pattern;             ///< "/missions/{id}/export"; a literal wins over a parameter
  std::vector<unsigned> statuses;  ///< as documented, ascending
  Handler handler;
  std::size_t body_bytes = kCommandBytes;
  Need need = Need::Admin;  ///< see Router::add
  NeedsControl control = NeedsControl::Yes;
};

/// Splits "/a/b%20c?x=1&y" into path and decoded query. Malformed: broken percent signs.
struct Target {
  std::string path;  ///< not decoded
  std::map<std::string, std::string, std::less<>> query;
};
base::Result<Target> parse_target(std::string_view target);

/// Percent-decoding; Malformed for "%", "%4", "%zz" and for a zero byte.
base::Result<std::string> percent_decoded(std::string_view text, bool plus_is_blank = false);

class Router {
 public:
  /// Fills in what it needs, by the table of access.hpp (what that does not name needs an admin),
  /// and the refusals that come of it.
  void add(Route route);
  const std::vector<Route>& routes() const noexcept { return routes_; }

  struct Match {
    const Route* route = nullptr;
    std::map<std::string, std::string, std::less<>> params;  ///< decoded
  };
  struct NotFound {};
  struct WrongMethod {
    std::string allow;  ///< "GET, HEAD, PUT, OPTIONS"
  };
  /// HEAD counts as GET. @param path without the base path and the query.
  std::variant<Match, NotFound, WrongMethod> find(http::verb method, std::string_view path) const;

 private:
  std::vector<Route> routes_;
};

}  // namespace roverd::api
