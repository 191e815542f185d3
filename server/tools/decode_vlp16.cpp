// Datagrams of a Velodyne VLP-16 to named values: out of a capture of the network, or one after
// another as they came.

#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pcap/pcap.hpp"
#include "tools/decode.hpp"
#include "velodyne/codec.hpp"

namespace roverd {
namespace {

using Json = nlohmann::ordered_json;

std::string vlp16_hex(unsigned value) {
  std::array<char, 4> text{};
  std::snprintf(text.data(), text.size(), "%02x", value & 0xFFU);
  return text.data();
}

Json block_object(const velodyne::Block& block) {
  Json ranges = Json::array();
  Json reflectivities = Json::array();
  for (const velodyne::Return& r : block.channels) {
    // 2 mm a word: whole millimetres make short numbers.
    ranges.push_back(r.distance == 0 ? Json(nullptr) : Json(r.distance * 2 / 1000.0));
    reflectivities.push_back(r.reflectivity);
  }
  Json out;
  out["azimuth_deg"] = block.azimuth_cdeg / 100.0;
  out["range_m"] = std::move(ranges);
  out["reflectivity"] = std::move(reflectivities);
  return out;
}

void describe_data(base::Bytes datagram, Json& out) {
  const velodyne::Decoded decoded = velodyne::decode(datagram);
  if (decoded.fault != velodyne::Fault::None) {
    out["refused"] = velodyne::describe(decoded);
    return;
  }
  const velodyne::Packet& p = decoded.packet;
  out["timestamp_us"] = p.stamp_us;
  out["return_mode"] = velodyne::to_string(p.mode);
  out["return_mode_hex"] = vlp16_hex(static_cast<unsigned>(p.mode));
  out["product"] = velodyne::to_string(p.product);
  out["product_hex"] = vlp16_hex(static_cast<unsigned>(p.product));
  out["blocks"] = Json::array();
  for (const velodyne::Block& block : p.blocks) out["blocks"].push_back(block_object(block));
}

void describe_position(base::Bytes datagram, Json& out) {
  const velodyne::DecodedPosition decoded = velodyne::decode_position(datagram);
  if (decoded.fault != velodyne::Fault::None) {
    out["refused"] = "a position packet with a time stamp of more than an hour";
    return;
  }
  out["timestamp_us"] = decoded.position.stamp_us;
  out["pps"] = decoded.position.pps;
  out["nmea"] = decoded.position.nmea;
}

bool is_position(base::Bytes datagram) {
  return datagram.size() == velodyne::kPositionSize;
}

void describe_datagram(base::Bytes datagram, Json& out) {
  out["message"] = is_position(datagram) ? "position" : "data";
  is_position(datagram) ? describe_position(datagram, out) : describe_data(datagram, out);
}

class Vlp16Bytes {
 public:
  explicit Vlp16Bytes(OnObject on_object)
      : on_object_(std::move(on_object)),
        capture_([this](const pcap::Datagram& d) { on_datagram(d); }) {}

  void feed(base::Bytes part) {
    if (kind_ == Kind::Capture) return feed_capture(part);
    rest_.insert(rest_.end(), part.begin(), part.end());
    if (kind_ == Kind::Unknown) {
      if (rest_.size() < 4) return;
      kind_ = pcap::begins_capture(rest_) ? Kind::Capture : Kind::Plain;
      if (kind_ == Kind::Capture) {
        const auto first = std::exchange(rest_, {});
        return feed_capture(first);
      }
    }
    read_plain();
  }
  void finish() {
    if (kind_ == Kind::Capture) return finish_capture();
    skipped_ += rest_.size();
    tell_skipped();
  }

 private:
  enum class Kind { Unknown, Plain, Capture };

  void feed_capture(base::Bytes part) {
    if (broken_) return;
    if (const auto read = capture_.feed(part); !read) tell_broken(read.error());
  }
  void finish_capture() {
    if (!broken_) {
      if (const auto ended = capture_.finish(); !ended) tell_broken(ended.error());
    }
    for (const auto& [cause, n] : capture_.passed_over()) {
      on_object_({{"passed_over", n}, {"refused", cause}});
    }
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
    if (d.payload.size() != velodyne::kPacketSize && !is_position(d.payload)) {
      out["bytes"] = d.payload.size();
      out["refused"] = "neither 1206 bytes (data) nor 512 (position)";
    } else {
      describe_datagram(d.payload, out);
    }
    on_object_(out);
  }

  /// 0: what comes there is neither.
  static std::size_t size_at(base::Bytes bytes) {
    if (bytes[0] == 0xFF && bytes[1] == 0xEE) return velodyne::kPacketSize;
    return looks_like_position(bytes) ? velodyne::kPositionSize : 0;
  }
  /// Without a capture's addresses only what no text has tells it: the state of the pulse is a
  /// small number with three zeros behind it, and then the sentence begins.
  static bool looks_like_position(base::Bytes bytes) {
    constexpr std::size_t kStateAt = 202;
    constexpr std::size_t kSentenceAt = 206;
    if (bytes[kStateAt] > 3) return false;
    for (std::size_t i = kStateAt + 1; i < kSentenceAt; ++i) {
      if (bytes[i] != 0) return false;
    }
    const std::string_view sentence(reinterpret_cast<const char*>(bytes.data()) + kSentenceAt, 7);
    return sentence.starts_with("$G") && sentence.substr(3) == "RMC,";
  }
  void read_plain() {
    std::size_t at = 0;
    while (rest_.size() - at >= velodyne::kPositionSize) {
      const base::Bytes here = base::Bytes(rest_).subspan(at);
      const std::size_t size = size_at(here);
      if (size == 0) {
        ++skipped_;
        ++at;
        continue;
      }
      if (here.size() < size) break;
      tell_skipped();
      Json out;
      out["packet"] = packets_++;
      describe_datagram(here.first(size), out);
      on_object_(out);
      at += size;
    }
    rest_.erase(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(at));
  }
  void tell_skipped() {
    if (skipped_ == 0) return;
    on_object_({{"skipped_bytes", skipped_}, {"refused", "outside any packet"}});
    skipped_ = 0;
  }

  const OnObject on_object_;
  pcap::Reader capture_;
  Kind kind_ = Kind::Unknown;
  std::vector<std::uint8_t> rest_;
  std::uint64_t packets_ = 0;
  std::uint64_t skipped_ = 0;
  bool broken_ = false;
};

}  // namespace

Reader vlp16_reader(OnObject on_object) {
  const auto bytes = std::make_shared<Vlp16Bytes>(std::move(on_object));
  return {.feed = [bytes](base::Bytes part) { bytes->feed(part); },
          .finish = [bytes] { bytes->finish(); }};
}

}  // namespace roverd
