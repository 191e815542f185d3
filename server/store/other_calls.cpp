// What Store is asked about fences, runs, node maps and recordings.

#include "store/routes.hpp"
#include "store/slips.hpp"
#include "store/store_impl.hpp"
#include "store/teach.hpp"

namespace roverd::store {

using base::Result;

void Store::list_fences(int limit, std::string cursor, Reply<Page<FenceSummary>> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), limit, cursor = std::move(cursor)] {
    return impl->fences.list(limit, cursor);
  });
}

void Store::create_fence(mission::Fence fence, Change change, Reply<StoredFence> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), fence = std::move(fence), change = std::move(change)]() mutable {
               return impl->fences.create(std::move(fence), change, impl->options.clock());
             });
}

void Store::read_fence(std::string id, Reply<StoredFence> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), id = std::move(id)] { return impl->fences.read(id); });
}

void Store::read_fence_revision(std::string id, std::int64_t revision, Reply<StoredFence> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), id = std::move(id), revision] {
    return impl->fences.read_revision(id, revision);
  });
}

void Store::replace_fence(std::string id, std::int64_t expected, mission::Fence fence,
                          Change change, Reply<StoredFence> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), id = std::move(id), expected, fence = std::move(fence),
              change = std::move(change)]() mutable {
               return impl->fences.replace(id, expected, std::move(fence), change,
                                           impl->options.clock());
             });
}

void Store::delete_fence(std::string id, std::int64_t expected, Change change, Reply<void> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), id = std::move(id), expected, change = std::move(change)] {
               return impl->fences.remove(id, expected, change, impl->options.clock());
             });
}

void Store::revert_fence(std::string id, std::int64_t expected, std::int64_t to_revision,
                         Change change, Reply<StoredFence> reply) {
  impl_->ask(
      deliver_, std::move(reply),
      [impl = impl_.get(), id = std::move(id), expected, to_revision, change = std::move(change)] {
        return impl->fences.revert(id, expected, to_revision, change, impl->options.clock());
      });
}

void Store::list_fence_revisions(std::string id, int limit, std::string cursor,
                                 Reply<Page<RevisionSummary>> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), id = std::move(id), limit, cursor = std::move(cursor)] {
               return impl->fences.list_revisions(id, limit, cursor);
             });
}

void Store::activate_fence(std::optional<std::string> id, Reply<std::optional<StoredFence>> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), id = std::move(id)] { return impl->fences.activate(id); });
}

void Store::read_active_fence(Reply<std::optional<StoredFence>> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get()] { return impl->fences.active(); });
}

void Store::begin_run(StoredRun run, Reply<std::int64_t> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), run = std::move(run)] {
    return impl->runs.begin(run, impl->options.keep_runs);
  });
}

void Store::add_to_run(std::int64_t id, RunBatch batch, Reply<void> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), id, batch = std::move(batch)] {
    return impl->runs.add(id, batch);
  });
}

void Store::list_runs(int limit, std::string cursor, Reply<Page<RunHead>> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), limit, cursor = std::move(cursor)] {
    return impl->runs.list(limit, cursor);
  });
}

void Store::read_run(std::int64_t id, Reply<StoredRun> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), id] { return impl->runs.read(id); });
}

void Store::delete_run(std::int64_t id, Reply<void> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), id] { return impl->runs.remove(id); });
}

void Store::read_run_points(std::int64_t id, Reply<std::vector<RunPoint>> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), id] { return impl->runs.points(id); });
}

void Store::keep_place(std::optional<StoredPlace> place, Reply<void> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), place = std::move(place)]() -> Result<void> {
               impl->runs.keep_place(place);
               return {};
             });
}

void Store::create_route_map(RouteMap map, Reply<RouteMap> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), map = std::move(map)]() mutable {
    return store::create_route_map(impl->db->connection, std::move(map), impl->options.clock());
  });
}

void Store::list_route_maps(int limit, std::string cursor, Reply<Page<RouteMapSummary>> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), limit, cursor = std::move(cursor)] {
    return store::list_route_maps(impl->db->connection, limit, cursor);
  });
}

void Store::read_route_map(std::string id, Reply<RouteMap> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), id = std::move(id)] {
    return store::read_route_map(impl->db->connection, id);
  });
}

void Store::delete_route_map(std::string id, Reply<void> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), id = std::move(id)] {
    return store::delete_route_map(impl->db->connection, id);
  });
}

void Store::begin_teach(TeachRecord record, Reply<void> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), record = std::move(record)] {
    return store::begin_teach(impl->db->connection, record);
  });
}

void Store::add_teach_points(std::vector<mission::TaughtPoint> points, Reply<void> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), points = std::move(points)] {
    return store::add_teach_points(impl->db->connection, points);
  });
}

void Store::read_teach(Reply<std::optional<TeachRecord>> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get()]() -> Result<std::optional<TeachRecord>> {
               return store::read_teach(impl->db->connection);
             });
}

void Store::discard_teach(Reply<void> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get()]() -> Result<void> {
    SQLite::Transaction transaction(impl->db->connection, SQLite::TransactionBehavior::IMMEDIATE);
    clear_teach(impl->db->connection);
    transaction.commit();
    return {};
  });
}

void Store::read_place(Reply<std::optional<StoredPlace>> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get()] { return impl->runs.place(); });
}

void Store::keep_parameter(StoredParameter parameter, Reply<void> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), parameter = std::move(parameter)]() -> Result<void> {
               impl->runs.keep_parameter(parameter, impl->options.clock());
               return {};
             });
}

void Store::note_slip(Slip slip, Reply<void> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), slip]() -> Result<void> {
    store::note_slip(impl->db->connection, slip);
    return {};
  });
}

void Store::list_slips(SlipFilter filter, int limit, std::string cursor, Reply<Page<Slip>> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), filter, limit, cursor = std::move(cursor)] {
               return store::list_slips(impl->db->connection, filter, limit, cursor);
             });
}

void Store::clear_slips(Reply<void> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get()]() -> Result<void> {
    store::clear_slips(impl->db->connection);
    return {};
  });
}

}  // namespace roverd::store
