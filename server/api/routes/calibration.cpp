// The guided calibration drive: what it needs, how far it has come, what becomes of it.

#include "api/context.hpp"

namespace roverd::api {

namespace {

const std::vector<unsigned> kBegun = {202, 400, 403, 409, 413, 415, 422, 429, 503};
const std::vector<unsigned> kSettled = {200, 400, 403, 409, 413, 415, 422, 429, 503};

/// The state with what each kind would need now.
Json whole(const ContextPtr& context, const base::Snapshot& snapshot) {
  Json out = calibration_json(snapshot);
  out["kinds"] = Json::array();
  for (const base::CalibrationKind kind : base::kCalibrationKinds) {
    if (const auto shown = context->deps.robot.calibration(kind)) {
      out["kinds"].push_back(calibration_preview_json(*shown));
    }
  }
  return out;
}

Handler begin_calibration(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    members.require("kind");
    robot::Calibrate command;
    if (const auto word = members.text("kind")) {
      const auto kind = base::calibration_from(*word);
      if (kind) command.kind = *kind;
      if (!kind) members.complain("kind", "must be drive, steering, compass or antennas");
    }
    const robot::Validity validity = validity_of(members, *call, Moves::Yes);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    context->commands.run(
        command, validity, base::steady_now(), [context, call](base::Result<void> result) {
          if (!result) return call->respond(problem(result.error()));
          const auto snapshot = context->snapshot_or_refuse(call);
          if (!snapshot) return;
          Response response = json_response(http::status::accepted, whole(context, *snapshot));
          response.set(http::field::location, "/api/v1/vehicle/calibration");
          call->respond(std::move(response));
        });
  };
}

/// A word about what was measured; nothing moves by it.
Handler settle_calibration(const ContextPtr& context, robot::Command command) {
  return [context, command = std::move(command)](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    const robot::Validity validity = validity_of(members, *call, Moves::No);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    run_command(context, call, command, validity,
                [context](const base::Snapshot& s) { return whole(context, s); });
  };
}

}  // namespace

void add_calibration_routes(const ContextPtr& c) {
  const std::string path = "/vehicle/calibration";
  c->router.add({http::verb::get, path, {200, 503}, [c](const CallPtr& call) {
                   if (const auto s = c->snapshot_or_refuse(call)) {
                     call->respond(json_response(http::status::ok, whole(c, *s)));
                   }
                 }});
  c->router.add({http::verb::post, path, kBegun, begin_calibration(c)});
  c->router.add({http::verb::post, path + "/keep", kSettled,
                 settle_calibration(c, robot::SettleCalibration{.keep = true})});
  c->router.add({http::verb::post, path + "/discard", kSettled,
                 settle_calibration(c, robot::SettleCalibration{.keep = false})});
  c->router.add({http::verb::delete_, path, {200, 403, 409, 429, 503}, [c](const CallPtr& call) {
                   run_command(c, call, robot::ForgetCalibration{}, base::Time::max(),
                               [c](const base::Snapshot& s) { return whole(c, s); });
                 }});
}

}  // namespace roverd::api
