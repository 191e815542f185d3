#pragma once
// The SQL of places where the robot slipped or dug. On the store's thread; throws SQLite::Exception
// (see guarded).

#include "store/database.hpp"
#include "store/store.hpp"

namespace roverd::store {

/// Places of a kind nearer than this are one: the older keeps its place, and takes the newer time
/// and the larger figure.
inline constexpr double kSlipsMerge_m = 2.0;
inline constexpr int kMaxSlips = 1000;  ///< the newest; older ones go

void note_slip(SQLite::Database& db, const Slip& slip);
/// Newest first. Malformed if the cursor is not one of ours.
base::Result<Page<Slip>> list_slips(SQLite::Database& db, const SlipFilter& filter, int limit,
                                    const std::string& cursor);
void clear_slips(SQLite::Database& db);

}  // namespace roverd::store
