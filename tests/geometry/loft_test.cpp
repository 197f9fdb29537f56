#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/core/hash.hpp>
#include <trocar/geometry/surfaces/loft.hpp>
#include <trocar/numerics/portable.hpp>

using namespace trocar;
using namespace trocar::geometry;

namespace {

// A bent, flattened, boxy body about the size of a uterus.
std::vector<Section> body() {
  std::vector<Section> sections;
  for (int i = 0; i < 6; ++i) {
    const double t = i / 5.0, a = 0.8 * t, width = 0.013 + 0.014 * t * t, depth = 0.011 + 0.008 * t;
    const Vec3d across{1, 0, 0}, deep{0, portable::sin(a), portable::cos(a)};
    sections.push_back(
        {{0, 0.07 * portable::sin(a), -0.07 * (1 - portable::cos(a))}, width * across, depth * deep, 2.4});
  }
  return sections;
}
// A sphere: three parallels and caps that complete it... the caps of an equator-only body are two half spheres.
std::vector<Section> capsule(double radius, double half_length) {
  return {{{0, 0, -half_length}, {radius, 0, 0}, {0, radius, 0}, 2.0},
          {{0, 0, 0}, {radius, 0, 0}, {0, radius, 0}, 2.0},
          {{0, 0, half_length}, {radius, 0, 0}, {0, radius, 0}, 2.0}};
}
struct Quality {
  double shortest = 1e9, longest = 0, mean = 0, smallest_angle = 180, worst_aspect = 0;
};
Quality quality(const TriMesh& mesh) {
  Quality q;
  const auto all = edges(mesh);
  for (const auto& [a, b] : all) {
    const double l = length(mesh.positions[b] - mesh.positions[a]);
    q.shortest = std::min(q.shortest, l), q.longest = std::max(q.longest, l), q.mean += l / double(all.size());
  }
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3d p = mesh.positions[t[k]];
      const Vec3d x = normalised(mesh.positions[t[(k + 1) % 3]] - p),
                  y = normalised(mesh.positions[t[(k + 2) % 3]] - p);
      q.smallest_angle = std::min(q.smallest_angle, portable::acos(dot(x, y)) * 180 / portable::pi);
    }
  return q;
}

}  // namespace

TEST(Section, OutlineIsTheEllipseOrSuperellipse) {
  const Section ellipse{{1, 2, 3}, {2, 0, 0}, {0, 0, 1}, 2.0}, boxy{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 4.0};
  for (double t = 0; t < 1; t += 0.03) {
    const Vec3d p = outline(ellipse, t) - ellipse.centre, q = outline(boxy, t);
    EXPECT_NEAR(p.x * p.x / 4 + p.z * p.z, 1, 1e-14);
    EXPECT_NEAR(q.x * q.x * q.x * q.x / 16 + q.y * q.y * q.y * q.y, 1, 1e-13);
  }
}

TEST(Loft, PassesThroughItsSectionsAndClosesInPoles) {
  const auto sections = body();
  const NurbsSurface surface = loft(sections);
  for (std::size_t s = 0; s < sections.size(); ++s) {
    const double v = surface.knots_v[3 + 4 + s];  // four rings of the cap come first
    for (int i = 0; i < 24; ++i)
      EXPECT_LT(length(surface.point(i / 24.0, v) - outline(sections[s], i / 24.0)), 1e-12) << s;
    for (int i = 0; i < 100; ++i)  // between the points followed: a hundredth of a millimetre
      EXPECT_LT(length(surface.point(i / 100.0, v) - outline(sections[s], i / 100.0)), 3e-5) << s;
  }
  for (double v : {0.0, 1.0})
    for (double u = 0; u < 1; u += 0.1) EXPECT_LT(length(surface.point(u, v) - surface.point(0, v)), 1e-12);
}

TEST(Loft, EndsAreRoundLikeHalfASphere) {
  const double r = 0.01, half = 0.02;
  const NurbsSurface surface = loft(capsule(r, half));
  double worst = 0;  // the cubic swings by 2 % where the curvature along jumps from 0 to 1/r
  for (double v = 0; v <= 1; v += 0.01)
    for (double u = 0; u < 1; u += 0.07) {
      const Vec3d p = surface.point(u, v);
      const double z = std::clamp(p.z, -half, half);
      worst = std::max(worst, std::fabs(length(p - Vec3d{0, 0, z}) / r - 1));
    }
  EXPECT_LT(worst, 0.03);
}

TEST(Loft, RefusesWhatHasNoSurface) {
  EXPECT_THROW(loft(std::vector<Section>(1)), std::invalid_argument);
  auto sections = body();
  sections[0].deep = 2.0 * sections[0].across;
  EXPECT_THROW(loft(sections), std::invalid_argument);
  sections = body();
  sections[2] = sections[1];
  EXPECT_THROW(loft(sections), std::invalid_argument);
}

TEST(Tessellation, IsClosedOutwardsAndOfOnePiece) {
  for (double edge : {0.02, 0.006, 0.0025, 0.0012}) {
    const TriMesh mesh = tessellate(loft(body()), edge);
    const EdgeReport report = check_edges(mesh);
    EXPECT_TRUE(report.closed()) << edge;
    EXPECT_GT(volume(mesh), 0) << edge;
    EXPECT_EQ(int(mesh.positions.size()) - report.edges + int(mesh.triangles.size()), 2) << edge;
  }
  auto mirrored = body();
  for (Section& s : mirrored) s.across = -s.across;
  EXPECT_GT(volume(tessellate(loft(mirrored), 0.004)), 0);
}

TEST(Tessellation, IsEven) {
  for (double edge : {0.004, 0.002}) {
    const TriMesh mesh = tessellate(loft(body()), edge);
    const Quality q = quality(mesh);
    EXPECT_NEAR(q.mean / edge, 1, 0.1);
    EXPECT_GT(q.shortest / edge, 0.35);
    EXPECT_LT(q.longest / edge, 1.9);
    EXPECT_GT(q.smallest_angle, 20);
    RecordProperty("triangles", int(mesh.triangles.size()));
    std::printf("edge %g: %d triangles, edges %.2f .. %.2f .. %.2f of it, smallest angle %.1f degrees\n", edge,
                int(mesh.triangles.size()), q.shortest / edge, q.mean / edge, q.longest / edge, q.smallest_angle);
  }
}

TEST(Tessellation, LiesOnTheSurfaceWithTheVolumeOfTheBody) {
  const double r = 0.01, half = 0.02;
  const NurbsSurface surface = loft(capsule(r, half));
  const Tessellation fine = tessellate_with_parameters(surface, 0.0005);
  const double truth = portable::pi * r * r * 2 * half + 4.0 / 3.0 * portable::pi * r * r * r;
  EXPECT_NEAR(volume(fine.mesh) / truth, 1, 0.03);  // the swing of the test above
  for (std::size_t i = 0; i < fine.parameters.size(); ++i)
    EXPECT_LT(length(surface.point(fine.parameters[i][0], fine.parameters[i][1]) - fine.mesh.positions[i]), 1e-12);
  const auto normals = vertex_normals(fine.mesh);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vec3d p = fine.mesh.positions[i];
    EXPECT_GT(dot(normals[i], normalised(p - Vec3d{0, 0, std::clamp(p.z, -half, half)})), 0.99);
  }
}

TEST(Tessellation, RefusesSurfacesThatDoNotClose) {
  NurbsSurface open = loft(capsule(0.01, 0.02));
  for (int i = 0; i < open.count_u; ++i) open.control[i] += 0.001 * double(i) * Vec3d{1, 0, 0};
  EXPECT_THROW(tessellate(open, 0.002), std::invalid_argument);
}

// The value was printed once by gcc 12 on x86-64; every other compiler and machine must find the same.
TEST(Tessellation, GivesTheSameBitsOnEveryCompiler) {
  const TriMesh mesh = tessellate(loft(body()), 0.004);
  core::Hasher hasher;
  hasher.add(mesh.positions);
  hasher.add(mesh.triangles);
  EXPECT_EQ(hasher.value(), 0x237821e1cef66a0cull) << std::hex << hasher.value();
}
