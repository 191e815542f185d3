#pragma once
// `roverd report [--data DIR] RUN...`: how well runs were driven, side by side, as a table.

namespace roverd {

/// Reads the database itself, so it works with and without a running program. @return exit code:
/// 0; 1 the database cannot be read; 2 wrong arguments, or no such run
int report(int argc, char** argv);

}  // namespace roverd
