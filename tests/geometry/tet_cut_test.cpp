#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/tets/tet_cut.hpp>

#include "cut_checks.hpp"

namespace trocar::geometry {
namespace {

/// A box of nx x ny x nz cubes of six tetrahedra each.
struct Body {
  CuttableTets tets;
  CutWork work;
  std::vector<Vec3d> now;
  double volume_before = 0;

  Body(int nx, int ny, int nz, double h, int spare, double jitter = 0) {
    std::vector<Vec3d> points;
    core::Random random(3);
    for (int k = 0; k <= nz; ++k)
      for (int j = 0; j <= ny; ++j)
        for (int i = 0; i <= nx; ++i) {
          Vec3d p{i * h, j * h, k * h};
          const bool inner = i > 0 && j > 0 && k > 0 && i < nx && j < ny && k < nz;
          for (int axis = 0; axis < 3; ++axis)
            if (inner) p[axis] += random.uniform(-jitter, jitter) * h;
          points.push_back(p);
        }
    const auto at = [&](int i, int j, int k) { return std::int32_t(i + (nx + 1) * (j + (ny + 1) * k)); };
    constexpr int kPaths[6][2] = {{1, 3}, {5, 1}, {3, 2}, {2, 6}, {4, 5}, {6, 4}};
    std::vector<Tet> cells;
    for (int k = 0; k < nz; ++k)
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
          const auto corner = [&](int c) { return at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1)); };
          for (const auto& p : kPaths) cells.push_back({corner(0), corner(p[0]), corner(p[1]), corner(7)});
        }
    tets = cuttable(points, cells, spare);
    work = make_work(tets);
    now = tets.rest;
    volume_before = volume();
  }
  double volume(const Tet& c) const { return drawn_volume(tets, c); }
  double volume() const {
    double v = 0;
    for (const Tet& c : tets.cells) v += volume(c);
    return v;
  }
  double least_angle() const {
    double least = 180;
    for (const Tet& c : tets.cells) least = std::min(least, least_dihedral(drawn_corners(tets, c)));
    return least;
  }
  CutResult cut(const Blade& blade) { return geometry::cut(tets, blade, now, work); }
  /// Volumes of the pieces that hang together over faces, largest first.
  std::vector<double> pieces() const {
    std::vector<double> out;
    std::vector<bool> seen(tets.cells.size(), false);
    for (size_t start = 0; start < tets.cells.size(); ++start) {
      if (seen[start]) continue;
      std::vector<std::int32_t> fan{std::int32_t(start)};
      seen[start] = true;
      double v = 0;
      for (size_t head = 0; head < fan.size(); ++head) {
        v += volume(tets.cells[size_t(fan[head])]);
        for (const std::int32_t u : tets.across[size_t(fan[head])])
          if (u >= 0 && !seen[size_t(u)]) seen[size_t(u)] = true, fan.push_back(u);
      }
      out.push_back(v);
    }
    std::sort(out.rbegin(), out.rend());
    return out;
  }
  /// What must hold after any cut.
  void expect_sound(const char* when, double least) const {
    const Soundness s = soundness(tets);
    ASSERT_GT(s.least_volume, 0) << when;
    ASSERT_TRUE(s.linked) << when << ": joined cells share their face's corners";
    ASSERT_EQ(s.odd_edges, 0) << when << ": the surface is closed";
    EXPECT_GE(s.least_dihedral, least) << when;
  }
};

/// A rectangle around `middle` with edges along u and v.
Blade rectangle(Vec3d middle, Vec3d u, Vec3d v) {
  Blade b;
  b.corners = 4;
  b.corner = {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
  return b;
}

TEST(TetCut, ABladeThroughTheWholeBodyMakesTwoPiecesThatAreAsLargeAsTheyShould) {
  Body b(6, 6, 12, 0.005, 400);
  const CutResult book = b.cut(rectangle({0.015, 0.015, 0.0222}, {0.05, 0.003, 0.004}, {0, 0.05, 0.006}));
  EXPECT_FALSE(book.full);
  EXPECT_GT(book.parted, 0);
  EXPECT_EQ(book.doubled, b.tets.nodes - book.first_new);
  const std::vector<double> pieces = b.pieces();
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_NEAR(pieces[0] + pieces[1], b.volume_before + book.volume, 1e-6 * b.volume_before);
  EXPECT_NEAR(pieces[1] / (pieces[0] + pieces[1]), 0.0222 / 0.06, 0.03);
  b.expect_sound("after the cut", kLeastDihedral);
  for (std::int32_t i = book.first_new; i < b.tets.nodes; ++i)
    EXPECT_EQ(length(b.now[size_t(i)] - b.now[size_t(b.tets.source[size_t(i)])]), 0);
}

TEST(TetCut, TheNewFacesLieAlongTheBlade) {
  Body b(8, 8, 8, 0.004, 400, 0.15);
  const Blade blade = rectangle({0.016, 0.016, 0.0143}, {0.05, 0, 0.004}, {0, 0.05, -0.003});
  const Vec3d n = normalised(cross(blade.corner[1] - blade.corner[0], blade.corner[2] - blade.corner[0]));
  const CutResult book = b.cut(blade);
  double off = 0;
  for (std::int32_t i = book.first_new; i < b.tets.nodes; ++i)
    off += std::fabs(dot(b.tets.rest[size_t(i)] - blade.corner[0], n)) / book.doubled;
  EXPECT_LT(off, 0.1 * 0.004) << "a tenth of a cell on average";
  EXPECT_LT(book.refused, book.snapped / 2);
}

TEST(TetCut, ABladeThatEndsInsideLeavesOnePieceWithASlit) {
  Body b(6, 6, 6, 0.005, 400);
  const CutResult book = b.cut(rectangle({0.0, 0.015, 0.0143}, {0.016, 0, 0}, {0, 0.05, 0}));
  EXPECT_GT(book.parted, 10);
  EXPECT_GT(book.doubled, 0);
  EXPECT_EQ(b.pieces().size(), 1u);
  b.expect_sound("slit", kLeastDihedral);
}

TEST(TetCut, ABladeBesideTheBodyDoesNothing) {
  Body b(3, 3, 3, 0.005, 40);
  const std::vector<Tet> before = b.tets.cells;
  for (const Blade& blade : {rectangle({0.05, 0, 0}, {0, 0.02, 0}, {0, 0, 0.02}), Blade{},
                             rectangle({0.007, 0.007, 0.007}, {0.02, 0, 0}, {0.02, 0, 0})}) {
    const CutResult book = b.cut(blade);
    EXPECT_EQ(book.parted + book.doubled + book.snapped, 0);
  }
  EXPECT_EQ(b.tets.cells, before);
}

TEST(TetCut, ACutThroughADeformedBodyLiesWhereTheTissueWasThen) {
  // Bent by a quarter: the plane z = const of the bent body is none of the drawn one.
  Body b(4, 4, 12, 0.005, 400);
  for (Vec3d& p : b.now) p.x += 8 * p.z * p.z;
  const CutResult book = b.cut(rectangle({0.02, 0.01, 0.031}, {0.1, 0, 0}, {0, 0.05, 0}));
  ASSERT_EQ(b.pieces().size(), 2u);
  EXPECT_NEAR(b.pieces()[1] / b.volume_before, 1 - 0.031 / 0.06, 0.03);
  EXPECT_LT(std::fabs(book.volume), 1e-3 * b.volume_before);
}

TEST(TetCut, WithoutSpareNodesItSaysSoAndStaysSound) {
  Body b(5, 5, 5, 0.005, 3);
  const CutResult book = b.cut(rectangle({0.0125, 0.0125, 0.012}, {0.05, 0, 0}, {0, 0.05, 0}));
  EXPECT_TRUE(book.full);
  EXPECT_EQ(book.doubled, 3);
  EXPECT_EQ(size_t(b.tets.nodes), b.tets.rest.size());
}

TEST(TetCut, AThousandRandomCutsKeepVolumeShapeAndAClosedSurface) {
  Body b(10, 8, 6, 0.005, 60'000, 0.2);
  const double least = std::min(kLeastDihedral, b.least_angle());
  core::Random random(41);
  const auto any = [&](double size) {
    return Vec3d{random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
  };
  double booked = 0;
  int parted = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3d middle{random.uniform(0, 0.05), random.uniform(0, 0.04), random.uniform(0, 0.03)};
    const Vec3d u = any(0.012), v = any(0.012);
    const CutResult book = b.cut(rectangle(middle, u, v - (dot(u, v) / dot(u, u)) * u));
    ASSERT_FALSE(book.full) << i;
    booked += book.volume;
    parted += book.parted;
    if (i % 100 == 99) b.expect_sound(("cut " + std::to_string(i)).c_str(), least - 1e-9);
  }
  EXPECT_NEAR(b.volume(), b.volume_before + booked, 1e-9 * b.volume_before);
  EXPECT_LT(std::fabs(booked), 0.03 * b.volume_before) << "what snaps along the surface shaved off";
  EXPECT_GT(parted, 1000);
  RecordProperty("smallest_dihedral", std::to_string(b.least_angle()));
  RecordProperty("pieces", int(b.pieces().size()));
  RecordProperty("volume_shaved_off", std::to_string(-booked / b.volume_before));
}

TEST(TetCut, TheSameCutsGiveTheSameBits) {
  const auto run = [] {
    Body b(6, 6, 6, 0.005, 2000, 0.2);
    core::Random random(7);
    for (int i = 0; i < 20; ++i) {
      const auto any = [&] { return random.uniform(-0.01, 0.01); };
      const Vec3d middle{random.uniform(0, 0.03), random.uniform(0, 0.03), random.uniform(0, 0.03)};
      const Vec3d u{any(), any(), any()}, v{any(), any(), any()};
      b.cut(rectangle(middle, u, cross(u, v) / length(u)));
    }
    return b;
  };
  const Body one = run();
  Body other = run();
  EXPECT_EQ(one.tets.cells, other.tets.cells);
  EXPECT_EQ(one.tets.across, other.tets.across);
  for (std::int32_t i = 0; i < one.tets.nodes; ++i)
    EXPECT_EQ(length(one.tets.rest[size_t(i)] - other.tets.rest[size_t(i)]), 0);
}

TEST(TetCut, RefusesWhatIsNoBody) {
  const std::vector<Vec3d> x{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {0.2, 0.2, 2}};
  EXPECT_THROW(cuttable(x, std::vector<Tet>{{0, 1, 2, 9}}, 0), std::invalid_argument);
  EXPECT_THROW(cuttable(x, std::vector<Tet>{{0, 2, 1, 3}}, 0), std::invalid_argument);
  EXPECT_THROW(cuttable(x, std::vector<Tet>{{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}}, 0), std::invalid_argument);
  EXPECT_NO_THROW(cuttable(x, std::vector<Tet>{{0, 1, 2, 3}, {0, 2, 1, 4}}, 0));
}

}  // namespace
}  // namespace trocar::geometry
