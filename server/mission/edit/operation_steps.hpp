#pragma once
// The operations one by one, and what they share. See operations.hpp.

#include <string>
#include <vector>

#include "mission/edit/operations.hpp"

namespace roverd::mission {

// operate_list.cpp
base::Result<Done> apply(Plan plan, const AddWaypoint& add);
base::Result<Done> apply(Plan plan, const RemoveItems& remove);
base::Result<Done> apply(Plan plan, const Clear& clear);
base::Result<Done> apply(Plan plan, const Reverse& reverse);
base::Result<Done> apply(Plan plan, const SetHome& set);
base::Result<Done> apply(Plan plan, const Join& join);
base::Result<Done> apply(Plan plan, const Renumber& renumber);
// operate_shape.cpp
base::Result<Done> apply(Plan plan, const Offset& offset);
base::Result<Done> apply(Plan plan, const ScaleRotate& change);
base::Result<Done> apply(Plan plan, const Mirror& mirror);
base::Result<Done> apply(Plan plan, const Align& align);
// operate_points.cpp
base::Result<Done> apply(Plan plan, const Simplify& simplify);
base::Result<Done> apply(Plan plan, const Densify& densify);

/// @param which empty: all. Invalid unless they are there; none at all is fine for an empty plan.
base::Result<Numbers> numbers_in(const Plan& plan, const std::optional<Numbers>& which);

/// Gives every jump its target's new number. @param new_number by old number − 1
void lead_jumps(std::vector<Item>& items, const std::vector<int>& new_number);

/// Takes out the items for which `gone` says so. @return how many jumps went with them
int take_out(std::vector<Item>& items, std::vector<bool> gone);

/// Whether a jump leads to it, by index.
std::vector<bool> jump_targets(const Plan& plan);

/// "all items", "item 3", "items 3 to 7"
std::string words_of(const Plan& plan, const Numbers& which);
/// "1 waypoint", "12 waypoints"
std::string counted(std::size_t count, const char* one);
/// To the millimetre, for people: "3.2".
std::string rounded_text(double value);

base::Error wrong(const std::string& pointer, const std::string& detail);

}  // namespace roverd::mission
