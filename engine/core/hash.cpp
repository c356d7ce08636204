#include "engine/core/hash.h"

#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

#include "engine/core/error.h"

namespace gfxrepro {

namespace {

class Sha256 {
  public:
    Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
        require(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
    }
    void update(const void* data, std::size_t sizeBytes) {
        require(EVP_DigestUpdate(context_.get(), data, sizeBytes));
    }
    std::string hexDigest() {
        std::array<unsigned char, 32> digest{};
        require(EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr));
        constexpr char kDigits[] = "0123456789abcdef";
        std::string text;
        for (const unsigned char byte : digest) {
            text += kDigits[byte >> 4];
            text += kDigits[byte & 15];
        }
        return text;
    }

  private:
    static void require(int done) { GFXREPRO_ASSERT(done == 1); }

    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string sha256(std::span<const std::byte> bytes) {
    Sha256 hash;
    hash.update(bytes.data(), bytes.size());
    return hash.hexDigest();
}

std::string sha256(std::string_view text) {
    return sha256(std::as_bytes(std::span(text)));
}

std::string sha256OfFile(const std::filesystem::path& path) {
    // Mapped, all of it would count as memory of the process.
    constexpr std::size_t kBytesAtOnce = std::size_t{1} << 20;
    if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path)) {
        throw Error("cannot read " + path.string() + ": not a file");
    }
    std::ifstream file(path, std::ios::binary);
    std::vector<char> bytes(kBytesAtOnce);
    Sha256 hash;
    while (file) {
        file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        hash.update(bytes.data(), static_cast<std::size_t>(file.gcount()));
    }
    if (!file.eof()) throw Error("cannot read " + path.string() + ": " + std::strerror(errno));
    return hash.hexDigest();
}

}  // namespace gfxrepro
