#include "net/hub.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <utility>

#include "net/frame.hpp"
#include "net/session.hpp"

namespace roverd::net {

/// One sampled topic at one rate. Kept when its last client leaves, so that its numbers go on.
struct Hub::Channel {
  Channel(boost::asio::io_context& io, Topic& of, std::uint64_t slot_id, std::int64_t ms)
      : timer(io), topic(of), slot(slot_id), period(ms) {}

  boost::asio::steady_timer timer;
  Topic& topic;
  std::uint64_t slot;
  std::chrono::milliseconds period;
  std::uint64_t seq = 0;
  Frame last;
  std::vector<Session*> clients;
};

struct Hub::Topic {
  Render render;  ///< empty: an event topic
  std::map<std::int64_t, std::unique_ptr<Channel>> channels;
  std::uint64_t seq = 0;
  std::vector<Session*> clients;  ///< of an event topic
};

namespace {

std::int64_t period_ms(double rate_hz) {
  const double rate =
      rate_hz > 0.0 ? std::clamp(rate_hz, Hub::kMinRate_hz, Hub::kMaxRate_hz) : Hub::kMaxRate_hz;
  return std::llround(1000.0 / rate);
}

}  // namespace

Hub::Hub(boost::asio::io_context& io) : io_(io) {}
Hub::~Hub() = default;

void Hub::add_sampled_topic(std::string name, Render render) {
  auto topic = std::make_unique<Topic>();
  topic->render = std::move(render);
  topics_[std::move(name)] = std::move(topic);
}

void Hub::add_event_topic(std::string name) {
  topics_[std::move(name)] = std::make_unique<Topic>();
}

bool Hub::has_topic(std::string_view name) const {
  return topics_.find(name) != topics_.end();
}

void Hub::arm(Channel& channel) {
  channel.timer.async_wait([this, &channel](boost::system::error_code ec) {
    if (ec || channel.clients.empty()) return;
    // From the planned time, so that the rate holds; a missed turn is left out, never made up for.
    const auto now = std::chrono::steady_clock::now();
    auto due = channel.timer.expiry() + channel.period;
    if (due <= now) due = now + channel.period;
    channel.timer.expires_at(due);
    try {
      fire(channel);
    } catch (const std::bad_alloc&) {
      // This one is left out.
    }
    arm(channel);
  });
}

void Hub::fire(Channel& channel) {
  const std::optional<std::string> text = channel.topic.render(channel.seq + 1);
  if (!text) return;
  ++channel.seq;
  channel.last = text_frame(*text);
  for (Session* client : channel.clients) client->offer(channel.slot, channel.last);
  delivered_ += channel.clients.size();
}

void Hub::subscribe(ClientId client, const std::map<std::string, double>& rates) {
  const auto found = clients_.find(client);
  if (found == clients_.end()) return;
  Session* session = found->second;
  unsubscribe(session);
  for (const auto& [name, rate] : rates) {
    const auto at = topics_.find(name);
    if (at == topics_.end()) continue;
    Topic& topic = *at->second;
    if (!topic.render) {
      topic.clients.push_back(session);
      continue;
    }
    auto& channel = topic.channels[period_ms(rate)];
    if (!channel) {
      channel = std::make_unique<Channel>(io_, topic, next_slot_++, period_ms(rate));
    }
    channel->clients.push_back(session);
    if (channel->clients.size() == 1) {
      fire(*channel);
      channel->timer.expires_after(channel->period);
      arm(*channel);
    } else if (channel->last) {
      session->offer(channel->slot, channel->last);
    }
  }
}

void Hub::unsubscribe(Session* session) {
  for (auto& [name, topic] : topics_) {
    std::erase(topic->clients, session);
    for (auto& [period, channel] : topic->channels) {
      if (std::erase(channel->clients, session) > 0 && channel->clients.empty()) {
        channel->timer.cancel();
      }
    }
  }
}

void Hub::publish(std::string_view topic, const Render& render) {
  const auto at = topics_.find(topic);
  if (at == topics_.end()) return;
  const std::optional<std::string> text = render(at->second->seq + 1);
  if (!text) return;
  ++at->second->seq;
  if (at->second->clients.empty()) return;
  const Frame frame = text_frame(*text);
  for (Session* client : at->second->clients) client->push(frame);
  delivered_ += at->second->clients.size();
}

void Hub::send(ClientId client, std::string_view text) {
  if (const auto found = clients_.find(client); found != clients_.end()) {
    found->second->push(text_frame(text));
  }
}

void Hub::close(ClientId client, std::uint16_t code, std::string_view reason) {
  if (const auto found = clients_.find(client); found != clients_.end()) {
    found->second->close(code, reason);
  }
}

void Hub::join(ClientId id, Session* session) {
  clients_[id] = session;
}

void Hub::leave(ClientId id) {
  const auto found = clients_.find(id);
  if (found == clients_.end()) return;
  dropped_by_gone_ += found->second->dropped();
  unsubscribe(found->second);
  clients_.erase(found);
}

std::uint64_t Hub::dropped() const noexcept {
  std::uint64_t sum = dropped_by_gone_;
  for (const auto& [id, session] : clients_) sum += session->dropped();
  return sum;
}

}  // namespace roverd::net
