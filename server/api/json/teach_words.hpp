#pragma once
// A recording of teach-in in the words of the public interface. Pure.

#include "api/message.hpp"
#include "services/teach.hpp"

namespace roverd::api {

/// {state, points, length_m}: a part of the vehicle's state.
Json teach_brief_json(const services::TeachView& teach);
Json teach_json(const services::TeachView& teach);

}  // namespace roverd::api
