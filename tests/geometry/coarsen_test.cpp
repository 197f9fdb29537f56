// A surface with fewer triangles stays where it was.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include <trocar/geometry/surfaces/coarsen.hpp>

#include "shapes.hpp"

namespace trocar::geometry {
namespace {

struct Surface {
  std::vector<Vec3f> positions;
  std::vector<std::uint32_t> triangles;

  Vec3f corner(std::size_t k) const { return positions[triangles[k]]; }
};

Surface ball(double radius, int levels) {
  const TriMesh mesh = sphere_mesh(radius, levels);
  Surface s;
  for (const Vec3d& p : mesh.positions) s.positions.push_back(vec_cast<float>(p));
  for (const auto& t : mesh.triangles)
    for (const int v : t) s.triangles.push_back(std::uint32_t(v));
  return s;
}

/// A square of n x n fields, 1 mm each.
Surface field(int n) {
  Surface s;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) s.positions.push_back({0.001f * float(x), 0.001f * float(y), 0});
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const auto a = std::uint32_t(y * (n + 1) + x), b = a + std::uint32_t(n) + 1;
      s.triangles.insert(s.triangles.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  return s;
}

std::vector<Surface> coarser(const Surface& s, std::vector<double> errors, double longest = 1,
                             std::vector<Vec3f> notes = {}) {
  std::vector<Surface> levels;
  for (auto& list : coarsened(s.positions, s.triangles, notes, errors, longest))
    levels.push_back({s.positions, std::move(list)});
  return levels;
}

/// How often each edge occurs, whichever way it runs.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges(const Surface& s) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
  for (std::size_t t = 0; t < s.triangles.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = s.triangles[t + k], b = s.triangles[t + (k + 1) % 3];
      ++count[{std::min(a, b), std::max(a, b)}];
    }
  return count;
}

double longest_edge(const Surface& s) {
  double longest = 0;
  for (const auto& [edge, count] : edges(s))
    longest = std::max(longest, double(length(s.positions[edge.first] - s.positions[edge.second])));
  return longest;
}

TEST(Coarsen, ABallHasFewerTrianglesTheMoreItMayDepart) {
  const Surface fine = ball(0.03, 5);
  const auto levels = coarser(fine, {0.0001, 0.0004, 0.0016});
  EXPECT_LT(levels[0].triangles.size(), fine.triangles.size() / 2);
  EXPECT_LT(levels[1].triangles.size(), levels[0].triangles.size() / 2);
  EXPECT_LT(levels[2].triangles.size(), levels[1].triangles.size() / 2);
}

TEST(Coarsen, ABallStaysWithinItsErrorInTheMeanAndTwiceThatAnywhere) {
  const Surface fine = ball(0.03, 5);
  const std::vector<double> errors{0.0001, 0.0004, 0.0016};
  const auto levels = coarser(fine, errors);
  for (std::size_t k = 0; k < levels.size(); ++k) {
    double mean = 0, most = 0;
    for (std::size_t t = 0; t < levels[k].triangles.size(); t += 3) {
      const Vec3f middle = (levels[k].corner(t) + levels[k].corner(t + 1) + levels[k].corner(t + 2)) / 3.0f;
      const double depth = 0.03 - double(length(middle));
      mean += depth / double(levels[k].triangles.size() / 3);
      most = std::max(most, depth);
    }
    EXPECT_LT(mean, errors[k]) << k;
    EXPECT_LT(most, 2 * errors[k]) << k;
  }
}

TEST(Coarsen, ABallStaysClosedAndFacesOutwards) {
  const Surface coarse = coarser(ball(0.03, 4), {0.001})[0];
  for (const auto& [edge, count] : edges(coarse)) EXPECT_EQ(count, 2);
  for (std::size_t t = 0; t < coarse.triangles.size(); t += 3) {
    const Vec3f a = coarse.corner(t);
    EXPECT_GT(dot(cross(coarse.corner(t + 1) - a, coarse.corner(t + 2) - a), a), 0.0f);
  }
}

TEST(Coarsen, APlaneIsOnlyItsBorder) {
  const Surface fine = field(20);
  const Surface coarse = coarser(fine, {1e-6})[0];
  EXPECT_LT(coarse.triangles.size(), fine.triangles.size() / 5);
  const auto border = [](const Surface& s) {
    std::size_t n = 0;
    for (const auto& [edge, count] : edges(s)) n += count == 1;
    return n;
  };
  EXPECT_EQ(border(coarse), border(fine));
}

TEST(Coarsen, NoEdgeIsLongerThanAsked) {
  const Surface fine = field(20);
  EXPECT_LE(longest_edge(coarser(fine, {1e-6}, 0.004)[0]), 0.004 + 1e-6);
  EXPECT_GT(longest_edge(coarser(fine, {1e-6})[0]), 0.006);
}

TEST(Coarsen, WhatVariesOverThePlaneKeepsItsPlace) {
  const Surface fine = field(20);
  std::vector<Vec3f> notes;
  for (const Vec3f& p : fine.positions) notes.push_back({p.x > 0.0101f ? 0.001f : 0.0f, 0, 0});
  const auto levels = coarser(fine, {0.0001}, 1, notes);
  int across = 0;
  for (const auto& [edge, count] : edges(levels[0])) {
    const Vec3f a = fine.positions[edge.first], b = fine.positions[edge.second];
    if ((a.x > 0.0101f) == (b.x > 0.0101f)) continue;
    ++across;
    EXPECT_LE(std::min(a.x, b.x), 0.0101f);
    EXPECT_LT(std::fabs(a.x - b.x), 0.0105f);  // one side may be plain, but the step's own vertices are there
  }
  EXPECT_GT(across, 0);
  std::size_t kept = 0, kept_without = 0;
  const auto at_step = [&](const Surface& s) {
    std::vector<bool> used(s.positions.size());
    for (const std::uint32_t v : s.triangles) used[v] = true;
    std::size_t n = 0;
    for (std::size_t v = 0; v < used.size(); ++v) n += used[v] && std::fabs(s.positions[v].x - 0.0105f) < 0.0006f;
    return n;
  };
  kept = at_step(levels[0]);
  kept_without = at_step(coarser(fine, {0.0001})[0]);
  EXPECT_GT(kept, kept_without);
}

TEST(Coarsen, GivesTheSameTrianglesEveryTime) {
  const Surface fine = ball(0.03, 4);
  EXPECT_EQ(coarser(fine, {0.0005})[0].triangles, coarser(fine, {0.0005})[0].triangles);
}

TEST(Coarsen, NothingIsLeftAsItIs) { EXPECT_EQ(coarsened({}, {}, {}, std::vector<double>{0.001}, 1).size(), 1u); }

}  // namespace
}  // namespace trocar::geometry
