// K14, the long one: a hundred thousand jerks.
#include <gtest/gtest.h>

#include "abuse.hpp"

namespace trocar::suture::test {
namespace {

constexpr int kJerks = 10000;

class ThreadAbuseSoak : public testing::TestWithParam<int> {};
TEST_P(ThreadAbuseSoak, TenThousandJerksPullNoPdsThroughItself) {
  expect_no_crossing("PDS", kJerks, std::uint64_t(GetParam()));
}
TEST_P(ThreadAbuseSoak, TenThousandJerksPullNoSilkThroughItself) {
  expect_no_crossing("silk", kJerks, std::uint64_t(100 + GetParam()));
}
INSTANTIATE_TEST_SUITE_P(Seeds, ThreadAbuseSoak, testing::Range(1, 6));

}  // namespace
}  // namespace trocar::suture::test
