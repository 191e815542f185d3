#pragma once
// One pair of functions per file format; formats.cpp chooses among them. The reader fills a plan
// without a name.

#include <string>
#include <string_view>
#include <vector>

#include "mission/formats.hpp"

namespace roverd::mission {

base::Result<ImportedFile> read_qgc_plan(std::string_view content);
std::string write_qgc_plan(const Plan& plan, std::vector<FileRow>& rows);

base::Result<ImportedFile> read_waypoints(std::string_view content);
std::string write_waypoints(const Plan& plan, std::vector<FileRow>& rows);

}  // namespace roverd::mission
