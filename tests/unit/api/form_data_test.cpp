// Forms: RFC 7578, framed as RFC 2046 says.

#include "api/form_data.hpp"

#include <gtest/gtest.h>

#include "api/import_request.hpp"

namespace roverd::api {
namespace {

std::string boundary_of(std::string_view type) {
  const auto found = form_boundary(type);
  if (!found) return "refused";
  return found->value_or("none");
}

// RFC 2046, 5.1.1: "boundary := 0*69<bchars> bcharsnospace"; "it is often necessary to enclose the
// boundary parameter values in quotes".
TEST(FormBoundary, IsReadAsATokenOrInQuotes) {
  EXPECT_EQ(boundary_of("multipart/form-data; boundary=abc"), "abc");
  EXPECT_EQ(boundary_of("Multipart/Form-Data;charset=utf-8 ; Boundary=\"a b:c\""), "a b:c");
  EXPECT_EQ(boundary_of("application/json"), "none");
  EXPECT_EQ(boundary_of(""), "none");
  EXPECT_EQ(boundary_of("multipart/form-data"), "refused");
  EXPECT_EQ(boundary_of("multipart/form-data; boundary="), "refused");
  EXPECT_EQ(boundary_of("multipart/form-data; boundary=\"a \""), "refused");
  EXPECT_EQ(boundary_of("multipart/form-data; boundary=" + std::string(71, 'a')), "refused");
  EXPECT_EQ(boundary_of("multipart/form-data; boundary=" + std::string(70, 'a')),
            std::string(70, 'a'));
}

/// "name|file name|content" of each part, or the first problem's place and words.
std::string parts_of(std::string_view body) {
  const auto parts = form_parts(body, "XX");
  if (!parts) {
    const auto& error = parts.error();
    return error.fields.empty() ? error.detail
                                : error.fields[0].pointer + ": " + error.fields[0].detail;
  }
  std::string out;
  for (const FormPart& part : *parts) {
    out += part.name + "|" + part.file_name.value_or("-") + "|" + std::string(part.content) + "\n";
  }
  return out;
}

const std::string kHead =
    "Content-Disposition: form-data; name=\"file\"; filename=\"a.csv\"\r\n\r\n";

// RFC 2046, 5.1.1: "The body must then contain one or more body parts, each preceded by a boundary
// delimiter line, and the last one followed by a closing boundary delimiter line"; "there appears
// to be room for additional information prior to the first boundary delimiter line and following
// the final boundary delimiter line … implementations must ignore".
TEST(FormParts, AreFoundBetweenPreambleAndEpilogue) {
  const std::string form = "--XX\r\n" + kHead +
                           "1,2\r\n3,4\r\n--XX\r\nContent-Type: text/plain\r\n"
                           "content-disposition: form-data; name=format\r\n\r\ncsv\r\n--XX--";
  EXPECT_EQ(parts_of(form), "file|a.csv|1,2\r\n3,4\nformat|-|csv\n");
  EXPECT_EQ(parts_of("hello\r\n--XXY\r\n" + form.substr(0, 0) + "\r\n" + form + "\r\nbye --XX"),
            "file|a.csv|1,2\r\n3,4\nformat|-|csv\n");
  EXPECT_EQ(parts_of("--XX \t\r\n" + kHead + "\r\n--XX--\r\n"), "file|a.csv|\n");
  EXPECT_EQ(parts_of("--XX\r\n" + kHead + "--XX--\r\n"), "file|a.csv|\n");
  EXPECT_EQ(parts_of("--XX--"), "");
}

// "Boundary delimiters must not appear within the encapsulated material": what only looks like one
// belongs to it.
TEST(FormParts, KeepEveryByteOfTheirContent) {
  using namespace std::string_literals;
  const std::string bytes = "a\r\n--XXL\r\n--X\r\n-- XX\r\n\n--XX\r\n\0\xFF--XX"s;
  EXPECT_EQ(parts_of("--XX\r\n" + kHead + bytes + "\r\n--XX--"), "file|a.csv|" + bytes + "\n");
}

// RFC 7578, 4.2: "each part MUST contain a Content-Disposition header field … The disposition type
// MUST be 'form-data'. The Content-Disposition header field MUST also contain an additional
// parameter of 'name'"; RFC 2183 and browsers on quotes in names.
TEST(FormParts, NamesMayHoldQuotesSemicolonsAndPaths) {
  const auto name = [](const std::string& disposition) {
    return parts_of("--XX\r\nContent-Disposition: " + disposition + "\r\n\r\nx\r\n--XX--");
  };
  EXPECT_EQ(name("form-data; name=file; filename=\"a \\\"b\\\"; c.csv\""),
            "file|a \"b\"; c.csv|x\n");
  EXPECT_EQ(name("form-data; filename=\"a%22b%0D%0A.csv\"; name=\"file\""), "file|a\"b  .csv|x\n");
  EXPECT_EQ(name("form-data; name=\"file\"; filename=\"C:\\new\\p.csv\""),
            "file|C:\\new\\p.csv|x\n");
  EXPECT_EQ(name("form-data; name=\"file\"; filename*=UTF-8''no.csv"), "file|-|x\n");
  EXPECT_EQ(name("form-data").substr(0, 7), "part 1:");
  EXPECT_EQ(name("attachment; name=file").substr(0, 7), "part 1:");
}

TEST(FormParts, ThatBreakOffOrAreEncodedAreRefusedInWords) {
  EXPECT_EQ(parts_of(""), "part 1: the form has no line with its boundary");
  EXPECT_EQ(parts_of("1,2\n3,4"), "part 1: the form has no line with its boundary");
  EXPECT_EQ(parts_of("--XX\r\n" + kHead + "1,2\r\n"), "part 1: part 1 of the form breaks off");
  EXPECT_EQ(parts_of("--XX\r\n\r\nx\r\n--XX--"),
            "part 1: part 1 of the form has no Content-Disposition: form-data with a name");
  EXPECT_EQ(parts_of("--XX\r\nContent-Dis"),
            "part 1: part 1 of the form has no end of its headers");
  EXPECT_EQ(parts_of("--XX\r\nno header\r\n\r\nx\r\n--XX--"),
            "part 1: part 1 of the form has a line that is no header");
  EXPECT_EQ(parts_of("--XX\r\nContent-Transfer-Encoding: base64\r\n" + kHead + "eA==\r\n--XX--"),
            "a part of the form is encoded: send it as it is");
  std::string many;
  for (int i = 0; i < 40; ++i) many += "--XX\r\n" + kHead + "x\r\n";
  EXPECT_EQ(parts_of(many + "--XX--"), "the form has more than 32 parts");
}

/// The mission's name, or the first problem's place.
std::string uploaded(const std::string& body, ImportWish wish) {
  const auto upload = read_upload(body, std::move(wish));
  if (upload) return upload->file.plan.name + " from " + upload->from;
  const auto& error = upload.error();
  return error.fields.empty() ? error.detail : error.fields[0].pointer;
}

TEST(Upload, IsTheBodyOrTheOneFileOfAForm) {
  const std::string table = "lat,lon\n58,26\n58.1,26\n";
  const ImportWish form{.content_type = "multipart/form-data; boundary=XX"};
  const auto file = [&](const std::string& head) {
    return "--XX\r\nContent-Disposition: form-data; " + head + "\r\n\r\n" + table + "\r\n";
  };
  const auto field = [](const std::string& name, const std::string& value) {
    return "--XX\r\nContent-Disposition: form-data; name=" + name + "\r\n\r\n" + value + "\r\n";
  };
  EXPECT_EQ(uploaded(table, {.name = "dir/yard.csv"}), "yard from yard.csv");
  EXPECT_EQ(uploaded(table, {}), "Imported mission from csv file");
  EXPECT_EQ(uploaded(file("name=f; filename=\"C:\\x\\yard.csv\"") + "--XX--", form),
            "yard from yard.csv");
  EXPECT_EQ(uploaded(file("name=file") + field("name", "barn.csv") + "--XX--", form),
            "barn from barn.csv");
  ImportWish named = form;
  named.name = "query.csv";
  EXPECT_EQ(uploaded(file("name=file") + field("name", "barn.csv") + "--XX--", named),
            "query from query.csv");
  EXPECT_EQ(uploaded(file("name=a; filename=a") + file("name=b; filename=b") + "--XX--", form),
            "file");
  EXPECT_EQ(uploaded(field("format", "csv") + "--XX--", form), "file");
  EXPECT_EQ(uploaded(field("colour", "red") + file("name=file") + "--XX--", form), "colour");
  EXPECT_EQ(uploaded(field("format", "doc") + file("name=file") + "--XX--", form), "format");
  EXPECT_EQ(uploaded(field("format", "gpx") + file("name=file") + "--XX--", form), "line 1");
  EXPECT_EQ(uploaded("", {}), "the file is empty");
  EXPECT_EQ(uploaded(table, {.origin_lat = "91", .origin_lon = "0"}), "origin_lat");
  EXPECT_EQ(uploaded(table, {.speed_unit = "knots"}), "speed_unit");
}

}  // namespace
}  // namespace roverd::api
