# Builds the page's files into the program.
#
#   cmake -DDIST=web/dist -DOUT_DIR=… -P embed_page.cmake
#
# Writes OUT_DIR/page.cpp, which takes the bytes in with the assembler's .incbin: quick, whatever
# their size. Every file goes in as it is and, where it is there beside it (the web build makes
# them), as .br and .gz. Files below /assets/ carry a hash of their content in the name.
# The output is only written when something changed, so an unchanged page compiles nothing.

set(not_built "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>roverd</title>\
<h1>The page was not built</h1><p>This program was compiled without <code>web/dist</code>. Run \
<code>./run</code>, or <code>npm ci && npm run build</code> in <code>web</code>, and compile \
again. The <a href=\"/openapi.json\">interface</a> works.</p></html>\n")

if(EXISTS ${DIST}/index.html)
  set(root ${DIST})
else()
  message("The page is not built (no ${DIST}/index.html): the program will say so in its place.")
  set(root ${OUT_DIR}/not_built)
  file(WRITE ${root}/index.html "${not_built}")
endif()

set(type_html "text/html; charset=utf-8")
set(type_js "text/javascript; charset=utf-8")
set(type_css "text/css; charset=utf-8")
set(type_json "application/json")
set(type_map "application/json")
set(type_webmanifest "application/manifest+json")
set(type_svg "image/svg+xml")
set(type_png "image/png")
set(type_jpg "image/jpeg")
set(type_ico "image/vnd.microsoft.icon")
set(type_woff2 "font/woff2")
set(type_wasm "application/wasm")
set(type_txt "text/plain; charset=utf-8")

# One blob: symbols page_N_begin and page_N_end. The bytes are copied first, under the name of their
# hash: the web build may replace dist while the compiler runs.
set(count 0)
set(blobs "")
set(externs "")
function(add_blob file out)
  file(SHA256 ${file} hash)
  set(copy ${OUT_DIR}/blobs/${hash})
  if(NOT EXISTS ${copy})
    file(MAKE_DIRECTORY ${OUT_DIR}/blobs)
    file(COPY_FILE ${file} ${copy})
  endif()
  set(n ${count})
  math(EXPR next "${count} + 1")
  set(count ${next} PARENT_SCOPE)
  set(blobs "${blobs}        \"page_${n}_begin: .incbin \\\"${copy}\\\"\\n\"\n        \"page_${n}_end: .byte 0\\n\"\n" PARENT_SCOPE)
  set(externs "${externs}extern const char page_${n}_begin[], page_${n}_end[];\n" PARENT_SCOPE)
  set(${out} "{page_${n}_begin, size_of(page_${n}_begin, page_${n}_end)}" PARENT_SCOPE)
endfunction()

file(GLOB_RECURSE files RELATIVE ${root} ${root}/*)
list(SORT files)
set(entries "")
foreach(file ${files})
  if(file MATCHES "\\.(br|gz)$")
    continue()
  endif()
  string(REGEX REPLACE "^.*\\." "" ending "${file}")
  set(type "${type_${ending}}")
  if(NOT type)
    set(type "application/octet-stream")
  endif()
  set(immutable false)
  if(file MATCHES "^assets/")
    set(immutable true)
  endif()
  add_blob(${root}/${file} raw)
  set(gzip "{}")
  set(brotli "{}")
  if(EXISTS ${root}/${file}.gz)
    add_blob(${root}/${file}.gz gzip)
  endif()
  if(EXISTS ${root}/${file}.br)
    add_blob(${root}/${file}.br brotli)
  endif()
  string(APPEND entries "      {\"/${file}\", \"${type}\", ${immutable}, ${raw}, ${gzip}, ${brotli}},\n")
endforeach()

set(source "// Made by embed_page.cmake.
#include \"net/page.hpp\"

extern \"C\" {
${externs}}

__asm__(\".section .rodata\\n\"
${blobs}        \".previous\\n\");

namespace roverd::net {

std::span<const FileEntry> page_entries() noexcept {
  const auto size_of = [](const char* begin, const char* end) {
    return static_cast<std::size_t>(end - begin);
  };
  static const FileEntry kEntries[] = {
${entries}  };
  return kEntries;
}

}  // namespace roverd::net
")
set(out ${OUT_DIR}/page.cpp)
set(old "")
if(EXISTS ${out})
  file(READ ${out} old)
endif()
if(NOT old STREQUAL source)
  file(WRITE ${out} "${source}")
endif()
