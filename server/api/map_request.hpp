#pragma once
// What is asked of maps: the form with a map's files, and the changes of one. Pure.

#include <string>
#include <string_view>
#include <vector>

#include "api/message.hpp"
#include "base/result.hpp"
#include "maps/exchange.hpp"
#include "maps/words.hpp"

namespace roverd::api {

struct MapForm {
  std::string name;
  maps::IfTaken if_taken = maps::IfTaken::Refuse;  ///< Number: nobody gave it, it is of the files
  maps::Upload upload;
};

/// multipart/form-data with `yaml` and `image`, or `cloud`, and perhaps `name`; without one the map
/// is called as its yaml says (maps/comments.hpp), else as the yaml's file, or the cloud's.
/// Unsupported: another type; Malformed: its frame is broken; Invalid: a file is missing, comes
/// twice or cannot be, or a field is not known, with its name. @param body is freed as soon as all
/// of it is read
base::Result<MapForm> read_map_form(std::string body, std::string_view content_type);

struct StopMaking {
  std::string name;                                ///< one that people may give
  maps::IfTaken if_taken = maps::IfTaken::Refuse;  ///< Number: nobody gave one
  bool discard = false;
};
/// {name?, discard?}. Invalid, with the name of what is wrong.
base::Result<StopMaking> read_stop_making(const Json& body);

/// {name?, anchor?|null, forbidden?, edits?}. Invalid, with the name of what is wrong.
base::Result<maps::Change> read_map_change(const Json& body);

}  // namespace roverd::api
