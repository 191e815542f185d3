#pragma once
// The inside of Api. Only api.cpp and requests.cpp include it. Web thread only.

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/api.hpp"
#include "api/context.hpp"
#include "api/idempotency.hpp"
#include "api/shares.hpp"
#include "api/stream.hpp"

namespace roverd::api {

inline constexpr std::string_view kBase = "/api/v1";

struct Api::Impl {
  explicit Impl(Deps deps) : context(std::make_shared<Context>(std::move(deps))) {
    if (!context->deps.aside) return;
    idempotency.aside = [this](std::function<void()> work, std::function<void()> then) {
      context->deps.aside({std::move(work), std::move(then), Aside::Size::Small, true});
    };
  }

  void handle(const CallPtr& call);
  void handle_next();
  void next_turn();
  void route(const CallPtr& call);
  void serve_page(const CallPtr& call, std::string_view path);
  bool is_too_much(const Call& call) const;
  void watch(const CallPtr& call, const Route& route);
  void look_at_people();

  ContextPtr context;
  Idempotency idempotency;
  std::unique_ptr<StreamTexts> stream;
  int unanswered = 0;
  /// By user. There must be room for the others.
  Shares unanswered_of{48};
  std::deque<CallPtr> turns;  ///< requests that wait for theirs
  bool turn_comes = false;    ///< handle_next is on its way
  std::map<std::string, std::uint64_t> driver_counts;
  base::Time counted;
  std::vector<robot::PendingReply> replies;
  std::vector<base::Event> events;
};

}  // namespace roverd::api
