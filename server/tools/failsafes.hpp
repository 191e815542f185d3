#pragma once
// The table of the failsafes for docs/safety.md, made from the rows by which the robot judges.

#include <string>
#include <string_view>

#include "base/result.hpp"

namespace roverd {

/// A Markdown table, a line a row; a parameter's default stands before its name.
std::string failsafes_table();

/// `page` with the table between its two marks. Invalid: it has not both of them, in order.
base::Result<std::string> with_failsafes(std::string_view page);

/// roverd failsafes [--into FILE]: prints the table, or writes it into a page.
/// @return exit code: 0, 1 the file cannot be read, has no marks or cannot be written.
int failsafes(const std::string& into);

}  // namespace roverd
