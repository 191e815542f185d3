#include "api/metrics.hpp"

#include <string_view>

namespace roverd::api {

namespace {

class Writer {
 public:
  void family(std::string_view name, std::string_view type, std::string_view help) {
    text_ += "# HELP " + std::string(name) + " " + std::string(help) + "\n# TYPE " +
             std::string(name) + " " + std::string(type) + "\n";
  }
  template <class N>
  void sample(std::string_view name, N value, std::string_view labels = {}) {
    text_ += name;
    if (!labels.empty()) text_ += "{" + std::string(labels) + "}";
    text_ += " " + Json(value).dump() + "\n";
  }
  template <class N>
  void one(std::string_view name, std::string_view type, std::string_view help, N value) {
    family(name, type, help);
    sample(name, value);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// Device names are short words of ours, but a quote must not break the format.
std::string label(std::string_view key, std::string_view value) {
  std::string out = std::string(key) + "=\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out + "\"";
}

void write_loop(Writer& out, const base::LoopHealth& loop) {
  out.one("roverd_loop_ticks_total", "counter", "Ticks of the control loop.", loop.ticks);
  out.one("roverd_loop_late_ticks_total", "counter", "Woken more than one period late.",
          loop.late_ticks);
  out.one("roverd_loop_faults_total", "counter",
          "Ticks that an exception ended: the robot disarmed itself.", loop.faults);
  constexpr std::string_view kName = "roverd_loop_lateness_seconds";
  out.family(kName, "histogram", "How late the control loop woke.");
  std::uint64_t sum = 0;
  const std::string bucket = std::string(kName) + "_bucket";
  for (std::size_t i = 0; i < loop.lateness_log2_us.size(); ++i) {
    sum += loop.lateness_log2_us[i];
    const bool last = i + 1 == loop.lateness_log2_us.size();
    const double bound_s = static_cast<double>(std::uint64_t{1} << i) * 1e-6;
    out.sample(bucket, sum, label("le", last ? "+Inf" : Json(bound_s).dump()));
  }
  out.sample(std::string(kName) + "_count", sum);
}

void write_drivers(Writer& out, const std::vector<base::DriverStatus>& drivers) {
  out.family("roverd_driver_up", "gauge", "1 while the driver is up.");
  for (const auto& d : drivers) {
    out.sample("roverd_driver_up", d.phase == base::DriverPhase::Up ? 1 : 0,
               label("driver", d.name));
  }
  out.family("roverd_driver_received_total", "counter", "Frames or sentences understood.");
  for (const auto& d : drivers) {
    out.sample("roverd_driver_received_total", d.received, label("driver", d.name));
  }
  out.family("roverd_driver_refused_total", "counter", "Damaged or out of range.");
  for (const auto& d : drivers) {
    out.sample("roverd_driver_refused_total", d.refused, label("driver", d.name));
  }
}

}  // namespace

std::string metrics_text(const MetricsInput& in) {
  Writer out;
  out.family("roverd_info", "gauge", "Version of the program.");
  out.sample("roverd_info", 1, label("version", in.version));
  out.one("roverd_uptime_seconds", "gauge", "Since the start.", in.uptime_s);
  if (in.snapshot) {
    write_loop(out, in.snapshot->loop);
    write_drivers(out, in.snapshot->drivers);
    out.one("roverd_armed", "gauge", "1 while armed.", in.snapshot->armed ? 1 : 0);
  }
  out.one("roverd_http_connections", "gauge", "Open now.", in.net.connections);
  out.one("roverd_stream_clients", "gauge", "WebSockets open now.", in.net.clients);
  out.one("roverd_http_accepted_total", "counter", "Connections accepted.", in.net.accepted);
  out.one("roverd_http_refused_total", "counter", "Connections beyond the limit.", in.net.refused);
  out.one("roverd_http_timed_out_total", "counter", "Too slow, or silent for too long.",
          in.net.timed_out);
  out.one("roverd_http_requests_total", "counter", "Requests read.", in.net.requests);
  out.one("roverd_stream_messages_total", "counter", "Messages for clients.", in.net.delivered);
  out.one("roverd_stream_dropped_total", "counter", "Messages that slow clients missed.",
          in.net.dropped);
  out.one("roverd_events_lost_total", "counter", "Events that could not be stored.",
          in.lost_events);
  out.one("roverd_measurements_lost_total", "counter", "Measurements that found no room.",
          in.lost_measurements);
  return out.take();
}

}  // namespace roverd::api
