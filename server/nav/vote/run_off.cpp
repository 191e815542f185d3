#include "nav/vote/run_off.hpp"

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"

namespace roverd::nav {
namespace {

using base::EnuPoint;
using base::rad_from_deg;
using base::seconds;

// What the ground may do, 1 sigma, and the way after which it is another one.
constexpr double kScaleMean = 0.9;
constexpr double kScaleSigma = 0.10;
constexpr double kCrabSigma = 0.045;
constexpr double kPatch_m = 3.0;
constexpr double kSlidePerGrade = 0.3;  // downhill: tracks on grass and soil, about
constexpr double kSlideSigmaPerGrade = 0.25;
constexpr double kSlideLevel = 0.01;
constexpr double kSlope_m = 20.0;
// What gyro and centre of rotation do.
const double kYawNoise_rad = rad_from_deg(0.3);
constexpr double kYawPerTurn = 0.005;
constexpr double kPlaceNoise_m = 0.005;
constexpr double kCentre_m = 0.1;          // by which it lies ahead of or behind the middle
constexpr double kCentreWanders_m = 0.05;  // for each radian
const double kYawAtFirst_rad = rad_from_deg(6.0);
const double kYawUnknown_rad = rad_from_deg(15.0);
constexpr double kFixed_m = 0.022;  // 1 sigma of an honest fixed solution, its slow part included
constexpr double kOffTime_s = 0.1;  // by which its time is wrong all the time
constexpr double kJitter_s = 0.02;  // and by which it is from one to the next
// The lies that are looked for.
constexpr double kDrift_mps = 0.25;
const double kGyro_radps = rad_from_deg(3.0);

constexpr double kEnough = 7.0;     // of the logarithm of the likelihoods' ratio
constexpr double kOfOneLook = 4.0;  // at most: an outlier is no drift
constexpr double kKept = 20.0;      // at most: what ends is forgotten again
constexpr double kMoreThanGyro = 2.0;
constexpr double kFits = 12.0;  // y'S⁻¹y of the lie, so that it is one
constexpr int kFewestLooks = 3;
// Tracks that spin leave the robot behind, too: what looks like that is theirs. Slower, and it is
// not told from what positions scatter by; more aside than this part of it, and no track does it.
// Ground that gives way all at once (from 8 to 40 % slip) does it straight back.
constexpr double kSpins_mps = 0.2;
constexpr double kSlipsLeast = 0.15;  // of the tracks' way; less, and the ground's filter follows
constexpr double kSlipsAside = 0.12;
constexpr double kSpinsLeast = 0.45;  // from there on spinning is looked for
constexpr double kSpinsAside = 0.3;
constexpr double kSpinsFrom = 2.0;  // of the ratio: before, the drift is not known well
constexpr double kGap_s = 1.3;
constexpr double kJump_m = 0.35;  // beyond what any of them foretells: another rule's matter

double slide_sigma(EnuPoint downhill, double doubt) noexcept {
  const double grade = std::hypot(downhill.east_m, downhill.north_m);
  return kSlideSigmaPerGrade * grade + kSlidePerGrade * doubt + kSlideLevel;
}

}  // namespace

/// For each metre, where the ground leans as it is told: over ground.
EnuPoint RunOff::slides_to(const Filter& f, const Look& look) noexcept {
  const double yaw = f.x(kHeading) + look.at.ref_rad;
  const double ahead = kSlidePerGrade * look.downhill.east_m;
  const double left = kSlidePerGrade * look.downhill.north_m;
  return {std::cos(yaw) * ahead - std::sin(yaw) * left,
          std::sin(yaw) * ahead + std::cos(yaw) * left};
}

bool RunOff::follows(const Look& look) const noexcept {
  const Moment& a = last_.at;
  const Moment& b = look.at;
  const double dt_s = seconds(look.spot.t - last_.spot.t);
  return begun_ && dt_s > 0.0 && dt_s <= kGap_s && look.spot.run == last_.spot.run &&
         a.ref_run == b.ref_run && a.gyro_run == b.gyro_run && a.track_run == b.track_run;
}

void RunOff::begin(const Look& look) noexcept {
  forget();
  if (look.at.yaw_sigma_rad > kYawUnknown_rad) return;
  begun_ = true;
  last_ = look;
  const double yaw = look.at.yaw_rad;
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  ground_ = {};
  ground_.x(kAtEast) = look.spot.at.east_m - c * look.arm.east_m + s * look.arm.north_m;
  ground_.x(kAtNorth) = look.spot.at.north_m - s * look.arm.east_m - c * look.arm.north_m;
  ground_.x(kHeading) = yaw - look.at.ref_rad;
  ground_.x(kWayShare) = kScaleMean;
  const EnuPoint downhill = slides_to(ground_, look);
  ground_.x(kFallE) = downhill.east_m;
  ground_.x(kFallN) = downhill.north_m;
  const double slide = slide_sigma(look.downhill, look.doubt);
  const double yaw_sigma = std::hypot(look.at.yaw_sigma_rad, kYawAtFirst_rad);
  const double place = std::hypot(look.spot.sigma_m, kFixed_m);
  const auto square = [](double v) { return v * v; };
  ground_.P.diagonal() << square(place), square(place), square(yaw_sigma), square(kScaleSigma),
      square(kCrabSigma), square(slide), square(slide), square(kCentre_m), square(kOffTime_s), 0.0,
      0.0;
  lie_ = suspect(Lies::Receiver);
  gyro_ = suspect(Lies::Gyro);
  lie_ratio_ = gyro_ratio_ = 0.0;
  lie_since_ = look.spot.t;
  lie_looks_ = 0;
}

/// As the ground's, and from now on somebody may lie.
RunOff::Filter RunOff::suspect(Lies who) const noexcept {
  Filter f = ground_;
  f.lies = who;
  if (who == Lies::Receiver) f.P(kLieE, kLieE) = f.P(kLieN, kLieN) = kDrift_mps * kDrift_mps;
  if (who == Lies::Gyro) f.P(kLieE, kLieE) = kGyro_radps * kGyro_radps;
  return f;
}

void RunOff::predict(Filter& f, const Look& to) const noexcept {
  const Moment& a = last_.at;
  const Moment& b = to.at;
  const double dt_s = seconds(to.spot.t - last_.spot.t);
  const double path_m = b.path_m - a.path_m;
  const double turned = std::abs(b.ref_rad - a.ref_rad);
  const double c = std::cos(f.x(kHeading));
  const double s = std::sin(f.x(kHeading));
  const EnuPoint way{c * (b.x_m - a.x_m) - s * (b.y_m - a.y_m),
                     s * (b.x_m - a.x_m) + c * (b.y_m - a.y_m)};
  const EnuPoint own{f.x(kWayShare) * way.east_m - f.x(kAside) * way.north_m,
                     f.x(kWayShare) * way.north_m + f.x(kAside) * way.east_m};
  Matrix F = Matrix::Identity();
  F(kAtEast, kHeading) = -own.north_m;
  F(kAtNorth, kHeading) = own.east_m;
  F(kAtEast, kWayShare) = F(kAtNorth, kAside) = way.east_m;
  F(kAtNorth, kWayShare) = way.north_m;
  F(kAtEast, kAside) = -way.north_m;
  F(kAtEast, kFallE) = F(kAtNorth, kFallN) = path_m;
  f.mps = {(own.east_m + path_m * f.x(kFallE)) / dt_s, (own.north_m + path_m * f.x(kFallN)) / dt_s};
  f.x(kAtEast) += own.east_m + path_m * f.x(kFallE);
  f.x(kAtNorth) += own.north_m + path_m * f.x(kFallN);
  if (f.lies == Lies::Receiver) {
    F(kAtEast, kLieE) = F(kAtNorth, kLieN) = dt_s;
    f.x(kAtEast) += dt_s * f.x(kLieE);
    f.x(kAtNorth) += dt_s * f.x(kLieN);
  } else if (f.lies == Lies::Gyro) {
    F(kHeading, kLieE) = dt_s;
    F(kAtEast, kLieE) = -0.5 * dt_s * own.north_m;
    F(kAtNorth, kLieE) = 0.5 * dt_s * own.east_m;
    f.x(kHeading) += dt_s * f.x(kLieE);
  }
  const double patch = std::exp(-path_m / kPatch_m);
  const double slope = std::exp(-path_m / kSlope_m);
  f.x(kWayShare) = kScaleMean + patch * (f.x(kWayShare) - kScaleMean);
  f.x(kAside) *= patch;
  const EnuPoint downhill = slides_to(f, to);
  f.x(kFallE) = downhill.east_m + slope * (f.x(kFallE) - downhill.east_m);
  f.x(kFallN) = downhill.north_m + slope * (f.x(kFallN) - downhill.north_m);
  F(kWayShare, kWayShare) = F(kAside, kAside) = patch;
  F(kFallE, kFallE) = F(kFallN, kFallN) = slope;
  f.P = (F * f.P * F.transpose()).eval();
  const auto noise = [&f](int i, double sigma) { f.P(i, i) += sigma * sigma; };
  const double fresh_patch = std::sqrt(1.0 - patch * patch);
  const double fresh_slope = std::sqrt(1.0 - slope * slope);
  const double slide = slide_sigma(to.downhill, to.doubt);
  noise(kWayShare, kScaleSigma * fresh_patch);
  noise(kAside, kCrabSigma * fresh_patch);
  noise(kFallE, slide * fresh_slope);
  noise(kFallN, slide * fresh_slope);
  noise(kHeading, std::hypot(kYawNoise_rad * std::sqrt(dt_s), kYawPerTurn * turned));
  const double place = std::hypot(kPlaceNoise_m * std::sqrt(dt_s), kCentreWanders_m * turned);
  noise(kAtEast, place);
  noise(kAtNorth, place);
}

void RunOff::update(Filter& f, const Look& to) const noexcept {
  const double yaw = f.x(kHeading) + to.at.ref_rad;
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  const double ahead_m = to.arm.east_m + f.x(kCentre);
  const EnuPoint arm{c * ahead_m - s * to.arm.north_m, s * ahead_m + c * to.arm.north_m};
  const Eigen::Vector2d y{
      to.spot.at.east_m - arm.east_m - f.x(kAtEast) + f.x(kLate) * f.mps.east_m,
      to.spot.at.north_m - arm.north_m - f.x(kAtNorth) + f.x(kLate) * f.mps.north_m};
  Eigen::Matrix<double, 2, kSize> H = Eigen::Matrix<double, 2, kSize>::Zero();
  H(0, kAtEast) = H(1, kAtNorth) = 1.0;
  H(0, kHeading) = -arm.north_m;
  H(1, kHeading) = arm.east_m;
  H(0, kCentre) = c;
  H(1, kCentre) = s;
  H(0, kLate) = -f.mps.east_m;
  H(1, kLate) = -f.mps.north_m;
  const double dt_s = seconds(to.spot.t - last_.spot.t);
  const double speed_mps = (to.at.path_m - last_.at.path_m) / dt_s;
  const double sigma = std::hypot(std::max(to.spot.sigma_m, kFixed_m), kJitter_s * speed_mps);
  const Eigen::Matrix<double, kSize, 2> PHt = f.P * H.transpose();
  const Eigen::Matrix2d S = H * PHt + sigma * sigma * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d S_inverse = S.inverse();
  f.nis = y.dot(S_inverse * y);
  f.log_likelihood = -0.5 * (f.nis + std::log(std::max(1e-12, S.determinant())));
  const Eigen::Matrix<double, kSize, 2> K = PHt * S_inverse;
  f.x += K * y;
  f.P = (f.P - K * PHt.transpose()).eval();
  f.P = (0.5 * (f.P + f.P.transpose())).eval();
}

/// Does it drift against the tracks' way, by much of it and by no more than that, as far as it is
/// known (1 sigma) what it does aside? So does a robot that stands in mud. A receiver that drifts
/// so is found where the robot turns or stops.
bool RunOff::like_spinning(const Look& to) const noexcept {
  const double dt_s = seconds(to.spot.t - last_.spot.t);
  const double dx = (to.at.x_m - last_.at.x_m) / dt_s;
  const double dy = (to.at.y_m - last_.at.y_m) / dt_s;
  const double speed_mps = std::hypot(dx, dy);
  if (speed_mps < kSpins_mps) return false;
  const double c = std::cos(lie_.x(kHeading));
  const double s = std::sin(lie_.x(kHeading));
  const EnuPoint ahead{(c * dx - s * dy) / speed_mps, (s * dx + c * dy) / speed_mps};
  const double along = lie_.x(kLieE) * ahead.east_m + lie_.x(kLieN) * ahead.north_m;
  const double aside = lie_.x(kLieN) * ahead.east_m - lie_.x(kLieE) * ahead.north_m;
  const double back = -along / speed_mps;
  if (back < kSlipsLeast || back > 1.0) return false;
  const double part = (back < kSpinsLeast ? kSlipsAside : kSpinsAside) * -along;
  const EnuPoint left{-ahead.north_m, ahead.east_m};
  const double variance = left.east_m * left.east_m * lie_.P(kLieE, kLieE) +
                          2.0 * left.east_m * left.north_m * lie_.P(kLieE, kLieN) +
                          left.north_m * left.north_m * lie_.P(kLieN, kLieN);
  return aside * aside <= part * part + variance;
}

/// A suspicion that came to nothing begins anew at the next position.
void RunOff::weigh(Filter& f, double& ratio) noexcept {
  const double more = f.log_likelihood - ground_.log_likelihood;
  ratio = std::min(kKept, ratio + std::clamp(more, -kOfOneLook, kOfOneLook));
  if (ratio > 0.0) return;
  ratio = 0.0;
  f = suspect(f.lies);
}

void RunOff::look(const Look& look) noexcept {
  if (!look.judgeable) return forget();
  if (!follows(look)) return begin(look);
  for (Filter* f : {&ground_, &lie_, &gyro_}) predict(*f, look);
  const auto beyond_m = [&](const Filter& f) {
    const double arm_m = std::hypot(look.arm.east_m, look.arm.north_m);
    return std::hypot(look.spot.at.east_m - f.x(kAtEast), look.spot.at.north_m - f.x(kAtNorth)) -
           arm_m;
  };
  if (std::min(beyond_m(ground_), beyond_m(lie_)) > kJump_m) return begin(look);
  for (Filter* f : {&ground_, &lie_, &gyro_}) update(*f, look);
  const bool spins = like_spinning(look);
  last_ = look;
  if (!ground_.x.allFinite() || !lie_.x.allFinite() || !gyro_.x.allFinite()) return forget();
  weigh(lie_, lie_ratio_);
  weigh(gyro_, gyro_ratio_);
  if (spins && lie_ratio_ >= kSpinsFrom) {
    lie_ratio_ = 0.0;
    lie_ = suspect(Lies::Receiver);
  }
  ++lie_looks_;
  if (lie_ratio_ <= 0.0) {
    lie_since_ = look.spot.t;
    lie_looks_ = 0;
  }
  const double more = std::min(lie_ratio_ / kEnough, (lie_ratio_ - gyro_ratio_) / kMoreThanGyro);
  const bool fits = lie_looks_ >= kFewestLooks && lie_.nis < kFits;
  proof_ = std::max(0.0, fits ? more : std::min(more, 0.99));
}

Difference RunOff::off() const noexcept {
  const double since_s = seconds(last_.spot.t - lie_since_);
  return {Difference::Of::Way, since_s * std::hypot(lie_.x(kLieE), lie_.x(kLieN)), since_s};
}

}  // namespace roverd::nav
