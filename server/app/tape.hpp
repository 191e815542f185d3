#pragma once
// The links of drivers and sensors, with the recordings that are made of them.

#include <memory>
#include <string>

#include "app/workshop.hpp"
#include "config/sensors.hpp"
#include "link/address.hpp"
#include "link/record.hpp"
#include "link/tcp.hpp"
#include "v4l2/camera.hpp"

namespace roverd {

/// Frames or bytes: how such a link is made, and taped.
struct Frames {
  using Link = link::FrameLink;
  using Taped = link::RecordedFrameLink;
  static constexpr auto kMake = link::make_frame_link;
  static constexpr const char* kEnding = ".log";
  static auto tape(std::unique_ptr<Link> made, const std::string& file,
                   const link::RecordOptions& record) {
    return Taped::create(std::move(made), file, record);
  }
};
struct ByteStream {
  using Link = link::ByteLink;
  using Taped = link::RecordedByteLink;
  static constexpr auto kMake = link::make_byte_link;
  static constexpr const char* kEnding = kBytesEnding;
  static auto tape(std::unique_ptr<Link> made, const std::string& file,
                   const link::RecordOptions& record) {
    return Taped::create(std::move(made), file, record);
  }
};
/// Of a sensor: datagrams as others' programs read them.
struct Datagrams {
  using Link = link::ByteLink;
  static constexpr auto kMake = link::make_byte_link;
  static constexpr const char* kEnding = kCaptureEnding;
  static auto tape(std::unique_ptr<Link> made, const std::string& file,
                   const link::RecordOptions& record) {
    return link::RecordedByteLink::create(std::move(made), file, record, link::ByteForm::Capture);
  }
};

/// The bus keeps its name in the log where it has one.
inline std::string bus_name(const std::string& address) {
  const auto parsed = link::parse_address(address);
  return parsed && parsed->scheme == link::Scheme::Can ? parsed->target : link::RecordOptions{}.bus;
}

/// A recording that cannot be written never keeps a driver from its work.
/// @param make the link, each time anew. @param bus its name in a log of frames.
template <class Kind, class Make>
base::Result<std::unique_ptr<typename Kind::Link>> open_taped(const Workshop& w,
                                                              const DeviceEars& ears,
                                                              const std::string& name,
                                                              const std::string& bus, Make&& make) {
  base::Result<std::unique_ptr<typename Kind::Link>> made = make();
  if (!made || !w.records) return made;
  const auto file = recording_file(w, name, Kind::kEnding);
  if (!file) {
    recording_refused(ears, file.error().detail);
    return made;
  }
  link::RecordOptions record = record_options(w, ears);
  record.bus = bus;
  ears.on_recording(base::Recording::On, "");  // before: the writer may refuse at once
  auto taped = Kind::tape(std::move(*made), *file, record);
  if (taped) return std::move(*taped);
  recording_refused(ears, taped.error().detail);
  return make();
}

template <class Kind>
base::Result<std::unique_ptr<typename Kind::Link>> open_link(const Workshop& w,
                                                             boost::asio::io_context& io,
                                                             const DeviceEars& ears,
                                                             const std::string& name,
                                                             const std::string& address) {
  return open_taped<Kind>(w, ears, name, bus_name(address),
                          [&] { return Kind::kMake(io, address, w.replay); });
}

/// A sensor's: datagrams become a capture.
inline base::Result<std::unique_ptr<link::ByteLink>> open_sensor(
    const Workshop& w, boost::asio::io_context& io, const DeviceEars& ears, const std::string& name,
    const std::string& address, const Sensor& sensor) {
  const auto stream = [&](auto make) {
    return open_taped<ByteStream>(
        w, ears, name, {},
        [&]() -> base::Result<std::unique_ptr<link::ByteLink>> { return make(); });
  };
  if (const auto port = static_cast<std::uint16_t>(sensor.said.listens()); port != 0) {
    return stream([&] { return std::make_unique<link::TcpServer>(io, "127.0.0.1", port, 1); });
  }
  if (const std::string path = v4l2::path_of(address); !path.empty()) {
    return stream([&] { return std::make_unique<v4l2::Camera>(io, path, sensor.depth); });
  }
  const auto parsed = link::parse_address(address);
  const bool datagrams = parsed && parsed->scheme == link::Scheme::Udp;
  return datagrams ? open_link<Datagrams>(w, io, ears, name, address)
                   : open_link<ByteStream>(w, io, ears, name, address);
}

}  // namespace roverd
