#include "announce/announcer.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include <avahi-client/client.h>
#include <avahi-client/publish.h>
#include <avahi-common/error.h>
#include <avahi-common/malloc.h>
#include <avahi-common/simple-watch.h>
#include <avahi-common/strlst.h>

namespace roverd::announce {
namespace {

constexpr const char* kNoDaemon = "no avahi-daemon runs";
constexpr int kLook_ms = 200;  // so soon it hears that it is to end
constexpr auto kAgain = std::chrono::seconds(5);
/// To take everything back. A daemon that hangs holds its caller for half a minute.
constexpr auto kGoodbye = std::chrono::seconds(1);
constexpr int kMostRobots = 99;
constexpr std::uint32_t kAliasLives_s = 120;  // as host names do

struct FreePoll {
  void operator()(AvahiSimplePoll* poll) const noexcept { avahi_simple_poll_free(poll); }
};
struct FreeClient {
  void operator()(AvahiClient* client) const noexcept { avahi_client_free(client); }
};
struct FreeList {
  void operator()(AvahiStringList* list) const noexcept { avahi_string_list_free(list); }
};

std::unique_ptr<AvahiStringList, FreeList> list_of(const std::vector<std::string>& facts) {
  AvahiStringList* list = nullptr;
  for (auto one = facts.rbegin(); one != facts.rend(); ++one) {
    list = avahi_string_list_add_arbitrary(list, reinterpret_cast<const std::uint8_t*>(one->data()),
                                           one->size());
  }
  return std::unique_ptr<AvahiStringList, FreeList>(list);
}

}  // namespace

/// Its thread holds it, too, and outlives the announcer where the daemon hangs.
class Announcer::Impl : public std::enable_shared_from_this<Announcer::Impl> {
 public:
  Impl(Service service, std::function<void(News)> tell)
      : tell_(std::move(tell)), service_(std::move(service)) {
    set_name();
  }
  ~Impl() = default;
  void begin() {
    std::thread([self = shared_from_this()] {
      self->run();
      const std::lock_guard lock(self->mutex_);
      self->gone_ = true;
      self->end_.notify_all();
    }).detach();
  }
  /// Nothing is told any more when this returns.
  void end() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    end_.notify_all();
    const std::lock_guard telling(telling_);
    std::unique_lock lock(mutex_);
    end_.wait_for(lock, kGoodbye, [this] { return gone_; });
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  State state() const {
    const std::lock_guard lock(mutex_);
    return state_;
  }

  void change(Service service) {
    const std::lock_guard lock(mutex_);
    if (service == service_) return;
    service_ = std::move(service);
    changed_ = true;
  }

 private:
  void run() {
    while (!ended_) {
      listen();
      std::unique_lock lock(mutex_);
      end_.wait_for(lock, kAgain, [this] { return ended_.load(); });
    }
  }

  /// With one connection to the daemon, until that breaks.
  void listen() {
    const std::unique_ptr<AvahiSimplePoll, FreePoll> poll(avahi_simple_poll_new());
    if (!poll) return;
    broken_ = false;
    group_ = nullptr;
    int error = 0;
    const auto on_client = [](AvahiClient* client, AvahiClientState state, void* self) {
      static_cast<Impl*>(self)->take(client, state);
    };
    // It also waits for a daemon that is started later.
    const std::unique_ptr<AvahiClient, FreeClient> client(avahi_client_new(
        avahi_simple_poll_get(poll.get()), AVAHI_CLIENT_NO_FAIL, on_client, this, &error));
    if (!client)
      return fail("no avahi-daemon can be reached (" + std::string(avahi_strerror(error)) + ")");
    while (!ended_ && !broken_ && avahi_simple_poll_iterate(poll.get(), kLook_ms) == 0) {
      if (changed_.exchange(false) && group_ != nullptr) publish(client.get());
    }
  }

  void take(AvahiClient* client, AvahiClientState state) {
    switch (state) {
      case AVAHI_CLIENT_S_RUNNING:
        return publish(client);
      case AVAHI_CLIENT_S_COLLISION:
      case AVAHI_CLIENT_S_REGISTERING:
        // This computer is getting another name or address; running comes again.
        if (group_ != nullptr) avahi_entry_group_reset(group_);
        return;
      case AVAHI_CLIENT_CONNECTING:
        return fail(kNoDaemon);
      case AVAHI_CLIENT_FAILURE:
        broken_ = true;
        return fail(avahi_client_errno(client) == AVAHI_ERR_DISCONNECTED ? kNoDaemon
                                                                         : cause(client));
    }
  }

  void take(AvahiClient* client, AvahiEntryGroupState state) {
    if (state == AVAHI_ENTRY_GROUP_ESTABLISHED) return established();
    if (state == AVAHI_ENTRY_GROUP_COLLISION && next_name()) return publish(client);
    if (state == AVAHI_ENTRY_GROUP_COLLISION || state == AVAHI_ENTRY_GROUP_FAILURE) {
      broken_ = true;
      fail("the avahi-daemon refuses (" + cause(client) + ")");
    }
  }

  void publish(AvahiClient* client) {
    if (group_ == nullptr) {
      const auto on_group = [](AvahiEntryGroup* group, AvahiEntryGroupState state, void* self) {
        static_cast<Impl*>(self)->group_ = group;
        static_cast<Impl*>(self)->take(avahi_entry_group_get_client(group), state);
      };
      group_ = avahi_entry_group_new(client, on_group, this);
    }
    int error = group_ == nullptr ? avahi_client_errno(client) : AVAHI_ERR_COLLISION;
    while (error == AVAHI_ERR_COLLISION) {
      error = fill(client);
      if (error == AVAHI_ERR_COLLISION && !next_name()) break;
    }
    if (error == AVAHI_OK) return;
    broken_ = true;
    fail("the avahi-daemon refuses (" + std::string(avahi_strerror(error)) + ")");
  }

  /// @return avahi's error: a name that is taken on this computer is known at once
  int fill(AvahiClient* client) {
    const auto [service, which] = wanted();
    const std::string name = numbered(service.name, which);
    const std::string alias = numbered(service.label, which) + ".local";
    const auto facts = list_of(txt_of(service));
    int error = avahi_entry_group_reset(group_);
    for (const char* type : {"_roverd._tcp", "_https._tcp"}) {
      if (error < 0) return error;
      error = avahi_entry_group_add_service_strlst(group_, AVAHI_IF_UNSPEC, AVAHI_PROTO_UNSPEC, {},
                                                   name.c_str(), type, nullptr, nullptr,
                                                   service.port, facts.get());
    }
    if (error < 0) return error;
    const char* known = avahi_client_get_host_name_fqdn(client);
    const std::string own = known == nullptr ? "" : known;
    if (alias != own && !own.empty()) {
      const std::string target = wire_name(own);
      error = avahi_entry_group_add_record(
          group_, AVAHI_IF_UNSPEC, AVAHI_PROTO_UNSPEC, AVAHI_PUBLISH_UNIQUE, alias.c_str(),
          AVAHI_DNS_CLASS_IN, AVAHI_DNS_TYPE_CNAME, kAliasLives_s, target.data(), target.size());
      if (error < 0) return error;
    }
    computer_ = own;
    set_name();
    return avahi_entry_group_commit(group_);
  }

  void established() {
    State now;
    {
      const std::lock_guard lock(mutex_);
      state_.told = true;
      state_.trouble.clear();
      now = state_;
    }
    const std::string text = "this robot is found as " + now.name + ", at " + now.host;
    if (std::exchange(told_, text) != text) say({text});
  }

  bool next_name() {
    std::string text;
    {
      const std::lock_guard lock(mutex_);
      if (which_ >= kMostRobots) return false;
      text = "another robot in this network is called " + numbered(service_.name, which_) +
             ": this one is " + numbered(service_.name, which_ + 1) + " there";
      ++which_;
    }
    set_name();
    say({text, true});
    return true;
  }

  void set_name() {
    const std::lock_guard lock(mutex_);
    state_.name = numbered(service_.name, which_);
    state_.host = numbered(service_.label, which_) + ".local";
    state_.hosts = {state_.host};
    if (!computer_.empty() && computer_ != state_.host) state_.hosts.push_back(computer_);
  }

  void fail(const std::string& why) {
    {
      const std::lock_guard lock(mutex_);
      state_.told = false;
      state_.trouble = why;
    }
    if (std::exchange(told_, why) != why) say({why, true});
  }

  void say(News news) {
    const std::lock_guard telling(telling_);
    if (!ended_) tell_(std::move(news));
  }

  std::pair<Service, int> wanted() const {
    const std::lock_guard lock(mutex_);
    return {service_, which_};
  }

  static std::string cause(AvahiClient* client) {
    return avahi_strerror(avahi_client_errno(client));
  }

  const std::function<void(News)> tell_;
  std::atomic<bool> ended_{false};
  std::atomic<bool> changed_{false};
  std::condition_variable end_;
  mutable std::mutex mutex_;
  std::mutex telling_;  ///< held while something is told; before mutex_
  bool gone_ = false;   ///< the thread; guarded by mutex_
  Service service_;
  State state_;
  int which_ = 1;
  // Its own thread's.
  bool broken_ = false;
  AvahiEntryGroup* group_ = nullptr;  ///< the client's, and freed with it
  std::string computer_;              ///< "raspberrypi.local"
  std::string told_;
};

Announcer::Announcer(Service service, std::function<void(News)> tell)
    : impl_(std::make_shared<Impl>(std::move(service), std::move(tell))) {
  impl_->begin();
}

Announcer::~Announcer() {
  impl_->end();
}

State Announcer::state() const {
  return impl_->state();
}

void Announcer::change(Service service) {
  impl_->change(std::move(service));
}

}  // namespace roverd::announce
