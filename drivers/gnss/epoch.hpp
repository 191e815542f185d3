#pragma once
// Sentences to epochs to measurements. Units die here: knots become m/s, headings yaw.
//
// A receiver says one epoch in several sentences (GGA RMC VTG GST …) in a burst. All measurements
// of an epoch are stamped with the arrival of the first byte of its first sentence: that is the
// moment closest to the measurement which the receiver shows us.
//
//   begins   with a sentence of another time than the one before, or of a type it already has
//   is told  as soon as it holds the types that the two epochs before held (so mostly with its last
//            sentence), or when the next begins, or after timeout_s without another sentence
//
// What comes later is not wasted: a late date is kept, a late RMC or VTG still gives the velocity.
//
//   fix       GGA; without it GNS; without both RMC. RMC of the same epoch with status V or mode N
//             overrules: no fix. Quality 0, manual, simulator and unknown numbers: no position.
//   sigmas    GST; a receiver that prints 0 gives none
//   velocity  RMC, else VTG; no course and (nearly) no speed is a velocity of zero, no course at
//             speed is none
//   heading   HDT or THS at once: the first of an epoch with the epoch's stamp, others with theirs
//   utc       date of RMC or ZDA, carried over midnight while the new date is still to come
//
// Pure state: no clock, no lock. One thread.

#include <functional>
#include <optional>

#include "base/measurements.hpp"
#include "gnss/sentence.hpp"

namespace roverd::gnss {

using base::Time;

/// The date goes with the time of day it came with, so a time just past midnight is the next day's.
class Calendar {
 public:
  void set(Date date, double time_s) noexcept;
  /// Empty before the first date. @param time_s seconds of the day.
  std::optional<base::WallTime> at(double time_s) const noexcept;

 private:
  std::optional<std::chrono::sys_days> day_;
  double time_s_ = 0.0;
};

struct EpochOptions {
  double timeout_s = 0.25;
  base::HeadingSource heading_source = base::HeadingSource::Compass;
  double heading_offset_deg = 0.0;  ///< added to what the receiver says
};

/// What was heard of one epoch so far.
struct Epoch {
  Time stamp;
  Time last;  ///< first byte of its last sentence
  std::optional<double> time_s;
  unsigned parts = 0;
  bool told = false;
  bool velocity_told = false;
  bool heading_told = false;
  base::FixType fix = base::FixType::None;  ///< once told
  std::optional<Gga> gga;
  std::optional<Rmc> rmc;
  std::optional<Vtg> vtg;
  std::optional<Gst> gst;
  std::optional<Gns> gns;
};

class EpochAssembler {
 public:
  using OnMeasurement = std::function<void(const base::Measurement&)>;

  EpochAssembler(const EpochOptions& options, OnMeasurement on_measurement);

  /// @param stamp arrival of the sentence's first byte.
  void add(const Sentence& sentence, Time stamp);
  /// Tells an epoch that nobody completed.
  void tick(Time now);
  /// The stream broke: what was begun is told, what was learned is forgotten.
  void reset();

 private:
  /// Bits of the types that make up an epoch.
  enum Part : unsigned { kGga = 1, kRmc = 2, kVtg = 4, kGst = 8, kGns = 16, kZda = 32 };

  Epoch& epoch_for(Part part, std::optional<double> time_s, Time stamp);
  void on_vtg(const Vtg& vtg, Time stamp);
  void on_heading(std::optional<double> heading_deg, Time stamp);
  void note_date(std::optional<Date> date, std::optional<double> time_s);
  void finish();
  void complete();
  void tell();
  void tell_velocity();
  base::GnssFix fix_of(const Epoch& e) const;

  const EpochOptions options_;
  const OnMeasurement on_measurement_;
  std::optional<Epoch> epoch_;
  Calendar calendar_;
  unsigned learned_ = 0;    ///< parts of a whole epoch; 0: not known yet
  unsigned candidate_ = 0;  ///< parts of the epoch before
};

}  // namespace roverd::gnss
