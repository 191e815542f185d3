// What each call needs. Anyone may stop: to take part in a stop nobody has to be known. What is not
// in here needs an admin.

#include <algorithm>
#include <array>

#include "api/access.hpp"

namespace roverd::api {

namespace {

struct Row {
  std::string_view operation;
  Need need;
};

constexpr Row kTable[] = {
    // who is not known yet, and the stop
    {"GET /health", Need::Anyone},
    {"GET /session", Need::Anyone},
    {"POST /session", Need::Anyone},
    {"POST /setup", Need::Anyone},
    {"POST /vehicle/estop", Need::Anyone},
    // reads
    {"GET /drivers", Need::Viewer},
    {"GET /drivers/{name}", Need::Viewer},
    {"GET /events", Need::Viewer},
    {"GET /execution", Need::Viewer},
    {"GET /execution/preview", Need::Viewer},
    {"GET /fence", Need::Viewer},
    {"GET /fences", Need::Viewer},
    {"GET /fences/{id}", Need::Viewer},
    {"GET /fences/{id}/revisions", Need::Viewer},
    {"GET /gnss/satellites", Need::Viewer},
    {"GET /metrics", Need::Viewer},
    {"GET /missions", Need::Viewer},
    {"GET /missions/{id}", Need::Viewer},
    {"GET /missions/{id}/compare", Need::Viewer},
    {"GET /missions/{id}/export", Need::Viewer},
    {"GET /missions/{id}/revisions", Need::Viewer},
    {"GET /missions/{id}/revisions/{revision}", Need::Viewer},
    {"GET /openapi.json", Need::Viewer},
    {"GET /parameters", Need::Viewer},
    {"GET /parameters/{name}", Need::Viewer},
    {"GET /routes", Need::Viewer},
    {"GET /routes/{id}", Need::Viewer},
    {"GET /runs", Need::Viewer},
    {"GET /runs/{id}", Need::Viewer},
    {"GET /runs/{id}/report", Need::Viewer},
    {"GET /runs/{id}/track", Need::Viewer},
    {"GET /safety/drill", Need::Viewer},
    {"DELETE /session", Need::Viewer},
    {"GET /sessions", Need::Viewer},
    {"DELETE /sessions/{id}", Need::Viewer},
    {"GET /stream", Need::Viewer},
    {"GET /tags", Need::Viewer},
    {"GET /teach", Need::Viewer},
    {"GET /tiles", Need::Viewer},
    {"GET /tiles/{set}/{z}/{x}/{y}", Need::Viewer},
    {"GET /vehicle", Need::Viewer},
    {"GET /vehicle/capabilities", Need::Viewer},
    {"GET /vehicle/checks", Need::Viewer},
    {"GET /vehicle/lights", Need::Viewer},
    {"GET /vehicle/trail", Need::Viewer},
    {"GET /vehicle/way_home", Need::Viewer},
    // drives and edits
    {"POST /drivers/{name}/restart", Need::Operator},
    {"DELETE /execution/left_behind", Need::Operator},
    {"POST /execution/load", Need::Operator},
    {"POST /execution/pause", Need::Operator},
    {"POST /execution/resume", Need::Operator},
    {"POST /execution/skip", Need::Operator},
    {"POST /execution/start", Need::Operator},
    {"POST /execution/stop", Need::Operator},
    {"PUT /fence", Need::Operator},
    {"POST /fences", Need::Operator},
    {"DELETE /fences/{id}", Need::Operator},
    {"PUT /fences/{id}", Need::Operator},
    {"POST /fences/{id}/revert", Need::Operator},
    {"POST /missions", Need::Operator},
    {"POST /missions/import", Need::Operator},
    {"POST /missions/survey", Need::Operator},
    {"DELETE /missions/{id}", Need::Operator},
    {"PATCH /missions/{id}", Need::Operator},
    {"PUT /missions/{id}", Need::Operator},
    {"POST /missions/{id}/check", Need::Operator},
    {"POST /missions/{id}/copy", Need::Operator},
    {"POST /missions/{id}/operations", Need::Operator},
    {"POST /missions/{id}/restore", Need::Operator},
    {"POST /missions/{id}/revert", Need::Operator},
    {"POST /routes/import", Need::Operator},
    {"POST /routes/plan", Need::Operator},
    {"DELETE /routes/{id}", Need::Operator},
    {"DELETE /runs/{id}", Need::Operator},
    {"DELETE /safety/drill", Need::Operator},
    {"POST /safety/drill", Need::Operator},
    {"POST /teach/discard", Need::Operator},
    {"POST /teach/pause", Need::Operator},
    {"POST /teach/resume", Need::Operator},
    {"POST /teach/start", Need::Operator},
    {"POST /teach/stop", Need::Operator},
    {"POST /vehicle/acknowledge", Need::Operator},
    {"DELETE /vehicle/anchor", Need::Operator},
    {"POST /vehicle/anchor", Need::Operator},
    {"POST /vehicle/arm", Need::Operator},
    {"POST /vehicle/disarm", Need::Operator},
    {"POST /vehicle/errors/clear", Need::Operator},
    {"POST /vehicle/estop/reset", Need::Operator},
    {"POST /vehicle/goto", Need::Operator},
    {"PUT /vehicle/home", Need::Operator},
    {"PUT /vehicle/lights", Need::Operator},
    {"PUT /vehicle/mode", Need::Operator},
    {"POST /vehicle/move", Need::Operator},
    {"PUT /vehicle/pose", Need::Operator},
    {"POST /vehicle/resume", Need::Operator},
    {"PUT /vehicle/target", Need::Operator},
    // sets parameters, users, tokens
    {"PUT /parameters/{name}", Need::Admin},
    {"GET /tokens", Need::Admin},
    {"POST /tokens", Need::Admin},
    {"DELETE /tokens/{id}", Need::Admin},
    {"GET /users", Need::Admin},
    {"POST /users", Need::Admin},
    {"DELETE /users/{name}", Need::Admin},
    {"PATCH /users/{name}", Need::Admin},
};

constexpr Row kMessages[] = {
    {"estop", Need::Anyone},  {"subscribe", Need::Viewer}, {"ping", Need::Viewer},
    {"halt", Need::Operator}, {"drive", Need::Operator},
};

template <std::size_t n>
std::optional<Need> find(const Row (&table)[n], std::string_view name) {
  const auto* const row = std::find_if(std::begin(table), std::end(table),
                                       [&](const Row& r) { return r.operation == name; });
  return row == std::end(table) ? std::nullopt : std::optional(row->need);
}

}  // namespace

std::optional<Need> need_of(std::string_view operation) {
  return find(kTable, operation);
}

std::optional<Need> need_of_message(std::string_view member) {
  return find(kMessages, member);
}

}  // namespace roverd::api
