// 100,000 instruments at up to 2 m/s.
#include <cstdio>

#include <gtest/gtest.h>

#include "tunnel_trials.hpp"

using namespace trocar;

namespace {

void expect_no_passage(trials::Kind kind, int count) {
  trials::Trials trials(kind, 2026);
  int stabs = 0, passed_stabs = 0, passed_sweeps = 0, sank = 0, touched = 0;
  for (int i = 0; i < count; ++i) {
    const trials::Trials::Result r = trials.trial();
    stabs += r.stab;
    (r.stab ? passed_stabs : passed_sweeps) += r.passed;
    sank += r.sank;
    touched += r.touched;
    if (r.passed) std::printf("  trial %d: %s\n", i, r.what.c_str());
    ASSERT_EQ(r.flags & (std::uint32_t(tissue::StepReport::kNonFinite) | sim::StepReport::kTooManyLoads), 0u) << i;
  }
  std::printf("%-20s %6d trials: %d of %d stabs and %d of %d sweeps passed; %d sank in on the way, %d touched\n",
              trials::name(kind), count, passed_stabs, stabs, passed_sweeps, count - stabs, sank, touched);
  EXPECT_EQ(passed_stabs + passed_sweeps, 0);
  EXPECT_GT(touched, count * 9 / 10);
}

TEST(TunnelSoak, OrgansOfALatticeAreNotPassed) { expect_no_passage(trials::Kind::organ, 20'000); }
TEST(TunnelSoak, OrgansOfTetrahedraAreNotPassed) { expect_no_passage(trials::Kind::cells, 10'000); }
TEST(TunnelSoak, StrandsAreNotPassed) { expect_no_passage(trials::Kind::strand, 60'000); }
TEST(TunnelSoak, FoldsAreNotPassed) { expect_no_passage(trials::Kind::fold, 10'000); }

}  // namespace
