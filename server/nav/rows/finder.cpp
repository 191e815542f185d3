#include "nav/rows/finder.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "nav/rows/rays.hpp"
#include "nav/rows/search.hpp"

namespace roverd::nav::rows {
namespace {

constexpr double kFitEvery_s = 0.035;
constexpr double kSearchEvery_s = 0.2;
constexpr double kFirstGate_m = 0.45;
constexpr double kFirstWidthSigma_m = 0.3;
constexpr double kWidthSigma_m = 0.06;       // as little is a learned width known to be wrong
constexpr double kWidthPerRootMetre = 0.03;  // and so much more where one side is missing
constexpr double kGivenSigma_m = 1e-3;       // a gap that was ordered is not learned
constexpr double kLostAfter_m = 3.0;         // without enough plants
constexpr double kLostSigma_m = 0.5;
constexpr double kJump_m = 0.30;             // farther at once the line does not move
constexpr double kJumpPart = 0.2;            // of its square is doubt, each time
constexpr double kWidthPart = 0.25;          // nor changes its width by more
constexpr double kShiftPerRootMetre = 0.02;  // what the odometry loses
constexpr double kTurnPerRootMetre = 0.01;
constexpr double kDriftOver_m = 3.0;  // of way it is learned
constexpr double kMostDrift = 0.08;
constexpr double kBendOver_m = 6.0;
constexpr double kBendAtFirst_1pm = 1.0 / 15.0;  // 1 sigma while nothing was seen of it
constexpr double kBendTells_m = 4.0;             // of way it takes to see some
constexpr double kPastEnd_m = 1.0;               // farther behind it nobody drives along this row
constexpr double kBendSigma_1pm = 0.005;         // at a row's end,
constexpr double kEndShiftPerRootMetre = 0.01;   // and what moves the line there
constexpr double kEndTurnPerRootMetre = 0.002;
constexpr double kLeast_m = 0.01;  // nobody knows a hedge better than this

constexpr double kBin_m = 0.25;
constexpr long kBins = 256;
constexpr std::uint8_t kSeenThrough = 3;  // scans
constexpr double kBehind_m = 0.30;        // a ray that goes so much farther went through
constexpr std::size_t kPlant = 4;         // marks in a bin
constexpr double kEndGate_m = 0.15;       // wider than the fit's: a bend ahead is no end
constexpr double kMayMiss = 0.12;         // share of the bins behind the end

long bin_of(double m) noexcept {
  return static_cast<long>(std::floor(m / kBin_m));
}
std::size_t slot_of(long bin) noexcept {
  return static_cast<std::size_t>(((bin % kBins) + kBins) % kBins);
}

}  // namespace

std::string_view to_string(Sides sides) noexcept {
  switch (sides) {
    case Sides::Both:
      return "both";
    case Sides::Left:
      return "left";
    case Sides::Right:
      return "right";
  }
  return "both";
}

std::string_view to_string(Seeing seeing) noexcept {
  switch (seeing) {
    case Seeing::Line:
      return "line";
    case Seeing::Rays:
      return "rays";
  }
  return "line";
}

template <class Do>
void RowFinder::each_side(Do&& what) {
  if (order_.sides != Sides::Right) what(sides_[0], 1);
  if (order_.sides != Sides::Left) what(sides_[1], -1);
}

void RowFinder::forget() {
  lose();
  marks_.clear();
  gone_m_ = learned_at_m_ = met_m_ = 0.0;
  sides_ = {};
  cleared_to_ = 0;
  fitted_.reset();
}

void RowFinder::lose() {
  line_.reset();
  view_.reset();
  last_ = {};
  bend_1pm_ = bend_over_m_ = 0.0;
  ending_ = false;
  unfitted_m_ = 0.0;
}

void RowFinder::see(const RowScan& scan) {
  if (scan.blind) return;
  if (order_.seeing == Seeing::Rays) {
    if (!scan.ahead) return;  // of a sensor that looks elsewhere
    const double seen_m = marks_.way_m();
    RowScan nothing;
    nothing.pose = scan.pose;
    marks_.take(nothing, 0.0);  // the way alone
    const double way_m = std::max(seen_m, marks_.way_m());
    RowView view = view_by_rays(scan, order_, p_);
    const bool met = view.left + view.right > 0;
    if (met) met_m_ += way_m - seen_m;
    if (met_m_ < p_.end_after_m) view.to_end_m.reset();
    if (!met && !view.to_end_m) return;  // nothing leads: the last view grows old
    view.seen_m = way_m;
    view.plants_m = met_m_;
    view_ = view;
    return;
  }
  marks_.take(scan, p_.ahead_m + 0.5 * p_.width_max_m);
  if (!line_) return begin(scan);
  advance(scan);
  look_through(scan);
  if (!fitted_ || base::seconds(scan.stamp - *fitted_) >= kFitEvery_s) {
    fitted_ = scan.stamp;
    marks_.read(read_);
    undrift();
    fit();
    if (line_) find_plants();
  }
  if (line_) tell(scan);
}

void RowFinder::begin(const RowScan& scan) {
  if (fitted_ && base::seconds(scan.stamp - *fitted_) < kSearchEvery_s) return;
  fitted_ = scan.stamp;
  marks_.read(read_);
  line_ = search_line(read_, scan.pose, order_, p_);
  if (!line_) return;
  learned_ = {line_->width_m, order_.sides == Sides::Both ? kFirstWidthSigma_m : kGivenSigma_m};
  last_ = fit_line(read_, order_.sides, kFirstGate_m, learned_, {}, p_, *line_, pieces_);
  const bool wide = line_->width_m >= p_.width_min_m && line_->width_m <= p_.width_max_m;
  if (!last_.good || (order_.sides == Sides::Both && !wide)) return lose();
  advance(scan);
  find_plants();
  tell(scan);
}

/// L to beside the robot again; what is known of the line comes along.
void RowFinder::advance(const RowScan& scan) {
  const Pose2 body = sense::inverse(line_->at) * scan.pose;
  const Along at = beside_arc(body.x_m, body.y_m, line_->curvature_1pm);
  line_->at = line_->at * on_arc(at.s_m, line_->curvature_1pm) * Pose2{0.0, drift_ * at.s_m, 0.0};
  gone_m_ += at.s_m;
  const double way_m = std::abs(at.s_m);
  unfitted_m_ += way_m;
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> p(line_->covariance.data());
  Eigen::Matrix4d j = Eigen::Matrix4d::Identity();
  j(0, 1) = at.s_m;
  j(0, 2) = 0.5 * at.s_m * at.s_m;
  j(1, 2) = at.s_m;
  p = (j * p * j.transpose()).eval();
  p(0, 0) += kShiftPerRootMetre * kShiftPerRootMetre * way_m;
  p(1, 1) += kTurnPerRootMetre * kTurnPerRootMetre * way_m;
  if (order_.sides == Sides::Both && (last_.left < 2 || last_.right < 2)) {
    learned_.sigma_m = std::sqrt(learned_.sigma_m * learned_.sigma_m +
                                 kWidthPerRootMetre * kWidthPerRootMetre * way_m);
  }
  const bool gone = unfitted_m_ > kLostAfter_m || std::sqrt(p(0, 0)) > kLostSigma_m;
  if (gone) unfitted_m_ = kLostAfter_m + 1.0;
}

/// What was seen a while ago has moved since, as the odometry counts.
void RowFinder::undrift() {
  const double east = -std::sin(line_->at.yaw_rad) * drift_;
  const double north = std::cos(line_->at.yaw_rad) * drift_;
  for (Mark& m : read_) {
    m.x_m += east * m.ago_m;
    m.y_m += north * m.ago_m;
  }
}

bool RowFinder::ends() const noexcept {
  return view_ && view_->to_end_m && *view_->to_end_m > -kPastEnd_m;
}

/// Until the end is in sight the plants alone tell. Then the line hardly moves; the first time
/// it is free to, for its bend may be another one.
LinePrior RowFinder::known() const noexcept {
  LinePrior known;
  if (!ends()) return known;
  known.curvature_1pm = bend_1pm_;
  known.curvature_sigma_1pm =
      kBendSigma_1pm + kBendAtFirst_1pm * std::exp(-bend_over_m_ / kBendTells_m);
  if (!ending_) return known;
  const double root = std::sqrt(std::max(1e-4, unfitted_m_));
  known.aside_m = kEndShiftPerRootMetre * root;
  known.turned_rad = kEndTurnPerRootMetre * root;
  return known;
}

void RowFinder::fit() {
  if (unfitted_m_ > kLostAfter_m) return lose();
  Line now = *line_;
  const double sigma_m = std::sqrt(std::max(0.0, now.covariance[0]));
  const double gate_m = p_.gate_m + std::min(0.2, sigma_m);
  const Fitted fitted = fit_line(read_, order_.sides, gate_m, learned_, known(), p_, now, pieces_);
  if (!fitted.good) {
    last_ = fitted;
    return;
  }
  const Pose2 moved = sense::inverse(line_->at) * now.at;
  const bool jumps = std::abs(moved.y_m) > kJump_m ||
                     std::abs(now.width_m - learned_.width_m) > kWidthPart * learned_.width_m;
  if (jumps) {
    // What contradicts the line is not followed, but the line is no longer sure either.
    const double aside_m =
        std::max(std::abs(moved.y_m), 0.5 * std::abs(now.width_m - learned_.width_m));
    line_->covariance[0] += kJumpPart * aside_m * aside_m;
    last_ = {};
    return;
  }
  const bool ends = this->ends();
  if (!ends) {
    bend_over_m_ += unfitted_m_;
    bend_1pm_ += std::min(1.0, unfitted_m_ / kBendOver_m) * (now.curvature_1pm - bend_1pm_);
  } else if (ending_) {
    now.covariance = line_->covariance;  // what was known before is not known twice
  }
  ending_ = ends;
  unfitted_m_ = 0.0;
  last_ = fitted;
  *line_ = now;
  const double learned = std::clamp((gone_m_ - learned_at_m_) / kDriftOver_m, 0.0, 0.2);
  learned_at_m_ = gone_m_;
  drift_ = std::clamp(drift_ + learned * fitted.drift, -kMostDrift, kMostDrift);
  // The fit may have moved L along: it lies beside the robot again with the next scan.
  if (order_.sides == Sides::Both && fitted.left >= 3 && fitted.right >= 3) {
    const double sigma_w = std::sqrt(now.covariance[15]);
    learned_.width_m += 0.2 * (now.width_m - learned_.width_m);
    learned_.sigma_m = std::max(kWidthSigma_m, sigma_w);
  }
}

/// Where rays go through the places at which this row's plants would stand.
void RowFinder::look_through(const RowScan& scan) {
  const long from = bin_of(gone_m_);
  const long to = bin_of(gone_m_ + p_.ahead_m);
  for (; cleared_to_ <= to; ++cleared_to_) {
    for (Side& side : sides_) side.through[slot_of(cleared_to_)] = 0;
  }
  const Pose2 in_body = sense::inverse(scan.pose) * line_->at;
  each_side([&](Side& side, int sign) {
    for (long b = from; b <= to; ++b) {
      const double s_m = (double(b) + 0.5) * kBin_m - gone_m_;
      const Pose2 there = in_body * on_arc(s_m, line_->curvature_1pm) *
                          Pose2{0.0, sign * 0.5 * line_->width_m, 0.0};
      const double far_m = std::hypot(there.x_m - scan.eye_x_m, there.y_m - scan.eye_y_m);
      if (scan.reach_to(there.x_m, there.y_m) < far_m + kBehind_m) continue;
      std::uint8_t& n = side.through[slot_of(b)];
      n = static_cast<std::uint8_t>(std::min(n + 1, 255));
    }
  });
}

void RowFinder::find_plants() {
  const Pose2 in = sense::inverse(line_->at);
  const double c = std::cos(in.yaw_rad);
  const double s = std::sin(in.yaw_rad);
  const long from = bin_of(gone_m_ - p_.behind_m);
  const auto bins = static_cast<std::size_t>(bin_of(gone_m_ + p_.ahead_m) - from + 1);
  struct Stand {
    std::size_t marks = 0;
    double first_m = 1e9;
    double last_m = -1e9;
  };
  std::vector<Stand> stands(2 * bins);
  for (const Mark& m : read_) {
    const double x = in.x_m + c * m.x_m - s * m.y_m;
    const double y = in.y_m + s * m.x_m + c * m.y_m;
    const Along at = beside_arc(x, y, line_->curvature_1pm);
    if (at.s_m < -p_.behind_m || at.s_m > p_.ahead_m) continue;
    if (std::abs(std::abs(at.d_m) - 0.5 * line_->width_m) > p_.gate_m + kEndGate_m) continue;
    const double along_m = gone_m_ + at.s_m;
    const auto i = static_cast<std::size_t>(
        std::clamp(bin_of(along_m) - from, 0L, static_cast<long>(bins) - 1));
    Stand& stand = stands[at.d_m > 0.0 ? i : bins + i];
    ++stand.marks;
    stand.first_m = std::min(stand.first_m, along_m);
    stand.last_m = std::max(stand.last_m, along_m);
  }
  each_side([&](Side& side, int sign) {
    for (std::size_t i = 0; i < bins; ++i) {
      const Stand& stand = stands[sign > 0 ? i : bins + i];
      if (stand.marks < kPlant) continue;
      side.first_m = std::min(side.first_m.value_or(1e9), stand.first_m);
      side.last_m = std::max(side.last_m.value_or(-1e9), stand.last_m);
    }
  });
}

bool RowFinder::empty_behind(const Side& side, double end_m) const {
  const long from = bin_of(end_m + kBin_m);
  const long to = bin_of(end_m + p_.end_gap_m);
  if (to >= cleared_to_) return false;
  long missed = 0;
  for (long b = from; b <= to; ++b) {
    if (side.through[slot_of(b)] < kSeenThrough) ++missed;
  }
  return double(missed) <= kMayMiss * double(to - from + 1);
}

/// Where both sides end that lead, counted as gone_m_.
std::optional<double> RowFinder::end_m() const {
  double first_m = 1e9;
  double last_m = -1e9;
  bool empty = true;
  const bool leads[2] = {order_.sides != Sides::Right, order_.sides != Sides::Left};
  for (std::size_t i = 0; i < 2; ++i) {
    if (!leads[i]) continue;
    if (sides_[i].first_m) first_m = std::min(first_m, *sides_[i].first_m);
    if (sides_[i].last_m) last_m = std::max(last_m, *sides_[i].last_m);
  }
  if (last_m - first_m < p_.end_after_m) return std::nullopt;
  for (std::size_t i = 0; i < 2; ++i) {
    if (leads[i]) empty = empty && empty_behind(sides_[i], last_m);
  }
  return empty ? std::optional(last_m) : std::nullopt;
}

void RowFinder::tell(const RowScan& scan) {
  RowView view;
  view.stamp = scan.stamp;
  view.line = line_->at;
  view.curvature_1pm = line_->curvature_1pm;
  view.width_m = order_.sides == Sides::Both ? line_->width_m : 0.0;
  view.drift = drift_;
  view.width_sigma_m = std::sqrt(std::max(0.0, line_->covariance[15]));
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) view.covariance[3 * r + c] = line_->covariance[4 * r + c];
  }
  view.covariance[0] += kLeast_m * kLeast_m;
  view.left = last_.left;
  view.right = last_.right;
  view.seen_m = gone_m_;
  double first_m = 1e9;
  double last_m = -1e9;
  each_side([&](const Side& side, int) {
    first_m = std::min(first_m, side.first_m.value_or(1e9));
    last_m = std::max(last_m, side.last_m.value_or(-1e9));
  });
  view.plants_m = std::max(0.0, last_m - first_m);
  if (const auto end = end_m()) view.to_end_m = *end - gone_m_;
  view_ = view;
}

}  // namespace roverd::nav::rows
