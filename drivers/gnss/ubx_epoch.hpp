#pragma once
// UBX messages to measurements. Messages of one epoch carry the same time of week:
//
//   NAV-PVT      the fix; nothing is told without it
//   NAV-HPPOSLLH the same position to 1e-9 deg, accuracy to 0.1 mm
//   NAV-COV      what is known of the errors east and north, and of the velocity's
//   NAV-RELPOSNED from a moving base: the direction from its antenna to ours; told at once
//
// Like NMEA epochs (gnss/epoch.hpp) one is told as soon as it holds the messages that the two
// before held, or when the next begins, or after timeout_s; stamped with the first byte of its
// first message. The receiver's horizontal accuracy is a radius: an axis has 1/√2 of it.
//
// Pure state: no clock, no lock. One thread.

#include <functional>
#include <optional>

#include "base/measurements.hpp"
#include "ubx/messages.hpp"

namespace roverd::gnss {

using base::Time;

struct UbxEpochOptions {
  double timeout_s = 0.25;
  double baseline_m = 0.0;           ///< between the antennas, as mounted; 0: there is one antenna
  double baseline_tolerance = 0.05;  ///< part of baseline_m by which it may be measured off
  double heading_offset_deg = 0.0;   ///< added to the direction from the base's antenna to ours
};

/// What was heard of one UBX epoch so far.
struct UbxEpoch {
  Time stamp;
  Time last;  ///< first byte of its last message
  std::uint32_t itow_ms = 0;
  unsigned parts = 0;
  bool told = false;
  std::optional<ubx::NavPvt> pvt;
  std::optional<ubx::NavHpPosLlh> precise;
  std::optional<ubx::NavCov> cov;
};

class UbxEpochs {
 public:
  using OnMeasurement = std::function<void(const base::Measurement&)>;

  UbxEpochs(const UbxEpochOptions& options, OnMeasurement on_measurement);

  /// @param stamp arrival of the frame's first byte.
  void add(const ubx::Message& message, Time stamp);
  /// Tells an epoch that nobody completed.
  void tick(Time now);
  /// The stream broke: what was begun is told, what was learned is forgotten.
  void reset();

  /// Directions of a moving base that were not fit for use: not fixed, or another length than the
  /// antennas have.
  std::uint64_t headings_refused() const noexcept { return headings_refused_; }

 private:
  enum Part : unsigned { kPvt = 1, kPrecise = 2, kCov = 4 };

  UbxEpoch& epoch_for(Part part, std::uint32_t itow_ms, Time stamp);
  void on_relative(const ubx::NavRelPosNed& m, Time stamp);
  void complete(Time stamp);
  void finish();
  void tell();

  const UbxEpochOptions options_;
  const OnMeasurement on_measurement_;
  std::optional<UbxEpoch> epoch_;
  unsigned learned_ = 0;    ///< parts of a whole epoch; 0: not known yet
  unsigned candidate_ = 0;  ///< parts of the epoch before
  std::uint64_t headings_refused_ = 0;
};

/// The longest age that the class in NAV-PVT's flags3 stands for; the last class is open. Empty: no
/// corrections.
std::optional<double> correction_age_s(int age_class) noexcept;

}  // namespace roverd::gnss
