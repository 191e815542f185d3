# Turns the OpenAPI document into a C++ constant. -DIN=… -DOUT=…
file(READ ${IN} text)
file(WRITE ${OUT} "#include \"api/api.hpp\"

namespace roverd::api {

std::string_view openapi_text() noexcept {
  // Its length from the array: a compiler counts no string as long as this.
  static constexpr char kText[] = R\"openapi(${text})openapi\";
  return {kText, sizeof kText - 1};
}

}  // namespace roverd::api
")
