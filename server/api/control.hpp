#pragma once
// Control at the interface: whose commands count while access control is on. What needs it stands
// in access_table.cpp; who holds it, people::Lease decides. Off: everybody may, as ever. Web thread
// only: the control loop knows nothing of it.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/access.hpp"
#include "base/snapshot.hpp"
#include "people/lease.hpp"

namespace roverd::api {

/// One whose page or script is connected.
struct Present {
  people::Driver who;
  people::Role role = people::Role::Viewer;
  int streams = 0;
};

class Control {
 public:
  using Notice = people::Lease::Notice;

  /// @param access must live as long
  Control(Access& access, base::Duration grace)
      : access_(access), lease_(people::Lease::Params{.grace = grace}) {}

  bool on() const noexcept { return access_.on(); }
  const people::Lease& lease() const noexcept { return lease_; }

  /// Without its name. Empty: nobody known.
  std::optional<people::Driver> driver(const std::optional<people::Who>& who,
                                       const std::string& address) const;
  bool may(const std::optional<people::Driver>& who) const noexcept {
    return !on() || (who && lease_.holds(*who));
  }
  /// The holder called.
  void heard(const std::optional<people::Driver>& who);
  /// Once a second, and when a stream or a log-in ends.
  void step();

  base::Result<people::Lease::Outcome> take(people::Driver who, people::Lease::How how,
                                            const std::string& reason);
  base::Result<void> release(const people::Driver& who);
  base::Result<void> answer(std::uint64_t request, bool accept);

  /// {"on", "holder", "requests", "grace_s", "ask_s"}
  Json state() const;
  /// Who has a stream open, by name: [{"id", "user", "name", "kind", "role", "streams"}].
  Json here() const;
  Json state_with(const Notice& notice) const;
  /// Of the vehicle's state: {"id", "user", "name", "kind"} or null.
  Json holder() const;
  /// Why a call is refused.
  Json problem() const;

  /// A stream of that one is open.
  std::function<bool(const people::Driver&)> linked{};
  /// All of them.
  std::function<std::vector<Present>()> present{};
  /// Something changed.
  std::function<void(const Notice&)> on_notice{};

 private:
  void tell();
  std::string name_of(const people::Driver& who) const;

  Access& access_;
  people::Lease lease_;
};

std::string_view word_of(people::Lease::Notice::Kind kind) noexcept;
/// For people.
std::string sentence(const people::Lease::Notice& notice);
/// For the log of events; empty where a question was asked or answered only.
std::optional<base::Event> event_of(const people::Lease::Notice& notice);

}  // namespace roverd::api
