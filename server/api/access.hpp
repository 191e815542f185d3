#pragma once
// Who may call what. One table (access_table.cpp), one check before any handler; what it finds out
// about the caller goes along with the call. Off: everybody may everything, as on a computer of
// one's own. Web thread only.

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "api/message.hpp"
#include "people/book.hpp"

namespace roverd::api {

/// Each includes those before it.
enum class Need { Anyone, Viewer, Operator, Admin };
std::string_view to_string(Need need) noexcept;
bool suffices(people::Role role, Need need) noexcept;

/// Must whoever calls it hold control (control.hpp)?
enum class NeedsControl {
  No,
  Yes,
  UnlessHold,  ///< a mode: HOLD stops
  IfActive,    ///< a fence, a map: only the one in force acts on the robot
};
std::string_view to_string(NeedsControl needs) noexcept;
/// Yes for what is not in the table.
NeedsControl needs_control(std::string_view operation);

/// "POST /vehicle/arm" → what it needs. Empty: it is not in the table.
std::optional<Need> need_of(std::string_view operation);
/// Of a message on the stream, by its member: "drive". Empty: no such message.
std::optional<Need> need_of_message(std::string_view member);

/// Set by net for each request, over whatever the client sent: the address it came from.
std::string peer_of(const Request& request);

class Access {
 public:
  /// Without TLS. With it they are named __Host-…: a browser takes such a one over TLS only, from
  /// this very host, for all of it.
  static constexpr std::string_view kCookie = "roverd_session";
  static constexpr std::string_view kDeviceCookie = "roverd_device";

  /// @param book null: off. @param secure the cookies go through TLS only
  Access(people::Book* book, bool secure) : book_(book), secure_(secure) {}

  bool on() const noexcept { return book_ != nullptr; }
  /// Only while on.
  people::Book& book() const { return *book_; }
  static people::Now now();

  /// The refusal, or empty: it may pass, and `who` is whoever showed a valid cookie or token.
  std::optional<Response> check(const Request& request, Need need, std::optional<people::Who>& who);
  /// The same for the stream's request; a browser must say where it comes from.
  std::optional<Response> check_upgrade(const Request& request, std::optional<people::Who>& who);
  /// Somebody has shown a valid cookie or token from there lately.
  bool knows(const std::string& address) const;
  /// The same, for a question that is asked before.
  bool would_pass(const Request& request, Need need);

  /// Set-Cookie. @param secret empty: forget it
  std::string cookie(std::string_view secret) const;
  /// The same of a paired device.
  std::string device_cookie(std::string_view secret) const;
  /// What a paired device shows; empty: nothing. Identifies nobody.
  std::string device_secret(const Request& request) const;

 private:
  std::optional<Response> identify(const Request& request, std::optional<people::Who>& who);
  void note(const std::string& address);
  std::optional<Response> judge(const std::optional<people::Who>& who, std::string_view method,
                                Need need) const;
  std::string cookie_name(std::string_view name) const;
  std::string set_cookie(std::string_view name, std::string_view secret, base::Duration age) const;

  people::Book* book_;
  bool secure_;
  std::map<std::string, base::Time> known_{};  ///< addresses, and when they were seen last
};

}  // namespace roverd::api
