#include <limits>
#include <utility>

#include "api/checks.hpp"
#include "api/context.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

const std::vector<unsigned> kCommand = {200, 400, 403, 409, 413, 415, 422, 429, 503};

constexpr std::int64_t kMostRevisions = 1'000'000'000;

/// Nothing is said of what an earlier life left behind before that was read: a script that asks in
/// the first moment would take silence for "nothing".
bool unread(const ContextPtr& context, const CallPtr& call) {
  if (context->deps.services.view()->recalled) return false;
  call->respond(problem({base::Code::Unavailable,
                         "what was left behind before the program started is not read yet"}));
  return true;
}

std::function<Json(const base::Snapshot&)> progress_of(const ContextPtr& context) {
  return [context](const base::Snapshot& snapshot) {
    return execution_json(snapshot.mission, context->offer(snapshot));
  };
}

/// "first", "nearest" or an item's number, from text or a JSON number.
std::optional<robot::StartMission> read_from(std::string_view word) {
  robot::StartMission start;
  if (word == "first") return start;
  if (word == "nearest") {
    start.from = robot::StartMission::From::Nearest;
    return start;
  }
  const auto item = whole_number(word);
  if (!item || *item < 1 || *item > static_cast<std::int64_t>(mission::kMaxItems)) {
    return std::nullopt;
  }
  start.from = robot::StartMission::From::Item;
  start.item = static_cast<int>(*item);
  return start;
}

constexpr const char* kFromRule = "must be \"first\", \"nearest\" or an item's number from 1";

Handler plain(const ContextPtr& context, robot::Command command, Moves moves) {
  return [context, command = std::move(command), moves](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    const robot::Validity validity = validity_of(members, *call, moves);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    run_command(context, call, command, validity, progress_of(context));
  };
}

void lay_out(const ContextPtr& context, const CallPtr& call, store::StoredMission stored,
             const robot::Validity& validity) {
  struct Laid {
    Verdict verdict;
    Context::Warnings warnings{};
  };
  const Effort effort{6 * bytes_of(stored.plan)};
  context->aside(
      call, effort,
      [judge = judge_now(*context), stored = std::move(stored)]() mutable {
        Laid laid{judge({stored.id, stored.revision, std::move(stored.plan)})};
        laid.warnings = {stored.id, stored.revision,
                         findings_json(laid.verdict.report, mission::Severity::Warning)};
        return laid;
      },
      [context, call, validity](Laid laid) {
        if (laid.verdict.lasting > 0 || !laid.verdict.compiled) {
          return call->respond(problem(laid.verdict.refusal));
        }
        run_command(context, call, robot::LoadMission{std::move(laid.verdict.compiled)}, validity,
                    [context, warnings = std::move(laid.warnings)](const base::Snapshot& snapshot) {
                      context->warnings = warnings;
                      Json out = progress_of(context)(snapshot);
                      out["warnings"] = warnings.list;
                      return out;
                    });
      });
}

Handler load(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    members.require("mission_id");
    const auto id = members.text("mission_id");
    const auto revision = members.whole("revision", 1, kMostRevisions);
    const robot::Validity validity = validity_of(members, *call, Moves::No);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));

    const auto hand_over = [context, call, validity](base::Result<store::StoredMission> stored) {
      if (!stored) return call->respond(problem(stored.error()));
      lay_out(context, call, std::move(*stored), validity);
    };
    if (revision) {
      context->deps.store.read_revision(*id, *revision, hand_over);
    } else {
      context->deps.store.read_mission(*id, hand_over);
    }
  };
}

/// What is not loaded cannot be previewed: a state, not a missing address.
base::Error as_conflict(base::Error error) {
  if (error.code == base::Code::NotFound) error.code = base::Code::Conflict;
  return error;
}

/// What was found at the load, and what a start finds now: the robot has moved, home may have, and
/// parameters may have been changed.
Json findings_now(const Json& at_load, const std::vector<mission::Finding>& now,
                  const std::vector<mission::Finding>& parameters) {
  Json out = Json::array();
  for (const mission::Finding& finding : now) out.push_back(finding_json(finding));
  for (const mission::Finding& finding : parameters) out.push_back(finding_json(finding));
  for (const Json& finding : at_load) {
    const bool then = finding["code"] == robot::kSafetyParameter;
    if (finding["severity"] == "warning" && !then) out.push_back(finding);
  }
  return out;
}

Json present_preview(const ContextPtr& context, const robot::Preview& preview,
                     const std::vector<mission::Finding>& now) {
  const auto snapshot = context->deps.robot.snapshot();
  Json out = preview_json(preview, snapshot ? snapshot->mission.state : base::ExecutionState::Idle);
  const Context::Warnings& found = context->warnings;
  const bool same = found.mission_id == preview.mission_id && found.revision == preview.revision;
  out["warnings"] = same ? found.list : Json::array();
  out["ready"] = now.empty();
  out["findings"] = findings_now(out["warnings"], now, context->deps.robot.changed_safety());
  return out;
}

base::Result<robot::StartMission> read_start(const Json& body, const Call& call,
                                             robot::Validity& validity) {
  Members members(body);
  members.require("mission_id");
  members.require("revision");
  const auto id = members.text("mission_id");
  const auto revision = members.whole("revision", 1, kMostRevisions);
  std::optional<robot::StartMission> start = robot::StartMission{};
  if (const Json* from = members.any("from")) {
    start.reset();
    if (from->is_number_integer()) start = read_from(from->dump());
    if (*from == "first" || *from == "nearest") start = read_from(from->get<std::string>());
    if (!start) members.complain("from", kFromRule);
  }
  validity = validity_of(members, call, Moves::Yes);
  if (const auto read = members.finish(); !read) {
    return tl::unexpected<base::Error>(read.error());
  }
  start->mission_id = *id;
  start->revision = *revision;
  return *start;
}

Handler start(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request);
    if (!body) return call->respond(problem(body.error()));
    robot::Validity validity{base::Time::max()};
    const auto command = read_start(*body, *call, validity);
    if (!command) return call->respond(problem(command.error()));
    if (refused_as_late(call, validity)) return;
    const auto preview = context->deps.robot.preview(*command);
    if (!preview) return call->respond(problem(as_conflict(preview.error())));
    context->commands.run(
        *command, validity, base::steady_now(),
        [context, call, shown = *preview](base::Result<void> result) {
          if (!result) return call->respond(problem(result.error()));
          call->respond(json_response(http::status::ok, present_preview(context, shown, {})));
        });
  };
}

Handler preview(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const std::string word = query_text(*call, "from");
    auto wanted = read_from(word.empty() ? "first" : word);
    if (!wanted) {
      return call->respond(
          problem({base::Code::Invalid, std::string("from ") + kFromRule, {{"from", kFromRule}}}));
    }
    const auto loaded = context->deps.robot.loaded();
    if (!loaded) {
      return call->respond(problem({base::Code::Conflict, "no mission is loaded (state idle)"}));
    }
    wanted->mission_id = loaded->id;
    wanted->revision = loaded->revision;
    const auto shown = context->deps.robot.preview(*wanted);
    if (!shown) return call->respond(problem(as_conflict(shown.error())));
    const auto now = context->deps.robot.objections(*wanted);
    call->respond(json_response(http::status::ok, present_preview(context, *shown, now)));
  };
}

Handler way(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto loaded = context->deps.robot.loaded();
    const Effort effort{loaded ? bytes_of(loaded->plan) : 0};
    context->answer_aside(call, effort, [&robot = context->deps.robot] {
      const auto laid = robot.mission_way();
      if (!laid) return problem({base::Code::Conflict, "no mission is loaded (state idle)"});
      return json_response(http::status::ok, mission_way_json(*laid));
    });
  };
}

Handler skip(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    const auto item = members.whole("item", 1, static_cast<std::int64_t>(mission::kMaxItems));
    const robot::Validity validity = validity_of(members, *call, Moves::Yes);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    run_command(context, call, robot::SkipItem{static_cast<int>(item.value_or(0))}, validity,
                progress_of(context));
  };
}

/// What is paused goes on. With nothing in hand, the mission that a restart left behind does, from
/// the place it had come to.
Handler resume(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    const auto body = json_body(call->request, true);
    if (!body) return call->respond(problem(body.error()));
    Members members(*body);
    const robot::Validity validity = validity_of(members, *call, Moves::Yes);
    if (const auto read = members.finish(); !read) return call->respond(problem(read.error()));
    if (refused_as_late(call, validity)) return;
    if (unread(context, call)) return;
    const auto now = context->deps.robot.snapshot();
    const auto offer = now ? context->offer(*now) : std::nullopt;
    const auto loaded = context->deps.robot.loaded();
    if (!offer || (loaded && loaded->id != offer->mission_id)) {
      return run_command(context, call, robot::ResumeMission{}, validity, progress_of(context));
    }
    context->deps.store.read_revision(
        offer->mission_id, offer->revision,
        [context, call, validity, place = offer->place](auto stored) {
          if (!stored) {
            return call->respond(
                problem({base::Code::Conflict,
                         "the mission that was left behind is gone: " + stored.error().detail}));
          }
          const Effort effort{2 * bytes_of(stored->plan)};
          context->aside(
              call, effort,
              [&robot = context->deps.robot, mission = std::move(*stored)]() mutable {
                return robot.compile({mission.id, mission.revision, std::move(mission.plan)});
              },
              [context, call, validity, place](auto compiled) {
                if (!compiled) return call->respond(problem(compiled.error()));
                run_command(context, call, robot::ResumeAt{std::move(*compiled), place}, validity,
                            progress_of(context));
              });
        });
  };
}

/// The mission stays stored; only where it stood is forgotten. Forgetting nothing is no error.
Handler forget(const ContextPtr& context) {
  return [context](const CallPtr& call) {
    context->deps.services.forget_left_behind([call](const base::Result<void>& done) {
      if (!done) return call->respond(problem(done.error()));
      call->respond(Response{http::status::no_content, 11});
    });
  };
}

}  // namespace

void add_execution_routes(const ContextPtr& c) {
  const auto get = http::verb::get;
  const auto post = http::verb::post;
  auto with_404 = kCommand;
  with_404.push_back(404);
  c->router.add({get, "/execution", {200, 503}, [c](const CallPtr& call) {
                   const auto s = c->snapshot_or_refuse(call);
                   if (s && !unread(c, call)) {
                     call->respond(json_response(http::status::ok, progress_of(c)(*s)));
                   }
                 }});
  c->router.add({http::verb::delete_, "/execution/left_behind", {204, 403, 503}, forget(c)});
  c->router.add({get, "/execution/preview", {200, 409, 422, 503}, preview(c)});
  c->router.add({get, "/execution/way", {200, 409, 503}, way(c)});
  c->router.add({post, "/execution/load", with_404, load(c)});
  c->router.add({post, "/execution/start", kCommand, start(c)});
  c->router.add({post, "/execution/pause", kCommand, plain(c, robot::PauseMission{}, Moves::No)});
  c->router.add({post, "/execution/resume", kCommand, resume(c)});
  c->router.add({post, "/execution/stop", kCommand, plain(c, robot::StopMission{}, Moves::No)});
  c->router.add({post, "/execution/skip", kCommand, skip(c)});
}

}  // namespace roverd::api
