#include "robot/safety/votes_watch.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::robot {
namespace {

using base::Difference;
using base::Sense;
using base::Severity;

const char* name_of(Sense s) {
  switch (s) {
    case Sense::Tracks:
      return "odometry";
    case Sense::Gyro:
      return "the gyro";
    case Sense::Position:
      return "the satellites' position";
    case Sense::Velocity:
      return "the satellites' velocity";
    case Sense::Compass:
      return "the compass";
    case Sense::Antennas:
      return "the two antennas' heading";
  }
  return "a sensor";
}

std::string side_of(double rad) {
  return rad > 0.0 ? " farther left" : " farther right";
}

/// What it does, beside the others.
std::string deed_of(const Difference& off) {
  const double deg = base::deg_from_rad(off.size);
  switch (off.of) {
    case Difference::Of::Turn:
      return "turns " + tenths_of(deg / std::max(0.1, off.window_s)) + " deg/s" +
             side_of(off.size) + " than";
    case Difference::Of::Heading:
      return "points " + tenths_of(deg) + " deg" + side_of(off.size) + " than";
    case Difference::Of::Way:
      return "tells of a way that within " + tenths_of(off.window_s) + " s is off by " +
             tenths_of(off.size) + " m from what";
  }
  return {};
}

std::string size_of(const Difference& off) {
  if (off.of == Difference::Of::Way) {
    return tenths_of(off.size) + " m within " + tenths_of(off.window_s) + " s";
  }
  return tenths_of(base::deg_from_rad(off.size)) + " deg within " + tenths_of(off.window_s) + " s";
}

}  // namespace

std::string contradiction_words(const base::Votes& votes, Sense liar) {
  const base::SenseVote& vote = votes[liar];
  std::string others;
  int count = 0;
  for (const bool against : vote.against) count += against ? 1 : 0;
  int left = count;
  for (std::size_t i = 0; i < base::kSenses; ++i) {
    if (!vote.against[i]) continue;
    if (!others.empty()) others += left > 1 ? ", " : " and ";
    others += name_of(static_cast<Sense>(i));
    --left;
  }
  if (others.empty()) others = "the others";
  std::string text = std::string(name_of(liar)) + " " + deed_of(vote.off) + " " + others +
                     (count == 1 ? " says" : " say");
  if (vote.frozen) text += "; it repeats itself";
  return text;
}

std::string undecided_words(const base::Votes& votes) {
  if (!votes.undecided) return {};
  return std::string(name_of((*votes.undecided)[0])) + " and " + name_of((*votes.undecided)[1]) +
         " differ by " + size_of(votes.undecided_off) +
         ", and it cannot be told which one is wrong";
}

const std::vector<EstimateWatch::News>& VotesWatch::step(const base::Votes& votes) {
  news_.clear();
  for (std::size_t i = 0; i < base::kSenses; ++i) {
    const bool out = votes.of[i].left_out;
    if (out == out_[i]) continue;
    out_[i] = out;
    const Sense s = static_cast<Sense>(i);
    if (out) {
      news_.push_back({Severity::Warning, "sensor_left_out",
                       contradiction_words(votes, s) + ": it is left out"});
    } else {
      news_.push_back({Severity::Info, "sensor_back", std::string(name_of(s)) + " is used again"});
    }
  }
  if (votes.undecided.has_value() != undecided_) {
    undecided_ = votes.undecided.has_value();
    news_.push_back(undecided_ ? EstimateWatch::News{Severity::Warning, "sensors_contradict",
                                                     undecided_words(votes)}
                               : EstimateWatch::News{Severity::Info, "sensors_agree",
                                                     "the sensors do not contradict any more"});
  }
  return news_;
}

}  // namespace roverd::robot
