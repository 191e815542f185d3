# Turns the OpenAPI document into a C++ constant. -DIN=… -DOUT=…
file(READ ${IN} text)
file(WRITE ${OUT} "#include \"api/api.hpp\"

namespace roverd::api {

std::string_view openapi_text() noexcept {
  static constexpr std::string_view kText = R\"openapi(${text})openapi\";
  return kText;
}

}  // namespace roverd::api
")
