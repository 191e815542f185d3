#include "people/lease.hpp"

#include <algorithm>
#include <utility>

namespace roverd::people {

using base::Code;
using base::Result;
using Kind = Lease::Notice::Kind;

bool same(const Driver& a, const Driver& b) noexcept {
  return a.by == b.by && a.id == b.id && a.address == b.address;
}

void Lease::note(Kind kind, std::optional<Driver> from, std::optional<Driver> to,
                 std::string reason) {
  notices_.push_back({kind, std::move(from), std::move(to), std::move(reason)});
}

std::vector<Lease::Request>::iterator Lease::request_of(const Driver& who) {
  return std::find_if(requests_.begin(), requests_.end(),
                      [&](const Request& r) { return same(r.who, who); });
}

void Lease::forget(const Driver& who) {
  std::erase_if(requests_, [&](const Request& r) { return same(r.who, who); });
}

void Lease::give(const Driver& to, base::Time now) {
  forget(to);
  holder_ = to;
  since_ = heard_ = now;
  linked_ = false;  // until the next step
}

/// Whoever asked first waits for nothing else.
void Lease::free(Kind kind, base::Time now) {
  note(kind, std::exchange(holder_, std::nullopt), std::nullopt);
  linked_ = false;
  if (requests_.empty()) return;
  give(Driver(requests_.front().who), now);
  note(Kind::Taken, std::nullopt, holder_);
}

/// By time alone. What expires together does so in its order: a request first, if it was due first.
void Lease::lapse(base::Time now) {
  const bool silent = holder_ && !linked_ && now - heard_ >= params_.grace;
  const base::Time lost_at = silent ? heard_ + params_.grace : now;
  std::erase_if(requests_, [&](const Request& r) {
    if (r.until > lost_at) return false;
    note(Kind::Expired, holder_, r.who);
    return true;
  });
  if (silent) free(Kind::Lost, now);
}

void Lease::step(const Facts& facts, base::Time now) {
  std::erase_if(requests_, [&](const Request& r) {
    if (facts(r.who).valid) return false;
    note(Kind::Withdrawn, holder_, r.who);
    return true;
  });
  if (holder_) {
    const Fact fact = facts(*holder_);
    if (!fact.valid) {
      free(Kind::Ended, now);
    } else {
      linked_ = fact.linked;
      if (linked_) heard_ = now;
    }
  }
  lapse(now);
}

void Lease::heard(const Driver& who, base::Time now) {
  lapse(now);
  if (holds(who)) heard_ = now;
}

Result<Lease::Outcome> Lease::take(const Driver& who, How how, const std::string& reason,
                                   base::Time now) {
  lapse(now);
  if (holds(who)) {
    heard_ = now;
    holder_->name = who.name;
    return Outcome::Holds;
  }
  if (!holder_) {
    give(who, now);
    note(Kind::Taken, std::nullopt, who);
    return Outcome::Holds;
  }
  if (how == How::Force) {
    const auto from = holder_;
    give(who, now);
    note(Kind::Forced, from, who, reason);
    return Outcome::Holds;
  }
  if (how == How::IfFree) return base::fail(Code::Conflict, "another holds control");
  if (const auto mine = request_of(who); mine != requests_.end()) return Outcome::Asked;
  if (requests_.size() >= kRequests) {
    return base::fail(Code::Conflict, "too many ask for control already");
  }
  requests_.push_back({next_request_++, who, now + params_.ask});
  note(Kind::Asked, holder_, who);
  return Outcome::Asked;
}

Result<void> Lease::release(const Driver& who, base::Time now) {
  lapse(now);
  if (holds(who)) {
    free(Kind::Released, now);
    return {};
  }
  if (request_of(who) == requests_.end()) {
    return base::fail(Code::Conflict, "you do not hold control, nor ask for it");
  }
  forget(who);
  note(Kind::Withdrawn, holder_, who);
  return {};
}

Result<void> Lease::answer(std::uint64_t request, bool accept, base::Time now) {
  lapse(now);
  const auto found = std::find_if(requests_.begin(), requests_.end(),
                                  [&](const Request& r) { return r.id == request; });
  if (!holder_ || found == requests_.end()) {
    return base::fail(Code::NotFound, "there is no such request any more");
  }
  const Driver who = found->who;
  const auto from = holder_;
  if (accept) {
    give(who, now);
  } else {
    requests_.erase(found);
  }
  note(accept ? Kind::HandedOver : Kind::Refused, from, who);
  return {};
}

std::optional<base::Duration> Lease::grace_left(base::Time now) const {
  if (!holder_ || linked_) return std::nullopt;
  return std::max(base::Duration::zero(), params_.grace - (now - heard_));
}

}  // namespace roverd::people
