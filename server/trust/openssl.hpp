#pragma once
// OpenSSL's objects, owned.

#include <memory>
#include <string>
#include <string_view>

#include <openssl/bio.h>
#include <openssl/bn.h>
#include <openssl/evp.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include "base/result.hpp"

namespace roverd::trust {

template <auto Free>
struct FreeWith {
  template <class T>
  void operator()(T* held) const noexcept {
    Free(held);
  }
};
using Certificate = std::unique_ptr<X509, FreeWith<X509_free>>;
using Key = std::unique_ptr<EVP_PKEY, FreeWith<EVP_PKEY_free>>;
using Bio = std::unique_ptr<BIO, FreeWith<BIO_free_all>>;
using Extension = std::unique_ptr<X509_EXTENSION, FreeWith<X509_EXTENSION_free>>;

/// The first certificate in the text; null: there is none, or it is broken.
Certificate parse_certificate(std::string_view pem);
/// Null: broken, or it asks for a pass phrase.
Key parse_key(std::string_view pem);
std::string pem_of(X509* certificate);
std::string pem_of(EVP_PKEY* key);
/// OpenSSL's own word for what failed last; its queue is empty then.
std::string last_cause();

}  // namespace roverd::trust
