// K14, the short one: hands that jerk do not pull thread through thread.
#include "abuse.hpp"

#include <gtest/gtest.h>

using namespace trocar::suture::test;

TEST(ThreadAbuse, ThousandJerksPullNoThreadThroughThread) {
  expect_no_crossing("PDS", 500, 7);
  expect_no_crossing("silk", 500, 11);
}
