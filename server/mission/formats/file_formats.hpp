#pragma once
// One pair of functions per file format; formats.cpp chooses among them. The reader fills a plan
// without a name.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mission/formats/formats.hpp"

namespace roverd::mission {

base::Result<ImportedFile> read_qgc_plan(std::string_view content);
std::string write_qgc_plan(const Plan& plan, const Fence* fence, std::vector<FileRow>& rows);

base::Result<ImportedFile> read_waypoints(std::string_view content);
std::string write_waypoints(const Plan& plan, std::vector<FileRow>& rows);

base::Result<ImportedFile> read_gpx(std::string_view content, const ImportHints& hints);
std::string write_gpx(const Plan& plan, std::vector<FileRow>& rows);

/// What a link of a KML document leads to, inside of an archive; empty: nothing.
using LinkedKml = std::function<std::optional<std::string>(const std::string& href)>;
/// @param linked may be empty: then no link is followed
base::Result<ImportedFile> read_kml(std::string_view content, const ImportHints& hints,
                                    const LinkedKml& linked = {});
std::string write_kml(const Plan& plan, const Fence* fence, std::vector<FileRow>& rows);

base::Result<ImportedFile> read_kmz(std::string_view content, const ImportHints& hints);
/// Empty if there is no memory.
std::string write_kmz(const Plan& plan, const Fence* fence, std::vector<FileRow>& rows);

base::Result<ImportedFile> read_geojson(std::string_view content, const ImportHints& hints);
std::string write_geojson(const Plan& plan, const Fence* fence, std::vector<FileRow>& rows);

base::Result<ImportedFile> read_fence_text(std::string_view content);
bool looks_like_fence_text(std::string_view content);

/// Either form of table.
base::Result<ImportedFile> read_csv(std::string_view content, const ImportHints& hints);
bool looks_like_csv(std::string_view content);
std::string write_csv(const Plan& plan, std::vector<FileRow>& rows);
std::string write_follower(const Plan& plan, std::vector<FileRow>& rows);

}  // namespace roverd::mission
