#pragma once
// Positions that run away over ground from where tracks and gyro lead. Ground gives way, but never
// like this: it slides downhill, aside for each metre that is driven, or holds back what the tracks
// do, and from place to place otherwise. A receiver that lies drifts by so much each second, in the
// same direction over ground whichever way the robot points and however fast it goes.
//
// Three filters follow the same positions along the tracks' way, laid out by the gyro:
//
//   ground   the heading; the scale s of the way and the crab c beside it, which wander from place
//            to place; the slide g, downhill, as far as the slope allows
//              Δp = R(ψ + ref) · (s, c) · ahead + g · path
//            and what is shown: z = p + R · (arm + centre, 0) − late · Δp/Δt
//            for it turns about a place ahead of or behind its middle, and positions come late
//   lie      the same, and the receiver drifts:      Δp += d · Δt
//   gyro     the same, and the gyro turns too fast:  Δψ += b · Δt
//
// What proves the lie is by how much it foretells the positions better than the ground does, as a
// logarithm of the likelihoods' ratio, summed up from where it last was none (CUSUM; Page 1954),
// and that a gyro which lies does not foretell them as well.
//
// Pure but for its memory; no allocation.

#include <optional>

#include <Eigen/Dense>

#include "nav/vote/compare.hpp"

namespace roverd::nav {

class RunOff {
 public:
  /// Where it is asked: at every new position.
  struct Look {
    Spot spot;
    Moment at;                ///< of the curve, when the receiver was there
    base::EnuPoint arm;       ///< to the antenna: ahead and to the left of the centre, m
    base::EnuPoint downhill;  ///< ahead and to the left: the ground falls by so much for each metre
    double doubt = 0.0;       ///< of that, 1 sigma; the most where nothing tells how it leans
    bool judgeable = false;   ///< RTK fixed, tracks and gyro are heard and do not spin
  };

  void look(const Look& look) noexcept;
  void forget() noexcept { begun_ = false, proof_ = 0.0; }

  /// How much is proved, of what is enough (1).
  double proved() const noexcept { return proof_; }
  /// How far and for how long the receiver ran off, as it seems. @return a Way.
  Difference off() const noexcept;

 private:
  enum Index : int {
    kAtEast,
    kAtNorth,
    kHeading,
    kWayShare,
    kAside,
    kFallE,
    kFallN,
    kCentre,
    kLate,
    kLieE,
    kLieN,
    kSize
  };
  /// The last two states: nothing, the receiver's drift (m/s), or the gyro's error (rad/s; first).
  enum class Lies { Nobody, Receiver, Gyro };
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  struct Filter {
    Vector x = Vector::Zero();
    Matrix P = Matrix::Zero();
    base::EnuPoint mps;  ///< lately
    Lies lies = Lies::Nobody;
    double log_likelihood = 0.0;  ///< of the last position
    double nis = 0.0;
  };

  void begin(const Look& look) noexcept;
  bool like_spinning(const Look& to) const noexcept;
  bool follows(const Look& look) const noexcept;
  void predict(Filter& f, const Look& to) const noexcept;
  void update(Filter& f, const Look& to) const noexcept;
  static base::EnuPoint slides_to(const Filter& f, const Look& look) noexcept;
  Filter suspect(Lies who) const noexcept;
  void weigh(Filter& f, double& ratio) noexcept;

  bool begun_ = false;
  Look last_;
  Filter ground_, lie_, gyro_;
  double lie_ratio_ = 0.0;
  double gyro_ratio_ = 0.0;
  Time lie_since_{};
  int lie_looks_ = 0;
  double proof_ = 0.0;
};

}  // namespace roverd::nav
