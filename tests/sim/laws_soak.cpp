// The laws of the step on the whole piece of work of session.hpp, of which the quick tests step the stretches in which
// something happens.
#include <gtest/gtest.h>

#include "session.hpp"

using namespace trocar;
using namespace trocar::sim;
using namespace trocar::laws;

TEST(StepSoak, PoisonedWorkChangesNoBit) {
  State s = initial_state(small::model());
  Work w = make_work(small::model());
  EXPECT_EQ(first_difference(s, w, [](State&, Work& work) { poison(work); }), 0u) << differing_field;
}

TEST(StepSoak, ThePoolsSizeChangesNoBit) {
  for (int threads : {1, 2, 3, 5}) {
    core::ThreadPool pool(threads);
    State s = initial_state(small::model());
    Work w = make_work(small::model(), &pool);
    EXPECT_EQ(first_difference(s, w), 0u) << threads << " threads, " << differing_field;
  }
}

TEST(StepSoak, TheSimdWidthChangesNoBit) {
  const std::string usual = tissue::simd_name();
  int tried = 0;
  for (const char* name : {"generic", "sse2", "avx2", "avx512"}) {
    if (!tissue::set_simd(name)) continue;
    ++tried;
    State s = initial_state(small::model());
    Work w = make_work(small::model());
    EXPECT_EQ(first_difference(s, w), 0u) << name << ", " << differing_field;
  }
  tissue::set_simd(usual);
  EXPECT_GE(tried, 1);
}
