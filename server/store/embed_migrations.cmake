# cmake -DFOLDER=<migrations> -DOUT=<file.cpp> -P embed_migrations.cmake
# Writes the SQL files as string literals, in the order of their numbers, which must be 1, 2, 3 …
file(GLOB files ${FOLDER}/*.sql)
list(SORT files)
set(rows "")
set(number 0)
foreach(path ${files})
  math(EXPR number "${number} + 1")
  get_filename_component(name ${path} NAME)
  if(NOT name MATCHES "^([0-9][0-9][0-9][0-9])_[a-z0-9_]+\\.sql$")
    message(FATAL_ERROR "${name}: a migration is named like 0001_missions.sql")
  endif()
  string(REGEX REPLACE "^0+" "" found "${CMAKE_MATCH_1}")
  if(NOT found EQUAL number)
    message(FATAL_ERROR "${name}: number ${number} is due")
  endif()
  # By bytes, because CMake would take semicolons and brackets as its own; 10 a line.
  file(READ ${path} hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${hex}")
  string(REGEX REPLACE "(......................................................................)"
         "\\1\n    " bytes "${bytes}")
  string(APPEND arrays "constexpr char kSql${number}[] = {\n    ${bytes}0};\n")
  string(APPEND rows "    {${number}, \"${name}\", {kSql${number}, sizeof kSql${number} - 1}},\n")
endforeach()
file(WRITE ${OUT}.new "// Made from migrations/*.sql by embed_migrations.cmake.
#include \"store/migrations.hpp\"

namespace roverd::store {
namespace {

${arrays}
constexpr Migration kAll[] = {
${rows}};

}  // namespace

std::span<const Migration> migrations() noexcept { return kAll; }

}  // namespace roverd::store
")
file(COPY_FILE ${OUT}.new ${OUT} ONLY_IF_DIFFERENT)
file(REMOVE ${OUT}.new)
file(TOUCH ${OUT})
