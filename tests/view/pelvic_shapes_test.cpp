// What is drawn of the pelvis beyond its simulated bodies: fimbriae, the bore of tubes, bowel that goes on.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/view/anatomy/bowel_loops.hpp>
#include <trocar/view/anatomy/fat_tags.hpp>
#include <trocar/view/anatomy/gut_line.hpp>
#include <trocar/view/anatomy/omentum_lobe.hpp>
#include <trocar/view/bodies/fimbria.hpp>
#include <trocar/view/bodies/tube_drawing.hpp>

#include "pelvis.hpp"

namespace trocar::view {
namespace {

const BowelLoops& loops() {
  static const BowelLoops made = bowel_loops(pelvis(), WallSurface(pelvis()));
  return made;
}

const sim::SolidModel& solid(const std::string& look) {
  const auto found =
      std::find_if(pelvis().solids.begin(), pelvis().solids.end(), [&](const auto& s) { return s.look == look; });
  if (found == pelvis().solids.end()) throw std::runtime_error("no " + look);
  return *found;
}

/// How far outside a skin a point lies, by the plane of the nearest vertex [m].
double above(const tissue::Skin& skin, Vec3d p) {
  double nearest = 1, height = 0;
  for (std::size_t v = 0; v < skin.rest.size(); ++v) {
    const Vec3d way = p - vec_cast<double>(skin.rest[v]);
    if (const double d = length(way); d < nearest) {
      nearest = d;
      height = dot(way, vec_cast<double>(skin.rest_normal[v]));
    }
  }
  return height;
}

/// Middles of a gut's rings.
std::vector<Vec3d> line_of(const MeshBuffer& gut) {
  std::vector<Vec3d> line;
  for (std::size_t i = 0; i + kGutSides <= gut.positions.size(); i += kGutSides) {
    Vec3d sum{};
    for (std::size_t k = 0; k < kGutSides; ++k) sum += (1.0 / kGutSides) * vec_cast<double>(gut.positions[i + k]);
    line.push_back(sum);
  }
  return line;
}

int pieces_of_surface(const MeshBuffer& b) {
  geometry::TriMesh mesh;
  for (const Vec3f& p : b.positions) mesh.positions.push_back(vec_cast<double>(p));
  for (std::size_t i = 0; i + 2 < b.indices.size(); i += 3)
    mesh.triangles.push_back({int(b.indices[i]), int(b.indices[i + 1]), int(b.indices[i + 2])});
  mesh = geometry::merged_vertices(mesh, 1e-7);
  std::vector<int> root(mesh.positions.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int v) {
    while (root[std::size_t(v)] != v) v = root[std::size_t(v)] = root[std::size_t(root[std::size_t(v)])];
    return v;
  };
  for (const auto& t : mesh.triangles) {
    root[std::size_t(find(t[0]))] = find(t[1]);
    root[std::size_t(find(t[2]))] = find(t[1]);
  }
  std::vector<int> used;
  for (const auto& t : mesh.triangles) used.push_back(find(t[0]));
  std::sort(used.begin(), used.end());
  return int(std::unique(used.begin(), used.end()) - used.begin());
}

TEST(Fimbriae, OfTheRimAreOneSurfaceWithTheirTube) {
  for (const char* name : {"tube_left", "tube_right"})
    EXPECT_EQ(pieces_of_surface(TubeDrawing(pelvis(), pelvis().strand_index(name)).drawn()), 1 + kFoldFronds) << name;
}

TEST(Fimbriae, OfTheFoldsRiseOutOfTheBell) {
  FimbriaSite site;
  site.radius = 0.004;
  site.down = {0, 0, -1};
  const MeshBuffer b = fimbriae(site);
  const std::uint32_t bell = 11 * kRimColumns;
  std::vector<std::uint32_t> part(b.size());
  for (std::uint32_t v = 0; v < b.size(); ++v) part[v] = v;
  const auto first = [&](std::uint32_t v) {
    while (part[v] != v) v = part[v];
    return v;
  };
  for (std::size_t i = 0; i + 2 < b.indices.size(); i += 3)
    for (const std::size_t k : {1, 2}) {
      const std::uint32_t one = first(b.indices[i]), other = first(b.indices[i + k]);
      part[std::max(one, other)] = std::min(one, other);
    }
  int fronds = 0;
  for (std::uint32_t v = bell; v < b.size(); ++v) {
    if (first(v) != v) continue;  // its root is a frond's first vertex
    ++fronds;
    float nearest = 1;
    for (std::uint32_t w = 0; w < bell; ++w) nearest = std::min(nearest, length(b.positions[w] - b.positions[v]));
    EXPECT_LT(nearest, 0.25f * float(site.radius)) << v;
  }
  EXPECT_EQ(fronds, kFoldFronds);
}

TEST(Fimbriae, LeaveTheRimWithoutAnEdge) {
  FimbriaSite site;
  site.radius = 0.004;
  site.down = {0, 0, -1};
  const MeshBuffer b = fimbriae(site);
  std::vector<Vec3f> normals;
  render::vertex_normals(b.positions, b.indices, normals);
  const std::uint32_t rim = 3 * kRimColumns;  // the last row of the bell's outer side
  int bent = 0;
  for (std::uint32_t k = 0; k < std::uint32_t(kRimColumns); ++k)
    bent += dot(normals[rim + k], normals[rim - std::uint32_t(kRimColumns) + k]) < 0.8f;
  EXPECT_LE(bent, kRimFronds) << "but between two of them";
}

TEST(Fimbriae, LieOnTheOvaryAndNotInIt) {
  for (const char* side : {"left", "right"}) {
    const TubeDrawing tube(pelvis(), pelvis().strand_index(std::string("tube_") + side));
    const auto ovary = std::find_if(pelvis().solids.begin(), pelvis().solids.end(),
                                    [&](const auto& s) { return s.name == std::string("ovary_") + side; });
    ASSERT_NE(ovary, pelvis().solids.end());
    double nearest = 1;
    FimbriaSite any;
    any.radius = 0.004;
    for (const Vec3f& p : std::span(tube.drawn().positions).last(fimbriae(any).size()))
      nearest = std::min(nearest, above(ovary->fine, vec_cast<double>(p)));
    EXPECT_LT(nearest, 0.001) << side;
    EXPECT_GT(nearest, -0.0016) << side;
  }
}

TEST(TubeDrawing, StaysWithinAMillimetreAndAHalfOfTheSimulatedTube) {
  const int strand = pelvis().strand_index("tube_left");
  const TubeDrawing tube(pelvis(), strand);
  const interactions::StrandBody& body = pelvis().strand_bodies[std::size_t(strand)];
  const std::vector<double>& outer = pelvis().strands[std::size_t(strand)].outer;
  double thinnest = 1, thickest = 0;
  for (std::size_t n = 4; n + 5 < body.model.rest.size(); ++n) {  // between the uterus and the bell
    const Vec3d middle = body.model.rest[n], along = normalised(body.model.rest[n + 1] - body.model.rest[n - 1]);
    double farthest = 0;
    for (const Vec3f& p : tube.drawn().positions) {
      const Vec3d d = vec_cast<double>(p) - middle;
      if (std::fabs(dot(d, along)) > 0.0008 || length(d) > 0.012) continue;
      farthest = std::max(farthest, length(d));
    }
    EXPECT_NEAR(farthest, outer[n], 0.0015) << n;
    thinnest = std::min(thinnest, farthest);
    thickest = std::max(thickest, farthest);
  }
  EXPECT_LT(thinnest, 0.002);   // the isthmus
  EXPECT_GT(thickest, 0.0038);  // the ampulla
}

TEST(FatTags, RiseFromTheBowelsSkinWithoutABorderAndHangOver) {
  auto backend = render::make_null_backend();
  const sim::SolidModel& bowel = solid("bowel");
  const OrganDrawing organ(bowel, {}, std::vector<Paint>(bowel.fine.rest.size()), *backend);
  const FatTags tags(organ, bowel, 6, pelvis().gravity, *backend);
  int feet = 0, over = 0;
  double out = 0;
  for (std::size_t i = 0; i < tags.buffer().positions.size(); ++i) {
    const Vec3f p = tags.buffer().positions[i], n = tags.buffer().normals[i];
    const double high = above(bowel.fine, vec_cast<double>(p));
    out = std::max(out, high);
    over += high > 0.001 && dot(vec_cast<double>(n), pelvis().gravity) > 0.5 * length(pelvis().gravity);
    if (tags.buffer().paint[i].tint < 255) continue;
    ++feet;
    EXPECT_LT(high, 0.0005);  // what has the bowel's colour lies on it or below
  }
  EXPECT_GT(feet, 300);
  EXPECT_GT(over, 200);  // their undersides
  EXPECT_GT(out, 0.004);
}

TEST(FatTags, AreBroaderThanTheyAreHighAndNoneIsNearAnother) {
  auto backend = render::make_null_backend();
  const sim::SolidModel& bowel = solid("bowel");
  const OrganDrawing organ(bowel, {}, std::vector<Paint>(bowel.fine.rest.size()), *backend);
  const FatTags one(organ, bowel, 1, pelvis().gravity, *backend), six(organ, bowel, 6, pelvis().gravity, *backend);
  const std::size_t each = one.buffer().positions.size();
  ASSERT_EQ(six.buffer().positions.size(), 6 * each);
  std::vector<Vec3d> middles;
  for (std::size_t first = 0; first < six.buffer().positions.size(); first += each) {
    Vec3d sum{};
    double wide = 0, high = 0;
    const Vec3f middle = six.buffer().positions[first];
    for (std::size_t i = first; i < first + each; ++i) {
      const Vec3f p = six.buffer().positions[i];
      sum += (1.0 / double(each)) * vec_cast<double>(p);
      wide = std::max(wide, double(length(p - middle)));
      high = std::max(high, above(bowel.fine, vec_cast<double>(p)));
    }
    EXPECT_GT(2 * wide, 1.5 * high);
    for (const Vec3d& other : middles) EXPECT_GT(length(other - sum), 0.008);
    middles.push_back(sum);
  }
}

TEST(BowelLoops, TheLargeBowelsEndIsInsideWhatGoesOnFromIt) {
  const std::vector<Vec3d> line = line_of(loops().large);
  ASSERT_GT(line.size(), 10u);
  const Vec3d end = line[5], onward = normalised(line[8] - line[2]);
  int looked = 0;
  for (const Vec3f& v : solid("bowel").fine.rest) {
    const Vec3d d = vec_cast<double>(v) - end;
    if (length(d) > 0.025 || dot(d, onward) < 0.003) continue;
    ++looked;
    double nearest = 1, around = 0;
    for (std::size_t i = 0; i < loops().large.positions.size(); ++i) {
      const Vec3d p = vec_cast<double>(loops().large.positions[i]);
      if (const double far = length(p - vec_cast<double>(v)); far < nearest) {
        nearest = far;
        around = dot(vec_cast<double>(v) - p, vec_cast<double>(loops().large.normals[i]));
      }
    }
    EXPECT_LT(around, 0.001);
  }
  EXPECT_GT(looked, 10);
}

TEST(BowelLoops, TheRectumGoesOnFromItsOtherEndAndIsLostBelow) {
  const std::vector<Vec3d> line = line_of(loops().large);
  const tissue::Skin& bowel = solid("bowel").fine;
  Vec3d tip = line[5];
  for (const Vec3f& v : bowel.rest)
    if (length(vec_cast<double>(v) - line[5]) > length(tip - line[5])) tip = vec_cast<double>(v);
  double nearest = 1;
  for (const Vec3d& p : line) nearest = std::min(nearest, length(p - tip));
  EXPECT_LT(nearest, 0.02);
  EXPECT_GT(dot(line.back() - tip, normalised(pelvis().gravity)), 0.02);
}

TEST(BowelLoops, SmallBowelIsBesideItselfAndBesideTheLarge) {
  const std::vector<Vec3d> line = line_of(loops().small);
  ASSERT_GT(line.size(), 100u);
  for (std::size_t i = 0; i < line.size(); ++i) {
    for (std::size_t j = i + 16; j < line.size(); ++j) EXPECT_GT(length(line[i] - line[j]), 0.015) << i << " " << j;
    EXPECT_GT(above(solid("bowel").fine, line[i]), 0.006) << i;
  }
}

TEST(BowelLoops, ScenesWithoutLargeBowelHaveNone) {
  const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cutting/scene.json"));
  EXPECT_EQ(bowel_loops(model, WallSurface(model)).small.size(), 0u);
  EXPECT_EQ(bowel_loops(model, WallSurface(model)).omentum.size(), 0u);
}

TEST(OmentumLobe, LiesOnWhatIsBelowItAndEndsInABorder) {
  const Vec3d up{0, 0, 1};
  LobeOutline outline;
  for (int j = 0; j <= 30; ++j) {
    outline.border.push_back({0.002 * j, 0, 0});
    outline.root.push_back({0.002 * j, 0.06, 0});
  }
  std::vector<Vec3d> below;  // a floor with a ridge 10 mm high across the middle
  for (int j = -10; j <= 40; ++j)
    for (int i = -10; i <= 40; ++i) below.push_back({0.002 * j, 0.002 * i, i > 12 && i < 18 ? 0.01 : 0.0});
  const MeshBuffer lobe = omentum_lobe(outline, below, up);
  ASSERT_GT(lobe.size(), 0u);
  for (std::size_t v = outline.border.size(); v < lobe.size(); ++v) {
    EXPECT_LT(lobe.positions[v].z, 0.02f) << v;
    const bool on_the_ridge = std::fabs(lobe.positions[v].y - 0.03f) < 0.002f;
    EXPECT_GT(lobe.positions[v].z, on_the_ridge ? 0.0095f : -0.0005f) << v;
  }
  for (std::size_t v = 0; v < outline.border.size(); ++v) EXPECT_LT(lobe.positions[v].z, 0.001f) << "tucked under";
  EXPECT_EQ(omentum_lobe(outline, {}, up).size(), 0u);
}

TEST(OmentumLobe, CoversTheFloorsBorderInThePelvisAndNotThePouch) {
  const MeshBuffer& lobe = loops().omentum;
  ASSERT_GT(lobe.size(), 0u);
  EXPECT_LT(lobe.indices.size() / 3, 9000u);
  const Vec3d pool{0, -0.150, -0.165};
  for (const Vec3f& p : lobe.positions) EXPECT_GT(length(vec_cast<double>(p) - pool), 0.03);
}

}  // namespace
}  // namespace trocar::view
