#pragma once
// What POST /missions/import is asked: a file as the body, or as a part of a form, and how it is to
// be read. Pure; with a large file it takes its time.

#include <cstddef>
#include <optional>
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
  std::string wrong{};  ///< refuse (also empty) or leave_out: positions that cannot be
};

struct Upload {
  mission::ImportedFile file;
  std::string from;  ///< "field.plan", "gpx file": for the list of revisions
};

ImportWish import_wish(const Call& call);

/// What would become of the rows of a file that is refused, if what is wrong were left out.
struct Rest {
  std::size_t taken = 0;
  std::size_t changed = 0;
  std::size_t left_out = 0;
};

/// @param refused by read_upload of the same. Empty: it would be refused all the same
std::optional<Rest> rest_of(std::string_view body, ImportWish wish, const base::Error& refused);

/// Invalid names the parameter, or the line or place in the file; Malformed: an empty file, a form
/// that is none. @param body of the request
base::Result<Upload> read_upload(std::string_view body, ImportWish wish);

/// "… is not a known format; known are plan …". @param written only those that are written, too
base::Error not_a_format(const std::string& word, bool written);

}  // namespace roverd::api
