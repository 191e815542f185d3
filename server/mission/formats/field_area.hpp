#pragma once
// Polygons that a file draws without a word of fences: fields that can be covered.

#include "mission/formats/formats.hpp"
#include "mission/json/pointer.hpp"

namespace roverd::mission {

/// Of one file.
inline constexpr std::size_t kMaxAreasOfFile = 1000;

/// Keeps an area, open or closed, in the file's list, with its account; one without three corners
/// is left out. A corner that is not on earth goes to `problems`. @param what it is called there
void take_field_area(FieldArea area, const char* what, ImportedFile& file, Problems& problems);

}  // namespace roverd::mission
