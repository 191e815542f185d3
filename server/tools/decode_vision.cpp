// Datagrams of a vision program to named values: out of a capture of the network, or one a line as
// somebody noted them.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pcap/pcap.hpp"
#include "tools/decode.hpp"
#include "vision/codec.hpp"

namespace roverd {
namespace {

using Json = nlohmann::ordered_json;

/// A datagram is no longer.
constexpr std::size_t kLongestVision = 65'535;

Json point_object(const vision::Point& p) {
  return {{"x_m", p.x_m}, {"y_m", p.y_m}, {"z_m", p.z_m}};
}

void describe_vision(base::Bytes datagram, Json& out) {
  const vision::Decoded decoded = vision::decode(datagram);
  if (decoded.fault != vision::Fault::None) {
    out["refused"] = vision::describe(decoded);
    return;
  }
  const vision::Datagram& d = decoded.datagram;
  out["names"] = d.names;
  out["landmarks"] = Json::array();
  for (const vision::Landmark& l : d.landmarks) {
    Json one{{"name", d.names[l.name]}};
    one.update(point_object(l.at));
    out["landmarks"].push_back(std::move(one));
  }
  out["obstacles"] = Json::array();
  for (const vision::Point& p : d.obstacles) out["obstacles"].push_back(point_object(p));
  out["planes"] = Json::array();
  for (const vision::Plane& p : d.planes) {
    out["planes"].push_back(
        {{"centre", point_object(p.centre)}, {"normal", point_object(p.normal)}, {"size", p.size}});
  }
}

class VisionBytes {
 public:
  explicit VisionBytes(OnObject on_object)
      : on_object_(std::move(on_object)),
        capture_([this](const pcap::Datagram& d) { on_datagram(d); }) {}

  void feed(base::Bytes part) {
    if (kind_ == Kind::Capture) return feed_capture(part);
    if (kind_ == Kind::Lines) return feed_lines(part);
    head_.insert(head_.end(), part.begin(), part.end());
    if (head_.size() >= 4) begin();
  }
  void finish() {
    if (kind_ == Kind::Unknown) begin();
    if (kind_ == Kind::Lines) return end_line();
    if (!broken_) {
      if (const auto ended = capture_.finish(); !ended) tell_broken(ended.error());
    }
    for (const auto& [cause, n] : capture_.passed_over()) {
      on_object_({{"passed_over", n}, {"refused", cause}});
    }
  }

 private:
  enum class Kind { Unknown, Lines, Capture };

  void begin() {
    const auto head = std::exchange(head_, {});
    const bool capture = head.size() >= 4 && pcap::begins_capture(head);
    kind_ = capture ? Kind::Capture : Kind::Lines;
    capture ? feed_capture(head) : feed_lines(head);
  }
  void feed_capture(base::Bytes part) {
    if (broken_) return;
    if (const auto read = capture_.feed(part); !read) tell_broken(read.error());
  }
  void tell_broken(const base::Error& error) {
    broken_ = true;
    on_object_({{"capture", "broken"}, {"refused", error.detail}});
  }
  void on_datagram(const pcap::Datagram& d) {
    Json out;
    out["packet"] = packets_++;
    out["time"] = base::to_rfc3339(d.stamp);
    out["from"] = pcap::to_string(d.from);
    out["to_port"] = d.to.port;
    describe_vision(d.payload, out);
    on_object_(out);
  }

  void feed_lines(base::Bytes part) {
    for (const std::uint8_t b : part) {
      if (b == '\n') {
        end_line();
      } else if (line_.size() <= kLongestVision) {
        line_.push_back(b);
      }
    }
  }
  void end_line() {
    if (!line_.empty() && line_.back() == '\r') line_.pop_back();
    if (line_.empty()) return;
    Json out;
    out["packet"] = packets_++;
    if (line_.size() > kLongestVision) {
      out["refused"] = "longer than any datagram";
    } else {
      describe_vision(line_, out);
    }
    line_.clear();
    on_object_(out);
  }

  const OnObject on_object_;
  pcap::Reader capture_;
  Kind kind_ = Kind::Unknown;
  std::vector<std::uint8_t> head_;
  std::vector<std::uint8_t> line_;  ///< one byte too many at most
  std::uint64_t packets_ = 0;
  bool broken_ = false;
};

}  // namespace

Reader vision_reader(OnObject on_object) {
  const auto bytes = std::make_shared<VisionBytes>(std::move(on_object));
  return {.feed = [bytes](base::Bytes part) { bytes->feed(part); },
          .finish = [bytes] { bytes->finish(); }};
}

}  // namespace roverd
