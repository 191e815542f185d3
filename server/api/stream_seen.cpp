// What the sensors see, on the live stream: made when somebody looks, and for all who look.

#include <optional>
#include <string>

#include "api/json/plain_json.hpp"
#include "api/json/words.hpp"
#include "api/stream.hpp"
#include "api/topics.hpp"

namespace roverd::api {

void StreamTexts::add_seen_topics() {
  using Words = Json (*)(const robot::Outlook&, const base::Snapshot&, base::Time);
  const auto add = [this](const char* topic, Words words) {
    stream_.add_sampled_topic(
        topic, [this, topic, words](std::uint64_t seq) -> std::optional<std::string> {
          const auto snapshot = context_->deps.robot.snapshot();
          const auto seen = context_->outlook();
          if (!snapshot || !seen) return std::nullopt;
          return stream_text(topic, seq, plain_json(words(*seen, *snapshot, base::steady_now())));
        });
  };
  add(kScan, scan_json);
  add(kGrid, grid_json);
  add(kObstacles, [](const robot::Outlook& seen, const base::Snapshot& snapshot, base::Time now) {
    return obstacles_json(&seen, snapshot, now);
  });
  stream_.add_sampled_topic(kRow, [this](std::uint64_t seq) -> std::optional<std::string> {
    const auto snapshot = context_->deps.robot.snapshot();
    if (!snapshot) return std::nullopt;
    return stream_text(kRow, seq, plain_json(row_now_json(snapshot->row)));
  });
}

}  // namespace roverd::api
