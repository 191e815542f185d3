// Load for the server: many WebSocket clients at one rate and REST calls at a steady pace, from one
// thread that costs little, because it shares the machine's cores with what it measures.
// Prints one JSON line: what was delivered, and how late.
//
//   roverd-load ADDRESS CLIENTS RATE_HZ CALLS_PER_S SECONDS      (ADDRESS: 127.0.0.1:8080)

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <sys/epoll.h>
#include <unistd.h>

#include "load/client.hpp"

namespace roverd::load {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::duration;

struct Plan {
  Address to;
  int clients = 0;
  double rate_hz = 0.0;
  double calls_per_s = 0.0;
  double seconds = 0.0;
};

double number(std::string_view text, const char* name) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value >= 0.0)) {
    throw std::runtime_error(std::string(name) +
                             " is not a number of 0 or more: " + std::string(text));
  }
  return value;
}

Plan read_plan(const std::vector<std::string_view>& words) {
  if (words.size() != 5) {
    throw std::runtime_error("wants ADDRESS CLIENTS RATE_HZ CALLS_PER_S SECONDS");
  }
  const auto colon = words[0].rfind(':');
  if (colon == std::string_view::npos) throw std::runtime_error("ADDRESS is HOST:PORT");
  Plan plan;
  plan.to = {std::string(words[0].substr(0, colon)),
             static_cast<std::uint16_t>(number(words[0].substr(colon + 1), "port"))};
  plan.clients = static_cast<int>(number(words[1], "CLIENTS"));
  plan.rate_hz = number(words[2], "RATE_HZ");
  plan.calls_per_s = number(words[3], "CALLS_PER_S");
  plan.seconds = number(words[4], "SECONDS");
  return plan;
}

/// Milliseconds of the day in a message's "time":"2026-03-01T12:00:00.250Z"; empty without one.
std::optional<double> stamp_ms(std::string_view text) {
  const std::string_view field = "\"time\":\"";
  const auto at = text.find(field);
  if (at == std::string_view::npos || text.size() < at + field.size() + 24) return std::nullopt;
  const std::string_view t = text.substr(at + field.size() + 11, 12);  // 12:00:00.250
  int parts[4] = {};
  const std::size_t starts[] = {0, 3, 6, 9};
  const std::size_t lengths[] = {2, 2, 2, 3};
  for (int i = 0; i < 4; ++i) {
    const char* begin = t.data() + starts[i];
    if (std::from_chars(begin, begin + lengths[i], parts[i]).ec != std::errc{}) {
      return std::nullopt;
    }
  }
  return ((parts[0] * 60.0 + parts[1]) * 60.0 + parts[2]) * 1000.0 + parts[3];
}

double wall_ms_of_day() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::fmod(duration<double, std::milli>(now).count(), 86'400'000.0);
}

/// @param share in (0, 1]. 0 of an empty list.
double percentile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  const auto at = std::min(values.size() - 1,
                           static_cast<std::size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

struct Caller {
  std::unique_ptr<Connection> connection;
  std::optional<Clock::time_point> asked;
};

class Load {
 public:
  explicit Load(Plan plan) : plan_(std::move(plan)), poll_(::epoll_create1(EPOLL_CLOEXEC)) {
    if (poll_ < 0) throw std::runtime_error("epoll_create1 failed");
    for (int i = 0; i < plan_.clients; ++i) add_client();
  }
  ~Load() { ::close(poll_); }
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;

  void run();
  void report();

 private:
  static constexpr std::size_t kCallers = 16;
  static constexpr auto kSettling = std::chrono::milliseconds(500);

  void add_client();
  std::vector<Caller>::iterator idle_caller();
  void watch(int handle, std::uint32_t index);
  void call(Clock::time_point now);
  void on_ready(std::uint32_t index);
  void on_frames(Connection& client);

  const Plan plan_;
  const int poll_;
  Clock::time_point counts_from_;
  std::vector<std::unique_ptr<Connection>> clients_;
  std::vector<Caller> callers_;
  std::vector<double> message_ms_;
  std::vector<double> call_ms_;
  long messages_ = 0;
  long bytes_ = 0;
  long lost_ = 0;
  long calls_ = 0;
  long refused_ = 0;  ///< answers other than 200
  long unsent_ = 0;   ///< due calls for which every caller still waited
  double took_s_ = 0.0;
  std::size_t next_path_ = 0;
};

void Load::watch(int handle, std::uint32_t index) {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u32 = index;
  if (::epoll_ctl(poll_, EPOLL_CTL_ADD, handle, &event) != 0) {
    throw std::runtime_error("epoll_ctl failed");
  }
}

void Load::add_client() {
  auto client = std::make_unique<Connection>(plan_.to);
  client->upgrade(plan_.to, "/api/v1/stream");
  char subscribe[80];
  std::snprintf(subscribe, sizeof subscribe, "{\"subscribe\":{\"vehicle\":%g}}", plan_.rate_hz);
  client->send(masked_frame(1, subscribe));
  watch(client->handle(), static_cast<std::uint32_t>(clients_.size()));
  clients_.push_back(std::move(client));
}

/// A caller that waits for no answer, the connected ones first: the server hangs up on those that
/// ask nothing for long. The end if all are busy.
std::vector<Caller>::iterator Load::idle_caller() {
  auto caller = std::find_if(callers_.begin(), callers_.end(),
                             [](const Caller& c) { return c.connection && !c.asked; });
  if (caller != callers_.end()) return caller;
  caller =
      std::find_if(callers_.begin(), callers_.end(), [](const Caller& c) { return !c.connection; });
  if (caller == callers_.end()) {
    if (callers_.size() == kCallers) return caller;
    callers_.emplace_back();
    caller = std::prev(callers_.end());
  }
  caller->connection = std::make_unique<Connection>(plan_.to);
  const auto index = static_cast<std::size_t>(caller - callers_.begin());
  watch(caller->connection->handle(), static_cast<std::uint32_t>(clients_.size() + index));
  return caller;
}

void Load::call(Clock::time_point now) {
  static constexpr std::string_view kPaths[] = {"vehicle", "vehicle/checks", "missions?limit=20",
                                                "execution", "drivers"};
  const auto idle = idle_caller();
  if (idle == callers_.end()) {
    ++unsent_;
    return;
  }
  const std::string_view path = kPaths[next_path_++ % std::size(kPaths)];
  idle->asked = now;
  idle->connection->send("GET /api/v1/" + std::string(path) + " HTTP/1.1\r\nHost: " +
                         plan_.to.host + ":" + std::to_string(plan_.to.port) + "\r\n\r\n");
}

void Load::on_frames(Connection& client) {
  while (const auto frame = client.take_frame()) {
    if (frame->opcode == 9) client.send(masked_frame(10, frame->text));
    if (frame->opcode != 1) continue;
    if (Clock::now() < counts_from_) continue;
    ++messages_;
    bytes_ += static_cast<long>(frame->text.size());
    if (const auto stamp = stamp_ms(frame->text)) message_ms_.push_back(wall_ms_of_day() - *stamp);
  }
}

void Load::on_ready(std::uint32_t index) {
  if (index < clients_.size()) {
    auto& client = clients_[index];
    if (client->receive()) return on_frames(*client);
    ++lost_;
    ::epoll_ctl(poll_, EPOLL_CTL_DEL, client->handle(), nullptr);
    return;
  }
  Caller& caller = callers_[index - clients_.size()];
  if (!caller.connection->receive()) {
    if (caller.asked) ++lost_;
    ::epoll_ctl(poll_, EPOLL_CTL_DEL, caller.connection->handle(), nullptr);
    caller = {};
    return;
  }
  if (const auto status = caller.connection->take_answer(); status && caller.asked) {
    call_ms_.push_back(duration<double, std::milli>(Clock::now() - *caller.asked).count());
    caller.asked.reset();
    ++calls_;
    if (*status != 200) ++refused_;
  }
}

void Load::run() {
  // While the later clients still connected, messages for the earlier ones waited unread here: they
  // tell nothing about the server, so the first moment is read but not counted.
  const auto begin = Clock::now() + kSettling;
  counts_from_ = begin;
  const auto end =
      begin + std::chrono::duration_cast<Clock::duration>(duration<double>(plan_.seconds));
  const auto period = std::chrono::duration_cast<Clock::duration>(
      duration<double>(plan_.calls_per_s > 0.0 ? 1.0 / plan_.calls_per_s : 3600.0));
  auto next_call = begin + period;
  epoll_event events[64];
  for (auto now = Clock::now(); now < end; now = Clock::now()) {
    for (; plan_.calls_per_s > 0.0 && next_call <= now; next_call += period) call(now);
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(std::min(next_call, end) - now);
    const int n =
        ::epoll_wait(poll_, events, 64, static_cast<int>(std::max<long>(left.count(), 0)));
    for (int i = 0; i < n; ++i) on_ready(events[i].data.u32);
  }
  took_s_ = duration<double>(Clock::now() - begin).count();
}

void Load::report() {
  std::printf(
      "{\"seconds\":%.2f,\"clients\":%d,\"messages\":%ld,\"message_bytes\":%.0f,"
      "\"messages_per_client_hz\":%.2f,\"message_p50_ms\":%.2f,\"message_p99_ms\":%.2f,"
      "\"calls\":%ld,\"calls_per_s\":%.1f,\"call_p50_ms\":%.2f,\"call_p99_ms\":%.2f,"
      "\"refused\":%ld,\"unsent\":%ld,\"lost\":%ld}\n",
      took_s_, plan_.clients, messages_,
      messages_ > 0 ? static_cast<double>(bytes_) / static_cast<double>(messages_) : 0.0,
      plan_.clients > 0 ? static_cast<double>(messages_) / plan_.clients / took_s_ : 0.0,
      percentile(message_ms_, 0.5), percentile(message_ms_, 0.99), calls_,
      static_cast<double>(calls_) / took_s_, percentile(call_ms_, 0.5), percentile(call_ms_, 0.99),
      refused_, unsent_, lost_);
}

}  // namespace
}  // namespace roverd::load

int main(int argc, char** argv) {
  try {
    roverd::load::Load load(
        roverd::load::read_plan(std::vector<std::string_view>(argv + 1, argv + argc)));
    load.run();
    load.report();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "roverd-load: %s\n", error.what());
    return 1;
  }
}
