// POST /missions/{id}/operations: reads the revision that If-Match names, makes the change and
// keeps it as the next one.

#include <utility>

#include "api/context.hpp"
#include "api/mission_change.hpp"
#include "api/operation_request.hpp"
#include "mission/json/json.hpp"

namespace roverd::api {

namespace {

OperationFacts facts_of(const ContextPtr& context, const store::StoredMission& mission) {
  OperationFacts facts;
  facts.items = static_cast<int>(mission.plan.items.size());
  const auto snapshot = context->deps.robot.snapshot();
  if (!snapshot) return facts;
  const auto& pose = snapshot->pose;
  if (pose && base::seconds(base::steady_now() - pose->stamp) <= StaleAfter::kPosition_s) {
    facts.vehicle = pose->global;
  }
  // Of another revision the numbers may be others.
  const base::MissionProgress& progress = snapshot->mission;
  if (progress.mission_id == mission.id && progress.revision == mission.revision) {
    facts.current = progress.current_item;
  }
  return facts;
}

/// The mission as it is now, and what was done.
Json done_json(const store::StoredMission& mission, const mission::Done& done) {
  Json out = mission_json(mission);
  out["done"] = {{"what", done.what},
                 {"item", done.item ? Json(*done.item) : Json(nullptr)},
                 {"about", nullptr},
                 {"created", nullptr}};
  if (done.about) out["done"]["about"] = {{"lat", done.about->lat}, {"lon", done.about->lon}};
  return out;
}

Response done_response(const store::StoredMission& mission, const Json& body) {
  Response response = json_response(http::status::ok, body);
  response.set(http::field::etag, etag_of(mission.revision));
  return response;
}

/// What an operation on one revision came to.
struct Outcome {
  base::Result<OperationRequest> request;
  std::optional<base::Result<mission::Done>> done{};  ///< unless another mission is needed first
  std::optional<base::Result<mission::Parts>> parts{};
  std::optional<Response> ready{};  ///< nothing is to be kept
};

/// What the mission would be, or that it is what it was.
Response unkept(const store::StoredMission& mission, mission::Done done, bool dry_run) {
  if (!dry_run) {
    done.what = "nothing changed";
    return done_response(mission, done_json(mission, done));
  }
  store::StoredMission would = mission;
  would.plan = std::move(done.plan);
  Json body = done_json(would, done);
  body["dry_run"] = true;
  return done_response(mission, body);
}

void perform_on(const store::StoredMission& mission, const mission::Operation& operation,
                bool dry_run, Outcome& out) {
  out.done = mission::perform(mission.plan, operation);
  if (!*out.done || (!dry_run && (*out.done)->plan != mission.plan)) return;
  out.ready = unkept(mission, std::move(**out.done), dry_run);
}

void split_at(const store::StoredMission& mission, const SplitAfter& cut, Outcome& out) {
  out.parts = mission::split(mission.plan, cut.item, cut.shared);
  if (!*out.parts) return;
  if (cut.name) (*out.parts)->rest.name = *cut.name;
  if (auto fine = mission::check_plan((*out.parts)->rest); !fine) {
    out.parts = tl::unexpected<base::Error>(fine.error());
  }
}

/// One operation on its way. Web thread; what it costs is done beside it.
class Work : public std::enable_shared_from_this<Work> {
 public:
  Work(ContextPtr context, CallPtr call) : context_(std::move(context)), call_(std::move(call)) {}

  void begin() {
    if (auto ok = check_json_type(call_->request); !ok) return refuse(ok.error());
    body_ = std::move(call_->request.body());
    with_expected(context_, call_, [self = shared_from_this()](std::int64_t expected) {
      self->expected_ = expected;
      self->context_->deps.store.read_mission(
          self->call_->params.at("id"),
          [self](base::Result<store::StoredMission> stored) { self->have(std::move(stored)); });
    });
  }

 private:
  void refuse(const base::Error& error) {
    if (error.code == base::Code::RevisionMismatch) {
      return refuse_with_present(context_, call_, error);
    }
    call_->respond(problem(error));
  }

  void have(base::Result<store::StoredMission> stored) {
    if (!stored) return refuse(stored.error());
    if (expected_ == store::kAnyRevision) expected_ = stored->revision;
    if (stored->revision != expected_) {
      return refuse({base::Code::RevisionMismatch,
                     "the mission is at revision " + std::to_string(stored->revision) +
                         ", the operation was asked for revision " + std::to_string(expected_),
                     {}});
    }
    const OperationFacts facts = facts_of(context_, *stored);
    auto mission = std::make_shared<store::StoredMission>(std::move(*stored));
    const Effort effort{body_.size() + 2 * bytes_of(mission->plan)};
    context_->aside(
        call_, effort,
        [body = std::move(body_), facts, mission] { return judge(body, facts, *mission); },
        [self = shared_from_this(), mission](Judged judged) {
          self->dry_run_ = judged.dry_run;
          self->take(std::move(judged.outcome), mission);
        });
  }

  struct Judged {
    Outcome outcome;
    bool dry_run = false;
  };

  static Judged judge(const std::string& text, const OperationFacts& facts,
                      const store::StoredMission& mission) {
    const auto body = mission::parse_json(text);
    if (!body) return {{tl::unexpected<base::Error>(body.error())}};
    bool dry_run = false;
    Judged out{{read_operation(*body, facts, dry_run)}};
    out.dry_run = dry_run;
    if (!out.outcome.request) return out;
    const OperationRequest& request = *out.outcome.request;
    if (const auto* cut = std::get_if<SplitAfter>(&request)) {
      split_at(mission, *cut, out.outcome);
    } else if (const auto* operation = std::get_if<mission::Operation>(&request)) {
      perform_on(mission, *operation, dry_run, out.outcome);
    }
    return out;
  }

  void take(Outcome outcome, const std::shared_ptr<store::StoredMission>& mission) {
    if (!outcome.request) return refuse(outcome.request.error());
    if (const auto* join = std::get_if<JoinWith>(&*outcome.request)) {
      return read_other(join->mission_id, mission);
    }
    if (const auto* cut = std::get_if<SplitAfter>(&*outcome.request)) {
      if (!*outcome.parts) return refuse(outcome.parts->error());
      context_->discard(std::move(mission->plan));
      return keep_parts(std::move(**outcome.parts), cut->item);
    }
    keep(std::move(outcome), mission);
  }

  void read_other(const std::string& id, const std::shared_ptr<store::StoredMission>& mission) {
    context_->deps.store.read_mission(
        id, [self = shared_from_this(), mission](base::Result<store::StoredMission> other) {
          if (other) return self->join(std::move(*other), mission);
          base::Error error = std::move(other.error());
          if (error.code == base::Code::NotFound) {
            error.code = base::Code::Invalid;
            error.fields = {{"/mission_id", error.detail}};
          }
          self->refuse(error);
        });
  }

  void join(store::StoredMission other, const std::shared_ptr<store::StoredMission>& mission) {
    const Effort effort{2 * (bytes_of(other.plan) + bytes_of(mission->plan))};
    context_->aside(
        call_, effort,
        [dry_run = dry_run_, mission, plan = std::move(other.plan)]() mutable {
          Outcome out{mission::Operation{mission::Clear{}}};  // read, and fine
          perform_on(*mission, mission::Join{std::move(plan)}, dry_run, out);
          return out;
        },
        [self = shared_from_this(), mission](Outcome outcome) {
          self->keep(std::move(outcome), mission);
        });
  }

  void keep(Outcome outcome, const std::shared_ptr<store::StoredMission>& mission) {
    if (!*outcome.done) return refuse(outcome.done->error());
    const std::string id = mission->id;
    context_->discard(std::move(mission->plan));
    if (outcome.ready) return call_->respond(std::move(*outcome.ready));
    mission::Done done = std::move(**outcome.done);
    mission::Plan plan = std::move(done.plan);
    done.plan = {};
    context_->deps.store.replace_mission(
        id, expected_, std::move(plan), {kAuthor, done.what},
        [self = shared_from_this(), done](base::Result<store::StoredMission> stored) {
          if (!stored) return self->refuse(stored.error());
          self->context_->announce(stored->id, stored->revision);
          self->show(std::move(*stored), done, std::nullopt);
        });
  }

  void keep_parts(mission::Parts parts, int after) {
    mission::Done done;
    done.what = "split after item " + std::to_string(after);
    context_->deps.store.split_mission(
        call_->params.at("id"), expected_, std::move(parts.first), std::move(parts.rest),
        {kAuthor, done.what}, [self = shared_from_this(), done](base::Result<store::Halves> both) {
          if (!both) return self->refuse(both.error());
          self->context_->announce(both->first.id, both->first.revision);
          self->context_->announce(both->rest.id, both->rest.revision);
          self->show(std::move(both->first), done, std::move(both->rest));
        });
  }

  void show(store::StoredMission mission, const mission::Done& done,
            std::optional<store::StoredMission> created) {
    const Effort effort{2 * bytes_of(mission.plan) + (created ? bytes_of(created->plan) : 0), true};
    context_->answer_aside(call_, effort,
                           [mission = std::move(mission), done, created = std::move(created)] {
                             Json body = done_json(mission, done);
                             if (created) body["done"]["created"] = mission_json(*created);
                             return done_response(mission, body);
                           });
  }

  ContextPtr context_;
  CallPtr call_;
  std::string body_;
  std::int64_t expected_ = 0;
  bool dry_run_ = false;
};

}  // namespace

void add_operation_routes(const ContextPtr& c) {
  c->router.add({http::verb::post,
                 "/missions/{id}/operations",
                 {200, 400, 403, 404, 409, 412, 413, 415, 422, 428, 429, 503},
                 [c](const CallPtr& call) { std::make_shared<Work>(c, call)->begin(); },
                 kDocumentBytes});
}

}  // namespace roverd::api
