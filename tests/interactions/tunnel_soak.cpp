// 100,000 instruments at up to 2 m/s. Hands reach 0.6 m/s.
#include <cstdio>

#include <gtest/gtest.h>

#include "tunnel_trials.hpp"

using namespace trocar;

namespace {

/// @return how many were passed
int passages(trials::Kind kind, int count, trials::With with = trials::With::grasper, double fastest = 2.0) {
  trials::Trials trials(kind, 2026, with);
  int stabs = 0, passed_stabs = 0, passed_sweeps = 0, sank = 0, touched = 0;
  for (int i = 0; i < count; ++i) {
    const trials::Trials::Result r = trials.trial(i, 0.3, fastest);
    stabs += r.stab;
    (r.stab ? passed_stabs : passed_sweeps) += r.passed;
    sank += r.sank;
    touched += r.touched;
    EXPECT_FALSE(r.passed) << "trial " << i << ": " << r.what;
    EXPECT_EQ(r.flags & (std::uint32_t(tissue::StepReport::kNonFinite) | sim::StepReport::kTooManyLoads), 0u) << i;
  }
  std::printf("%-20s %6d trials: %d of %d stabs and %d of %d sweeps passed; %d sank in on the way, %d touched\n",
              trials::name(kind), count, passed_stabs, stabs, passed_sweeps, count - stabs, sank, touched);
  EXPECT_GT(touched, count * 9 / 10);
  return passed_stabs + passed_sweeps;
}

TEST(TunnelSoak, OrgansOfALatticeAreNotPassed) { EXPECT_EQ(passages(trials::Kind::organ, 20'000), 0); }
TEST(TunnelSoak, OrgansOfTetrahedraAreNotPassed) { EXPECT_EQ(passages(trials::Kind::cells, 20'000), 0); }
TEST(TunnelSoak, StrandsAreNotPassed) { EXPECT_EQ(passages(trials::Kind::strand, 40'000), 0); }
TEST(TunnelSoak, FoldsAreNotPassed) { EXPECT_EQ(passages(trials::Kind::fold, 20'000), 0); }
TEST(TunnelSoak, NothingIsPassedByAHookWithAFootAtHandSpeed) {
  for (const trials::Kind kind : {trials::Kind::organ, trials::Kind::cells, trials::Kind::strand, trials::Kind::fold})
    EXPECT_EQ(passages(kind, 2'000, trials::With::hook, 0.6), 0);
}

}  // namespace
