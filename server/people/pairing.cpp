// Paired devices: how a browser becomes one, and how it comes in with a PIN.

#include <algorithm>
#include <utility>

#include "people/book.hpp"
#include "people/secret.hpp"

namespace roverd::people {

using base::Code;
using base::Result;

namespace {

/// Of a device, beside the names of users, which have no blank in them.
std::string pin_door(const Device& device) {
  return "device " + device.id;
}

}  // namespace

Device* Book::find_device(std::string_view id) noexcept {
  const auto at =
      std::find_if(devices_.begin(), devices_.end(), [&](const Device& d) { return d.id == id; });
  return at == devices_.end() ? nullptr : &*at;
}

/// Only its last state is of interest.
void Book::keep(const Device& device) {
  std::erase_if(change_.now.devices, [&](const Device& d) { return d.id == device.id; });
  change_.now.devices.push_back(device);
}

void Book::drop_devices(const std::function<bool(const Device&)>& which) {
  std::erase_if(devices_, [&](const Device& device) {
    if (!which(device)) return false;
    drop_sessions([&](const Live& s) { return s.row.paired == device.id; });
    std::erase_if(change_.now.devices, [&](const Device& d) { return d.id == device.id; });
    change_.gone_devices.push_back(device.id);
    users_wait_.clear(pin_door(device));
    return true;
  });
}

Result<void> Book::may_pair(const std::string& user) const {
  if (this->user(user) == nullptr) return base::fail(Code::NotFound, "there is no such user");
  const auto count = std::count_if(devices_.begin(), devices_.end(),
                                   [&](const Device& d) { return d.user == user; });
  if (static_cast<std::size_t>(count) < kDevicesEach) return {};
  return base::fail(Code::Conflict, "\"" + user + "\" has " + std::to_string(kDevicesEach) +
                                        " paired devices: end one that is not needed any more");
}

Result<Opened<Device>> Book::pair(Device wanted, std::string_view replaced,
                                  const std::string& session, Now now) {
  const Device* const before = by_device(replaced, now);
  const std::string old = before != nullptr ? before->id : std::string();
  if (before == nullptr || before->user != wanted.user) {
    if (auto may = may_pair(wanted.user); !may) return tl::unexpected(may.error());
  }
  std::string secret = random_secret();
  wanted.id = random_id();
  wanted.hash = digest(secret);
  wanted.wrong = 0;
  wanted.created = now.wall;
  wanted.used.reset();
  devices_.push_back(wanted);
  keep(wanted);
  if (!old.empty()) {
    for (Live& live : sessions_) {
      if (live.row.id != session || live.row.paired != old) continue;
      live.row.paired = wanted.id;
      std::erase_if(change_.now.sessions, [&](const Session& s) { return s.id == session; });
      change_.now.sessions.push_back(live.row);
    }
    drop_devices([&](const Device& d) { return d.id == old; });
  }
  return Opened<Device>{std::move(secret), std::move(wanted)};
}

const Device* Book::by_device(std::string_view secret, Now now) const {
  if (secret.empty()) return nullptr;
  const std::string hash = digest(secret);
  for (const Device& device : devices_) {
    if (!same(device.hash, hash)) continue;
    const base::WallTime last = std::max(device.created, device.used.value_or(device.created));
    const bool known = now.wall >= base::kYoungest && last >= base::kYoungest;
    return known && now.wall - last > kPaired ? nullptr : &device;
  }
  return nullptr;
}

std::vector<Device> Book::devices_of(const std::string& user) const {
  std::vector<Device> out;
  std::copy_if(devices_.begin(), devices_.end(), std::back_inserter(out),
               [&](const Device& d) { return d.user == user; });
  return out;
}

Result<void> Book::end_device(const std::string& user, const std::string& id) {
  const std::size_t before = devices_.size();
  drop_invitations(user);  // a phone that was sent away must not come back by what it invited
  drop_devices([&](const Device& d) { return d.user == user && d.id == id; });
  if (devices_.size() < before) return {};
  return base::fail(Code::NotFound, "there is no such device");
}

void Book::unlock(std::string_view secret, const std::string& user, Now now) {
  const Device* const shown = by_device(secret, now);
  if (shown == nullptr || shown->user != user || shown->wrong == 0) return;
  Device* const device = find_device(shown->id);
  device->wrong = 0;
  users_wait_.clear(pin_door(*device));
  keep(*device);
}

// ---- PINs

base::Duration Book::pin_wait(const Device& device, const std::string& address, Now now) const {
  return std::max(users_wait_.wait(pin_door(device), now.mono),
                  addresses_wait_.wait(address, now.mono));
}

PinAttempt Book::begin_pin(const Device& device, const std::string& address, Now now) {
  Device* const known = find_device(device.id);
  if (known == nullptr) return {{}, address, nobodys_hash()};
  tried(pin_door(*known), address, now);
  ++known->wrong;
  keep(*known);
  return {known->id, address, known->pin};
}

std::optional<Opened<Session>> Book::end_pin(const PinAttempt& attempt, bool right, Now now) {
  Device* const known = find_device(attempt.device);
  if (!right || known == nullptr || known->pin != attempt.hash) return std::nullopt;
  tried_rightly(pin_door(*known), attempt.address);
  known->wrong = 0;
  if (now.wall >= base::kYoungest) known->used = now.wall;
  keep(*known);
  return open_session(known->user, attempt.address, known->name, now, known->id);
}

// ---- invitations

void Book::drop_invitations(const std::string& of) {
  std::erase_if(invited_, [&](const Invited& i) {
    return i.invitation.inviter == of || i.invitation.user == of;
  });
}

std::string Book::invite(Invitation invitation, Now now) {
  std::erase_if(invited_, [&](const Invited& i) {
    const bool open = !i.hash.empty() && i.invitation.inviter == invitation.inviter;
    return now.mono >= i.over || open;
  });
  std::string code = spoken_code();
  invitation.number = ++invitations_;
  invited_.push_back({std::move(invitation), digest(code), now.mono + kInvited});
  return code;
}

bool Book::may_invite(const Invitation& i) const noexcept {
  const User* const inviter = user(i.inviter);
  const bool may = inviter != nullptr && (i.inviter == i.user || inviter->role == Role::Admin);
  return may && user(i.user) != nullptr;
}

/// Whoever invited must still be allowed to.
std::optional<Invitation> Book::take_invitation(std::string_view typed, const std::string& address,
                                                Now now) {
  tried(door_of({}, address), address, now);
  const std::string hash = digest(plain_code(typed));
  for (auto at = invited_.begin(); at != invited_.end(); ++at) {
    if (at->hash.empty() || !same(at->hash, hash)) continue;
    if (now.mono >= at->over || !may_invite(at->invitation)) {
      invited_.erase(at);
      return std::nullopt;
    }
    at->hash.clear();
    tried_rightly(door_of({}, address), address);
    return at->invitation;
  }
  return std::nullopt;
}

bool Book::end_invitation(const Invitation& taken, Now now) {
  const auto at = std::find_if(invited_.begin(), invited_.end(), [&](const Invited& i) {
    return i.hash.empty() && i.invitation.number == taken.number;
  });
  if (at == invited_.end()) return false;
  const bool good = now.mono < at->over && may_invite(at->invitation);
  invited_.erase(at);
  return good;
}

}  // namespace roverd::people
