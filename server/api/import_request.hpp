#pragma once
// What POST /missions/import is asked: a file as the body, or as a part of a form, and how it is to
// be read. Pure; with a large file it takes its time.

#include <string>
#include <string_view>

#include "api/message.hpp"
#include "mission/formats/formats.hpp"

namespace roverd::api {

/// As they came; empty: not given. In a form they may be fields of it; the query goes before those.
struct ImportWish {
  std::string content_type{};
  std::string format{};
  std::string name{};  ///< of the file
  std::string origin_lat{};
  std::string origin_lon{};
  std::string speed_unit{};
};

struct Upload {
  mission::ImportedFile file;
  std::string from;  ///< "field.plan", "gpx file": for the list of revisions
};

ImportWish import_wish(const Call& call);

/// Invalid names the parameter, or the line or place in the file; Malformed: an empty file, a form
/// that is none. @param body of the request
base::Result<Upload> read_upload(std::string_view body, ImportWish wish);

/// "… is not a known format; known are plan …". @param written only those that are written, too
base::Error not_a_format(const std::string& word, bool written);

}  // namespace roverd::api
