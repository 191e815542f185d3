// What speaks against driving a mission: asked for, and before every load.

#include <algorithm>
#include <utility>

#include "api/checks.hpp"
#include "api/context.hpp"
#include "robot/compile.hpp"
#include "robot/safety/start_check.hpp"

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
  return {{"ready", report.errors == 0},       {"errors", report.errors},
          {"warnings", report.warnings},       {"findings", findings_json(report, std::nullopt)},
          {"length_m", or_null(e.length_m)},   {"time_s", or_null(e.time_s)},
          {"energy_wh", or_null(e.energy_wh)}, {"battery_pct", std::move(battery_pct)}};
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
      const Effort effort{6 * bytes_of(stored->plan)};
      context->answer_aside(
          call, effort,
          [judge = judge_now(*context), fence = context->fence, profile = context->profile(),
           mission = std::move(*stored)]() mutable {
            const Verdict verdict = judge({mission.id, mission.revision, std::move(mission.plan)});
            Json out = report_json(verdict.report, profile);
            out["mission_id"] = mission.id;
            out["revision"] = mission.revision;
            out["smoothed"] =
                smoothed_json(verdict.compiled ? robot::smoothed_items(*verdict.compiled)
                                               : std::vector<robot::SmoothedItems>{});
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

/// Errors first, each kind of its severity by item, as the check itself puts them.
void add_findings(mission::CheckReport& report, std::vector<mission::Finding> more) {
  for (mission::Finding& finding : more) {
    const bool told =
        std::any_of(report.findings.begin(), report.findings.end(), [&](const auto& known) {
          return known.severity == finding.severity && known.pointer == finding.pointer &&
                 known.code == finding.code;
        });
    if (told) continue;
    ++(finding.severity == mission::Severity::Error ? report.errors : report.warnings);
    report.findings.push_back(std::move(finding));
  }
  std::stable_sort(report.findings.begin(), report.findings.end(),
                   [](const mission::Finding& a, const mission::Finding& b) {
                     if (a.severity != b.severity) return a.severity == mission::Severity::Error;
                     return a.item.value_or(0) < b.item.value_or(0);
                   });
  if (report.findings.size() > mission::kMaxFindings) {
    report.findings.resize(mission::kMaxFindings);
  }
}

/// What cannot be laid out, as findings: the items that the robot names.
std::vector<mission::Finding> not_laid_out(const base::Error& error,
                                           const mission::CheckReport& report) {
  std::vector<mission::Finding> out;
  const auto known = [&report](const std::string& pointer) {
    return std::any_of(report.findings.begin(), report.findings.end(), [&](const auto& finding) {
      return finding.pointer == pointer && finding.severity == mission::Severity::Error;
    });
  };
  for (const base::FieldError& f : error.fields) {
    if (known(f.pointer)) continue;
    mission::Finding finding{mission::Severity::Error, "not_drivable", f.pointer, {}, f.detail};
    constexpr std::string_view kItems = "/items/";
    if (f.pointer.starts_with(kItems)) {
      const std::string number = f.pointer.substr(kItems.size());
      if (const auto at = whole_number(number.substr(0, number.find('/')))) {
        finding.item = static_cast<int>(*at) + 1;
      }
    }
    out.push_back(std::move(finding));
  }
  if (error.fields.empty()) {
    out.push_back({mission::Severity::Error, "not_drivable", "/items", {}, error.detail});
  }
  return out;
}

/// What a verdict rests on.
struct Bench {
  robot::Robot& robot;
  const store::StoredFence* fence;
  const mission::VehicleLimits& limits;
  mission::Surroundings around;
};

/// Beside the web thread.
Verdict verdict_of(robot::MissionCopy copy, Bench bench) {
  Verdict out;
  auto compiled = bench.robot.compile(copy);
  // The robot compares with its fence, with the margin that it keeps. Where it has no map yet the
  // check itself looks whether the mission lies inside.
  const bool compared = compiled && bench.robot.fenced(**compiled);
  if (bench.fence && !compared) bench.around.fence = &bench.fence->fence;
  const mission::Plan& plan = compiled ? (*compiled)->copy.plan : copy.plan;
  out.report = mission::check(plan, bench.limits, bench.around);
  out.refusal.code = base::Code::Invalid;
  add_findings(out.report, bench.robot.changed_safety());
  if (compiled) {
    add_findings(out.report, bench.robot.objections(**compiled, {}));
    out.compiled = std::move(*compiled);
  } else {
    if (compiled.error().fields.empty()) out.refusal.code = compiled.error().code;
    add_findings(out.report, not_laid_out(compiled.error(), out.report));
  }
  out.lasting = out.report.errors;
  for (const mission::Finding& finding : out.report.findings) {
    if (finding.severity != mission::Severity::Error) continue;
    if (robot::of_the_moment(finding)) {
      --out.lasting;
      continue;
    }
    if (out.refusal.detail.empty()) out.refusal.detail = mission::sentence(finding);
    out.refusal.fields.push_back({finding.pointer, finding.detail});
  }
  if (out.lasting > 1) {
    out.refusal.detail += "; " + std::to_string(out.lasting) + " findings in all";
  }
  return out;
}

}  // namespace

std::function<Verdict(robot::MissionCopy)> judge_now(const Context& context) {
  mission::Surroundings around;
  const auto snapshot = context.deps.robot.snapshot();
  if (snapshot && snapshot->pose &&
      base::seconds(base::steady_now() - snapshot->pose->stamp) <= StaleAfter::kPosition_s) {
    around.vehicle = snapshot->pose->global;
  }
  return [around, &robot = context.deps.robot, fence = context.fence,
          limits = context.profile().limits](robot::MissionCopy copy) mutable {
    return verdict_of(std::move(copy), {robot, fence.get(), limits, around});
  };
}

Json finding_json(const mission::Finding& finding) {
  return {{"severity", mission::to_string(finding.severity)},
          {"code", finding.code},
          {"pointer", finding.pointer},
          {"item", finding.item ? Json(*finding.item) : Json(nullptr)},
          {"detail", finding.detail}};
}

Json findings_json(const mission::CheckReport& report, std::optional<mission::Severity> severity) {
  Json out = Json::array();
  for (const mission::Finding& finding : report.findings) {
    // What the robot's place speaks against is shown beside the warnings of a load: it may be
    // driven there by hand.
    const bool shown = !severity || finding.severity == *severity || robot::of_the_moment(finding);
    if (shown) out.push_back(finding_json(finding));
  }
  return out;
}

void add_check_routes(const ContextPtr& c) {
  c->router.add({http::verb::post,
                 "/missions/{id}/check",
                 {200, 400, 403, 404, 413, 415, 422, 429, 503},
                 check_mission(c)});
}

}  // namespace roverd::api
