#include "link/record.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include "link/candump.hpp"
#include "link/recording.hpp"
#include "pcap/pcap.hpp"

namespace roverd::link {
namespace {

/// A full 1 Mbit/s bus fills this in half a second, the control loop in a minute.
constexpr std::size_t kFramesWaiting = 4096;
constexpr std::size_t kChunksWaiting = 1024;

bool is_bus_name(const std::string& name) {
  return !name.empty() && name.size() <= 15 && std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
  });
}

/// One datagram as a record of a capture.
void append_datagram(std::string& out, base::Duration stamp, bool sent, const Ends& ends,
                     Bytes bytes) {
  const pcap::Address ours{{}, ends.port};
  const pcap::Address peer{ends.peer, ends.peer_port};
  const auto record = pcap::record({.stamp = base::WallTime{stamp},
                                    .from = sent ? ours : peer,
                                    .to = sent ? peer : ours,
                                    .payload = bytes});
  out.append(record.begin(), record.end());
}

}  // namespace

base::Result<std::unique_ptr<RecordedFrameLink>> RecordedFrameLink::create(
    std::unique_ptr<FrameLink> inner, const std::string& file, const RecordOptions& options) {
  if (!is_bus_name(options.bus)) {
    return base::fail(base::Code::Invalid,
                      "'" + options.bus + "' is no name for a bus in a recording");
  }
  auto out = RecordFile::create(file, options);
  if (!out) return tl::unexpected(out.error());
  const auto format = [bus = options.bus](std::string& text, const Entry& entry,
                                          base::Duration stamp) {
    text += to_candump_line({stamp, bus, entry.frame, entry.sent});
  };
  auto writer = std::make_unique<Writer>(std::move(*out), format, options, kFramesWaiting);
  return std::unique_ptr<RecordedFrameLink>(
      new RecordedFrameLink(std::move(inner), std::move(writer)));
}

RecordedFrameLink::RecordedFrameLink(std::unique_ptr<FrameLink> inner,
                                     std::unique_ptr<Writer> writer)
    : writer_(std::move(writer)), inner_(std::move(inner)) {
  inner_->on_frame = [this](const CanFrame& frame, Time t) {
    writer_->put({t, false, frame});
    if (on_frame) on_frame(frame, t);
  };
  inner_->on_closed = [this](const std::string& reason) {
    if (on_closed) on_closed(reason);
  };
}

RecordedFrameLink::~RecordedFrameLink() = default;

SendResult RecordedFrameLink::send(const CanFrame& frame) noexcept {
  const SendResult result = inner_->send(frame);
  if (result == SendResult::Sent) writer_->put({base::steady_now(), true, frame});
  return result;
}

base::Result<std::unique_ptr<ByteTape>> ByteTape::create(std::string_view source,
                                                         const std::string& file,
                                                         const RecordOptions& options) {
  auto out = RecordFile::create(file, options, recording_header(source));
  if (!out) return tl::unexpected(out.error());
  const auto format = [](std::string& text, const Entry& entry, base::Duration stamp) {
    append_record(text, stamp, entry.sent, entry.bytes);
  };
  auto writer = std::make_unique<Writer>(std::move(*out), format, options, kChunksWaiting);
  return std::unique_ptr<ByteTape>(new ByteTape(std::move(writer)));
}

ByteTape::ByteTape(std::unique_ptr<Writer> writer) : writer_(std::move(writer)) {}
ByteTape::~ByteTape() = default;

void ByteTape::put(Bytes bytes, Time stamp) noexcept {
  writer_->put({stamp, false, {bytes.begin(), bytes.end()}});
}

RecordStatus ByteTape::status() const {
  return writer_->status();
}

base::Result<std::unique_ptr<RecordedByteLink>> RecordedByteLink::create(
    std::unique_ptr<ByteLink> inner, const std::string& file, const RecordOptions& options,
    ByteForm form) {
  const bool captures = form == ByteForm::Capture;
  const auto head = pcap::file_header();
  auto out = RecordFile::create(
      file, options,
      captures ? std::string(head.begin(), head.end()) : recording_header(inner->describe()));
  if (!out) return tl::unexpected(out.error());
  const auto format = [captures](std::string& text, const Entry& entry, base::Duration stamp) {
    if (captures) {
      append_datagram(text, stamp, entry.sent, entry.ends, entry.bytes);
    } else {
      append_record(text, stamp, entry.sent, entry.bytes);
    }
  };
  auto writer = std::make_unique<Writer>(std::move(*out), format, options, kChunksWaiting);
  return std::unique_ptr<RecordedByteLink>(
      new RecordedByteLink(std::move(inner), std::move(writer)));
}

RecordedByteLink::RecordedByteLink(std::unique_ptr<ByteLink> inner, std::unique_ptr<Writer> writer)
    : writer_(std::move(writer)), inner_(std::move(inner)) {
  inner_->on_bytes = [this](Bytes bytes, Time t) {
    writer_->put({t, false, {bytes.begin(), bytes.end()}, inner_->ends()});
    if (on_bytes) on_bytes(bytes, t);
  };
  inner_->on_peer = [this] {
    if (on_peer) on_peer();
  };
  inner_->on_closed = [this](const std::string& reason) {
    if (on_closed) on_closed(reason);
  };
}

RecordedByteLink::~RecordedByteLink() = default;

SendResult RecordedByteLink::write(Bytes bytes) noexcept {
  const SendResult result = inner_->write(bytes);
  if (result == SendResult::Sent && !bytes.empty()) {
    writer_->put({base::steady_now(), true, {bytes.begin(), bytes.end()}, {}});
  }
  return result;
}

}  // namespace roverd::link
