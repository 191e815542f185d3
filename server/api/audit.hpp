#pragma once
// What is written down of the calls: every change and every log-in with its answer, and what was
// refused. What is refused again and again (a forgotten log-in, a wrong password, an attack), and
// what anyone or any viewer may do again and again (stop, open a stream), becomes one row with a
// number every ten seconds, so that nobody can fill the disk by asking.
// Never a body, a query, a cookie, a token or a password. Web thread only.

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "api/message.hpp"
#include "people/audit.hpp"
#include "people/lease.hpp"

namespace roverd::api {

class Audit {
 public:
  using Keep = std::function<void(people::Deed)>;
  static constexpr base::Duration kTogether = std::chrono::seconds(10);
  /// Kinds that are counted apart; the others are counted together.
  static constexpr std::size_t kKinds = 256;

  explicit Audit(Keep keep) : keep_(std::move(keep)) {}

  /// A request was answered.
  void answered(const Call& call, const Response& response, people::Now now);
  /// A stream was opened, or not.
  void upgraded(const Request& request, const std::optional<people::Who>& who, int status,
                people::Now now);
  /// Somebody stopped the robot by a message on a stream, or held its guard off.
  void stopped(const std::optional<people::Who>& who, const std::string& address,
               std::string_view how, people::Now now);
  /// Control changed hands, or was asked for.
  void control(const people::Lease::Notice& notice, people::Now now);
  /// Once a second: what was counted long enough is written down.
  void sweep(base::Time now);
  /// All of it.
  void flush();

 private:
  struct Counted {
    people::Deed deed;  ///< with the number of those that were not written down yet
    base::Time since;
  };
  /// The first of a kind at once, what follows together.
  void count(people::Deed deed, base::Time now);
  void write(Counted& counted);

  Keep keep_;
  std::map<std::string, Counted> counted_;
};

}  // namespace roverd::api
