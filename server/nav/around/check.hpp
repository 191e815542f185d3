#pragma once
// Which questions are none: every field within its range, or the field is named.

#include "nav/around/around.hpp"

namespace roverd::nav::around {

base::Result<void> check(const sense::Patch& patch, const Question& question);

}  // namespace roverd::nav::around
