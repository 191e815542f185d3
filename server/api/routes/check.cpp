// What speaks against driving a mission: asked for, and before every load.

#include <utility>

#include "api/checks.hpp"
#include "api/context.hpp"

namespace roverd::api {

namespace {

Json report_json(const mission::CheckReport& report, const Profile& profile) {
  const auto or_null = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
  };
  const mission::Estimate& e = report.estimate;
  Json battery_pct = nullptr;
  if (e.energy_wh && profile.limits.battery_wh) {
    battery_pct = 100.0 * *e.energy_wh / *profile.limits.battery_wh;
  }
  return {{"ready", report.errors == 0},
          {"errors", report.errors},
          {"warnings", report.warnings},
          {"findings", findings_json(report, std::nullopt)},
          {"length_m", e.length_m},
          {"time_s", or_null(e.time_s)},
          {"energy_wh", or_null(e.energy_wh)},
          {"battery_pct", std::move(battery_pct)}};
}

Handler check_mission(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    constexpr std::int64_t kMost = 1'000'000'000;
    const auto revision = members.whole("revision", 1, kMost);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    const auto answer = [context, call](base::Result<store::StoredMission> stored) {
      if (!stored) return call->respond(problem(stored.error()));
      const Effort effort{2 * bytes_of(stored->plan)};
      context->answer_aside(call, effort,
                            [check = checker(*context), fence = context->fence,
                             profile = context->deps.profile, mission = std::move(*stored)] {
                              Json out = report_json(check(mission.plan), profile);
                              out["mission_id"] = mission.id;
                              out["revision"] = mission.revision;
                              out["fence_id"] = fence ? Json(fence->id) : Json(nullptr);
                              return json_response(http::status::ok, out);
                            });
    };
    if (revision) {
      context->deps.store.read_revision(call->params.at("id"), *revision, answer);
    } else {
      context->deps.store.read_mission(call->params.at("id"), answer);
    }
  };
}

}  // namespace

std::function<mission::CheckReport(const mission::Plan&)> checker(const Context& context) {
  mission::Surroundings around;
  const auto snapshot = context.deps.robot.snapshot();
  if (snapshot && snapshot->pose &&
      base::seconds(base::steady_now() - snapshot->pose->stamp) <= StaleAfter::kPosition_s) {
    around.vehicle = snapshot->pose->global;
  }
  return [around, fence = context.fence,
          limits = context.deps.profile.limits](const mission::Plan& plan) mutable {
    if (fence) around.fence = &fence->fence;
    return mission::check(plan, limits, around);
  };
}

Json findings_json(const mission::CheckReport& report, std::optional<mission::Severity> severity) {
  Json out = Json::array();
  for (const mission::Finding& finding : report.findings) {
    if (severity && finding.severity != *severity) continue;
    out.push_back({{"severity", mission::to_string(finding.severity)},
                   {"code", finding.code},
                   {"pointer", finding.pointer},
                   {"item", finding.item ? Json(*finding.item) : Json(nullptr)},
                   {"detail", finding.detail}});
  }
  return out;
}

base::Error refusal(const mission::CheckReport& report) {
  base::Error error{base::Code::Invalid, {}, {}};
  for (const mission::Finding& finding : report.findings) {
    if (finding.severity != mission::Severity::Error) continue;
    const std::string who = finding.item ? "item " + std::to_string(*finding.item) + " " : "";
    if (error.detail.empty()) error.detail = who + finding.detail;
    error.fields.push_back({finding.pointer, finding.detail});
  }
  if (report.errors > 1) {
    error.detail += "; " + std::to_string(report.errors) + " findings in all";
  }
  return error;
}

void add_check_routes(const ContextPtr& c) {
  c->router.add({http::verb::post,
                 "/missions/{id}/check",
                 {200, 400, 403, 404, 413, 415, 422, 429, 503},
                 check_mission(c)});
}

}  // namespace roverd::api
