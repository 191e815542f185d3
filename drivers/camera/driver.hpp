#pragma once
// A camera of pictures: an IP camera over HTTP (a stream, or one picture after the other), or a
// camera of this computer, whose link hands over a JPEG at a time.
//
//   Down ─start─▶ Opening ─new picture─▶ Up ─none for silent_after_s─▶ Faulty ─new picture─▶ Up
//                    ▲ └─refused, closed, silent_reopen_s──────────────▶ │
//                    └──────────────────── back-off over ────────────────┘
//
// Pictures go to on_picture as they came, the newest only. One whose coded pixels are those of the
// picture before is none: a real camera never gives it, for its sensor has noise; a camera that
// hangs gives nothing else. It is counted, and the driver becomes Faulty as if nothing came.
//
// A login is told only when it is asked for, by a Digest where the camera can (RFC 7616).
//
// Device thread only.

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/measurements.hpp"
#include "base/picture.hpp"
#include "base/result.hpp"
#include "camera/answer.hpp"
#include "camera/jpeg.hpp"
#include "camera/params.hpp"
#include "camera/source.hpp"
#include "link/lifecycle.hpp"
#include "link/link.hpp"

namespace roverd::camera {

class Driver {
 public:
  struct Doors {
    std::function<base::Result<std::unique_ptr<link::ByteLink>>()> make_link;
    std::function<void(const base::Measurement&)> on_measurement;  ///< DriverStatus only
    base::OnPicture on_picture;
  };

  /// @param params valid. @param source of an IP camera; empty: the link hands over pictures.
  Driver(std::string name, const Params& params, std::optional<Source> source, Doors doors);
  ~Driver();
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  void start(Time now);
  /// 20 to 50 times a second.
  void tick(Time now);
  void stop(Time now);
  void restart(Time now);
  base::DriverStatus status(Time now) const;

 private:
  /// Asking: to be asked once connected. Hearing: what it answers. Resting: between two single
  /// pictures, not connected.
  enum class Stage { Closed, Asking, Hearing, Resting };

  void open(Time now);
  void ask(Time now);
  void on_bytes(Bytes bytes, Time stamp);
  void on_closed(const std::string& reason);
  void on_answer(Time now);
  void on_refused(Time now);
  void on_picture(Bytes bytes, Time began);
  void check_silence(Time now);
  void rest(Time now);
  void fail(const std::string& reason, Time now, bool wait_long = false);
  void close();
  void refuse(const std::string& cause, std::uint64_t more = 1);
  void count_refused();
  void report(Time now);
  std::string link_name() const;

  const std::string name_;
  const Params params_;
  const std::optional<Source> source_;
  const Doors doors_;
  std::unique_ptr<link::ByteLink> link_;
  std::unique_ptr<link::ByteLink> old_;  ///< closed inside its own callback; freed at the next tick
  std::string link_told_;
  link::Lifecycle life_;
  Stage stage_ = Stage::Closed;
  Answer answer_;
  Wish wish_;  ///< how it wanted the login when it was asked last
  int wished_ = 0;
  Time asked_{};  ///< or opened
  Time heard_{};  ///< the last new picture, or opened
  Time wait_until_{};
  base::PicturePtr last_;
  std::size_t last_scan_ = 0;  ///< where its coded pixels begin
  bool same_ = false;          ///< what came last was last_ once more
  std::deque<Time> lately_;    ///< arrivals of the last two seconds
  std::uint64_t pictures_ = 0;
  std::uint64_t refused_ = 0;
  std::uint64_t twice_ = 0;
  std::uint64_t bytes_ = 0;
  std::string refused_last_;
  std::optional<Time> refused_last_at_;
  std::map<std::string, std::uint64_t> counts_;
  std::map<std::string, std::uint64_t> counted_;  ///< of answer_
  Time now_{};
};

}  // namespace roverd::camera
