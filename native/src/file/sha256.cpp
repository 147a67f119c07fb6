#include <openssl/evp.h>

#include <algorithm>
#include <memory>

#include "file/file.h"
#include "file/random_access_file.h"
#include "job/error.h"

namespace velour {
namespace {

class Digest {
 public:
  Digest() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    require(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void add(std::span<const uint8_t> bytes) {
    require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
  }
  std::string hex() {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int size = 0;
    require(EVP_DigestFinal_ex(context_.get(), digest, &size) == 1);
    static constexpr char kHex[] = "0123456789abcdef";
    std::string text;
    for (unsigned int i = 0; i < size; ++i) {
      text += kHex[digest[i] >> 4];
      text += kHex[digest[i] & 15];
    }
    return text;
  }

 private:
  static void require(bool works) {
    if (!works) throw Error(Status::unknown, "SHA-256 is not available in this build of OpenSSL.");
  }
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string sha256_hex(std::span<const uint8_t> bytes) {
  Digest digest;
  digest.add(bytes);
  return digest.hex();
}

std::string sha256_of_file(const std::string& path, const Progress& progress) {
  const RandomAccessFile file(path);
  std::vector<uint8_t> piece(size_t{1} << 20);
  Digest digest;
  for (uint64_t done = 0; done < file.size(); done += piece.size()) {
    progress.check();
    piece.resize(std::min<uint64_t>(piece.size(), file.size() - done));
    file.read(done, piece);
    digest.add(piece);
  }
  return digest.hex();
}

}  // namespace velour
