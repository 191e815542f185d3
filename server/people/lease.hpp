#pragma once
// Control: who may move the robot. One drives, everyone may watch, anyone may stop.
//
//   Free ──take──▶ Held ──released │ log-in over │ silent for the grace──▶ Free, or who asked first
//                  Held ──handed over │ forced──▶ Held by the other
//
// A browser is its session, all its tabs together; a script is its token at one address, so that
// the same token from two addresses is two drivers. The lease moves nothing and stops nothing: it
// says whose commands count. Pure: facts and time are arguments. One thread at a time.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.hpp"
#include "people/book.hpp"

namespace roverd::people {

struct Driver {
  Who::By by = Who::By::Session;
  std::string id;       ///< of the session or token
  std::string address;  ///< of a token; empty for sessions: a phone may change its network
  std::string user;
  std::string name{};  ///< of the device or token, for people
};
/// The name does not count.
bool same(const Driver& a, const Driver& b) noexcept;

class Lease {
 public:
  struct Params {
    base::Duration grace = std::chrono::seconds(10);
    base::Duration ask = std::chrono::seconds(30);  ///< a request lives so long
  };
  static constexpr std::size_t kRequests = 8;

  enum class How { IfFree, Ask, Force };
  enum class Outcome { Holds, Asked };

  struct Request {
    std::uint64_t id = 0;
    Driver who;
    base::Time until;
  };

  /// What happened, once.
  struct Notice {
    enum class Kind {
      Taken,       ///< to
      Released,    ///< from
      Lost,        ///< from, who was not heard any more
      Ended,       ///< from, whose log-in, token or role is over
      HandedOver,  ///< from, to
      Forced,      ///< from, to, reason
      Asked,       ///< from: the holder; to: who asks
      Refused,     ///< the same
      Expired,     ///< the same
      Withdrawn,   ///< the same
    };
    Kind kind;
    std::optional<Driver> from{};
    std::optional<Driver> to{};
    std::string reason{};
  };

  /// What is known of a driver now.
  struct Fact {
    bool valid = true;    ///< still logged in, and may drive
    bool linked = false;  ///< has a stream open
  };
  using Facts = std::function<Fact(const Driver&)>;

  explicit Lease(Params params) : params_(params) {}

  /// Often: what is over goes.
  void step(const Facts& facts, base::Time now);
  /// It called; to whom does not hold it that means nothing.
  void heard(const Driver& who, base::Time now);

  /// Who holds it already goes on holding it. Conflict: another holds it, or too many ask.
  base::Result<Outcome> take(const Driver& who, How how, const std::string& reason, base::Time now);
  /// Also takes a request back. Conflict: there is neither.
  base::Result<void> release(const Driver& who, base::Time now);
  /// The holder's answer to a request. NotFound: there is none of that number (any more).
  base::Result<void> answer(std::uint64_t request, bool accept, base::Time now);

  bool holds(const Driver& who) const noexcept { return holder_ && same(*holder_, who); }
  const std::optional<Driver>& holder() const noexcept { return holder_; }
  base::Time since() const noexcept { return since_; }
  /// Empty: nobody holds it, or its stream is open.
  std::optional<base::Duration> grace_left(base::Time now) const;
  /// The oldest first.
  const std::vector<Request>& requests() const noexcept { return requests_; }
  const Params& params() const noexcept { return params_; }
  std::vector<Notice> take_notices() { return std::exchange(notices_, {}); }

 private:
  void lapse(base::Time now);
  void give(const Driver& to, base::Time now);
  void free(Notice::Kind kind, base::Time now);
  void forget(const Driver& who);
  std::vector<Request>::iterator request_of(const Driver& who);
  void note(Notice::Kind kind, std::optional<Driver> from, std::optional<Driver> to,
            std::string reason = {});

  Params params_;
  std::optional<Driver> holder_;
  base::Time since_{};
  base::Time heard_{};   ///< the holder, last
  bool linked_ = false;  ///< the holder, at the last step
  std::vector<Request> requests_;
  std::uint64_t next_request_ = 1;
  std::vector<Notice> notices_;
};

}  // namespace roverd::people
