#include "nav/mapping/mapper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace roverd::nav::mapping {

namespace {

constexpr double kThin_m = 0.05;
constexpr double kFarthest_m = 30.0;   // points beyond it turn too much with the yaw
constexpr std::size_t kTogether = 10;  // nodes after which loops are looked for
constexpr std::size_t kBeside = 6;     // nodes to either side that make a place
constexpr std::size_t kPlaces = 2;     // tried for one node
constexpr std::size_t kSecond = 4;     // nodes before: the one that must agree
constexpr double kAgree_m = 0.25;
constexpr double kAgree_rad = 0.05;

double distance_m(const Pose2& a, const Pose2& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

Points hits_of(const chart::Scan& scan) {
  Points out;
  for (const chart::Beam& beam : scan.beams) {
    const float range_m = std::hypot(beam.x_m - scan.eye_x_m, beam.y_m - scan.eye_y_m);
    if (beam.hit && range_m < static_cast<float>(kFarthest_m)) out.push_back({beam.x_m, beam.y_m});
  }
  return thinned(out, kThin_m);
}

void append_moved(const Points& points, const Pose2& by, Points& out) {
  const Eigen::Rotation2Df turn(static_cast<float>(by.yaw_rad));
  const Eigen::Vector2f to(static_cast<float>(by.x_m), static_cast<float>(by.y_m));
  for (const auto& p : points) out.push_back(turn * p + to);
}

/// What was measured in M, for an edge that begins at a.
Eigen::Matrix3d in_frame_of(const Pose2& a, const Eigen::Matrix3d& covariance) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-a.yaw_rad).toRotationMatrix();
  // No scan is surer than the grid and the sensor's own noise.
  const Eigen::Vector3d floor(0.02 * 0.02, 0.02 * 0.02, 0.004 * 0.004);
  return turn * covariance * turn.transpose() + Eigen::Matrix3d(floor.asDiagonal());
}

}  // namespace

Window Mapper::window_for(const Pose2& step) const {
  const double d = std::hypot(step.x_m, step.y_m);
  const double turn = std::abs(step.yaw_rad);
  Window w;
  w.guess_m = 0.02 + p_.slip * d;
  w.guess_rad = 0.01 + p_.drift_radpm * d + p_.drift * turn;
  w.m = std::min(0.1 + 3.0 * w.guess_m, 1.0);
  w.rad = std::min(0.05 + 3.0 * w.guess_rad, 0.6);
  return w;
}

base::Result<void> Mapper::add(const chart::Scan& scan, const Pose2& odometry) {
  if (!std::isfinite(odometry.x_m) || !std::isfinite(odometry.y_m) ||
      !std::isfinite(odometry.yaw_rad)) {
    return base::fail(base::Code::Invalid, "the odometry of a scan is no number");
  }
  if (nodes_.size() >= kMostNodes || path_.size() >= kMostScans) {
    return base::fail(base::Code::TooLarge, "the map has as many scans as it may have");
  }
  if (nodes_.empty()) {
    last_odometry_ = odometry;
    add_node(scan, odometry, {});
    return {};
  }
  const Pose2 step = inverse(last_odometry_) * odometry;
  last_odometry_ = odometry;
  way_m_ += std::hypot(step.x_m, step.y_m);
  const Pose2 guess = pose() * step;
  const Window window = window_for(step);
  const Points points = hits_of(scan);
  Fit fit = search(*local_, points, guess, window);
  if (!(fit.score >= p_.least_fit)) {
    ++unfit_;
    fit.pose = guess;
    const double m2 = 0.01 + window.guess_m * window.guess_m;
    fit.covariance =
        Eigen::Vector3d(m2, m2, 1e-3 + window.guess_rad * window.guess_rad).asDiagonal();
  }
  const Pose2 x_nb = inverse(poses_.back()) * fit.pose;
  if (std::hypot(x_nb.x_m, x_nb.y_m) < p_.node_m && std::abs(x_nb.yaw_rad) < p_.node_rad) {
    path_.push_back({nodes_.size() - 1, x_nb});
    return {};
  }
  add_node(scan, fit.pose, fit);
  if (p_.loops && nodes_.size() >= looked_ + kTogether) close_loops(nullptr);
  return {};
}

void Mapper::add_node(const chart::Scan& scan, const Pose2& pose, const Fit& fit) {
  if (!nodes_.empty()) {
    const Pose2& before = poses_.back();
    edges_.push_back({nodes_.size() - 1, nodes_.size(), inverse(before) * pose,
                      in_frame_of(before, fit.covariance)});
  }
  nodes_.push_back({scan, hits_of(scan), way_m_});
  poses_.push_back(pose);
  path_.push_back({nodes_.size() - 1, {}});
  refresh_local();
}

void Mapper::refresh_local() {
  Points all;
  const std::size_t from = nodes_.size() > p_.local ? nodes_.size() - p_.local : 0;
  for (std::size_t i = from; i < nodes_.size(); ++i) append_moved(nodes_[i].points, poses_[i], all);
  local_.emplace(thinned(all, 0.5 * Field::kCell_m));
}

Field Mapper::field_around(std::size_t node) const {
  Points all;
  const Pose2 x_nm = inverse(poses_[node]);
  const std::size_t from = node > kBeside ? node - kBeside : 0;
  for (std::size_t i = from; i < std::min(node + kBeside + 1, nodes_.size()); ++i) {
    append_moved(nodes_[i].points, x_nm * poses_[i], all);
  }
  return Field(thinned(all, 0.5 * Field::kCell_m));
}

void Mapper::close_loops(const GiveUp& give_up) {
  const std::size_t until = nodes_.size();
  for (std::size_t node = looked_ + kTogether / 2; node < until; node += kTogether / 2) {
    if (give_up && give_up()) return;
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t i = 0; i < node; ++i) {
      if (nodes_[node].way_m - nodes_[i].way_m < p_.loop_way_m) break;
      const double d = distance_m(poses_[node], poses_[i]);
      if (d < p_.loop_reach_m) near.emplace_back(d, i);
    }
    std::sort(near.begin(), near.end());
    std::vector<std::size_t> tried;
    for (const auto& [d, place] : near) {
      const bool same = std::any_of(tried.begin(), tried.end(), [&, at = place](std::size_t t) {
        return std::max(t, at) - std::min(t, at) <= 2 * kBeside;
      });
      if (same) continue;
      tried.push_back(place);
      try_loop(node, place);
      if (tried.size() == kPlaces) break;
    }
  }
  looked_ = until;
  if (found_ > 0) settle();
}

void Mapper::try_loop(std::size_t node, std::size_t place) {
  if (node < kSecond) return;
  const Field field = field_around(place);
  const double since_m = nodes_[node].way_m - nodes_[place].way_m;
  Window wide;
  wide.m = std::min(p_.loop_search_m + 0.02 * since_m, p_.loop_most_m);
  wide.rad = p_.loop_search_rad;
  const Pose2 guess = inverse(poses_[place]) * poses_[node];
  const Fit fit = search(field, nodes_[node].points, guess, wide);
  if (fit.score < p_.loop_fit) return;
  // A second scan, some nodes before, must lie where the first one says that it does.
  const std::size_t second = node - kSecond;
  const Pose2 said = fit.pose * (inverse(poses_[node]) * poses_[second]);
  const Fit again = search(field, nodes_[second].points, said, {2.0 * kAgree_m, 2.0 * kAgree_rad});
  if (again.score < p_.loop_fit || distance_m(again.pose, said) > kAgree_m ||
      std::abs(base::wrap_rad(again.pose.yaw_rad - said.yaw_rad)) > kAgree_rad) {
    return;
  }
  edges_.push_back({place, node, fit.pose, in_frame_of({}, fit.covariance), true});
  edges_.push_back({place, second, again.pose, in_frame_of({}, again.covariance), true});
  ++found_;
}

void Mapper::settle() {
  found_ = 0;
  if (!relax(edges_, poses_)) return;
  const std::size_t before = edges_.size();
  std::erase_if(edges_,
                [&](const Edge& e) { return e.loop && strain(e, poses_) > p_.loop_strain; });
  dropped_ += before - edges_.size();
  if (edges_.size() != before) relax(edges_, poses_);
  refresh_local();
}

void Mapper::finish(const GiveUp& give_up) {
  if (p_.loops && !nodes_.empty()) close_loops(give_up);
}

Pose2 Mapper::pose() const {
  if (path_.empty()) return {};
  return poses_[path_.back().node] * path_.back().x_nb;
}

std::vector<Pose2> Mapper::path() const {
  std::vector<Pose2> out;
  out.reserve(path_.size());
  for (const Hanging& h : path_) out.push_back(poses_[h.node] * h.x_nb);
  return out;
}

Mapper::Counts Mapper::counts() const {
  const auto loops =
      std::count_if(edges_.begin(), edges_.end(), [](const Edge& e) { return e.loop; });
  return {path_.size(), nodes_.size(), unfit_, static_cast<std::size_t>(loops), dropped_};
}

base::Result<chart::OccupancyMap> Mapper::draw(const DrawParams& how) const {
  std::vector<const chart::Scan*> scans;
  for (const Node& node : nodes_) scans.push_back(&node.scan);
  return drawn(scans, poses_, how);
}

}  // namespace roverd::nav::mapping
