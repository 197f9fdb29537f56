// Ducts and vessels of the hepatoduodenal ligament end within the liver: fat covers where they go in, and no edge of it
// shows.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/render/meshes/openness.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/view/anatomy/porta.hpp>
#include <trocar/view/base/looks.hpp>

namespace trocar::view {
namespace {

const sim::Model& upper_abdomen() {
  static const sim::Model model =
      scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cholecystectomy_operation/scene.json"));
  return model;
}

std::size_t ligament() {
  const std::vector<sim::WallModel>& walls = upper_abdomen().walls;
  for (std::size_t w = 0; w < walls.size(); ++w)
    if (walls[w].name == "hepatoduodenal_ligament") return w;
  ADD_FAILURE() << "no such wall";
  return 0;
}

std::size_t liver() {
  const std::vector<sim::SolidModel>& solids = upper_abdomen().solids;
  for (std::size_t s = 0; s < solids.size(); ++s)
    if (solids[s].name == "liver") return s;
  ADD_FAILURE() << "no such organ";
  return 0;
}

/// [m] < 0: below the skin
double above_skin(Vec3d p, const tissue::Skin& skin) {
  double nearest = 1, side = 1;
  for (const auto& t : skin.triangles) {
    const auto corner = [&](std::size_t k) { return vec_cast<double>(skin.rest[std::size_t(t[k])]); };
    if (length(corner(0) - p) > 0.03) continue;
    const auto at = geometry::closest_on_triangle(p, corner(0), corner(1), corner(2));
    if (at.distance2 >= nearest) continue;
    nearest = at.distance2;
    side = dot(p - at.point, cross(corner(1) - corner(0), corner(2) - corner(0)));
  }
  return side < 0 ? -std::sqrt(nearest) : std::sqrt(nearest);
}

struct PortaScene {
  std::unique_ptr<render::Backend> backend = render::make_null_backend();
  std::vector<PortaEntry> entries = porta_entries(upper_abdomen(), ligament(), liver());
  const sim::SolidModel& solid = upper_abdomen().solids[liver()];
  OrganDrawing organ{solid, {}, std::vector<Paint>(solid.fine.rest.size()), *backend};
  Porta porta{upper_abdomen(), ligament(), liver(), entries, *backend};
};

TEST(Porta, DuctAndArteryGoIntoTheLiverThroughItsFace) {
  const PortaScene s;
  std::vector<std::string> names;
  for (const PortaEntry& e : s.entries) {
    names.push_back(upper_abdomen().strands[e.strand].name);
    EXPECT_NEAR(above_skin(e.at, s.solid.fine), 0, 0.001) << names.back();
    EXPECT_GT(above_skin(e.at + 0.004 * e.out, s.solid.fine), 0.001) << names.back() << " comes out of it";
  }
  EXPECT_EQ(names, (std::vector<std::string>{"common_duct", "right_hepatic_artery"}));
}

TEST(Porta, CoversStrandsWhereTheyGoIn) {
  const PortaScene s;
  for (const PortaEntry& e : s.entries) {
    const Vec3d middle = e.at + 0.0015 * e.out, u = any_perpendicular(e.out), v = cross(e.out, u);
    for (int k = 0; k < 12; ++k) {
      const Vec3d side = std::cos(k * 0.5236) * u + std::sin(k * 0.5236) * v, p = middle + e.radius * side;
      if (above_skin(p, s.solid.fine) < 0.001 || above_skin(p, upper_abdomen().walls[ligament()].skin) < 0.001)
        continue;  // within one of both
      double out = 0;
      for (const Vec3f& at : s.porta.buffer().positions) {
        const Vec3d off = vec_cast<double>(at) - middle;
        if (std::fabs(dot(off, e.out)) < 0.002 && dot(off, side) > 0.85 * length(off)) out = std::max(out, length(off));
      }
      EXPECT_GT(out, e.radius + 0.0002) << upper_abdomen().strands[e.strand].name << " is bare, sector " << k;
    }
  }
}

TEST(Porta, HasNoEdgeThatIsSeen) {
  const PortaScene s;
  const MeshBuffer& mesh = s.porta.buffer();
  ASSERT_GT(mesh.indices.size(), 3000u);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{mesh.indices[t + k], mesh.indices[t + (k + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    if (edges.count({edge.second, edge.first})) continue;
    const auto p = vec_cast<double>(mesh.positions[edge.first]);
    EXPECT_TRUE(above_skin(p, s.solid.fine) < 0 || above_skin(p, upper_abdomen().walls[ligament()].skin) < 0)
        << "an edge in the air at " << p.x << " " << p.y << " " << p.z;
  }
}

TEST(Porta, GoesAlongWithTheLiverWhereItLiesOnIt) {
  PortaScene s;
  s.porta.settle(s.organ, render::OpennessBaker({}, 0.001f, 0.018f));
  const std::vector<Vec3f> before = s.porta.buffer().positions;
  sim::State state = sim::initial_state(upper_abdomen());
  for (tissue::NodeState& node : state.solids[liver()].nodes) node.z += 0.002f;
  s.organ.update(state.solids[liver()]);
  s.porta.update(s.organ);
  float most = 0, least = 1;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const float way = length(s.porta.buffer().positions[i] - before[i]);
    most = std::max(most, way);
    least = std::min(least, way);
  }
  EXPECT_NEAR(most, 0.002f, 2e-4f);
  EXPECT_LT(least, 2e-4f) << "what lies on the ligament stays";
}

TEST(Porta, IsThereForWhoAsksForItOnly) {
  for (std::size_t w = 0; w < upper_abdomen().walls.size(); ++w)
    EXPECT_EQ(look(upper_abdomen(), upper_abdomen().walls[w].look).has(Look::Generator::porta), w == ligament());
}

}  // namespace
}  // namespace trocar::view
