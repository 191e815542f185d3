#pragma once
// The SQL of runs, of the execution in hand and of parameters. Each function is one transaction on
// the store's thread; they throw SQLite::Exception (see guarded) and change nothing then.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "store/database.hpp"
#include "store/store.hpp"

namespace roverd::store {

class Runs {
 public:
  explicit Runs(SQLite::Database& db) : db_(db) {}

  /// Runs whose end was not seen end with their last point.
  void close_interrupted();
  /// @param keep the newest so many stay, older ones go with all they have
  base::Result<std::int64_t> begin(const StoredRun& run, std::int64_t keep);
  /// With its track and events. NotFound; Conflict while it is driven.
  base::Result<void> remove(std::int64_t id);
  /// The oldest that is to go; none that is being driven. @param before it ended then, by a clock
  /// that was set; empty: ages do not count. @param max_bytes of all runs; 0: room does not count
  struct Spare {
    std::int64_t id = 0;
    std::int64_t bytes = 0;  ///< about, with its track
  };
  std::optional<Spare> spare(std::optional<base::WallTime> before, std::int64_t max_bytes);
  /// NotFound if there is no such run (any more).
  base::Result<void> add(std::int64_t id, const RunBatch& batch);
  base::Result<Page<RunHead>> list(int limit, const std::string& cursor);
  base::Result<StoredRun> read(std::int64_t id);
  base::Result<std::vector<RunPoint>> points(std::int64_t id);

  void keep_place(const std::optional<StoredPlace>& place);
  base::Result<std::optional<StoredPlace>> place();

  void keep_parameter(const StoredParameter& parameter, base::WallTime now);
  std::vector<StoredParameter> parameters();

 private:
  SQLite::Database& db_;
};

}  // namespace roverd::store
