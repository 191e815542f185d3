#pragma once
// What casters offer, for choosing a mountpoint.

#include <string>
#include <vector>

#include "ntrip/reply.hpp"

namespace roverd {

/// A line a stream, with a head; columns aligned. What is not printable is shown as '?'.
std::string table_text(const std::vector<ntrip::Source>& sources);
/// A JSON array of objects. Not terminated.
std::string table_json(const std::string& caster, const std::vector<ntrip::Source>& sources);

/// roverd ntrip table CASTER… [--json]; CASTER: HOST[:PORT] or
/// ntrip[s]://[USER:PASSWORD@]HOST[:PORT].
/// @param argc, argv what follows the word "ntrip". @return exit code: 0, 1 a caster did not
/// answer, 2 wrong arguments.
int ntrip_command(int argc, char** argv);

}  // namespace roverd
