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

/// roverd ntrip table CASTER… [--json]. @param addresses each HOST[:PORT] or
/// ntrip[s]://[USER:PASSWORD@]HOST[:PORT]. @return exit code: 0, 1 a caster did not answer, 2 an
/// address cannot be read.
int ntrip_table(const std::vector<std::string>& addresses, bool json);

}  // namespace roverd
