#include "reports/sha256.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace tetproof::sha256_test {
namespace {

// The vectors of FIPS 180-4's examples.
TEST(Sha256, PublishedVectors) {
  EXPECT_EQ(sha256_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_of(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, FilesAndMissingFiles) {
  const auto path = std::filesystem::path(testing::TempDir()) /
                    ("sha256_test_" + std::to_string(getpid()) + ".bin");
  std::ofstream(path, std::ios::binary) << "abc";
  EXPECT_EQ(sha256_of_file(path), sha256_of("abc"));
  std::filesystem::remove(path);
  EXPECT_THROW(sha256_of_file(path), std::runtime_error);
}

}  // namespace
}  // namespace tetproof::sha256_test
