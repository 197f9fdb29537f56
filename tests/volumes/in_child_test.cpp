#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/volumes/files/in_child.hpp>

namespace trocar::volumes {

#if defined(__unix__)
TEST(InChild, WhatComesBackIsWholeAndWhatDiesIsNoticed) {
  const std::string large(3'000'000, 'x');
  const ChildResult good = in_child([&] { return large; }, 30, large.size());
  EXPECT_TRUE(good.came_back);
  EXPECT_EQ(good.bytes, large);
  EXPECT_FALSE(in_child([&] { return large; }, 30, 1000).came_back);  // more than was allowed
  EXPECT_FALSE(in_child([]() -> std::string { throw std::runtime_error("no"); }, 30, 1000).came_back);
  EXPECT_FALSE(in_child([]() -> std::string { std::_Exit(0); }, 30, 1000).came_back);
  EXPECT_FALSE(in_child(
                   []() -> std::string {
                     std::raise(SIGKILL);
                     return "!";
                   },
                   30, 1000)
                   .came_back);
}

TEST(InChild, WhatTakesTooLongIsEnded) {
  EXPECT_FALSE(in_child(
                   [] {
                     volatile unsigned long n = 0;
                     while (n + 1 != 0) n = n + 1;
                     return std::string("late");
                   },
                   1, 1000)
                   .came_back);
}
#endif

}  // namespace trocar::volumes
