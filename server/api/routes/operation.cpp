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

/// One operation on its way. Web thread.
class Work : public std::enable_shared_from_this<Work> {
 public:
  Work(ContextPtr context, CallPtr call, Json body)
      : context_(std::move(context)), call_(std::move(call)), body_(std::move(body)) {}

  void begin() {
    with_expected(context_, call_, [self = shared_from_this()](std::int64_t expected) {
      self->expected_ = expected;
      self->context_->deps.store.read_mission(self->call_->params.at("id"),
                                              [self](auto stored) { self->have(stored); });
    });
  }

 private:
  void refuse(const base::Error& error) {
    if (error.code == base::Code::RevisionMismatch) {
      return refuse_with_present(context_, call_, error);
    }
    call_->respond(problem(error));
  }

  void have(base::Result<store::StoredMission>& stored) {
    if (!stored) return refuse(stored.error());
    if (expected_ == store::kAnyRevision) expected_ = stored->revision;
    if (stored->revision != expected_) {
      return refuse({base::Code::RevisionMismatch,
                     "the mission is at revision " + std::to_string(stored->revision) +
                         ", the operation was asked for revision " + std::to_string(expected_),
                     {}});
    }
    mission_ = std::move(*stored);
    const auto request = read_operation(body_, facts_of(context_, mission_), dry_run_);
    if (!request) return refuse(request.error());
    if (const auto* join = std::get_if<JoinWith>(&*request)) return read_other(join->mission_id);
    if (const auto* cut = std::get_if<SplitAfter>(&*request)) return split(*cut);
    perform(std::get<mission::Operation>(*request));
  }

  void read_other(const std::string& id) {
    context_->deps.store.read_mission(
        id, [self = shared_from_this()](base::Result<store::StoredMission> other) {
          if (other) return self->perform(mission::Join{std::move(other->plan)});
          base::Error error = std::move(other.error());
          if (error.code == base::Code::NotFound) {
            error.code = base::Code::Invalid;
            error.fields = {{"/mission_id", error.detail}};
          }
          self->refuse(error);
        });
  }

  /// What the mission would be; nothing is kept.
  void show(const mission::Done& done) {
    store::StoredMission would = mission_;
    would.plan = done.plan;
    Json body = done_json(would, done);
    body["dry_run"] = true;
    call_->respond(done_response(mission_, body));
  }

  void perform(const mission::Operation& operation) {
    auto done = mission::perform(mission_.plan, operation);
    if (!done) return refuse(done.error());
    if (dry_run_) return show(*done);
    if (done->plan == mission_.plan) {
      // Nothing to keep: the same revision.
      done->what = "nothing changed";
      return call_->respond(done_response(mission_, done_json(mission_, *done)));
    }
    store::Change change{kAuthor, done->what};
    mission::Plan plan = std::move(done->plan);
    context_->deps.store.replace_mission(
        mission_.id, expected_, std::move(plan), std::move(change),
        [self = shared_from_this(), done = std::move(*done)](auto stored) {
          if (!stored) return self->refuse(stored.error());
          self->context_->announce(stored->id, stored->revision);
          self->call_->respond(done_response(*stored, done_json(*stored, done)));
        });
  }

  void split(const SplitAfter& cut) {
    auto parts = mission::split(mission_.plan, cut.item, cut.shared);
    if (!parts) return refuse(parts.error());
    if (cut.name) parts->rest.name = *cut.name;
    if (auto fine = mission::check_plan(parts->rest); !fine) return refuse(fine.error());
    mission::Done done;
    done.what = "split after item " + std::to_string(cut.item);
    context_->deps.store.split_mission(
        mission_.id, expected_, std::move(parts->first), std::move(parts->rest),
        {kAuthor, done.what}, [self = shared_from_this(), done](base::Result<store::Halves> both) {
          if (!both) return self->refuse(both.error());
          self->context_->announce(both->first.id, both->first.revision);
          self->context_->announce(both->rest.id, both->rest.revision);
          Json body = done_json(both->first, done);
          body["done"]["created"] = mission_json(both->rest);
          self->call_->respond(done_response(both->first, body));
        });
  }

  ContextPtr context_;
  CallPtr call_;
  Json body_;
  std::int64_t expected_ = 0;
  bool dry_run_ = false;
  store::StoredMission mission_;
};

}  // namespace

void add_operation_routes(const ContextPtr& c) {
  c->router.add({http::verb::post,
                 "/missions/{id}/operations",
                 {200, 400, 403, 404, 409, 412, 413, 415, 422, 428, 429, 503},
                 [c](const CallPtr& call) {
                   auto body = json_body(call->request);
                   if (!body) return call->respond(problem(body.error()));
                   std::make_shared<Work>(c, call, std::move(*body))->begin();
                 }});
}

}  // namespace roverd::api
