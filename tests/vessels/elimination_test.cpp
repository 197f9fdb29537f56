#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/vessels/elimination.hpp>

namespace trocar::vessels {
namespace {

using Links = std::vector<std::pair<int, int>>;

/// Fills in a random matrix dominant by columns, solves, and puts the solution back: largest |A x - b|.
double residual(int nodes, const Links& links, core::Random& random) {
  const Elimination e = plan_elimination(nodes, links, 1'000'000);
  const std::size_t n = std::size_t(nodes);
  std::vector<double> diagonal(n, 0.01), values(e.values(), 0), b(n);
  for (double& x : b) x = random.uniform(-1, 1);
  for (std::size_t l = 0; l < links.size(); ++l) {
    const double ab = random.uniform(0, 10), ba = random.uniform(0, 10);
    const int a = e.row_of[links[l].first], c = e.row_of[links[l].second];
    values[e.entry_of_link[l]] -= ab, values[e.entry_of_link[l] ^ 1] -= ba;
    diagonal[c] += ab, diagonal[a] += ba;
  }
  std::vector<double> d = diagonal, v = values, x = b;
  EXPECT_EQ(eliminate(e, d, v, x), -1);
  std::vector<double> back(n, 0);
  for (int i = 0; i < nodes; ++i) back[i] += diagonal[i] * x[i];
  for (int i = 0; i < nodes; ++i)
    for (int k = e.start[i]; k < e.start[i + 1]; ++k) {
      back[i] += values[2 * k] * x[e.later[k]];
      back[e.later[k]] += values[2 * k + 1] * x[i];
    }
  double worst = 0;
  for (int i = 0; i < nodes; ++i) worst = std::max(worst, std::abs(back[i] - b[i]));
  return worst;
}

TEST(Elimination, SolvesTreesGraphsAndDoubledLinks) {
  core::Random random(5);
  for (int trial = 0; trial < 200; ++trial) {
    const int nodes = 1 + int(random.uniform(0, 60)), extra = trial % 3 == 0 ? 0 : int(random.uniform(0, 40));
    Links links;
    for (int i = 1; i < nodes; ++i) links.emplace_back(i, int(random.uniform(0, i)));
    for (int i = 0; i < extra && nodes > 1; ++i) {
      const int a = int(random.uniform(0, nodes)), b = int(random.uniform(0, nodes));
      if (a != b) links.emplace_back(a, b);
    }
    EXPECT_LT(residual(nodes, links, random), 1e-9) << trial;
  }
}

TEST(Elimination, FillsNothingIntoATree) {
  core::Random random(6);
  Links links;
  for (int i = 1; i < 2000; ++i) links.emplace_back(i, int(random.uniform(0, i)));
  const Elimination e = plan_elimination(2000, links, 1'000'000);
  EXPECT_EQ(e.later.size(), links.size());
  EXPECT_TRUE(e.fill.empty());
}

TEST(Elimination, FillsALittleForEachCycle) {
  core::Random random(7);
  Links links;
  for (int i = 1; i < 2000; ++i) links.emplace_back(i, int(random.uniform(0, i)));
  for (int i = 0; i < 20; ++i) links.emplace_back(i, 1000 + i);
  const Elimination e = plan_elimination(2000, links, 1'000'000);
  EXPECT_LT(e.later.size(), links.size() + 20 * 40);
}

TEST(Elimination, RefusesWhatWouldFillTooMuch) {
  core::Random random(8);
  Links links;
  for (int i = 0; i < 4000; ++i) {
    const int a = int(random.uniform(0, 1000)), b = int(random.uniform(0, 1000));
    if (a != b) links.emplace_back(a, b);
  }
  EXPECT_THROW(plan_elimination(1000, links, 10'000), std::length_error);
}

TEST(Elimination, TellsTheRowThatHasNoPivot) {
  const Links links{{0, 1}};
  const Elimination e = plan_elimination(2, links, 100);
  std::vector<double> d{1, 0}, v(e.values(), 0), x{1, 1};
  EXPECT_EQ(eliminate(e, d, v, x), 1);
  d = {std::nan(""), 1};
  EXPECT_EQ(eliminate(e, d, v, x), 0);
}

}  // namespace
}  // namespace trocar::vessels
