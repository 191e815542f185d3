// What Store is asked about missions.

#include <SQLiteCpp/Transaction.h>

#include "store/store_impl.hpp"

namespace roverd::store {

void Store::list_missions(int limit, std::string cursor, Reply<Page<MissionSummary>> reply,
                          Filter filter) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), limit, cursor = std::move(cursor), filter = std::move(filter)] {
               if (filter.which == Which::Deleted) impl->forget();
               return impl->missions.list(limit, cursor, filter);
             });
}

void Store::restore_mission(std::string id, std::int64_t expected, Change change,
                            Reply<StoredMission> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), id = std::move(id), expected, change = std::move(change)] {
               return impl->missions.restore(id, expected, change, impl->options.clock());
             });
}

void Store::describe_mission(std::string id, std::int64_t expected, Description description,
                             Change change, Reply<StoredMission> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), id = std::move(id), expected,
              description = std::move(description), change = std::move(change)] {
               return impl->missions.describe(id, expected, description, change,
                                              impl->options.clock());
             });
}

void Store::list_tags(int limit, std::string cursor, Reply<Page<TagCount>> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), limit, cursor = std::move(cursor)] {
    return impl->missions.list_tags(limit, cursor);
  });
}

void Store::copy_mission(std::string id, std::optional<std::string> name, Change change,
                         Reply<StoredMission> reply) {
  impl_->ask(
      deliver_, std::move(reply),
      [impl = impl_.get(), id = std::move(id), name = std::move(name), change = std::move(change)] {
        return impl->missions.copy(id, name, change, impl->options.clock());
      });
}

void Store::create_mission(mission::Plan plan, Change change, Reply<StoredMission> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), plan = std::move(plan), change = std::move(change)]() mutable {
               return impl->missions.create(std::move(plan), change, impl->options.clock());
             });
}

void Store::create_import(std::vector<mission::Plan> plans, std::optional<mission::Fence> fence,
                          Change change, Reply<StoredImport> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), plans = std::move(plans), fence = std::move(fence),
              change = std::move(change)]() mutable -> base::Result<StoredImport> {
               const base::WallTime now = impl->options.clock();
               SQLite::Transaction transaction(impl->db->connection,
                                               SQLite::TransactionBehavior::IMMEDIATE);
               StoredImport out;
               for (mission::Plan& plan : plans) {
                 auto made = impl->missions.add(std::move(plan), change, now);
                 if (!made) return tl::unexpected<base::Error>(made.error());
                 out.missions.push_back(std::move(*made));
               }
               if (fence) {
                 auto made = impl->fences.add(std::move(*fence), change, now);
                 if (!made) return tl::unexpected<base::Error>(made.error());
                 out.fence = std::move(*made);
               }
               transaction.commit();
               return out;
             });
}

void Store::read_mission(std::string id, Reply<StoredMission> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), id = std::move(id)] { return impl->missions.read(id); });
}

void Store::read_revision(std::string id, std::int64_t revision, Reply<StoredMission> reply) {
  impl_->ask(deliver_, std::move(reply), [impl = impl_.get(), id = std::move(id), revision] {
    return impl->missions.read_revision(id, revision);
  });
}

void Store::replace_mission(std::string id, std::int64_t expected, mission::Plan plan,
                            Change change, Reply<StoredMission> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), id = std::move(id), expected, plan = std::move(plan),
              change = std::move(change)]() mutable {
               return impl->missions.replace(id, expected, std::move(plan), change,
                                             impl->options.clock());
             });
}

void Store::split_mission(std::string id, std::int64_t expected, mission::Plan first,
                          mission::Plan rest, Change change, Reply<Halves> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), id = std::move(id), expected, first = std::move(first),
              rest = std::move(rest), change = std::move(change)]() mutable {
               return impl->missions.split(id, expected, std::move(first), std::move(rest), change,
                                           impl->options.clock());
             });
}

void Store::delete_mission(std::string id, std::int64_t expected, Change change,
                           Reply<void> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), id = std::move(id), expected, change = std::move(change)] {
               auto done = impl->missions.remove(id, expected, change, impl->options.clock());
               if (done) impl->forget();
               return done;
             });
}

void Store::list_revisions(std::string id, int limit, std::string cursor,
                           Reply<Page<RevisionSummary>> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), id = std::move(id), limit, cursor = std::move(cursor)] {
               return impl->missions.list_revisions(id, limit, cursor);
             });
}

void Store::revert_mission(std::string id, std::int64_t expected, std::int64_t to_revision,
                           Change change, Reply<StoredMission> reply) {
  impl_->ask(
      deliver_, std::move(reply),
      [impl = impl_.get(), id = std::move(id), expected, to_revision, change = std::move(change)] {
        return impl->missions.revert(id, expected, to_revision, change, impl->options.clock());
      });
}

void Store::finish_teach(mission::Plan plan, Change change, Reply<StoredMission> reply) {
  impl_->ask(deliver_, std::move(reply),
             [impl = impl_.get(), plan = std::move(plan), change = std::move(change)]() mutable {
               return impl->missions.create(std::move(plan), change, impl->options.clock(),
                                            Missions::Teach::Ends);
             });
}

}  // namespace roverd::store
