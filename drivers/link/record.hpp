#pragma once
// A link that records what passes through it: what was heard, with its arrival stamp, and what was
// sent, marked as such. CAN goes into a candump log (candump.hpp) that can-utils' canplayer and
// log2asc read, bytes into a recording (recording.hpp), a sensor's datagrams into a capture
// (pcap/pcap.hpp) that tcpdump and Wireshark read; link/replay.hpp plays them all.
//
// Times in the file are UTC by the clock as it was when recording began.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "link/link.hpp"
#include "link/record_writer.hpp"

namespace roverd::link {

/// Wraps a frame link and behaves like it.
class RecordedFrameLink final : public FrameLink {
 public:
  /// Takes `inner` over, on error too. @param file a new one: an existing file is an error. Its
  /// folder must exist.
  static base::Result<std::unique_ptr<RecordedFrameLink>> create(std::unique_ptr<FrameLink> inner,
                                                                 const std::string& file,
                                                                 const RecordOptions& options = {});
  ~RecordedFrameLink() override;

  void attend(const std::vector<std::uint32_t>& ids) override { inner_->attend(ids); }
  base::Result<void> open() override { return inner_->open(); }
  void close() noexcept override { inner_->close(); }
  /// Recorded if the link took it. Does not wait for the disk.
  SendResult send(const CanFrame& frame) noexcept override;
  std::string describe() const override { return inner_->describe(); }
  BusReport report(Time now) override { return inner_->report(now); }

  /// Any thread.
  RecordStatus status() const { return writer_->status(); }

 private:
  struct Entry {
    Time stamp;
    bool sent = false;
    CanFrame frame;
  };
  using Writer = RecordWriter<Entry>;
  RecordedFrameLink(std::unique_ptr<FrameLink> inner, std::unique_ptr<Writer> writer);

  const std::unique_ptr<Writer> writer_;
  const std::unique_ptr<FrameLink> inner_;  // goes first: nothing is recorded after that
};

/// Bytes that come by no link of ours, in the same format. One thread puts.
class ByteTape {
 public:
  /// @param source for the file's first line; no secrets. @param file as for a link.
  static base::Result<std::unique_ptr<ByteTape>> create(std::string_view source,
                                                        const std::string& file,
                                                        const RecordOptions& options = {});
  ~ByteTape();

  /// Received then. Does not wait for the disk.
  void put(Bytes bytes, Time stamp) noexcept;
  /// Any thread.
  RecordStatus status() const;

 private:
  struct Entry {
    Time stamp;
    bool sent = false;
    std::vector<std::uint8_t> bytes;
  };
  using Writer = RecordWriter<Entry>;
  explicit ByteTape(std::unique_ptr<Writer> writer);

  const std::unique_ptr<Writer> writer_;
};

/// How bytes are written down: with stamps of microseconds, or as datagrams of IPv4 with those of
/// nanoseconds. In a capture what we sent comes from our port, and the address of ours is 0.0.0.0.
enum class ByteForm { Recording, Capture };

/// Wraps a byte link and behaves like it.
class RecordedByteLink final : public ByteLink {
 public:
  static base::Result<std::unique_ptr<RecordedByteLink>> create(
      std::unique_ptr<ByteLink> inner, const std::string& file, const RecordOptions& options = {},
      ByteForm form = ByteForm::Recording);
  ~RecordedByteLink() override;

  base::Result<void> open() override { return inner_->open(); }
  void close() noexcept override { inner_->close(); }
  SendResult write(Bytes bytes) noexcept override;
  std::string describe() const override { return inner_->describe(); }
  std::uint64_t strangers() const noexcept override { return inner_->strangers(); }
  std::map<std::string, std::uint64_t> troubles() const override { return inner_->troubles(); }
  Ends ends() const noexcept override { return inner_->ends(); }
  bool retune() override { return inner_->retune(); }

  /// Any thread.
  RecordStatus status() const { return writer_->status(); }

 private:
  struct Entry {
    Time stamp;
    bool sent = false;
    std::vector<std::uint8_t> bytes;
    Ends ends{};
  };
  using Writer = RecordWriter<Entry>;
  RecordedByteLink(std::unique_ptr<ByteLink> inner, std::unique_ptr<Writer> writer);

  const std::unique_ptr<Writer> writer_;
  const std::unique_ptr<ByteLink> inner_;
};

}  // namespace roverd::link
