// What each call needs: which role, and whether control must be held. Control: what moves or arms
// the robot, or changes its mode, its mission, its limits or what it believes. Not: what stops or
// slows it, what is stored only. Anyone may stop: to take part in a stop nobody has to be known.
// What is not in here needs an admin who holds control.

#include <algorithm>
#include <array>

#include "api/access.hpp"

namespace roverd::api {

namespace {

struct Row {
  std::string_view operation;
  Need need;
  /// Of what only reads: no. Whatever changes something says it.
  NeedsControl control = NeedsControl::No;
};

constexpr Row kTable[] = {
    // who is not known yet, and the stop
    {"GET /health", Need::Anyone},
    {"GET /session", Need::Anyone},
    {"POST /session", Need::Anyone, NeedsControl::No},
    {"POST /invitations/accept", Need::Anyone, NeedsControl::No},
    {"POST /setup", Need::Anyone, NeedsControl::No},
    {"POST /vehicle/estop", Need::Anyone, NeedsControl::No},
    // reads
    {"GET /control", Need::Viewer},
    {"GET /devices", Need::Viewer},
    {"DELETE /devices/{id}", Need::Viewer, NeedsControl::No},
    {"GET /drivers", Need::Viewer},
    {"GET /drivers/{name}", Need::Viewer},
    {"GET /events", Need::Viewer},
    {"GET /execution", Need::Viewer},
    {"GET /execution/preview", Need::Viewer},
    {"GET /execution/way", Need::Viewer},
    {"GET /fence", Need::Viewer},
    {"GET /fences", Need::Viewer},
    {"GET /fences/{id}", Need::Viewer},
    {"GET /fences/{id}/revisions", Need::Viewer},
    {"GET /gnss/satellites", Need::Viewer},
    {"GET /maps", Need::Viewer},
    {"GET /maps/{id}", Need::Viewer},
    {"GET /maps/{id}/cells", Need::Viewer},
    {"GET /maps/{id}/export", Need::Viewer},
    {"GET /known-places", Need::Viewer},
    {"GET /landmarks", Need::Viewer},
    {"GET /metrics", Need::Viewer},
    {"GET /missions", Need::Viewer},
    {"GET /missions/{id}", Need::Viewer},
    {"GET /missions/{id}/compare", Need::Viewer},
    {"GET /missions/{id}/export", Need::Viewer},
    {"GET /missions/{id}/revisions", Need::Viewer},
    {"GET /missions/{id}/revisions/{revision}", Need::Viewer},
    {"GET /obstacles", Need::Viewer},
    {"GET /openapi.json", Need::Viewer},
    {"GET /parameters", Need::Viewer},
    {"GET /cameras", Need::Viewer},
    {"GET /cameras/{name}/snapshot", Need::Viewer},
    {"GET /parameters/{name}", Need::Viewer},
    {"GET /routes", Need::Viewer},
    {"GET /routes/{id}", Need::Viewer},
    {"GET /runs", Need::Viewer},
    {"GET /runs/{id}", Need::Viewer},
    {"GET /runs/{id}/report", Need::Viewer},
    {"GET /runs/{id}/track", Need::Viewer},
    {"GET /safety/drill", Need::Viewer},
    {"DELETE /session", Need::Viewer, NeedsControl::No},
    {"POST /session/password", Need::Viewer, NeedsControl::No},
    {"GET /sessions", Need::Viewer},
    {"DELETE /sessions", Need::Viewer, NeedsControl::No},
    {"DELETE /sessions/{id}", Need::Viewer, NeedsControl::No},
    {"GET /sensors", Need::Viewer},
    {"GET /slips", Need::Viewer},
    {"GET /stream", Need::Viewer},
    {"GET /tags", Need::Viewer},
    {"GET /teach", Need::Viewer},
    {"GET /tiles", Need::Viewer},
    {"GET /tiles/{set}/{z}/{x}/{y}", Need::Viewer},
    {"GET /vehicle", Need::Viewer},
    {"GET /vehicle/calibration", Need::Viewer},
    {"GET /vehicle/capabilities", Need::Viewer},
    {"GET /vehicle/checks", Need::Viewer},
    {"GET /vehicle/lights", Need::Viewer},
    {"GET /vehicle/trail", Need::Viewer},
    {"GET /vehicle/way_home", Need::Viewer},
    // drives and edits
    {"POST /control/handover", Need::Operator, NeedsControl::No},
    {"POST /control/release", Need::Operator, NeedsControl::No},
    {"POST /control/take", Need::Operator, NeedsControl::No},
    {"POST /devices", Need::Operator, NeedsControl::No},
    {"POST /drivers/{name}/restart", Need::Operator, NeedsControl::Yes},
    {"DELETE /execution/left_behind", Need::Operator, NeedsControl::Yes},
    {"POST /execution/load", Need::Operator, NeedsControl::Yes},
    {"POST /execution/pause", Need::Operator, NeedsControl::No},
    {"POST /execution/resume", Need::Operator, NeedsControl::Yes},
    {"POST /execution/skip", Need::Operator, NeedsControl::Yes},
    {"POST /execution/start", Need::Operator, NeedsControl::Yes},
    {"POST /execution/stop", Need::Operator, NeedsControl::No},
    {"PUT /fence", Need::Operator, NeedsControl::Yes},
    {"POST /fences", Need::Operator, NeedsControl::No},
    {"DELETE /fences/{id}", Need::Operator, NeedsControl::IfActive},
    {"PUT /fences/{id}", Need::Operator, NeedsControl::IfActive},
    {"POST /fences/{id}/revert", Need::Operator, NeedsControl::IfActive},
    {"POST /invitations", Need::Operator, NeedsControl::No},
    {"POST /maps", Need::Operator, NeedsControl::No},
    {"POST /maps/start", Need::Operator, NeedsControl::Yes},
    {"POST /maps/stop", Need::Operator, NeedsControl::Yes},
    {"POST /maps/unuse", Need::Operator, NeedsControl::Yes},
    {"DELETE /known-places/{name}", Need::Operator, NeedsControl::Yes},
    {"PUT /known-places/{name}", Need::Operator, NeedsControl::Yes},
    {"DELETE /maps/{id}", Need::Operator, NeedsControl::No},
    {"PATCH /maps/{id}", Need::Operator, NeedsControl::IfActive},
    {"POST /maps/{id}/use", Need::Operator, NeedsControl::Yes},
    {"POST /missions", Need::Operator, NeedsControl::No},
    {"POST /missions/import", Need::Operator, NeedsControl::No},
    {"POST /missions/rows", Need::Operator, NeedsControl::No},
    {"POST /missions/survey", Need::Operator, NeedsControl::No},
    {"DELETE /missions/{id}", Need::Operator, NeedsControl::No},
    {"PATCH /missions/{id}", Need::Operator, NeedsControl::No},
    {"PUT /missions/{id}", Need::Operator, NeedsControl::No},
    {"POST /missions/{id}/check", Need::Operator, NeedsControl::No},
    {"POST /missions/{id}/copy", Need::Operator, NeedsControl::No},
    {"POST /missions/{id}/operations", Need::Operator, NeedsControl::No},
    {"POST /missions/{id}/restore", Need::Operator, NeedsControl::No},
    {"POST /missions/{id}/revert", Need::Operator, NeedsControl::No},
    {"POST /routes/import", Need::Operator, NeedsControl::No},
    {"POST /routes/plan", Need::Operator, NeedsControl::No},
    {"DELETE /routes/{id}", Need::Operator, NeedsControl::No},
    {"DELETE /runs/{id}", Need::Operator, NeedsControl::No},
    {"DELETE /safety/drill", Need::Operator, NeedsControl::No},
    {"POST /safety/drill", Need::Operator, NeedsControl::No},
    {"DELETE /slips", Need::Operator, NeedsControl::No},
    {"POST /tiles", Need::Operator, NeedsControl::No},
    {"DELETE /tiles/{set}", Need::Operator, NeedsControl::No},
    {"PATCH /tiles/{set}", Need::Operator, NeedsControl::No},
    {"PUT /tiles/{set}/file", Need::Operator, NeedsControl::No},
    {"PUT /tiles/{set}/{z}/{x}/{y}", Need::Operator, NeedsControl::No},
    {"POST /teach/discard", Need::Operator, NeedsControl::Yes},
    {"POST /teach/pause", Need::Operator, NeedsControl::Yes},
    {"POST /teach/resume", Need::Operator, NeedsControl::Yes},
    {"POST /teach/start", Need::Operator, NeedsControl::Yes},
    {"POST /teach/stop", Need::Operator, NeedsControl::Yes},
    {"POST /vehicle/acknowledge", Need::Operator, NeedsControl::Yes},
    {"DELETE /vehicle/anchor", Need::Operator, NeedsControl::Yes},
    {"POST /vehicle/anchor", Need::Operator, NeedsControl::Yes},
    {"POST /vehicle/antennas-offset", Need::Operator, NeedsControl::Yes},
    {"POST /vehicle/arm", Need::Operator, NeedsControl::Yes},
    {"POST /vehicle/base-shift", Need::Operator, NeedsControl::Yes},
    {"DELETE /vehicle/calibration", Need::Operator, NeedsControl::Yes},
    {"POST /vehicle/calibration", Need::Operator, NeedsControl::Yes},
    {"POST /vehicle/calibration/discard", Need::Operator, NeedsControl::Yes},
    {"POST /vehicle/calibration/keep", Need::Operator, NeedsControl::Yes},
    {"POST /vehicle/disarm", Need::Operator, NeedsControl::No},
    {"POST /vehicle/errors/clear", Need::Operator, NeedsControl::Yes},
    {"POST /vehicle/estop/reset", Need::Operator, NeedsControl::Yes},
    {"POST /vehicle/goto", Need::Operator, NeedsControl::Yes},
    {"PUT /vehicle/home", Need::Operator, NeedsControl::Yes},
    {"PUT /vehicle/lights", Need::Operator, NeedsControl::No},
    {"PUT /vehicle/mode", Need::Operator, NeedsControl::UnlessHold},
    {"POST /vehicle/move", Need::Operator, NeedsControl::Yes},
    {"PUT /vehicle/pose", Need::Operator, NeedsControl::Yes},
    {"POST /vehicle/resume", Need::Operator, NeedsControl::Yes},
    {"PUT /vehicle/target", Need::Operator, NeedsControl::Yes},
    // sets parameters, users, tokens
    {"PUT /parameters/{name}", Need::Admin, NeedsControl::Yes},
    {"GET /audit", Need::Admin},
    {"GET /audit/check", Need::Admin},
    {"GET /audit/export", Need::Admin},
    {"GET /tokens", Need::Admin},
    {"POST /tokens", Need::Admin, NeedsControl::No},
    {"DELETE /tokens/{id}", Need::Admin, NeedsControl::No},
    {"GET /users", Need::Admin},
    {"POST /users", Need::Admin, NeedsControl::No},
    {"DELETE /users/{name}", Need::Admin, NeedsControl::No},
    {"PATCH /users/{name}", Need::Admin, NeedsControl::No},
};

constexpr Row kMessages[] = {
    {"estop", Need::Anyone},
    {"subscribe", Need::Viewer},
    {"ping", Need::Viewer},
    {"halt", Need::Operator},
    {"drive", Need::Operator, NeedsControl::Yes},
    {"throttle", Need::Operator, NeedsControl::Yes},
};

template <std::size_t n>
const Row* find(const Row (&table)[n], std::string_view name) {
  const auto* const row = std::find_if(std::begin(table), std::end(table),
                                       [&](const Row& r) { return r.operation == name; });
  return row == std::end(table) ? nullptr : row;
}

std::optional<Need> need_in(const Row* row) {
  return row == nullptr ? std::nullopt : std::optional(row->need);
}

}  // namespace

std::optional<Need> need_of(std::string_view operation) {
  return need_in(find(kTable, operation));
}

std::optional<Need> need_of_message(std::string_view member) {
  return need_in(find(kMessages, member));
}

NeedsControl needs_control(std::string_view operation) {
  const Row* const row = find(kTable, operation);
  return row == nullptr ? NeedsControl::Yes : row->control;
}

std::string_view to_string(NeedsControl needs) noexcept {
  switch (needs) {
    case NeedsControl::No:
      return "not needed";
    case NeedsControl::Yes:
      return "needed";
    case NeedsControl::UnlessHold:
      return "needed, except for HOLD";
    case NeedsControl::IfActive:
      return "needed if it is in force";
  }
  return "";
}

}  // namespace roverd::api
